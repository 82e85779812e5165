#include "judge/legal/possible_surfaces.h"

#include <algorithm>
#include <optional>

#include "core/threads/parallel_for.h"
#include "judge/legal/possible_sample.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

constexpr uint32_t kChunk = 8192;         // triangles a piece of work, of one instance
constexpr uint32_t kBatch = 64 * kChunk;  // triangles looked at together: bounds the memory of those that are near
constexpr int kBoxWidth = 16;             // pixels whose coverage is asked for together

/// A possible surface of a pixel of a band, `pixel` counted from the band's first.
struct Entry {
  uint32_t pixel;
  PossibleSurface surface;
};

struct Work {
  uint32_t instance, first, last;
  double order;  ///< of the first triangle among all
};

/// A triangle that may have samples, and the bands that these are in.
struct NearTriangle {
  uint32_t triangle;
  PixelRect rect;
};

/// Which fragments a search keeps.
enum class Kept : uint8_t {
  possible,    ///< of opaque surfaces, those that may be seen
  tied,        ///< of opaque surfaces, those that may have the depth that is left
  transparent  ///< of surfaces drawn apart, none of which hides another
};

/// What a search is for.
struct Search {
  Kept kept = Kept::possible;
  bool apart = false;  ///< whether there are surfaces that are drawn apart
  bool wants(const Projector& p, uint32_t instance) const {
    const Scene& scene = p.scene();
    return !apart || scene.materials[scene.instances[instance].material].transparent == (kept == Kept::transparent);
  }
};

/// Whole rows of the image, which one thread fills. Rows count from the bottom.
class Band {
 public:
  Band(const Projector& projector, const Search& search, int y0, int y1, const std::vector<double>& front)
      : projector_(projector),
        state_(projector.pipeline().geometry),
        search_(search),
        clear_(clear_key(state_)),
        y0_(y0),
        y1_(y1),
        bound_(front.begin() + int64_t(y0) * projector.width(), front.begin() + int64_t(y1) * projector.width()),
        most_(4 * bound_.size()) {}

  /// Adds the fragments of a triangle. Called in order of submission.
  void add(uint32_t instance, const NearTriangle& near, double order);

  int first_row() const { return y0_; }
  int last_row() const { return y1_; }
  void finish(PossibleSurfaces& map);       ///< writes how many each pixel has behind map.first[pixel]
  void write(PossibleSurfaces& map) const;  ///< once map.first is known

 private:
  void add_piece(const Piece& piece, const TriangleValues* values, PossibleSurface base, double order,
                 const PixelRect& rect);
  void keep(Entry entry);
  bool keeps(PossibleSurface& surface, double& limit) const {
    if (search_.kept == Kept::transparent) return surface.low <= limit;
    return search_.kept == Kept::tied ? may_be_left(state_, clear_, surface, limit)
                                      : is_kept(state_, clear_, surface, limit);
  }
  void drop_hidden() {
    if (search_.kept == Kept::tied && !orders_depths(state_.depth_func)) return;
    std::erase_if(entries_, [&](const Entry& e) { return e.surface.low > bound_[e.pixel]; });
  }

  const Projector& projector_;
  const GeometryState& state_;
  const Search& search_;
  const double clear_;
  const int y0_, y1_;
  std::vector<double> bound_;  ///< of each pixel, what is sure to be in front; what lies behind is not added
  std::vector<Entry> entries_;
  size_t most_;  ///< entries, before those that are hidden by now are dropped
  std::vector<Piece> pieces_;
};

void Band::add(uint32_t instance, const NearTriangle& near, double order) {
  const PixelRect rect{near.rect.x0, std::max(near.rect.y0, y0_), near.rect.x1, std::min(near.rect.y1, y1_)};
  if (rect.y0 >= rect.y1) return;
  projector_.pieces(instance, near.triangle, pieces_);
  PossibleSurface base;
  base.instance = instance, base.triangle = near.triangle;
  const Scene& scene = projector_.scene();
  std::optional<TriangleValues> values;
  if (scene.materials[scene.instances[instance].material].masked())
    values = triangle_values(projector_, instance, near.triangle);
  for (size_t k = 0; k < pieces_.size(); ++k) {
    base.piece = uint8_t(k);
    add_piece(pieces_[k], values ? &*values : nullptr, base, order, rect);
  }
}

void Band::add_piece(const Piece& piece, const TriangleValues* values, PossibleSurface base, double order,
                     const PixelRect& rect) {
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (const WindowVertex& v : piece.v)
    for (size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], v.low[k]), high[k] = std::max(high[k], v.high[k]);
  const auto first = [](double v, int from, int to) {
    return int(std::clamp(std::ceil(v - 0.5), double(from), double(to)));
  };
  const auto end_of = [](double v, int from, int to) {
    return int(std::clamp(std::floor(v - 0.5) + 1, double(from), double(to)));
  };
  const int x0 = first(low[0], rect.x0, rect.x1), x1 = end_of(high[0], rect.x0, rect.x1);
  const int y0 = first(low[1], rect.y0, rect.y1), y1 = end_of(high[1], rect.y0, rect.y1);
  if (x0 >= x1 || y0 >= y1) return;
  const PieceShape shape(piece, projector_.profile(), projector_.window_reach());
  base.cut = piece.cut || piece.leaves_view;
  for (int x = x0; x < x1; x += kBoxWidth) {
    const int end = std::min(x + kBoxWidth, x1);
    BoxCoverage box;
    if ((end - x) * (y1 - y0) > 8) box = coverage_of_box(piece, {x + 0.5, y0 + 0.5}, {end - 0.5, y1 - 0.5});
    if (box.none) continue;
    for (int row = y0; row < y1; ++row)
      for (int column = x; column < end; ++column) {
        Coverage cover;
        cover.cover = Cover::certain;
        if (box.edges != 0)
          cover = coverage_at(piece, projector_.profile(), state_.clip_origin, column + 0.5, row + 0.5, box.edges);
        if (cover.cover == Cover::no) continue;
        const std::optional<PossibleSurface> c =
            possible_sample(projector_, piece, shape, values, cover, base, order, column + 0.5, row + 0.5);
        if (c) keep({uint32_t(row - y0_) * uint32_t(projector_.width()) + uint32_t(column), *c});
      }
  }
}

void Band::keep(Entry e) {
  double& limit = bound_[e.pixel];
  if (!keeps(e.surface, limit)) return;
  entries_.push_back(e);
  if (entries_.size() < most_) return;
  drop_hidden();
  most_ = std::max(most_, 2 * entries_.size());
}

void Band::finish(PossibleSurfaces& map) {
  drop_hidden();
  const size_t first = size_t(y0_) * size_t(projector_.width());
  for (const Entry& e : entries_) ++map.first[first + e.pixel + 1];
}

void Band::write(PossibleSurfaces& map) const {
  const size_t first = size_t(y0_) * size_t(projector_.width());
  std::vector<uint32_t> next(map.first.begin() + int64_t(first), map.first.begin() + int64_t(first + bound_.size()));
  for (const Entry& e : entries_) map.list[next[e.pixel]++] = e.surface;
}

std::vector<Work> work_of(const Projector& projector, const Search& search) {
  const Scene& scene = projector.scene();
  std::vector<Work> work;
  double order = 0;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    if (!search.wants(projector, i)) continue;
    const auto count = uint32_t(scene.meshes[scene.instances[i].mesh].triangle_count());
    for (uint32_t t = 0; t < count; t += kChunk) work.push_back({i, t, std::min(count, t + kChunk), order + t});
    order += count;
  }
  return work;
}

/// The work's triangles that may have samples, in order.
std::vector<NearTriangle> near_of(const Projector& projector, const Work& work) {
  std::vector<NearTriangle> near;
  NearTriangle n{};
  for (n.triangle = work.first; n.triangle < work.last; ++n.triangle)
    if (projector.near_pixels(work.instance, n.triangle, n.rect)) near.push_back(n);
  return near;
}

/// Pieces of work that are done together, from `from` on.
size_t batch_end(const std::vector<Work>& work, size_t from) {
  size_t end = from;
  for (uint32_t triangles = 0; end < work.size() && triangles < kBatch; ++end)
    triangles += work[end].last - work[end].first;
  return end;
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

std::vector<Band> bands_of(const Projector& projector, const Search& search, const std::vector<double>& front,
                           const JudgedRows& rows) {
  std::vector<Band> bands;
  const int height = projector.height();
  for (int band = 0; band < JudgedRows::bands_of(height); ++band) {
    const int top = band * JudgedRows::kBand, end = std::min(top + JudgedRows::kBand, height);
    if (rows.has_band(band)) bands.emplace_back(projector, search, height - end, height - top, front);
  }
  return bands;
}

/// `front`: of each pixel, what is in front of all that is looked for.
PossibleSurfaces found(const Projector& projector, const Search& search, const std::vector<double>& front,
                       const JudgedRows& rows, int threads) {
  std::vector<Band> bands = bands_of(projector, search, front, rows);
  const std::vector<Work> work = work_of(projector, search);
  for (size_t from = 0; from < work.size();) {
    const size_t end = batch_end(work, from);
    std::vector<std::vector<NearTriangle>> near(end - from);
    parallel_for(int(near.size()), threads,
                 [&](int k) { near[size_t(k)] = near_of(projector, work[from + size_t(k)]); });
    parallel_for(int(bands.size()), threads, [&](int b) {
      Band& band = bands[size_t(b)];
      for (size_t k = 0; k < near.size(); ++k)
        for (const NearTriangle& n : near[k])
          if (n.rect.y0 < band.last_row() && n.rect.y1 > band.first_row())
            band.add(work[from + k].instance, n, work[from + k].order + (n.triangle - work[from + k].first));
    });
    from = end;
  }
  PossibleSurfaces map;
  map.first.assign(front.size() + 1, 0);
  parallel_for(int(bands.size()), threads, [&](int b) { bands[size_t(b)].finish(map); });
  for (size_t i = 0; i < front.size(); ++i) map.first[i + 1] += map.first[i];
  map.list.resize(map.first.back());
  parallel_for(int(bands.size()), threads, [&](int b) { bands[size_t(b)].write(map); });
  return map;
}

}  // namespace

namespace {

PossibleSurfaces found_opaque(const Projector& projector, Kept kept, const JudgedRows& rows, int threads) {
  const std::vector<double> clear(size_t(projector.width()) * size_t(projector.height()),
                                  clear_key(projector.pipeline().geometry));
  const Search search{kept, draws_transparent(projector.scene(), projector.pipeline())};
  return found(projector, search, clear, rows, threads);
}

}  // namespace

PossibleSurfaces possible_surfaces(const Projector& projector, const JudgedRows& rows, int threads) {
  return found_opaque(projector, Kept::possible, rows, threads);
}

PossibleSurfaces find_tied(const Projector& projector, const JudgedRows& rows, int threads) {
  return found_opaque(projector, Kept::tied, rows, threads);
}

PossibleSurfaces find_transparent(const Projector& projector, const std::vector<double>& front, const JudgedRows& rows,
                                  int threads) {
  return found(projector, {Kept::transparent, true}, front, rows, threads);
}

}  // namespace trueshade::oracle
