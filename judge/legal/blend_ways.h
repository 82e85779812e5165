#pragma once
// The ways in which the fragments of one light's draw may take a pixel from one texel to the next.
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "judge/legal/blend_range.h"
#include "judge/legal/light_output.h"
#include "judge/legal/pixel_class.h"

namespace trueshade::oracle {

/// What one fragment of a light's draw may output at a pixel, and how often it may be drawn there.
struct DrawnFragment {
  LightOutput output;
  int least = 1, most = 1, nominal = 1;
  PixelClass doubt = PixelClass::edge;           ///< the pixel's class if it is drawn another number of times than
                                                 ///< `nominal`
  std::optional<std::array<Range, 4>> likely{};  ///< what the likely rule outputs, where that differs: of clears

  /// The source colour by the likely rule: `likely`, or else the nominal output.
  const std::array<Range, 4>& likely_source() const { return likely ? *likely : output.nominal; }
};

/// One way in which a pixel's fragments may have been drawn: what the pixel then holds, and the class that it then has.
struct Way {
  PixelClass pixel_class = PixelClass::exact;
  Texel texel;
  double value[4] = {};  ///< source colour of the last fragment drawn
};

inline constexpr size_t kMostWays = 64;  // of drawing a pixel that are tried apart

/// What a pixel that holds `from` may hold after the fragments: one Way for each number of times that each fragment may
/// be drawn and for each result of its open comparison. The nominal way comes first. Where there are more than
/// kMostWays: the nominal one, and one that holds all others.
///   fragments: in the order in which they are blended
std::vector<Way> ways_from(const Texel& from, std::span<const DrawnFragment> fragments, const BlendState& blend,
                           Format format, const Profile& profile);

/// A fast test for unorm targets to which each light's colour is added (ONE, ONE). Deletable: ways_from() judges each
/// pixel that as_predicted() does not accept, and would find EXACT each that it accepts.
class AddedCodes {
 public:
  /// Finds out whether the format and the blend state allow the test.
  AddedCodes(Format format, const BlendState& blend);

  /// Whether they do. If not, as_predicted() must not be called.
  bool suit() const { return suit_; }

  /// Whether the texel `after` is the texel `before` with the nominal codes of one fragment's `color` added, clamped,
  /// and with its alpha unchanged. False also where the colour lies so near the middle of two codes that either may be
  /// added.
  bool as_predicted(const Bounded3& color, const uint8_t* before, const uint8_t* after) const;

 private:
  bool suit_ = false;
  int bytes_ = 1, channels_ = 4;
  double largest_ = 255;
};

}  // namespace trueshade::oracle
