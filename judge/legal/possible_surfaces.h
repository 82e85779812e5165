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

/// A triangle that may be seen at a pixel, and how surely it covers the pixel's sample.
struct PossibleSurface {
  uint32_t instance = 0, triangle = 0;
  uint8_t piece = 0;
  bool certain = false;                  ///< covers the sample whatever the profile leaves open
  bool nominal = false;                  ///< covers it where vertices are in the middle of their boxes
  bool masked = false;                   ///< its alpha test may go either way
  bool cut = false;                      ///< its doubt comes from near, far, w or the sides of the view
  float chance_other = 0;                ///< predicted probability that coverage is not the nominal one
  double low = 0, high = 0, middle = 0;  ///< of the depth test's key (clear_key()): smaller is in front
};

/// The surfaces that each pixel may show. Those of pixel i are list[first[i]] up to list[first[i + 1]], in submission
/// order; row 0 is the bottom row.
struct PossibleSurfaces {
  std::vector<uint32_t> first;  ///< width * height + 1
  std::vector<PossibleSurface> list;
  /// The surfaces that a pixel, by its index, may show; none where nothing may be seen.
  std::span<const PossibleSurface> at(size_t pixel) const {
    return {list.data() + first[pixel], first[pixel + 1] - first[pixel]};
  }
};

/// The key of the clear depth. Keys are how a depth test orders fragments: the least one is seen. LESS and LEQUAL: z;
/// GREATER and GEQUAL: -z; ALWAYS: the last drawn; EQUAL, NOTEQUAL: all alike, so that whatever was drawn may be seen;
/// NEVER: nothing passes.
double clear_key(const GeometryState& state);

/// Finds the opaque surfaces that each pixel may show. Memory: 56 bytes a surface, a few surfaces a covered pixel.
///   rows:    pixels of other rows get none
///   threads: 0: one a core
PossibleSurfaces possible_surfaces(const Projector& projector, const JudgedRows& rows = {}, int threads = 0);

/// Finds the opaque fragments, seen or not, whose depth may equal the depth that opaque surfaces leave at a pixel.
/// These are the possible surfaces, and those that fail the test against a clear depth which they may have themselves.
/// Under depth functions that do not order depths they are all opaque fragments. `certain`: the fragment surely covers
/// the sample and passes the alpha test and the depth test against the clear depth.
PossibleSurfaces find_tied(const Projector& projector, const JudgedRows& rows = {}, int threads = 0);

/// Finds the fragments of transparent surfaces that are not surely hidden by opaque ones. No transparent fragment hides
/// another. `certain` is of coverage and the alpha test alone.
///   front: for each pixel, row 0 at the bottom, the key behind which all is hidden
PossibleSurfaces find_transparent(const Projector& projector, const std::vector<double>& front,
                                  const JudgedRows& rows = {}, int threads = 0);

}  // namespace trueshade::oracle
