#pragma once
// Which surfaces a pixel may show: every triangle whose coverage interval touches its sample and which nothing in front
// is sure to hide.
#include <cstdint>
#include <span>
#include <vector>

#include "judge/bounds/window.h"
#include "judge/legal/judged_rows.h"
#include "judge/legal/surface.h"

namespace trueshade::oracle {

/// A triangle that a pixel may show, and how surely.
struct PossibleSurface {
  uint32_t instance = 0, triangle = 0;
  uint8_t piece = 0;
  bool certain = false;                  ///< covers the sample whatever the profile leaves open
  bool nominal = false;                  ///< covers it where vertices are in the middle of their boxes
  bool masked = false;                   ///< its alpha test may go either way
  bool cut = false;                      ///< its doubt comes from near, far, w or the sides of the view
  float chance_other = 0;                ///< predicted probability that coverage is not the nominal one
  double low = 0, high = 0, middle = 0;  ///< of the test's key: smaller is in front
};

/// Possible surfaces of every pixel, in submission order; row 0 is the bottom row.
struct PossibleSurfaces {
  std::vector<uint32_t> first;  ///< width * height + 1
  std::vector<PossibleSurface> list;
  /// The possible surfaces of a pixel, by its index; none where nothing may be seen.
  std::span<const PossibleSurface> at(size_t pixel) const {
    return {list.data() + first[pixel], first[pixel + 1] - first[pixel]};
  }
};

/// The key of the clear depth. Keys are how a depth test orders fragments: the least one is seen. LESS and LEQUAL: z;
/// GREATER and GEQUAL: -z; ALWAYS: the last drawn; EQUAL, NOTEQUAL: all alike, so that whatever was drawn is a possible
/// surface; NEVER: nothing passes.
double clear_key(const GeometryState& state);

/// The possible surfaces of pixels where surfaces hide one another, found with every core. Memory: 56 bytes each, a few
/// per covered pixel. `rows`: where they are looked for; other pixels get none.
PossibleSurfaces possible_surfaces(const Projector& projector, const JudgedRows& rows = {}, int threads = 0);

/// The fragments that may have the depth which opaque surfaces leave at a pixel, be they seen or not: beside the
/// possible surfaces those that fail the test against a clear depth which they may have themselves. Under tests that do
/// not order depths all fragments; `certain` is of their coverage and the alpha test alone.
PossibleSurfaces find_tied(const Projector& projector, const JudgedRows& rows = {}, int threads = 0);

/// All fragments of transparent surfaces but those sure to lie behind `front`, the key of what is in front of each
/// pixel (row 0 the bottom row). None hides another; `certain` is of coverage and the alpha test alone.
PossibleSurfaces find_transparent(const Projector& projector, const std::vector<double>& front,
                                  const JudgedRows& rows = {}, int threads = 0);

}  // namespace trueshade::oracle
