#pragma once
#include <span>
#include <vector>

#include "oracle/intervals/candidates.h"

namespace trueshade::oracle {

/// The key behind which nothing can be seen at a sample, although each of the triangles over it alone is in doubt:
/// watertightness (GL 4.6 core, 14.6.1: of two polygons that share an edge exactly one has a sample on it).
/// Where every edge in doubt of a group of candidates of one instance is walked once each way, the winding number of
/// the group about the sample does not depend on where its vertices are; if it is not 0, one of the group covers the
/// sample. Returns the least, over such groups, of the greatest key of their members; infinity if there is none.
double patch_key(const Projector& projector, std::span<const Candidate> candidates, double x, double y);

}  // namespace trueshade::oracle
