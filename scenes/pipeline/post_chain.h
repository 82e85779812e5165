#pragma once
#include <cstdint>

#include "core/format.h"

namespace trueshade {

inline constexpr Format kPostOutputs[] = {Format::rgba8, Format::rgba16f, Format::rgba32f};

/// What is done with the target afterwards, in this order; docs/post.md has every operation. Every field may change
/// pixels; the defaults do nothing, and then the image is the target.
struct PostChain {
  int samples = 1;             ///< a side, 1..8: the frame is drawn that much larger and each square averaged
  float marker_radius = 0.0f;  ///< scene units; point and spot lights as spheres of their colour; 0: none

  /// Light that glows around what is bright.
  struct Bloom {
    float strength = 0.0f;   ///< how much of the blurred light is added; 0: none
    float threshold = 1.0f;  ///< what is above it in a channel glows
    int radius = 8;          ///< of one blur, pixels, 1..14: binomial weights C(2r, k) / 4^r
    int passes = 1;          ///< blurs one upon another, 1..64
    bool operator==(const Bloom&) const = default;
  } bloom;

  enum class ToneMap : uint8_t { none, reinhard };
  ToneMap tone_map = ToneMap::none;
  float key = 0.18f;         ///< what the logarithmic mean luminance is mapped to; above 0
  float white = 0.0f;        ///< the least luminance, after scaling by the key, that is mapped to 1; 0: infinite
  float log_offset = 1e-4f;  ///< added to luminances before the logarithm; above 0

  enum class Encode : uint8_t { linear, srgb };
  Encode encode = Encode::linear;
  bool edge_filter = false;       ///< edges smoothed by their shape in luminance
  Format output = Format::rgba8;  ///< of kPostOutputs; not read where there is nothing else to do

  bool operator==(const PostChain&) const = default;
  bool active() const;  ///< Whether anything is done with the target.
};

}  // namespace trueshade
