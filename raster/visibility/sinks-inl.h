// Where covered samples go. A sink counts them, tests their depths and keeps the visible one, or lists those that pass.
// begin() takes a triangle; vector() and scalar() take its samples, and return whether a block's depths changed, of
// which finish_block() then finds the largest. Included once per SIMD target.
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

#include "core/simd/lanes-inl.h"
#include "raster/triangles/depth_plane-inl.h"
#include "raster/triangles/triangle_setup.h"
#include "raster/triangles/vertex_stage-inl.h"
#include "raster/visibility/alpha_test-inl.h"
#include "raster/visibility/depth_test-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Counts covered samples: for overdraw, and for tests of watertightness. Count: uint16_t or uint32_t.
template <class Count>
struct CountSink {
  Count* counts;      ///< in tile_index() order
  bool fast = false;  ///< triangles may take fast paths
  uint32_t id = 0;    ///< is not read

  const VisibilityTile* hiding() const { return nullptr; }  ///< hidden fragments count
  AlphaTest* masked_by(AlphaTest*) { return nullptr; }      ///< so do those that the alpha test would drop

  template <class T>
  void begin(const TriangleSetup<T>&) {}
  void begin_piece(const ClipVertex*, const ClippedFan&, int, const WindowTransform&) {}
  bool hidden(int) const { return false; }
  HWY_INLINE bool vector(int at, M64 covered, const V64*) {
    const hn::Rebind<Count, D64> d;
    const auto one = hn::DemoteTo(I32(), hn::IfThenElseZero(covered, hn::Set(D64(), 1.0)));
    if constexpr (sizeof(Count) == sizeof(int32_t))
      hn::StoreU(hn::Add(hn::LoadU(d, counts + at), hn::BitCast(d, one)), d, counts + at);
    else
      hn::StoreU(hn::Add(hn::LoadU(d, counts + at), hn::DemoteTo(d, one)), d, counts + at);
    return false;
  }
  bool scalar(int at, double, double, double) {
    ++counts[at];
    return false;
  }
  void finish_block(int) {}
};

/// The polygon offset of a triangle: m the larger of |dz/dx| and |dz/dy| per pixel, r a unit of the format, for floats
/// 2^(e - 23) with e the exponent of the largest |z| of its corners as an f32, within [-126, 127].
template <class T>
double polygon_offset(const TriangleSetup<T>& s, const DepthRule& rule) {
  if (!rule.offsets()) return 0.0;
  const double across = double(s.sx[1]) * s.depth.g1 + double(s.sx[2]) * s.depth.g2;
  const double up = double(s.sy[1]) * s.depth.g1 + double(s.sy[2]) * s.depth.g2;
  const double slope = std::max(std::abs(across), std::abs(up));
  double unit = rule.unit;
  if (rule.largest_code == 0.0f) {
    const auto most = float(std::min(std::max({std::abs(s.depth.low), std::abs(s.depth.high), 0x1p-126}), 0x1p127));
    unit =
        std::bit_cast<double>((std::bit_cast<uint64_t>(double(most)) & 0x7FF0000000000000ull) - (uint64_t(23) << 52));
  }
  return slope * rule.factor + unit * rule.units;
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
  bool fast = false;           ///< triangles may take fast paths
  AlphaTest* alpha = nullptr;  ///< of the material drawn; null: every fragment counts
  uint64_t fragments = 0;
  uint32_t id = 0;
  DepthPlane plane{};  ///< of the triangle at work, offset and clamped to the range
  float nearest = 0;   ///< the depth test compares no less for any of its fragments

  /// The tile whose blocks hide what is behind them; null where nothing may be skipped.
  const VisibilityTile* hiding() const { return skip_hidden ? &tile : nullptr; }
  AlphaTest* masked_by(AlphaTest* test) { return alpha = test; }

  template <class T>
  void begin(const TriangleSetup<T>& s) {
    plane = s.depth;
    if (rule.offsets()) {
      const double offset = polygon_offset(s, rule);
      plane.z0 += offset, plane.low += offset, plane.high += offset;
    }
    plane = plane.in_range(double(range_low), double(range_high));
    nearest = rule.stored(float(plane.low));
    if (alpha != nullptr) alpha->set_edges(s);
  }
  /// Before begin(), for a piece of a triangle that needed clipping.
  void begin_piece(const ClipVertex v[3], const ClippedFan& fan, int index, const WindowTransform& t) {
    if (alpha != nullptr) alpha->set_piece(v, fan, index, t);
  }
  bool hidden(int block) const { return skip_hidden && nearest > tile.far[block]; }

  /// What the depth test compares, of any vector of floats: DepthRule::stored().
  template <class V>
  HWY_INLINE V stored(V z) const {
    if (rule.largest_code == 0.0f) return z;
    const V largest = hn::Set(hn::DFromV<V>(), rule.largest_code);
    return hn::Div(hn::Round(hn::Mul(z, largest)), largest);
  }

  /// Depths of a vector of samples; NaN where not covered, which passes no comparison.
  HWY_INLINE V32 depths(M64 covered, V64 e1, V64 e2) const {
    const V64 nan = hn::Set(D64(), std::numeric_limits<double>::quiet_NaN());
    return stored(hn::DemoteTo(D32(), hn::IfThenElse(covered, DepthPlanes(plane).at(e1, e2), nan)));
  }
  float depth(double e1, double e2) const { return rule.stored(float(plane.at(e1, e2))); }

  HWY_INLINE bool vector(int at, M64 covered, const V64 e[3]) {
    const D32 df;
    const U32 du;
    fragments += uint64_t(lane_count(D64(), covered));
    const V32 z = depths(covered, e[1], e[2]), there = hn::Load(df, tile.depth + at);
    const auto my_id = hn::Set(du, id), there_id = hn::Load(du, tile.id + at);
    auto pass = winners(func, z, there, my_id, there_id);
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
    if (!wins(func, z, tile.depth[at], id, tile.id[at])) return false;
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

  const VisibilityTile* hiding() const { return skip_hidden ? &tile : nullptr; }
  AlphaTest* masked_by(AlphaTest* alpha) { return test.masked_by(alpha); }
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
