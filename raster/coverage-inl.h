// Edge functions -> covered pixels of a tile, block by block, and what happens to them. Included once per SIMD target.
// docs/arithmetic.md sections 4 to 6.
#if defined(TRUESHADE_RASTER_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_COVERAGE_INL_H_
#undef TRUESHADE_RASTER_COVERAGE_INL_H_
#else
#define TRUESHADE_RASTER_COVERAGE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "raster/careful.h"
#include "raster/triangle_setup.h"
#include "raster/vertex_stage-inl.h"
#include "raster/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using M64 = hn::Mask<D64>;

/// Counts covered samples: for overdraw, and for tests of watertightness.
struct CountCommit {
  uint16_t* counts;  ///< in tile_index() order

  template <class T>
  void begin(const TriangleSetup<T>&) {}
  bool hidden(int) const { return false; }
  HWY_INLINE bool vector(int at, M64 covered, V64, V64) {
    const D64 d;
    constexpr size_t kLanes = HWY_MAX_BYTES / sizeof(double);
    alignas(64) double one[kLanes];
    hn::Store(hn::IfThenElseZero(covered, hn::Set(d, 1.0)), d, one);
    for (size_t i = 0; i < hn::Lanes(d); ++i)
      counts[size_t(at) + i] = uint16_t(counts[size_t(at) + i] + (one[i] != 0.0));
    return false;
  }
  bool scalar(int at, double, double) {
    ++counts[at];
    return false;
  }
  void finish_block(int) {}
};

/// Whether a fragment replaces what is there. Ties of the ordered functions go by submission, so order of drawing is
/// free.
constexpr bool passes(DepthFunc func, float z, float there, uint32_t id, uint32_t there_id) {
  switch (func) {
    case DepthFunc::never:
      return false;
    case DepthFunc::less:
      return z < there || (z == there && id < there_id);
    case DepthFunc::lequal:
      return z < there || (z == there && id > there_id);
    case DepthFunc::greater:
      return z > there || (z == there && id < there_id);
    case DepthFunc::gequal:
      return z > there || (z == there && id > there_id);
    case DepthFunc::equal:
      return z == there;
    case DepthFunc::notequal:
      return z != there;
    case DepthFunc::always:
      return true;
  }
  return false;
}

/// Tests depth and keeps the visible id.
struct DepthCommit {
  VisibilityTile& tile;
  DepthFunc func;
  float range_low, range_high;
  bool skip_hidden;  ///< use the blocks' largest depths
  uint64_t fragments = 0;
  uint32_t id = 0;
  double z0 = 0, g1 = 0, g2 = 0, z_low = 0, z_high = 0;
  float nearest = 0;

  template <class T>
  void begin(const TriangleSetup<T>& s) {
    z0 = s.z0, g1 = s.g1, g2 = s.g2, z_low = s.z_low, z_high = s.z_high;
    nearest = std::min(std::max(float(z_low), range_low), range_high);
  }
  bool hidden(int block) const { return skip_hidden && nearest > tile.far[block]; }

  HWY_INLINE bool vector(int at, M64 covered, V64 e1, V64 e2) {
    const D64 d;
    const D32 df;
    const U32 du;
    fragments += hn::CountTrue(d, covered);
    const V64 plane = hn::Add(hn::Set(d, z0), hn::Add(hn::Mul(e1, hn::Set(d, g1)), hn::Mul(e2, hn::Set(d, g2))));
    const V64 in_hull = hn::Min(hn::Max(plane, hn::Set(d, z_low)), hn::Set(d, z_high));
    const V64 in_range = hn::Min(hn::Max(in_hull, hn::Set(d, double(range_low))), hn::Set(d, double(range_high)));
    // Lanes that are not covered become NaN, which passes no comparison below.
    const V64 nan = hn::Set(d, std::numeric_limits<double>::quiet_NaN());
    const V32 z = hn::DemoteTo(df, hn::IfThenElse(covered, in_range, nan));
    const V32 there = hn::Load(df, tile.depth + at);
    const auto there_id = hn::Load(du, tile.id + at);
    const auto my_id = hn::Set(du, id);
    const auto tie_first = hn::And(hn::Eq(z, there), hn::RebindMask(df, hn::Gt(there_id, my_id)));
    const auto tie_last = hn::And(hn::Eq(z, there), hn::RebindMask(df, hn::Gt(my_id, there_id)));
    auto pass = hn::Lt(z, there);
    switch (func) {
      case DepthFunc::never:
        return false;
      case DepthFunc::less:
        pass = hn::Or(pass, tie_first);
        break;
      case DepthFunc::lequal:
        pass = hn::Or(pass, tie_last);
        break;
      case DepthFunc::greater:
        pass = hn::Or(hn::Gt(z, there), tie_first);
        break;
      case DepthFunc::gequal:
        pass = hn::Or(hn::Gt(z, there), tie_last);
        break;
      case DepthFunc::equal:
        pass = hn::Eq(z, there);
        break;
      case DepthFunc::notequal:
        pass = hn::Or(pass, hn::Gt(z, there));
        break;
      case DepthFunc::always:
        pass = hn::Eq(z, z);
        break;
    }
    if (hn::AllFalse(df, pass)) return false;
    hn::Store(hn::IfThenElse(pass, z, there), df, tile.depth + at);
    hn::Store(hn::IfThenElse(hn::RebindMask(du, pass), my_id, there_id), du, tile.id + at);
    return true;
  }

  bool scalar(int at, double e1, double e2) {
    ++fragments;
    const double plane = z0 + (e1 * g1 + e2 * g2);
    const double in_hull = std::min(std::max(plane, z_low), z_high);
    const float z = float(std::min(std::max(in_hull, double(range_low)), double(range_high)));
    if (!passes(func, z, tile.depth[at], id, tile.id[at])) return false;
    tile.depth[at] = z;
    tile.id[at] = id;
    return true;
  }

  HWY_INLINE void finish_block(int block) {
    const D32 df;
    const float* depth = tile.depth + block * kBlockPixels;
    V32 far = hn::Load(df, depth);
    for (size_t i = hn::Lanes(df); i < kBlockPixels; i += hn::Lanes(df)) far = hn::Max(far, hn::Load(df, depth + i));
    tile.far[block] = hn::GetLane(hn::MaxOfLanes(df, far));
  }
};

/// Column and row of each lane's pixel in a block, for vectors that start at a multiple of their length.
alignas(64) inline constexpr double kLaneColumn[8] = {0, 1, 2, 3, 0, 1, 2, 3}, kLaneRow[8] = {0, 0, 0, 0, 1, 1, 1, 1};

/// Edge functions of a setup at vectors of pixels, as f64 rounded once; exact below 2^53.
template <class T>
struct EdgeVectors;

template <>
struct EdgeVectors<double> {
  const TriangleSetup<double>& s;
  V64 across[3];

  explicit EdgeVectors(const TriangleSetup<double>& setup) : s(setup) {
    const D64 d;
    const V64 column = hn::LoadU(d, kLaneColumn), row = hn::LoadU(d, kLaneRow);
    for (int i = 0; i < 3; ++i)
      across[i] = hn::Add(hn::Mul(column, hn::Set(d, s.sx[i])), hn::Mul(row, hn::Set(d, s.sy[i])));
  }
  HWY_INLINE V64 at(int i, double px, double py) const {
    return hn::Add(hn::Set(D64(), s.c[i] + px * s.sx[i] + py * s.sy[i]), across[i]);
  }
};

/// E = high * 2^32 + low with both parts exact, so that one addition rounds it once; and rounding keeps the sign and 1.
template <>
struct EdgeVectors<__int128> {
  static_assert(2 * (kWideBits + 1) + 1 - 32 <= 53);
  double c[3][2], sx[3][2], sy[3][2];  // high, low
  V64 column, row;

  explicit EdgeVectors(const TriangleSetup<__int128>& s)
      : column(hn::LoadU(D64(), kLaneColumn)), row(hn::LoadU(D64(), kLaneRow)) {
    for (int i = 0; i < 3; ++i) {
      split(s.c[i], c[i]);
      split(s.sx[i], sx[i]);
      split(s.sy[i], sy[i]);
    }
  }
  static void split(__int128 v, double out[2]) {
    out[0] = double(int64_t(v >> 32));
    out[1] = double(uint32_t(v));
  }
  HWY_INLINE V64 at(int i, double px, double py) const {
    const D64 d;
    V64 part[2];
    for (int k = 0; k < 2; ++k)
      part[k] = hn::Add(hn::Set(d, c[i][k] + px * sx[i][k] + py * sy[i][k]),
                        hn::Add(hn::Mul(column, hn::Set(d, sx[i][k])), hn::Mul(row, hn::Set(d, sy[i][k]))));
    return hn::Add(hn::Mul(part[0], hn::Set(d, 0x1p32)), part[1]);
  }
};

/// Draws the 4x4 blocks under the triangle's box, a vector of pixels at a time.
template <class T, class Commit>
HWY_INLINE void cover_blocks(const TriangleSetup<T>& s, const TileRect& rect, Commit& commit) {
  const D64 d;
  const int lanes = int(hn::Lanes(d));
  const EdgeVectors<T> edges(s);
  const V64 column = hn::LoadU(d, kLaneColumn), row = hn::LoadU(d, kLaneRow);
  V64 least[3];
  for (int i = 0; i < 3; ++i) least[i] = hn::Set(d, double(s.least[i]));
  const bool limited = rect.limit[0] > 0 || rect.limit[1] > 0 || rect.limit[2] < rect.size || rect.limit[3] < rect.size;
  commit.begin(s);
  for (int by = s.y0 / kBlockSize; by * kBlockSize < s.y1; ++by) {
    for (int bx = s.x0 / kBlockSize; bx * kBlockSize < s.x1; ++bx) {
      const int block = by * (rect.size / kBlockSize) + bx;
      if (commit.hidden(block)) continue;
      bool changed = false;
      for (int k = 0; k < kBlockPixels; k += lanes) {
        const int top = by * kBlockSize + k / kBlockSize;
        if (top >= s.y1 || top + (lanes + kBlockSize - 1) / kBlockSize <= s.y0) continue;
        const double px = bx * kBlockSize + k % kBlockSize, py = top;
        V64 e[3];
        for (int i = 0; i < 3; ++i) e[i] = edges.at(i, px, py);
        M64 covered = hn::And(hn::Ge(e[0], least[0]), hn::And(hn::Ge(e[1], least[1]), hn::Ge(e[2], least[2])));
        if (limited) {
          const V64 x = hn::Add(hn::Set(d, px), column), y = hn::Add(hn::Set(d, py), row);
          covered =
              hn::And(covered, hn::And(hn::Ge(x, hn::Set(d, rect.limit[0])), hn::Lt(x, hn::Set(d, rect.limit[2]))));
          covered =
              hn::And(covered, hn::And(hn::Ge(y, hn::Set(d, rect.limit[1])), hn::Lt(y, hn::Set(d, rect.limit[3]))));
        }
        if (hn::AllFalse(d, covered)) continue;
        changed |= commit.vector(block * kBlockPixels + k, covered, e[1], e[2]);
      }
      if (changed) commit.finish_block(block);
    }
  }
}

/// The same for a box of a few samples, where vectors would stay nearly empty.
template <class Commit>
HWY_INLINE void cover_samples(const TriangleSetup<double>& s, const TileRect& rect, Commit& commit) {
  commit.begin(s);
  for (int y = s.y0; y < s.y1; ++y) {
    for (int x = s.x0; x < s.x1; ++x) {
      if (!s.covers(x, y)) continue;
      const int at = tile_index(rect.size, x, y);
      if (commit.scalar(at, s.edge(1, x, y), s.edge(2, x, y))) commit.finish_block(at / kBlockPixels);
    }
  }
}

/// Draws a triangle by the path its size asks for.
template <class Commit>
inline void draw_window_triangle(const WindowTriangle& triangle, const GeometryState& state, bool upper_left,
                                 const TileRect& rect, Commit& commit) {
  bool small = true;
  for (int i = 0; i < 3; ++i)
    small = small && std::abs(triangle.x[i]) < kVectorLimit && std::abs(triangle.y[i]) < kVectorLimit;
  if (small) {
    TriangleSetup<double> setup;
    if (set_up_triangle(triangle, state, upper_left, rect.limit, setup)) cover_blocks(setup, rect, commit);
  } else {
    TriangleSetup<__int128> setup;
    if (set_up_triangle(triangle, state, upper_left, rect.limit, setup)) cover_blocks(setup, rect, commit);
  }
}

/// A fan in which snapping has turned a piece over: a pixel belongs to the polygon if the pieces that cover it, counted
/// with their signs, leave the polygon's own; the first piece of that sign gives its depth.
template <class Commit>
inline void cover_turned_fan(const CarefulPieces& fan, const GeometryState& state, bool upper_left,
                             const TileRect& rect, Commit& commit) {
  TriangleSetup<__int128> setup[CarefulPieces::kMax];
  bool used[CarefulPieces::kMax];
  GeometryState both_sides = state;
  both_sides.cull_face = CullFace::none;
  for (int i = 0; i < fan.count; ++i)
    used[i] = set_up_triangle(fan.piece[i].triangle, both_sides, upper_left, rect.limit, setup[i]);
  for (int y = rect.limit[1]; y < rect.limit[3]; ++y) {
    for (int x = rect.limit[0]; x < rect.limit[2]; ++x) {
      int winding = 0, drawn = -1;
      for (int i = 0; i < fan.count; ++i) {
        if (!used[i] || !setup[i].covers(x, y)) continue;
        winding += fan.piece[i].sign;
        if (drawn < 0 && fan.piece[i].sign == fan.facing) drawn = i;
      }
      if (winding * fan.facing <= 0) continue;
      const TriangleSetup<__int128>& s = setup[drawn];
      commit.begin(s);
      commit.scalar(tile_index(rect.size, x, y), double(s.edge(1, x, y)), double(s.edge(2, x, y)));
    }
  }
  for (int block = 0; block < rect.size * rect.size / kBlockPixels; ++block) commit.finish_block(block);
}

/// Draws a triangle that needs care: clipped, snapped exactly, by the path its size asks for.
template <class Commit>
inline void draw_careful(const ClipVertex v[3], const WindowTransform& t, SampleOrigin origin,
                         const GeometryState& state, const TileRect& rect, Commit& commit) {
  const CarefulPieces fan = careful_pieces(v, t, origin.x, origin.y);
  if (fan.count == 0 || culled(state, (fan.facing > 0) != t.upper_left)) return;
  if (fan.turned) {
    cover_turned_fan(fan, state, t.upper_left, rect, commit);
  } else {
    for (int i = 0; i < fan.count; ++i) draw_window_triangle(fan.piece[i].triangle, state, t.upper_left, rect, commit);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
