#include "judge/legal/patch.h"

#include <algorithm>
#include <numeric>

#include "judge/legal/possible_sample.h"

namespace trueshade::oracle {

namespace {

struct DoubtfulEdge {
  size_t member;
  Pair from, to;
};

size_t root_of(std::vector<size_t>& parent, size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Signed coverage of one triangle at nominal vertices: 1, 0 or -1.
int winding(const Piece& piece, double x, double y) {
  int left = 0;
  for (size_t i = 0; i < 3; ++i) left += nominally_left(piece.v[i], piece.v[(i + 1) % 3], x, y) ? 1 : 0;
  return left == 3 ? 1 : left == 0 ? -1 : 0;
}

}  // namespace

std::vector<ClosedPatch> closed_patches(const Projector& projector, std::span<const PossibleSurface> possible, double x,
                                        double y) {
  std::vector<size_t> members;
  std::vector<Piece> shapes, pieces;
  std::vector<DoubtfulEdge> edges;
  const ClipOrigin origin = projector.pipeline().geometry.clip_origin;
  for (size_t k = 0; k < possible.size(); ++k) {
    const PossibleSurface& c = possible[k];
    if (c.certain || c.masked) continue;
    projector.pieces(c.instance, c.triangle, pieces);
    const Piece& piece = pieces[c.piece];
    const Coverage cover = coverage_at(piece, projector.profile(), origin, x, y);
    for (size_t i = 0; i < 3; ++i)
      if ((cover.uncertain_edges >> i & 1u) != 0)
        edges.push_back({members.size(), piece.v[(i + 1) % 3].exact, piece.v[(i + 2) % 3].exact});
    members.push_back(k);
    shapes.push_back(piece);
  }
  std::vector<size_t> parent(members.size());
  std::iota(parent.begin(), parent.end(), size_t(0));
  std::vector<bool> open(members.size(), false), paired(edges.size(), false);
  for (size_t i = 0; i < edges.size(); ++i) {
    for (size_t j = i + 1; j < edges.size() && !paired[i]; ++j) {
      const bool twins = !paired[j] && edges[i].from == edges[j].to && edges[i].to == edges[j].from &&
                         possible[members[edges[i].member]].instance == possible[members[edges[j].member]].instance;
      if (!twins) continue;
      paired[i] = paired[j] = true;
      parent[root_of(parent, edges[i].member)] = root_of(parent, edges[j].member);
    }
  }
  std::vector<bool> edged(members.size(), false);  // otherwise the doubt is not of an edge
  for (size_t i = 0; i < edges.size(); ++i) {
    edged[edges[i].member] = true;
    if (!paired[i]) open[edges[i].member] = true;
  }
  std::vector<ClosedPatch> patches;
  for (size_t group = 0; group < members.size(); ++group) {
    if (root_of(parent, group) != group) continue;
    ClosedPatch patch;
    bool closed = true;
    for (size_t i = 0; i < members.size(); ++i) {
      if (root_of(parent, i) != group) continue;
      closed = closed && edged[i] && !open[i];
      patch.turns += winding(shapes[i], x, y);
      patch.members.push_back({members[i], shapes[i].facing_known ? shapes[i].sign : 0});
    }
    if (closed) patches.push_back(std::move(patch));
  }
  return patches;
}

double patch_key(const Projector& projector, std::span<const PossibleSurface> possible, double x, double y) {
  double key = HUGE_VAL;
  const DepthFunc func = projector.pipeline().geometry.depth_func;
  if (!orders_depths(func) && func != DepthFunc::always) return key;  // what covers the sample need not pass
  for (const ClosedPatch& patch : closed_patches(projector, possible, x, y)) {
    if (patch.turns == 0) continue;
    double behind = -HUGE_VAL;
    for (const ClosedPatch::Member& m : patch.members) behind = std::max(behind, possible[m.surface].high);
    key = std::min(key, behind);
  }
  return key;
}

}  // namespace trueshade::oracle
