#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "compare/flip_map.h"
#include "core/pixel_mask.h"

namespace trueshade::compare {

/// FLIP (Andersson et al. 2020), and of more light than a screen shows HDR-FLIP (Andersson et al. 2021): how different
/// two pictures look to somebody who alternates between them. The figures are within 1e-4 of those of NVIDIA's tool.

enum class ToneMapper : uint8_t { aces, hable, reinhard };
inline constexpr std::array<std::string_view, 3> kToneMapperNames = {"aces", "hable", "reinhard"};

/// Factors of light as powers of 2, from start to stop.
struct Exposures {
  double start, stop;
  int count;
};

struct FlipOptions {
  double pixels_per_degree =
      67.0206433;  ///< a screen of 3840 pixels and 0.7 m, seen from 0.7 m: 0.7 * 3840/0.7 * pi/180
  ToneMapper tone_mapper = ToneMapper::aces;  ///< of HDR-FLIP
  std::optional<Exposures> exposures;         ///< of HDR-FLIP; nothing: exposures_of()
  int threads = 0;                            ///< 0: one a core. Never changes a figure
  const PixelMask* mask = nullptr;  ///< pixels that are in no figure; both pictures are alike there. Null: none
};

/// Pixels' errors in [0, 1], and their figures. A weighted percentile counts each pixel by its error.
struct FlipResult {
  std::vector<float> map;  ///< rows from the top
  double mean = 0, weighted_median = 0, weighted_first_quartile = 0, weighted_third_quartile = 0, least = 0,
         largest = 0;
  std::optional<Exposures> exposures;  ///< of HDR-FLIP
};

/// Of pictures of one size that show what a screen shows: light in [0, 1].
FlipResult flip(const LinearPicture& reference, const LinearPicture& test, const FlipOptions& options);

/// HDR-FLIP: the largest error of each pixel over the exposures. Empty map where the exposures cannot be found.
FlipResult hdr_flip(const LinearPicture& reference, const LinearPicture& test, const FlipOptions& options);

/// From the exposure at which the brightest pixel of the reference is shown at 0.85 to that at which its median pixel
/// is. Pixels of no light are not counted for the median where it would be 0. Nothing for a picture without light.
std::optional<Exposures> exposures_of(const LinearPicture& reference, ToneMapper mapper,
                                      const PixelMask* mask = nullptr);

/// The figures of a map. What the mask leaves out is 0 in it.
void measure(FlipResult& result, const PixelMask* mask = nullptr);

}  // namespace trueshade::compare
