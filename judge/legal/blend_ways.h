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

/// One fragment of a light's draw at a pixel, as often as it may be there.
struct DrawnFragment {
  LightOutput output;
  int least = 1, most = 1, nominal = 1;
  PixelClass doubt = PixelClass::edge;           ///< of another number of them than the nominal one
  std::optional<std::array<Range, 4>> likely{};  ///< what the likely rule draws, where that is another: of clears

  /// What the likely rule draws.
  const std::array<Range, 4>& likely_source() const { return likely ? *likely : output.nominal; }
};

/// How often each fragment was there, and which way a comparison went.
struct Way {
  PixelClass pixel_class = PixelClass::exact;
  Texel texel;
  double value[4] = {};  ///< of the last fragment
};

inline constexpr size_t kMostWays = 64;  // of drawing a pixel that are tried apart

/// Every way from a known texel on, the nominal one first. Of more than kMostWays: the nominal one and the hull of all.
///   fragments: in the order in which they are blended
std::vector<Way> ways_from(const Texel& from, std::span<const DrawnFragment> fragments, const BlendState& blend,
                           Format format, const Profile& profile);

/// Targets of whole codes that draws of one light each only add to, with no other step: what a pixel may become is told
/// by its codes alone. Deletable: ways_from() judges whatever is not as_predicted(), and finds what is as_predicted()
/// EXACT, with no rounding that could have gone another way.
class AddedCodes {
 public:
  /// Finds out whether the target suits.
  AddedCodes(Format format, const BlendState& blend);

  /// Whether the target and the blending are such; otherwise as_predicted() is not asked.
  bool suit() const { return suit_; }

  /// Whether `after` is `before` and the nominal codes of one fragment, alpha left alone, where no other code than the
  /// nominal one is predicted.
  bool as_predicted(const Bounded3& color, const uint8_t* before, const uint8_t* after) const;

 private:
  bool suit_ = false;
  int bytes_ = 1, channels_ = 4;
  double largest_ = 255;
};

}  // namespace trueshade::oracle
