#pragma once
#include <span>
#include <vector>

#include "judge/legal/possible_surfaces.h"

namespace trueshade::oracle {

/// Possible surfaces of one instance whose every edge in doubt is walked once each way: the winding number of the group
/// about the sample does not depend on where its vertices are.
struct ClosedPatch {
  struct Member {
    size_t surface;  ///< index in the list
    int sense;       ///< 1 counter-clockwise in the window, -1 clockwise, 0 not known
  };
  std::vector<Member> members;
  int turns = 0;  ///< the winding number about the sample, at nominal vertices; 0: no member need cover it
};
/// TransparentPixel::turns of a patch that tells nothing: a sense is not known, or a member is hidden.
inline constexpr int kOpenPatch = 1 << 30;

/// The patches among possible surfaces that are not certain and not masked (a hole in a mask is no seam). A surface is
/// in at most one; one that is in doubt, but by no edge, is in none. (x, y): the sample in the window, y up.
std::vector<ClosedPatch> closed_patches(const Projector& projector, std::span<const PossibleSurface> possible, double x,
                                        double y);

/// The key behind which nothing can be seen at a sample, although each of the triangles over it alone is in doubt:
/// watertightness (GL 4.6 core, 14.6.1: of two polygons that share an edge exactly one has a sample on it). Where every
/// edge in doubt of a group of possible surfaces of one instance is walked once each way, the winding number of the
/// group about the sample does not depend on where its vertices are; if it is not 0, one of the group covers the
/// sample. Returns the least, over such groups, of the greatest key of their members; infinity if there is none.
double patch_key(const Projector& projector, std::span<const PossibleSurface> possible, double x, double y);

}  // namespace trueshade::oracle
