#include "judge/legal/possible_surfaces.h"

#include <algorithm>

#include "core/threads/parallel_for.h"
#include "judge/legal/map_range.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

constexpr uint32_t kChunk = 8192;  // triangles a piece of work
constexpr size_t kBatch = 64;      // pieces of work between merges: bounds the memory of entries not yet pruned

struct Entry {
  uint32_t pixel;
  PossibleSurface surface;
};

struct Work {
  uint32_t instance, first, last;
};

/// What a search is for.
struct Search {
  bool transparent = false;  ///< surfaces drawn apart, none of which hides another; else all the others
  bool apart = false;        ///< whether there are any that are drawn apart
  bool wants(const Projector& p, uint32_t instance) const {
    const Scene& scene = p.scene();
    return !apart || scene.materials[scene.instances[instance].material].transparent == transparent;
  }
};

void key_range(const GeometryState& state, const Range& z, double order, PossibleSurface& c) {
  switch (state.depth_func) {
    case DepthFunc::less:
    case DepthFunc::lequal:
      c.low = z.low, c.middle = z.value, c.high = z.high;
      return;
    case DepthFunc::greater:
    case DepthFunc::gequal:
      c.low = -z.high, c.middle = -z.value, c.high = -z.low;
      return;
    case DepthFunc::always:
      c.low = c.middle = c.high = -order;
      return;
    case DepthFunc::equal:
    case DepthFunc::notequal:
    case DepthFunc::never:
      c.low = c.middle = c.high = 0;
      return;
  }
}

/// Whether near and far, which float arithmetic places with an error, may cut here after all.
bool near_a_limit(const GeometryState& state, const Range& z) {
  if (state.depth_clamp) return false;
  const double near = double(state.depth_near), far = double(state.depth_far);
  return z.low <= std::min(near, far) || z.high >= std::max(near, far);
}

/// What the alpha test leaves of a possible surface; false: nothing.
bool test_alpha(const Projector& p, const Piece& piece, const SurfacePoint& point, const TriangleValues& values,
                double x, double y, PossibleSurface& c) {
  const Material& material = p.scene().materials[p.scene().instances[c.instance].material];
  if (!material.masked()) return true;
  const AlphaVerdict verdict = alpha_verdict(p, material, piece, point, values, x, y);
  if (!verdict.may_keep) return false;
  if (!verdict.may_drop) return true;
  c.certain = false, c.masked = true, c.chance_other = 0.5f;
  c.nominal = c.nominal && verdict.nominal_keeps;
  return true;
}

/// `bound`: of each pixel, what is sure to be in front; what lies behind is not added.
void add_piece(const Projector& p, const Piece& piece, PossibleSurface base, double order, const PixelRect& rect,
               const std::vector<double>& bound, std::vector<Entry>& out) {
  const GeometryState& state = p.pipeline().geometry;
  const bool offset = state.polygon_offset_factor != 0 || state.polygon_offset_units != 0;
  const bool masked = p.scene().materials[p.scene().instances[base.instance].material].masked();
  const TriangleValues values = masked ? triangle_values(p, base.instance, base.triangle) : TriangleValues{};
  double largest = 0;
  for (const WindowVertex& v : piece.v) largest = std::max(largest, std::fabs(v.z));
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (const WindowVertex& v : piece.v)
    for (size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], v.low[k]), high[k] = std::max(high[k], v.high[k]);
  for (int y = rect.y0; y < rect.y1; ++y) {
    if (y + 0.5 < low[1] || y + 0.5 > high[1]) continue;
    for (int x = rect.x0; x < rect.x1; ++x) {
      if (x + 0.5 < low[0] || x + 0.5 > high[0]) continue;
      const Coverage cover = coverage_at(piece, p.profile(), state.clip_origin, x + 0.5, y + 0.5);
      if (cover.cover == Cover::no) continue;
      const SurfacePoint point(piece, p.profile(), p.window_reach(), x + 0.5, y + 0.5);
      const Range z = stored_depth(point, state, p.profile(), largest);
      PossibleSurface c = base;
      c.cut = piece.cut || piece.leaves_view;
      c.certain = cover.cover == Cover::certain && point.bounded();
      c.chance_other = float(cover.chance_other);
      c.nominal = cover.nominal;
      if (!p.profile().exact_planes && near_a_limit(state, offset ? point.depth() : z))
        c.certain = false, c.cut = true, c.chance_other = 0.5f;
      if (masked && !test_alpha(p, piece, point, values, x + 0.5, y + 0.5, c)) continue;
      key_range(state, z, order, c);
      const uint32_t pixel = uint32_t(y) * uint32_t(p.width()) + uint32_t(x);
      if (c.low <= bound[pixel]) out.push_back({pixel, c});
    }
  }
}

void scan(const Projector& projector, const Work& work, double order, const std::vector<double>& bound,
          std::vector<Entry>& out) {
  std::vector<Piece> pieces;
  PixelRect rect;
  for (uint32_t t = work.first; t < work.last; ++t) {
    if (!projector.near_pixels(work.instance, t, rect)) continue;
    projector.pieces(work.instance, t, pieces);
    PossibleSurface base;
    base.instance = work.instance;
    base.triangle = t;
    for (size_t k = 0; k < pieces.size(); ++k) {
      base.piece = uint8_t(k);
      add_piece(projector, pieces[k], base, order + (t - work.first), rect, bound, out);
    }
  }
}

std::vector<Work> work_of(const Projector& projector, const Search& search) {
  const Scene& scene = projector.scene();
  std::vector<Work> work;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    if (!search.wants(projector, i)) continue;
    const auto count = uint32_t(scene.meshes[scene.instances[i].mesh].triangle_count());
    for (uint32_t t = 0; t < count; t += kChunk) work.push_back({i, t, std::min(count, t + kChunk)});
  }
  return work;
}

}  // namespace

double clear_key(const GeometryState& state) {
  switch (state.depth_func) {
    case DepthFunc::less:
    case DepthFunc::lequal:
      return depth_in_buffer(state, double(state.clear_depth));
    case DepthFunc::greater:
    case DepthFunc::gequal:
      return -depth_in_buffer(state, double(state.clear_depth));
    case DepthFunc::never:
      return -HUGE_VAL;
    default:
      return HUGE_VAL;
  }
}

namespace {

/// `bound`: of each pixel, what is in front of all that is looked for.
PossibleSurfaces found(const Projector& projector, const Search& search, std::vector<double> bound, int threads) {
  const size_t pixels = bound.size();
  const GeometryState& state = projector.pipeline().geometry;
  const double clear = clear_key(state);
  const bool equal_passes = state.depth_func == DepthFunc::lequal || state.depth_func == DepthFunc::gequal;
  const bool ordered = state.depth_func != DepthFunc::equal && state.depth_func != DepthFunc::notequal &&
                       state.depth_func != DepthFunc::never;
  const std::vector<Work> work = work_of(projector, search);
  std::vector<Entry> entries;
  double order = 0;
  for (size_t from = 0; from < work.size(); from += kBatch) {
    const size_t count = std::min(kBatch, work.size() - from);
    std::vector<std::vector<Entry>> lists(count);
    std::vector<double> starts(count);
    for (size_t k = 0; k < count; ++k) starts[k] = order, order += work[from + k].last - work[from + k].first;
    // Nothing writes `bound` meanwhile, and it only falls: what it drops here the merge would drop as well.
    parallel_for(int(count), threads,
                 [&](int k) { scan(projector, work[from + size_t(k)], starts[size_t(k)], bound, lists[size_t(k)]); });
    for (const std::vector<Entry>& list : lists)
      for (Entry e : list) {
        double& limit = bound[e.pixel];
        if (e.surface.low > limit) continue;
        if (!search.transparent) {
          if (e.surface.low == clear && !equal_passes) continue;
          if (e.surface.high > clear || (e.surface.high == clear && !equal_passes)) e.surface.certain = false;
          e.surface.certain = e.surface.certain && ordered;
          if (e.surface.certain) limit = std::min(limit, e.surface.high);
        }
        entries.push_back(e);
      }
  }
  PossibleSurfaces map;
  map.first.assign(pixels + 1, 0);
  const auto kept = [&](const Entry& e) { return e.surface.low <= bound[e.pixel]; };
  for (const Entry& e : entries)
    if (kept(e)) ++map.first[e.pixel + 1];
  for (size_t i = 0; i < pixels; ++i) map.first[i + 1] += map.first[i];
  map.list.resize(map.first[pixels]);
  std::vector<uint32_t> next(map.first.begin(), map.first.end() - 1);
  for (const Entry& e : entries)
    if (kept(e)) map.list[next[e.pixel]++] = e.surface;
  return map;
}

}  // namespace

PossibleSurfaces possible_surfaces(const Projector& projector, int threads) {
  const std::vector<double> clear(size_t(projector.width()) * size_t(projector.height()),
                                  clear_key(projector.pipeline().geometry));
  const Search search{false, draws_transparent(projector.scene(), projector.pipeline())};
  return found(projector, search, clear, threads);
}

PossibleSurfaces find_transparent(const Projector& projector, std::vector<double> front, int threads) {
  return found(projector, {true, true}, std::move(front), threads);
}

}  // namespace trueshade::oracle
