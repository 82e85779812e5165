// What happens to covered samples: they are counted, or tested for depth and kept. Included once per SIMD target.
// docs/arithmetic.md sections 5 and 6.
#if defined(TRUESHADE_RASTER_VISIBILITY_SINKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_SINKS_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_SINKS_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_SINKS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "raster/visibility/alpha_test-inl.h"
#include "raster/triangles/lanes-inl.h"
#include "raster/triangles/triangle_setup.h"
#include "raster/triangles/vertex_stage-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Counts covered samples: for overdraw, and for tests of watertightness.
struct CountSink {
  uint32_t* counts;   ///< in tile_index() order
  bool fast = false;  ///< triangles may take the paths for usual ones

  template <class T>
  void begin(const TriangleSetup<T>&) {}
  void begin_piece(const ClipVertex*, const ClippedFan&, int, const WindowTransform&) {}
  bool hidden(int) const { return false; }
  HWY_INLINE bool vector(int at, M64 covered, const V64*) {
    const D64 d;
    constexpr size_t kLanes = HWY_MAX_BYTES / sizeof(double);
    alignas(64) double one[kLanes];
    hn::Store(hn::IfThenElseZero(covered, hn::Set(d, 1.0)), d, one);
    for (size_t i = 0; i < hn::Lanes(d); ++i) counts[size_t(at) + i] += one[i] != 0.0;
    return false;
  }
  bool scalar(int at, double, double, double) {
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

/// The polygon offset of a triangle: m the larger of |dz/dx| and |dz/dy| per pixel, r a unit of the format, for floats
/// 2^(e - 23) with e the exponent of the largest |z| of its corners as an f32, within [-126, 127].
template <class T>
double polygon_offset(const TriangleSetup<T>& s, const DepthRule& rule) {
  if (!rule.offsets()) return 0.0;
  const double across = double(s.sx[1]) * s.g1 + double(s.sx[2]) * s.g2;
  const double up = double(s.sy[1]) * s.g1 + double(s.sy[2]) * s.g2;
  const double slope = std::max(std::abs(across), std::abs(up));
  double unit = rule.unit;
  if (rule.largest_code == 0.0f) {
    const auto most = float(std::min(std::max({std::abs(s.z_low), std::abs(s.z_high), 0x1p-126}), 0x1p127));
    unit =
        std::bit_cast<double>((std::bit_cast<uint64_t>(double(most)) & 0x7FF0000000000000ull) - (uint64_t(23) << 52));
  }
  return slope * rule.factor + unit * rule.units;
}

/// Lanes that a depth test lets through, whatever was submitted when; none of those that are NaN.
HWY_INLINE hn::Mask<D32> passing(DepthFunc func, V32 z, V32 there) {
  switch (func) {
    case DepthFunc::never:
      break;
    case DepthFunc::less:
      return hn::Lt(z, there);
    case DepthFunc::lequal:
      return hn::Le(z, there);
    case DepthFunc::greater:
      return hn::Gt(z, there);
    case DepthFunc::gequal:
      return hn::Ge(z, there);
    case DepthFunc::equal:
      return hn::Eq(z, there);
    case DepthFunc::notequal:
      return hn::Or(hn::Lt(z, there), hn::Gt(z, there));
    case DepthFunc::always:
      return hn::Eq(z, z);
  }
  return hn::Lt(z, z);  // none
}

/// Finds a block's largest depth.
HWY_INLINE void set_far(VisibilityTile& tile, int block) {
  const D32 df;
  const float* depth = tile.depth + block * kBlockPixels;
  V32 far = hn::Load(df, depth);
  for (size_t i = hn::Lanes(df); i < kBlockPixels; i += hn::Lanes(df)) far = hn::Max(far, hn::Load(df, depth + i));
  tile.far[block] = hn::GetLane(hn::MaxOfLanes(df, far));
}

/// Tests depth and keeps the visible id.
struct DepthSink {
  VisibilityTile& tile;
  DepthFunc func;
  float range_low, range_high;
  bool skip_hidden;  ///< use the blocks' largest depths
  DepthRule rule{};
  bool fast = false;           ///< triangles may take the paths for usual ones (small_triangles, large_triangles)
  AlphaTest* alpha = nullptr;  ///< of the material drawn; null: every fragment counts
  uint64_t fragments = 0;
  uint32_t id = 0;
  double z0 = 0, g1 = 0, g2 = 0, z_low = 0, z_high = 0;
  float nearest = 0;

  template <class T>
  void begin(const TriangleSetup<T>& s) {
    z0 = s.z0, g1 = s.g1, g2 = s.g2, z_low = s.z_low, z_high = s.z_high;
    if (rule.offsets()) {
      const double offset = polygon_offset(s, rule);
      z0 += offset, z_low += offset, z_high += offset;
    }
    nearest = rule.stored(std::min(std::max(float(z_low), range_low), range_high));
    if (alpha != nullptr) alpha->set_edges(s);
  }
  /// Before begin(), for a piece of a triangle that needed clipping.
  void begin_piece(const ClipVertex v[3], const ClippedFan& fan, int index, const WindowTransform& t) {
    if (alpha != nullptr) alpha->set_piece(v, fan, index, t);
  }
  bool hidden(int block) const { return skip_hidden && nearest > tile.far[block]; }

  /// What the depth test compares, of any vector of floats.
  template <class V>
  HWY_INLINE V stored(V z) const {
    if (rule.largest_code == 0.0f) return z;
    const V largest = hn::Set(hn::DFromV<V>(), rule.largest_code);
    return hn::Div(hn::Round(hn::Mul(z, largest)), largest);
  }

  /// Depths of a vector of samples; NaN where not covered, which passes no comparison.
  HWY_INLINE V32 depths(M64 covered, V64 e1, V64 e2) const {
    const D64 d;
    const V64 plane = hn::Add(hn::Set(d, z0), hn::Add(hn::Mul(e1, hn::Set(d, g1)), hn::Mul(e2, hn::Set(d, g2))));
    const V64 in_hull = hn::Min(hn::Max(plane, hn::Set(d, z_low)), hn::Set(d, z_high));
    const V64 in_range = hn::Min(hn::Max(in_hull, hn::Set(d, double(range_low))), hn::Set(d, double(range_high)));
    const V64 nan = hn::Set(d, std::numeric_limits<double>::quiet_NaN());
    return stored(hn::DemoteTo(D32(), hn::IfThenElse(covered, in_range, nan)));
  }
  float depth(double e1, double e2) const {
    const double plane = z0 + (e1 * g1 + e2 * g2);
    const double in_hull = std::min(std::max(plane, z_low), z_high);
    return rule.stored(float(std::min(std::max(in_hull, double(range_low)), double(range_high))));
  }

  HWY_INLINE bool vector(int at, M64 covered, const V64 e[3]) {
    const D32 df;
    const U32 du;
    fragments += uint64_t(lane_count(D64(), covered));
    const V32 z = depths(covered, e[1], e[2]);
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
    if (alpha != nullptr) {
      pass = hn::And(pass, opaque(e, pass));
      if (hn::AllFalse(df, pass)) return false;
    }
    hn::Store(hn::IfThenElse(pass, z, there), df, tile.depth + at);
    hn::Store(hn::IfThenElse(hn::RebindMask(du, pass), my_id, there_id), du, tile.id + at);
    return true;
  }

  /// Lanes of `asked` that the alpha test keeps.
  HWY_NOINLINE hn::Mask<D32> opaque(const V64 e[3], hn::Mask<D32> asked) const {
    const D64 d;
    const V64 one = hn::PromoteTo(d, hn::IfThenElseZero(asked, hn::Set(D32(), 1.0f)));
    return alpha->opaque(e, hn::Gt(one, hn::Zero(d)));
  }
  HWY_NOINLINE bool opaque(double e0, double e1, double e2) const {
    const D64 d;
    const D32 df;
    const V64 e[3] = {hn::Set(d, e0), hn::Set(d, e1), hn::Set(d, e2)};
    const auto kept = alpha->opaque(e, hn::FirstN(d, 1));
    return hn::GetLane(hn::IfThenElseZero(kept, hn::Set(df, 1.0f))) != 0.0f;
  }

  bool scalar(int at, double e0, double e1, double e2) {
    ++fragments;
    const float z = depth(e1, e2);
    if (!passes(func, z, tile.depth[at], id, tile.id[at])) return false;
    if (alpha != nullptr && !opaque(e0, e1, e2)) return false;
    tile.depth[at] = z;
    tile.id[at] = id;
    return true;
  }

  HWY_INLINE void finish_block(int block) { set_far(tile, block); }
};

/// Lists the fragments that a depth test lets through; the depths stay.
struct FragmentListSink {
  VisibilityTile& tile;
  DepthSink test;  ///< for its depths, and by its function
  std::vector<DepthFragment>& out;
  bool skip_hidden;
  uint32_t id = 0;

  template <class T>
  void begin(const TriangleSetup<T>& s) {
    test.begin(s);
  }
  void begin_piece(const ClipVertex v[3], const ClippedFan& fan, int index, const WindowTransform& t) {
    test.begin_piece(v, fan, index, t);
  }
  bool hidden(int block) const { return test.hidden(block); }
  HWY_INLINE bool vector(int at, M64 covered, const V64 e[3]) {
    const D32 df;
    alignas(64) float one[HWY_MAX_BYTES / sizeof(float)];
    auto pass = passing(test.func, test.depths(covered, e[1], e[2]), hn::Load(df, tile.depth + at));
    if (hn::AllFalse(df, pass)) return false;
    if (test.alpha != nullptr) pass = hn::And(pass, test.opaque(e, pass));
    hn::Store(hn::IfThenElseZero(pass, hn::Set(df, 1.0f)), df, one);
    for (size_t i = 0; i < hn::Lanes(df); ++i)
      if (one[i] != 0.0f) out.push_back({at + int(i), id});
    return false;
  }
  bool scalar(int at, double e0, double e1, double e2) {
    const D32 df;
    const auto pass = passing(test.func, hn::Set(df, test.depth(e1, e2)), hn::Set(df, tile.depth[at]));
    if (!hn::AllFalse(df, pass) && (test.alpha == nullptr || test.opaque(e0, e1, e2))) out.push_back({at, id});
    return false;
  }
  void finish_block(int) {}
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
