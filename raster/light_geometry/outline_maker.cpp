#include "raster/light_geometry/outline_maker.h"

#include <algorithm>
#include <bit>
#include <compare>
#include <cstdlib>

#include "raster/triangles/clipped_fan.h"
#include "raster/triangles/edge_rule.h"

namespace trueshade {
namespace {

using Wide = __int128;

// Whether clipping leaves nothing of the mesh in the viewport: all of it is behind the camera, or beyond one side.
bool out_of_view(const TransformedMesh& placed) {
  const size_t count = placed.world.size();
  bool behind = true, side[4] = {true, true, true, true};
  for (size_t i = 0; i < count; ++i) {
    const float x = placed.clip[0][i], y = placed.clip[1][i], w = placed.clip[3][i];
    behind = behind && w <= 0.0f;
    side[0] = side[0] && x > w;
    side[1] = side[1] && x < -w;
    side[2] = side[2] && y > w;
    side[3] = side[3] && y < -w;
  }
  return behind || side[0] || side[1] || side[2] || side[3];
}

int64_t doubled_area(const LightMesh& mesh, const TransformedMesh& placed, size_t triangle) {
  const uint32_t* v = &mesh.indices[3 * triangle];
  return int64_t(placed.x[v[1]] - placed.x[v[0]]) * (placed.y[v[2]] - placed.y[v[0]]) -
         int64_t(placed.x[v[2]] - placed.x[v[0]]) * (placed.y[v[1]] - placed.y[v[0]]);
}

// The samples in a box of corners: (v - 128) / 256, rounded up and down.
int32_t first_sample(int64_t v, int low, int high) { return int32_t(std::clamp<int64_t>((v + 127) >> 8, low, high)); }
int32_t past_sample(int64_t v, int low, int high) {
  return int32_t(std::clamp<int64_t>(((v - 128) >> 8) + 1, low, high));
}

}  // namespace

OutlineMaker::Outline OutlineMaker::outline(const LightMesh& mesh, const TransformedMesh& placed) {
  if (state_.cull_face == CullFace::front_and_back) return {};
  const size_t first = edges_.size();
  Outline out;
  if (!placed.any_needs_clip)
    out = unclipped_outline(mesh, placed);
  else if (!out_of_view(placed))
    out = clipped_outline(mesh, placed);
  out.edges = uint32_t(edges_.size() - first);
  return out;
}

OutlineMaker::Outline OutlineMaker::unclipped_outline(const LightMesh& mesh, const TransformedMesh& placed) {
  Outline out;
  const auto count = std::ptrdiff_t(placed.world.size());
  const auto [left, right] = std::minmax_element(placed.x.begin(), placed.x.begin() + count);
  const auto [low, high] = std::minmax_element(placed.y.begin(), placed.y.begin() + count);
  out.x0 = first_sample(*left, window_.x0, window_.x1), out.x1 = past_sample(*right, window_.x0, window_.x1);
  out.y0 = first_sample(*low, window_.y0, window_.y1), out.y1 = past_sample(*high, window_.y0, window_.y1);
  if (out.x0 >= out.x1 || out.y0 >= out.y1) return {};
  // The mesh is closed, so that its other side covers each sample as often.
  const bool left_turn = !culled(state_, !window_.upper_left), right_turn = !culled(state_, window_.upper_left);
  out.layers = left_turn && right_turn ? 2 : 1;
  out.kind = find_loop(mesh, placed, left_turn ? 1 : -1) && convex_loop() ? add_edges() : OutlineKind::mesh;
  return out;
}

// Of a mesh that clipping cuts, or that the camera is in.
OutlineMaker::Outline OutlineMaker::clipped_outline(const LightMesh& mesh, const TransformedMesh& placed) {
  int sign = 0;
  sides_.clear();
  if (!add_sides(mesh, placed, sign)) return everywhere(OutlineKind::mesh);
  if (sides_.empty()) return {};
  cancel_shared_sides();
  if (!link_sides() || !convex_loop()) return everywhere(OutlineKind::mesh);
  Outline out = everywhere(add_edges());
  Corner least = loop_[0], most = loop_[0];
  for (const Corner& c : loop_) {
    least = {std::min(least.x, c.x), std::min(least.y, c.y)};
    most = {std::max(most.x, c.x), std::max(most.y, c.y)};
  }
  out.x0 = first_sample(least.x, window_.x0, window_.x1), out.x1 = past_sample(most.x, window_.x0, window_.x1);
  out.y0 = first_sample(least.y, window_.y0, window_.y1), out.y1 = past_sample(most.y, window_.y0, window_.y1);
  return out.x0 < out.x1 && out.y0 < out.y1 ? out : Outline{};
}

// Corners of the one loop around the triangles of a sign, counter-clockwise; false if there is another number.
bool OutlineMaker::find_loop(const LightMesh& mesh, const TransformedMesh& placed, int sign) {
  constexpr uint32_t kNone = UINT32_MAX;
  const size_t triangles = mesh.triangles();
  drawn_.assign(triangles, 0);
  next_.assign(mesh.unit.size(), kNone);
  for (size_t t = 0; t < triangles; ++t) {
    const int64_t area = doubled_area(mesh, placed, t);
    drawn_[t] = sign > 0 ? area >= 0 : area <= 0;
  }
  uint32_t start = kNone;
  size_t edges = 0;
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    if (drawn_[i / 3] == 0 || drawn_[mesh.neighbour[i]] != 0) continue;
    start = mesh.indices[i];
    if (next_[start] != kNone) return false;
    next_[start] = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
    ++edges;
  }
  loop_.clear();
  uint32_t v = start;
  for (size_t steps = 0; v != kNone && steps < edges; v = next_[v], ++steps)
    loop_.push_back({placed.x[v], placed.y[v]});
  if (edges == 0 || v != start || loop_.size() != edges) return false;
  if (sign < 0) std::reverse(loop_.begin(), loop_.end());
  return true;
}

// Sides of all pieces of the drawn triangles, the inside to the left, but for those that two triangles share which
// clipping leaves alone: they would cancel. False where pieces of both signs are drawn, or a fan has turned over.
bool OutlineMaker::add_sides(const LightMesh& mesh, const TransformedMesh& placed, int& sign) {
  const auto add = [&](const WindowTriangle& t, int piece_sign) {
    for (size_t k = 0; k < 3; ++k) {
      const size_t from = piece_sign > 0 ? k : (k + 1) % 3, to = piece_sign > 0 ? (k + 1) % 3 : k;
      sides_.push_back({{t.x[from], t.y[from]}, {t.x[to], t.y[to]}});
    }
  };
  const auto joins = [&](int piece_sign) {
    if (culled(state_, (piece_sign > 0) != window_.upper_left)) return false;
    sign |= piece_sign > 0 ? 1 : 2;
    return true;
  };
  drawn_.assign(mesh.triangles(), 0);
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const uint32_t* const corner = &mesh.indices[i];
    if ((placed.needs_clip[corner[0]] | placed.needs_clip[corner[1]] | placed.needs_clip[corner[2]]) == 0) {
      const int64_t area = doubled_area(mesh, placed, i / 3);
      if (area != 0 && joins(area > 0 ? 1 : -1)) drawn_[i / 3] = area > 0 ? 1 : -1;
      continue;
    }
    ClipVertex clip[3];
    for (size_t k = 0; k < 3; ++k)
      for (size_t c = 0; c < 4; ++c) clip[k].c[c] = placed.clip[c][corner[k]];
    const ClippedFan fan = clipped_fan(clip, window_, 0, 0);
    if (fan.count == 0 || !joins(fan.facing)) continue;
    if (fan.folded) return false;
    for (int piece = 0; piece < fan.count; ++piece) add(fan.piece[piece].triangle, fan.piece[piece].sign);
  }
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    const int8_t side = drawn_[i / 3];
    if (side == 0 || drawn_[mesh.neighbour[i]] != 0) continue;
    const size_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
    const Corner from{placed.x[a], placed.y[a]}, to{placed.x[b], placed.y[b]};
    sides_.push_back(side > 0 ? Side{from, to} : Side{to, from});
  }
  return sign != 3;
}

// Takes away what two triangles go along in opposite directions. Equal sides meet in a table of places: sorting took
// half of the time of an outline.
void OutlineMaker::cancel_shared_sides() {
  std::erase_if(sides_, [](const Side& s) { return s.from == s.to; });
  const size_t places = std::bit_ceil(2 * sides_.size() + 1);
  const auto place_of = [&](const Side& s) {
    uint64_t mixed = 0;
    for (const int64_t v : {s.from.x, s.from.y, s.to.x, s.to.y})
      mixed = (std::rotl(mixed, 29) ^ uint64_t(v)) * 0x9E3779B97F4A7C15ull;
    return size_t(mixed >> 32) & (places - 1);
  };
  place_.assign(places, 0);
  upward_.clear();
  for (size_t i = 0; i < sides_.size(); ++i) {  // upward_.size() of them, all different, come to the front
    const bool up = sides_[i].from < sides_[i].to;
    const Side side = up ? sides_[i] : Side{sides_[i].to, sides_[i].from};
    size_t at = place_of(side);
    while (place_[at] != 0 && sides_[place_[at] - 1] != side) at = (at + 1) & (places - 1);
    if (place_[at] == 0) {
      sides_[upward_.size()] = side;
      upward_.push_back(0);
      place_[at] = uint32_t(upward_.size());
    }
    upward_[place_[at] - 1] += up ? 1 : -1;
  }
  sides_.resize(upward_.size());
  size_t kept = 0;
  for (size_t i = 0; i < upward_.size(); ++i) {
    const Side up = sides_[i];
    const Side left = upward_[i] > 0 ? up : Side{up.to, up.from};
    if (upward_[i] != 0) sides_[kept++] = left;
    for (int more = std::abs(upward_[i]); more > 1; --more) sides_.push_back(left);
  }
  sides_.erase(sides_.begin() + std::ptrdiff_t(kept), sides_.begin() + std::ptrdiff_t(upward_.size()));
}

// Corners of the one loop that the sides make; false if there is another number.
bool OutlineMaker::link_sides() {
  std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) { return a.from < b.from; });
  for (size_t i = 1; i < sides_.size(); ++i)
    if (sides_[i].from == sides_[i - 1].from) return false;
  loop_.clear();
  size_t at = 0;
  do {
    loop_.push_back(sides_[at].from);
    const auto next = std::lower_bound(sides_.begin(), sides_.end(), sides_[at].to,
                                       [](const Side& s, const Corner& c) { return s.from < c; });
    if (next == sides_.end() || next->from != sides_[at].to) return false;
    at = size_t(next - sides_.begin());
  } while (at != 0 && loop_.size() < sides_.size());
  return at == 0 && loop_.size() == sides_.size();
}

// Whether the loop is a convex polygon, once its repeated points are gone.
bool OutlineMaker::convex_loop() {
  loop_.erase(std::unique(loop_.begin(), loop_.end()), loop_.end());
  while (loop_.size() > 1 && loop_.back() == loop_.front()) loop_.pop_back();
  const size_t corners = loop_.size();
  if (corners < 3 || corners > kMostOutlineCorners) return false;
  const auto up = [](int64_t dx, int64_t dy) { return dy > 0 || (dy == 0 && dx > 0); };
  int upward_turns = 0;
  for (size_t i = 0; i < corners; ++i) {
    const Corner &a = loop_[i], &b = loop_[i + 1 < corners ? i + 1 : i + 1 - corners],
                 &c = loop_[i + 2 < corners ? i + 2 : i + 2 - corners];
    const int64_t ux = b.x - a.x, uy = b.y - a.y, vx = c.x - b.x, vy = c.y - b.y;
    const Wide cross = Wide(ux) * vy - Wide(uy) * vx;
    if (cross < 0 || (cross == 0 && Wide(ux) * vx + Wide(uy) * vy <= 0)) return false;
    upward_turns += !up(ux, uy) && up(vx, vy);
  }
  return upward_turns == 1;
}

// Keeps the edges of the loop that some pixel of the window is outside of.
OutlineKind OutlineMaker::add_edges() {
  const size_t first = edges_.size();
  const int64_t width = window_.x1 - window_.x0, height = window_.y1 - window_.y0;
  for (size_t i = 0; i < loop_.size(); ++i) {
    const Corner &a = loop_[i], &b = loop_[i + 1 < loop_.size() ? i + 1 : 0];
    const int64_t dx = b.x - a.x, dy = b.y - a.y;
    const bool owns = owns_edge(dx, dy, window_.upper_left);
    const Wide e =
        Wide(dx) * (int64_t(window_.y0) * 256 + 128 - a.y) - Wide(dy) * (int64_t(window_.x0) * 256 + 128 - a.x);
    const Wide at = (e - (owns ? 0 : 1)) >> 8, right = Wide(-dy) * (width - 1), top = Wide(dx) * (height - 1);
    if (at + std::max<Wide>(right, 0) + std::max<Wide>(top, 0) < 0) {
      edges_.resize(first);
      return OutlineKind::nothing;
    }
    if (at + std::min<Wide>(right, 0) + std::min<Wide>(top, 0) >= 0) continue;
    edges_.push_back({int64_t(at + Wide(dy) * window_.x0 - Wide(dx) * window_.y0), -dy, dx});
  }
  return edges_.size() == first ? OutlineKind::everywhere : OutlineKind::polygon;
}

}  // namespace trueshade
