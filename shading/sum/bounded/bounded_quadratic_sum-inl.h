// Sums of many lights of which only the codes in a fixed-point target are wanted. A sum is estimated, with a bound of
// its error. Where all values within the bound have one code, that is the code of the sum (Ziv, Fast evaluation of
// elementary mathematical functions with correctly rounded last bit, 1991). The proof is docs/proofs.md section 16.
// Included once per SIMD target.
#if defined(TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_QUADRATIC_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_QUADRATIC_SUM_INL_H_
#undef TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_QUADRATIC_SUM_INL_H_
#else
#define TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_QUADRATIC_SUM_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/simd/store-inl.h"
#include "shading/light/light_term-inl.h"
#include "shading/sum/bounded/bounded_lights.h"
#include "shading/sum/bounded/lights_by_gloss-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sums of a vector of pixels before the surface's colours multiply them.
struct QuadraticSum {
  VF diffuse[3], shine[3];
  hn::Vec<DI> lights;  ///< that light each pixel: exact

  QuadraticSum() : lights(hn::Zero(DI())) {
    for (int c = 0; c < 3; ++c) diffuse[c] = shine[c] = hn::Zero(DF());
  }
};

/// kMany lights, a step of each after the other.
template <size_t kMany, bool kShines>
HWY_INLINE void add_quadratic(const PixelVector& px, const QuadraticLight* lights, const uint32_t* index,
                              QuadraticSum& sum) {
  const DF d;
  const DI di;
  using Shape = QuadraticBlinn;
  const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  VF to_light[kMany][3], nl[kMany], d2[kMany], weaker[kMany], distance[kMany], weight[kMany], shine[kMany];
  MF lit[kMany];
  for (size_t k = 0; k < kMany; ++k) {
    for (int c = 0; c < 3; ++c) to_light[k][c] = hn::Sub(hn::Set(d, lights[index[k]].position[c]), px.p[c]);
    nl[k] = dot3(px.n, to_light[k]);
    d2[k] = dot3(to_light[k], to_light[k]);
    lit[k] = hn::Gt(nl[k], zero);
    sum.lights = hn::Add(sum.lights, hn::IfThenElseZero(hn::RebindMask(di, lit[k]), hn::Set(di, 1)));
  }
  for (size_t k = 0; k < kMany; ++k) {
    distance[k] = hn::Sqrt(d2[k]);
    const VF linear = hn::Add(one, hn::Mul(hn::Set(d, lights[index[k]].k1), distance[k]));
    weaker[k] = hn::Add(linear, hn::Mul(hn::Mul(hn::Set(d, lights[index[k]].k2), distance[k]), distance[k]));
  }
  if constexpr (!kShines) {
    for (size_t k = 0; k < kMany; ++k)
      weight[k] = hn::IfThenElseZero(lit[k], hn::Div(nl[k], hn::Mul(distance[k], weaker[k])));
  } else {
    VF half2[kMany], along[kMany];
    for (size_t k = 0; k < kMany; ++k) {
      const VF inverse = hn::Div(one, distance[k]);
      VF half[3];
      for (int c = 0; c < 3; ++c) half[c] = hn::Add(hn::Mul(to_light[k][c], inverse), px.v[c]);
      half2[k] = dot3(half, half);
      along[k] = dot3(px.n, half);
      nl[k] = hn::IfThenElseZero(lit[k], hn::Mul(nl[k], inverse));
    }
    for (size_t k = 0; k < kMany; ++k) {
      const VF quotient = hn::Div(one, hn::Mul(half2[k], weaker[k])), strength = hn::Mul(quotient, half2[k]);
      const VF t = hn::IfThenElseZero(hn::Gt(along[k], zero), along[k]);
      VF x = hn::Mul(hn::Mul(t, t), hn::Mul(quotient, weaker[k]));
      if (Shape::shape.renormalize) x = at_most(x, 1.0f);
      const VF power = integer_power<Shape::shape.power>(x);
      weight[k] = hn::Mul(nl[k], strength);
      shine[k] = hn::Mul(power, strength);
      if (Shape::shape.specular_masked) shine[k] = hn::IfThenElseZero(lit[k], shine[k]);
    }
  }
  for (size_t k = 0; k < kMany; ++k)
    for (int c = 0; c < 3; ++c) {
      const VF color = hn::Set(d, lights[index[k]].color[c]);
      sum.diffuse[c] = hn::Add(sum.diffuse[c], hn::Mul(color, weight[k]));
      if constexpr (kShines) sum.shine[c] = hn::Add(sum.shine[c], hn::Mul(color, shine[k]));
    }
}

/// The lights of a list, part by part, so that the parts' roundings do not add up.
template <bool kShines>
HWY_NOINLINE void add_quadratic_lights(const PixelVector& px, const BoundedLights& bounded,
                                       std::span<const uint32_t> list, QuadraticSum& total) {
  constexpr size_t kTogether = 4;
  const QuadraticLight* const lights = bounded.quadratic.data();
  for (size_t from = 0; from < list.size(); from += kSumPart) {
    const size_t end = std::min(list.size(), from + kSumPart);
    QuadraticSum part;
    size_t i = from;
    for (; i + kTogether <= end; i += kTogether) add_quadratic<kTogether, kShines>(px, lights, &list[i], part);
    for (; i < end; ++i) add_quadratic<1, kShines>(px, lights, &list[i], part);
    for (int c = 0; c < 3; ++c) {
      total.diffuse[c] = hn::Add(total.diffuse[c], part.diffuse[c]);
      if constexpr (kShines) total.shine[c] = hn::Add(total.shine[c], part.shine[c]);
    }
    total.lights = hn::Add(total.lights, part.lights);
  }
}

/// Pixels whose numbers are in the ranges of section 16.
HWY_INLINE MF pixels_in_proof_range(const PixelVector& px) {
  const DF d;
  const VF zero = hn::Zero(d);
  MF holds = px.covered;
  for (int c = 0; c < 3; ++c) {
    const VF size = hn::Abs(px.p[c]);
    const MF sized = hn::And(hn::Ge(size, hn::Set(d, 0x1p-40f)), hn::Le(size, hn::Set(d, 0x1p30f)));
    holds = hn::And(holds, hn::Or(sized, hn::Eq(size, zero)));
    holds = hn::And(holds, hn::Le(hn::Abs(px.n[c]), hn::Set(d, kMostProvenNormal)));
    holds = hn::And(holds, hn::And(hn::Ge(px.albedo[c], zero), hn::Le(px.albedo[c], hn::Set(d, kMostProvenAlbedo))));
  }
  return holds;
}

/// Values that have the right codes in the pixels returned, and are unspecified elsewhere.
HWY_INLINE MF bounded_colors(const PixelVector& px, const QuadraticSum& sum, float relative, float left_out,
                             Format format, VF color[3]) {
  const DF d;
  constexpr float kAbsolute = 0x1p-60f;  // covers what underflows
  MF proved = pixels_in_proof_range(px);
  for (int c = 0; c < 3; ++c) {
    const VF value = hn::Add(hn::Mul(sum.diffuse[c], px.albedo[c]), hn::Mul(sum.shine[c], px.specular[c]));
    const VF low = hn::Sub(hn::Mul(value, hn::Set(d, 1.0f - relative)), hn::Set(d, kAbsolute));
    const VF high = hn::Mul(hn::Add(value, hn::Set(d, left_out + kAbsolute)), hn::Set(d, 1.0f + relative));
    const MF same = hn::Eq(encoded(low, format, c, HalfRound::nearest), encoded(high, format, c, HalfRound::nearest));
    proved = hn::And(proved, hn::And(same, hn::Lt(low, high)));  // which no NaN is
    color[c] = low;
  }
  return proved;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
