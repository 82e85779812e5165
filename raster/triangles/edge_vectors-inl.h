// Edge functions at vectors of a block's pixels. Included once per SIMD target. docs/arithmetic.md section 4.
#if defined(TRUESHADE_RASTER_TRIANGLES_EDGE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TRIANGLES_EDGE_VECTORS_INL_H_
#undef TRUESHADE_RASTER_TRIANGLES_EDGE_VECTORS_INL_H_
#else
#define TRUESHADE_RASTER_TRIANGLES_EDGE_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/triangles/triangle_setup.h"
#include "raster/triangles/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Column and row of a block's pixels.
alignas(64) inline constexpr int32_t kPixelColumn[kBlockPixels] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},
                                     kPixelRow[kBlockPixels] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

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

  explicit EdgeVectors(const TriangleSetup<__int128>& s) {
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
    const V64 column = hn::LoadU(d, kLaneColumn), row = hn::LoadU(d, kLaneRow);
    V64 part[2];
    for (int k = 0; k < 2; ++k)
      part[k] = hn::Add(hn::Set(d, c[i][k] + px * sx[i][k] + py * sy[i][k]),
                        hn::Add(hn::Mul(column, hn::Set(d, sx[i][k])), hn::Mul(row, hn::Set(d, sy[i][k]))));
    return hn::Add(hn::Mul(part[0], hn::Set(d, 0x1p32)), part[1]);
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
