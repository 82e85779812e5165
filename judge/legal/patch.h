#pragma once
#include <span>
#include <vector>

#include "judge/legal/possible_surfaces.h"

namespace trueshade::oracle {

/// Triangles of one instance around a sample. Each edge that may pass on either side of the sample is shared by two of
/// them, in opposite directions; so their winding number about the sample is the same wherever the vertices are.
struct ClosedPatch {
  struct Member {
    size_t surface;  ///< index in the list that closed_patches() was given
    int sense;       ///< 1 counter-clockwise in the window, -1 clockwise, 0 not known
  };
  std::vector<Member> members;
  int turns = 0;  ///< the winding number about the sample, at nominal vertices; 0: no member need cover it
};
/// Stands in TransparentPixel::turns for a patch that rules nothing out: a member's sense is not known, or a member is
/// hidden.
inline constexpr int kOpenPatch = 1 << 30;

/// Finds the closed patches among the surfaces that may or may not cover the sample (x, y), in the window, y up. Those
/// that surely cover it are left out, and masked ones (a hole in a mask is no seam). A surface is in one patch at most;
/// one that is in doubt by no edge is in none.
std::vector<ClosedPatch> closed_patches(const Projector& projector, std::span<const PossibleSurface> possible, double x,
                                        double y);

/// The depth key behind which nothing can be seen at a sample because a closed patch covers it: each of the patch's
/// triangles alone may miss the sample, but a winding number that is not 0 means that one of them has it (GL 4.6 core,
/// 14.6.1: of two polygons that share an edge exactly one has a sample on it). Returns the least, over such patches, of
/// the greatest key of a member; infinity where there is none, and under depth functions that do not order fragments.
double patch_key(const Projector& projector, std::span<const PossibleSurface> possible, double x, double y);

}  // namespace trueshade::oracle
