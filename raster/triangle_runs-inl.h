// Attributes of pixels by vertex records: runs of one triangle set it up once, pixels of different triangles take a
// lane an attribute. The same operations as interpolate-inl.h, without its gathers. Included once per SIMD target.
// docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_TRIANGLE_RUNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TRIANGLE_RUNS_INL_H_
#undef TRUESHADE_RASTER_TRIANGLE_RUNS_INL_H_
#else
#define TRUESHADE_RASTER_TRIANGLE_RUNS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "raster/coverage-inl.h"
#include "raster/interpolate-inl.h"
#include "raster/surfaces.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The records of a triangle's corners in canonical order: smallest (y, x) first, the others as they follow.
struct CanonicalRecords {
  const VertexRecord* vertex[3];

  HWY_INLINE void find(const VertexRecord* a, const VertexRecord* b, const VertexRecord* c) {
    const auto key = [](const VertexRecord* v) { return int64_t(v->y) * (int64_t(1) << 32) + v->x; };  // |x| < 2^26
    const int64_t ka = key(a), kb = key(b), kc = key(c);
    const bool from_c = (kc < ka) & (kc < kb), from_b = (kb < ka) & !(kc < kb);
    vertex[0] = from_c ? c : (from_b ? b : a);
    vertex[1] = from_c ? a : (from_b ? c : b);
    vertex[2] = from_c ? b : (from_b ? a : c);
  }
};

/// Smooth barycentrics of vertices 1 and 2 at pixels, from the corners' window positions and 1 / w.
struct SmoothWeights {
  V64 b1, b2;

  HWY_INLINE void set(const V64 x[3], const V64 y[3], const V64 u[3], V64 px, V64 py) {
    const D64 d;
    const V64 sx = hn::Mul(px, hn::Set(d, 256.0)), sy = hn::Mul(py, hn::Set(d, 256.0));
    V64 rx[3], ry[3], l[3];
    for (int i = 0; i < 3; ++i) {
      rx[i] = hn::Sub(x[i], sx);
      ry[i] = hn::Sub(y[i], sy);
    }
    for (int i = 0; i < 3; ++i) {
      const V64 e = hn::Sub(hn::Mul(rx[(i + 1) % 3], ry[(i + 2) % 3]), hn::Mul(rx[(i + 2) % 3], ry[(i + 1) % 3]));
      l[i] = hn::Mul(e, u[i]);
    }
    const V64 r = hn::Div(hn::Set(d, 1.0), hn::Add(hn::Add(l[0], l[1]), l[2]));
    b1 = hn::Mul(l[1], r);
    b2 = hn::Mul(l[2], r);
  }
};

HWY_INLINE float lesser_of(float a, float b) { return b < a ? b : a; }
HWY_INLINE float greater_of(float a, float b) { return b > a ? b : a; }

/// One triangle, set up for many pixels.
struct RunTriangle {
  uint32_t id = 0;
  double x[3], y[3], u[3];
  double a0[kStreams], to_1[kStreams], to_2[kStreams];
  float low[kStreams], high[kStreams];

  void set(uint32_t new_id, const CanonicalRecords& in, int attributes) {
    id = new_id;
    const VertexRecord &v0 = *in.vertex[0], &v1 = *in.vertex[1], &v2 = *in.vertex[2];
    for (int i = 0; i < 3; ++i) {
      x[i] = in.vertex[i]->x;
      y[i] = in.vertex[i]->y;
      u[i] = in.vertex[i]->u;
    }
    for (int c = 0; c < attributes; ++c) {
      a0[c] = double(v0.attribute[c]);
      to_1[c] = double(v1.attribute[c]) - double(v0.attribute[c]);
      to_2[c] = double(v2.attribute[c]) - double(v0.attribute[c]);
      low[c] = lesser_of(lesser_of(v0.attribute[c], v1.attribute[c]), v2.attribute[c]);
      high[c] = greater_of(greater_of(v0.attribute[c], v1.attribute[c]), v2.attribute[c]);
    }
  }

  HWY_INLINE void interpolate(V64 px, V64 py, int attributes, int at, SurfaceTile& out) const {
    const D64 d;
    const D32 df;
    V64 vx[3], vy[3], vu[3];
    for (int i = 0; i < 3; ++i) {
      vx[i] = hn::Set(d, x[i]);
      vy[i] = hn::Set(d, y[i]);
      vu[i] = hn::Set(d, u[i]);
    }
    SmoothWeights w;
    w.set(vx, vy, vu, px, py);
    for (int c = 0; c < attributes; ++c) {
      const V64 plane =
          hn::Add(hn::Set(d, a0[c]), hn::Add(hn::Mul(w.b1, hn::Set(d, to_1[c])), hn::Mul(w.b2, hn::Set(d, to_2[c]))));
      const V32 value = hn::DemoteTo(df, plane);
      hn::Store(lesser(greater(value, hn::Set(df, low[c])), hn::Set(df, high[c])), df,
                out.plane[kRecordStream[c]] + at);
    }
  }
};

/// Pixels of different triangles, collected until there are enough to go through them stage by stage.
struct MixedPixels {
  static constexpr int kMost = 64;
  int count = 0;  ///< whole vectors
  const VertexRecord* vertex[3][kMost];
  alignas(64) int32_t at[kMost];
  alignas(64) double px[kMost], py[kMost], u[3][kMost], b1[kMost], b2[kMost];
  alignas(64) int32_t x[3][kMost], y[3][kMost];
  alignas(64) float value[kMost][16];

  HWY_INLINE void add(const CanonicalRecords& in, int place) {
    for (int k = 0; k < 3; ++k) {
      const VertexRecord* v = in.vertex[k];
      vertex[k][count] = v;
      x[k][count] = v->x;
      y[k][count] = v->y;
      u[k][count] = v->u;
    }
    at[count++] = place;
  }

  void flush(int attributes, SurfaceTile& out) {
    const D64 d;
    const D32 df;
    const I32 di;
    const int lanes = int(hn::Lanes(d));
    for (int i = 0; i < count; i += lanes) {
      V64 vx[3], vy[3], vu[3];
      for (int k = 0; k < 3; ++k) {
        vx[k] = hn::PromoteTo(d, hn::Load(di, x[k] + i));
        vy[k] = hn::PromoteTo(d, hn::Load(di, y[k] + i));
        vu[k] = hn::Load(d, u[k] + i);
      }
      SmoothWeights w;
      w.set(vx, vy, vu, hn::Load(d, px + i), hn::Load(d, py + i));
      hn::Store(w.b1, d, b1 + i);
      hn::Store(w.b2, d, b2 + i);
    }
    for (int i = 0; i < count; ++i) {  // here a lane is an attribute
      const V64 w1 = hn::Set(d, b1[i]), w2 = hn::Set(d, b2[i]);
      for (int from = 0; from < attributes; from += lanes) {
        const int c = std::min(from, int(kStreams) - lanes);
        const V32 a0 = hn::LoadU(df, vertex[0][i]->attribute + c), a1 = hn::LoadU(df, vertex[1][i]->attribute + c),
                  a2 = hn::LoadU(df, vertex[2][i]->attribute + c);
        const V64 wide = hn::PromoteTo(d, a0);
        const V64 plane = hn::Add(wide, hn::Add(hn::Mul(w1, hn::Sub(hn::PromoteTo(d, a1), wide)),
                                                hn::Mul(w2, hn::Sub(hn::PromoteTo(d, a2), wide))));
        const V32 low = lesser(lesser(a0, a1), a2), high = greater(greater(a0, a1), a2);
        hn::StoreU(lesser(greater(hn::DemoteTo(df, plane), low), high), df, value[i] + c);
      }
    }
    for (int c = 0; c < attributes; ++c) {
      float* plane = out.plane[kRecordStream[c]];
      for (int i = 0; i < count; ++i) plane[at[i]] = value[i][c];
    }
    count = 0;
  }
};

/// Fills the planes of a tile whose attributes are all smooth: the first `attributes` of the records.
inline void interpolate_runs(const TileRect& rect, const VisibilityTile& visible, const VisibleVertices& work,
                             int attributes, SurfaceTile& out) {
  const D64 d;
  const I32 di;
  const int lanes = int(hn::Lanes(d)), blocks = rect.size / kBlockSize;
  const VertexRecord* record = work.record.data();
  const uint32_t* corner[3] = {work.corner[0].data(), work.corner[1].data(), work.corner[2].data()};
  RunTriangle run;
  MixedPixels mixed;
  for (int i = 0; i < rect.size * rect.size; i += lanes) {
    const auto covered = hn::Load(di, out.covered + i);
    if (hn::AllTrue(di, hn::Eq(covered, hn::Zero(di)))) continue;
    const int block = i / kBlockPixels, k = i % kBlockPixels;
    const V64 px = hn::Add(hn::Set(d, (block % blocks) * kBlockSize + k % kBlockSize), hn::LoadU(d, kLaneColumn));
    const V64 py = hn::Add(hn::Set(d, (block / blocks) * kBlockSize + k / kBlockSize), hn::LoadU(d, kLaneRow));
    int first = 0;
    while (visible.id[i + first] == 0) ++first;
    const uint32_t id = visible.id[i + first];
    const auto same = hn::Eq(hn::Load(di, reinterpret_cast<const int32_t*>(visible.id) + i), hn::Set(di, int32_t(id)));
    CanonicalRecords at;
    if (hn::AllTrue(di, hn::Or(same, hn::Eq(covered, hn::Zero(di))))) {
      if (run.id != id) {
        at.find(record + corner[0][i + first], record + corner[1][i + first], record + corner[2][i + first]);
        run.set(id, at, attributes);
      }
      run.interpolate(px, py, attributes, i, out);
      continue;
    }
    hn::Store(px, d, mixed.px + mixed.count);
    hn::Store(py, d, mixed.py + mixed.count);
    for (int lane = 0; lane < lanes; ++lane) {
      at.find(record + corner[0][i + lane], record + corner[1][i + lane], record + corner[2][i + lane]);
      mixed.add(at, i + lane);
    }
    if (mixed.count == MixedPixels::kMost) mixed.flush(attributes, out);
  }
  mixed.flush(attributes, out);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
