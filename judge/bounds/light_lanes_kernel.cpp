#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <utility>

#include "judge/bounds/light_lanes.h"

namespace trueshade::oracle {
constexpr double kFlushed = 0x1p-110;  // a few 2^-126, times colours and powers
constexpr double kShortest = 0x1p-80;  // d2
constexpr double kUlp = 0x1p-23, kLn2 = 0.69314718055994530942;
}  // namespace trueshade::oracle

HWY_BEFORE_NAMESPACE();
namespace trueshade::oracle::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

/// A lane's Bounded.
struct Both {
  V value, error;
};

HWY_INLINE V all(double v) { return hn::Set(D(), v); }
HWY_INLINE V plus(V a, V b) { return hn::Add(a, b); }
HWY_INLINE V times(V a, V b) { return hn::Mul(a, b); }
HWY_INLINE V times(V a, double b) { return hn::Mul(a, all(b)); }
HWY_INLINE V plus(V a, double b) { return hn::Add(a, all(b)); }

/// The lanes added up, in order.
HWY_INLINE double sum_of(V v) {
  const D d;
  HWY_ALIGN double lane[hn::MaxLanes(D())];
  hn::Store(v, d, lane);
  double sum = 0;
  for (size_t i = 0; i < hn::Lanes(d); ++i) sum += lane[i];
  return sum;
}

/// Lanes that are set, counted as numbers: g++ 12 may spill a mask narrow and read it wide, so no mask becomes a word.
HWY_INLINE int count_of(M mask) { return int(sum_of(hn::IfThenElseZero(mask, all(1)))); }

/// max(x, 0) as positive() has it.
HWY_INLINE Both positive(Both x) {
  const V zero = hn::Zero(D()), high = hn::Max(zero, plus(x.value, x.error));
  const M above = hn::Gt(x.value, zero);
  return {hn::IfThenElseZero(above, x.value), hn::IfThenElse(above, x.error, high)};
}

HWY_INLINE V chord(double start, double slope, V k) { return plus(times(k, slope), start); }

/// Sums of three products with the pixel's numbers.
HWY_INLINE V dot(const V x[3], const double w[3]) {
  return plus(plus(times(x[0], w[0]), times(x[1], w[1])), times(x[2], w[2]));
}

/// What of a pixel the lights share.
struct Pixel {
  double position[3], normal[3], view[3];
  double normal_size[3];   ///< |n| + its error
  double normal_error[3];  ///< of a product with n: (1 + 3 v) error + 3 v |n|
  double view_error[3];    ///< (1 + v) error
  double position_error[3], position_norm = 0, position_most = 0;
  double moved_normal = 0;  ///< sum of normal_size times position_error
  double value[2][3], size[2][3],
      error[2][3];  ///< diffuse and specular: value; |value| + error; error and two products
};

/// Of a light in the lane.
struct Lane {
  V direction[3], distance, d2, inverse, ratio;  ///< ratio: k
  V direction_error, moved;                      ///< a, b
  Both n_l;
};

HWY_INLINE Both one_minus(Both x, double v) {
  const V value = hn::Sub(all(1), x.value);
  return {value, plus(plus(x.error, times(plus(hn::Abs(value), x.error), v)), kFlushed)};
}

/// 1 / (k0 + k1 d + k2 d d): of x = E / all <= 1/2, x / (1 - x) <= x (1 + 2 x).
HWY_INLINE Both attenuation(const LightColumns& lights, size_t i, const LaneModel& m, const Lane& lane) {
  const D d;
  const V k0 = m.model.falloff == Falloff::quadratic ? all(1) : hn::LoadU(d, &lights.k0[i]);
  const V k1 = times(hn::LoadU(d, &lights.k1[i]), lane.distance), k2 = times(hn::LoadU(d, &lights.k2[i]), lane.d2);
  const V value = hn::Div(all(1), plus(plus(k0, k1), k2));
  const V error = plus(plus(times(k0, m.constant), times(k1, chord(m.start.linear, m.slope.linear, lane.ratio))),
                       times(k2, chord(m.start.square, m.slope.square, lane.ratio)));
  const V x = times(error, value), own = all(m.arithmetic.divide * kOurs);
  const V relative = plus(times(times(x, plus(times(x, 2), 1)), 1 + m.arithmetic.divide), own);
  const V safe = hn::IfThenElse(hn::Le(x, all(0.5)), relative, all(HUGE_VAL));
  return {hn::Min(value, all(1e18)), plus(times(value, safe), kFlushed)};
}

/// q = d / range or d2 / range^2 as a relative error of at most `inherited` makes it.
HWY_INLINE Both ratio_of(V over, V under, V inherited, const Arithmetic& a) {
  const V value = hn::Div(over, under);
  return {value, plus(times(value, plus(times(inherited, 1 + a.divide), a.divide)), kFlushed)};
}

HWY_INLINE Both falloff_at(const LightColumns& lights, size_t i, const LaneModel& m, const Lane& lane) {
  const D d;
  const Arithmetic& a = m.arithmetic;
  const double v = a.roundoff * (1 + 0x1p-16);
  const V range = hn::LoadU(d, &lights.range[i]);
  const V delta = chord(m.start.distance, m.slope.distance, lane.ratio);
  switch (m.model.falloff) {
    case Falloff::none:
      return {all(1), hn::Zero(d)};
    case Falloff::linear_range:
      return positive(one_minus(ratio_of(lane.distance, range, delta, a), v));
    case Falloff::linear:
      return one_minus(ratio_of(lane.distance, range, delta, a), v);
    case Falloff::quadratic:
    case Falloff::attenuation:
      return attenuation(lights, i, m, lane);
    case Falloff::inverse_square:
      break;
  }
  // The square of the range has one rounding; r^2 and 1/d^2 double a relative error, and round.
  const V eta = chord(m.start.eta, m.slope.eta, lane.ratio), rho = chord(m.start.root, m.slope.root, lane.ratio);
  const Both u = ratio_of(lane.d2, times(range, range), times(plus(eta, v), 1 + 4 * v), a);
  const V u2 = times(u.value, u.value);
  const V u2_error = plus(times(times(u.error, plus(plus(u.value, u.value), u.error)), 1 + v), times(u2, v));
  const Both window = positive(one_minus({u2, plus(u2_error, kFlushed)}, v));
  const V square = times(lane.inverse, lane.inverse);
  const V relative = plus(times(plus(times(rho, rho), plus(rho, rho)), 1 + v), v);
  const Both over{hn::Min(square, all(1e18)), plus(times(square, relative), kFlushed)};
  const V value = times(window.value, over.value);
  const V error = plus(times(plus(window.value, window.error), over.error), times(over.value, window.error));
  return {value, plus(plus(times(error, 1 + v), times(value, v)), kFlushed)};
}

/// x^s by squaring, within s 2^-52 of itself.
HWY_INLINE V powered(V x, int s) {
  V result = all(1);
  for (;; x = times(x, x)) {
    if ((s & 1) != 0) result = times(result, x);
    if ((s >>= 1) == 0) return result;
  }
}

/// power() of bounded.h for t = s r < 1/2, |ln x| from above by its neighbours: for p in [low, 1] |ln p| <= (1/p - p) /
/// 2
/// <= (1/low - low) / 2, for p in [1, high] ln p <= high - 1; and expm1(q) <= q + q^2 for q <= 1. Others are `left`.
HWY_INLINE Both power(const Arithmetic& a, V low, V x, V high, int s, M& left) {
  const D d;
  const V zero = hn::Zero(d);
  const M none = hn::Le(high, zero);
  const V inverse = hn::Div(all(1), low);
  const V r = times(hn::Max(hn::Sub(high, x), hn::Sub(x, low)), inverse), t = times(r, double(s));
  const V value = powered(x, s);
  V own = all(0x1p-24);
  const V natural = hn::Max(times(hn::Sub(inverse, low), 0.5), plus(high, -1));
  const V exponent = plus(times(natural, kOurs / kLn2), plus(r, r));
  const V y = times(exponent, double(s));
  M good = hn::And(hn::Lt(t, all(0.5)), hn::Lt(value, all(0x1p120)));
  if (!a.exact_pow) {
    const M near_one = hn::And(hn::Ge(low, all(0.5)), hn::Le(high, all(2)));
    const V log2_error = hn::IfThenElse(near_one, all(0x1p-21 * s), times(y, 3 * kUlp));
    const V q = times(plus(log2_error, times(y, a.roundoff)), kLn2 * kOurs);
    own = plus(times(q, plus(q, 1)), times(plus(plus(y, y), 3), kUlp));
    good = hn::And(good, hn::Le(q, all(1)));
  }
  const V ours = plus(times(y, 0x1p-45), 0x1p-45 + s * 0x1p-50);
  const V relative = plus(plus(times(plus(times(t, t), t), plus(own, 1)), own), ours);
  left = hn::Or(left, hn::Not(hn::Or(good, none)));
  return {hn::IfThenElse(none, zero, value), plus(hn::IfThenElse(none, zero, times(value, relative)), kFlushed)};
}

/// The power of N.H, where H is far enough from zero: E(h2) <= h2 / 8.
HWY_INLINE Both specular_at(const LaneModel& m, const Pixel& px, const Lane& lane, int shininess, M& left) {
  const D d;
  const Arithmetic& a = m.arithmetic;
  const double v = a.roundoff * (1 + 0x1p-16);
  V h[3], size[3], error[3];
  for (int k = 0; k < 3; ++k) {
    h[k] = plus(lane.direction[k], px.view[k]);
    size[k] = hn::Abs(h[k]);
    const V of_l =
        plus(times(hn::Abs(lane.direction[k]), lane.direction_error), times(lane.moved, px.position_error[k]));
    error[k] = plus(plus(times(of_l, 1 + v), px.view_error[k] + kFlushed), times(size[k], v));
  }
  const V h2 = plus(plus(times(h[0], h[0]), times(h[1], h[1])), times(h[2], h[2]));
  V spread = hn::Zero(d);
  for (int k = 0; k < 3; ++k) spread = plus(spread, times(error[k], plus(plus(size[k], size[k]), error[k])));
  const V h2_error = plus(plus(times(spread, 1 + 3 * v), times(h2, 3 * v)), kFlushed);
  left = hn::Or(left, hn::Not(hn::Lt(h2_error, times(h2, 0.125))));
  const V inverse = hn::Div(all(1), hn::Sqrt(h2)), eta = times(times(h2_error, inverse), inverse);
  const V rho = plus(times(times(eta, plus(eta, 0.5)), 1 + a.inverse_sqrt), a.inverse_sqrt * kOurs);
  const V q1 = dot(size, px.normal_size), q2 = dot(error, px.normal_size), q3 = dot(size, px.normal_error);
  const V inner = plus(times(plus(rho, v), q1), times(plus(rho, 1), q2));
  const V n_h_error = plus(times(times(plus(times(inner, 1 + 8 * v), q3), inverse), kOurs), kFlushed);
  const Both n_h = positive({times(dot(h, px.normal), inverse), n_h_error});
  V low = hn::Max(hn::Zero(d), hn::Sub(n_h.value, n_h.error)), high = plus(n_h.value, n_h.error), x = n_h.value;
  if (m.model.renormalize) {
    high = hn::Min(high, all(1 + 16 * a.roundoff));
    x = hn::Min(x, high);
    low = hn::Min(low, x);
  }
  const Both shine = power(a, low, x, high, shininess, left);
  if (!m.model.specular_masked || !m.adds_unlit) return shine;
  const M lit = hn::Gt(hn::Sub(lane.n_l.value, lane.n_l.error), hn::Zero(d));
  const M dark = hn::Le(plus(lane.n_l.value, lane.n_l.error), hn::Zero(d));
  left = hn::Or(left, hn::Not(hn::Or(lit, dark)));
  return {hn::IfThenElseZero(lit, shine.value), hn::IfThenElseZero(lit, shine.error)};
}

/// Direction and distance of a light, and N.L.
HWY_INLINE Lane lane_of(const V offset[3], V d2, const LaneModel& m, const Pixel& px) {
  const double v = m.arithmetic.roundoff * (1 + 0x1p-16);
  Lane lane;
  lane.d2 = d2;
  lane.distance = hn::Sqrt(d2);
  lane.inverse = hn::Div(all(1), lane.distance);
  V size[3];
  for (int k = 0; k < 3; ++k) {
    lane.direction[k] = times(offset[k], lane.inverse);
    size[k] = hn::Abs(lane.direction[k]);
  }
  lane.ratio = lane.moved = hn::Zero(D());
  if (px.position_norm > 0) {
    const V all_of_it = times(lane.inverse, px.position_norm);
    lane.ratio = plus(times(dot(size, px.position_error), lane.inverse),
                      times(all_of_it, plus(times(all_of_it, 0.5 + 2 * v), v)));
    lane.ratio = hn::IfThenElse(hn::Le(all_of_it, all(kLargestRatio / 2)), lane.ratio, all(1));
    lane.moved = times(lane.inverse, (1 + 4 * v) * (1 + 0x1p-5));  // rho <= 1/32 where k <= 1/64
  }
  lane.direction_error = chord(m.start.direction, m.slope.direction, lane.ratio);
  const V inherited = plus(times(lane.direction_error, dot(size, px.normal_size)), times(lane.moved, px.moved_normal));
  const V error = plus(times(inherited, 1 + 3 * v), dot(size, px.normal_error));
  lane.n_l = {dot(lane.direction, px.normal), plus(times(error, kOurs), kFlushed)};
  return lane;
}

struct Sums {
  V value[3], error[3], magnitude[3];
};

/// (diffuse N.L + specular power) colour strength: two roundings for the sum, in px.error; one for colour times
/// strength, one more where the colour was damped, one for the product. Written apart, the terms have three more each.
/// Where an ambient share of nothing is added to what the colour multiplies, that is one more.
HWY_INLINE void add_terms(const LightColumns& lights, size_t i, const Pixel& px, Both cosine, Both shine, Both strength,
                          double roundings, double v, M taken, Sums& sums) {
  const D d;
  const V most = plus(hn::Abs(strength.value), strength.error);
  const V last = plus(strength.error, times(most, roundings * v * (1 + 8 * v)));
  const V cosine_size = hn::Abs(cosine.value);
  for (int k = 0; k < 3; ++k) {
    const V color = hn::LoadU(d, &lights.color[k][i]);
    const V reflected = plus(times(cosine.value, px.value[0][k]), times(shine.value, px.value[1][k]));
    const V error = plus(plus(times(cosine.error, px.size[0][k]), times(cosine_size, px.error[0][k])),
                         plus(times(shine.error, px.size[1][k]), times(shine.value, px.error[1][k])));
    const V value = hn::IfThenElseZero(taken, times(times(reflected, color), strength.value));
    const V off = plus(times(times(error, most), 1 + 4 * v), times(hn::Abs(reflected), last));
    const V full = hn::IfThenElseZero(taken, times(plus(off, kFlushed), times(color, kOurs)));
    sums.value[k] = plus(sums.value[k], value);
    sums.error[k] = plus(sums.error[k], full);
    sums.magnitude[k] = plus(sums.magnitude[k], plus(hn::Abs(value), full));
  }
}

Pixel pixel_of(const LanePixel& in, const LaneModel& m) {
  const double v = m.arithmetic.roundoff * (1 + 0x1p-16);
  const bool last = m.model.order == TermOrder::albedo_last;
  // Of the sum of the two terms: a product and the sum; the sum alone; and where terms are written apart, three more.
  double roundings = last ? 1 : 2;
  if (m.model.order == TermOrder::separate) roundings += 3;
  Pixel px;
  double square = 0;
  for (size_t k = 0; k < 3; ++k) {
    px.position[k] = in.position[k].value;
    square += in.position[k].error * in.position[k].error;
    px.position_most = std::max(px.position_most, in.position[k].error);
    px.normal[k] = in.normal[k].value;
    px.view[k] = in.view[k].value;
    px.view_error[k] = in.view[k].error * (1 + v);
    px.normal_size[k] = std::fabs(in.normal[k].value) + in.normal[k].error;
    px.normal_error[k] = (1 + 3 * v) * in.normal[k].error + 3 * v * std::fabs(in.normal[k].value);
    px.position_error[k] = in.position[k].error;
    px.moved_normal += px.normal_size[k] * px.position_error[k];
    for (size_t j = 0; j < 2; ++j) {
      const Bounded& factor = j == 0 ? in.diffuse[k] : in.specular[k];
      px.value[j][k] = factor.value;
      px.size[j][k] = (std::fabs(factor.value) + factor.error) * (1 + 6 * v);
      px.error[j][k] = (factor.error + roundings * v * (std::fabs(factor.value) + factor.error)) * (1 + 6 * v);
    }
  }
  px.position_norm = std::sqrt(square);
  return px;
}

/// Lights i and on, `inside` of them; those not judged are left.
HWY_INLINE void judge_vector(const LightColumns& lights, size_t i, const LaneModel& m, const Pixel& px, int shininess,
                             M inside, Sums& sums, LaneSums& out) {
  const D d;
  const Arithmetic& a = m.arithmetic;
  const double v = a.roundoff * (1 + 0x1p-16);
  const V zero = hn::Zero(d), range = hn::LoadU(d, &lights.range[i]);
  V offset[3];
  for (int k = 0; k < 3; ++k) offset[k] = hn::Sub(hn::LoadU(d, &lights.position[k][i]), all(px.position[k]));
  const V d2 = plus(plus(times(offset[0], offset[0]), times(offset[1], offset[1])), times(offset[2], offset[2]));
  if (m.model.falloff == Falloff::linear_range || m.model.falloff == Falloff::inverse_square) {
    const V reach = times(plus(range, 2 * px.position_most), 1 + 16 * a.square_root);
    inside = hn::And(inside, hn::Le(d2, times(reach, reach)));
    if (hn::AllFalse(d, inside)) return;
  }
  const Lane lane = lane_of(offset, d2, m, px);
  M left = hn::Not(hn::And(hn::Ge(d2, all(kShortest)), hn::Le(lane.ratio, all(kLargestRatio))));
  if (m.extents) {
    const V error = plus(times(lane.distance, chord(m.start.distance, m.slope.distance, lane.ratio)), kFlushed);
    inside = hn::And(inside, hn::Or(left, hn::Lt(hn::Sub(lane.distance, error), range)));
    left = hn::Or(left, hn::And(hn::Ge(plus(lane.distance, error), range), hn::Lt(range, all(HUGE_VAL))));
  }
  const Both strength = falloff_at(lights, i, m, lane);
  M sure = hn::Eq(zero, zero);
  if (m.model.falloff != Falloff::linear) {
    sure = hn::Gt(strength.value, strength.error);
    inside = hn::And(inside, hn::Or(left, hn::Gt(plus(strength.value, strength.error), zero)));
  }
  left = hn::Or(left, hn::Not(hn::Lt(strength.error, all(1e30))));
  const M facing = hn::Gt(lane.n_l.value, lane.n_l.error);
  const M maybe_facing = hn::Gt(plus(lane.n_l.value, lane.n_l.error), zero);
  M taken = inside;
  if (!m.adds_unlit) {
    left = hn::Or(left, hn::And(maybe_facing, hn::Not(facing)));
    taken = hn::And(inside, hn::Or(left, maybe_facing));
  }
  if (!hn::AllFalse(d, taken)) {
    Both shine{zero, zero};
    if (m.model.specular != Specular::none) shine = specular_at(m, px, lane, shininess, left);
    const Both cosine = m.model.diffuse == Diffuse::clamped ? positive(lane.n_l) : lane.n_l;
    const double roundings = m.model.order == TermOrder::with_ambient ? 4 : 3;
    add_terms(lights, i, px, cosine, shine, strength, roundings, v, hn::And(taken, hn::Not(left)), sums);
  }
  left = hn::And(left, taken);
  const M judged = hn::And(inside, hn::Not(left));
  out.added += count_of(judged);
  out.lights_low += count_of(hn::And(judged, hn::And(sure, facing)));
  out.lights_high += count_of(hn::And(judged, maybe_facing));
  if (hn::AllFalse(d, left)) return;
  HWY_ALIGN double is_left[hn::MaxLanes(D())];
  hn::Store(hn::IfThenElseZero(left, all(1)), d, is_left);
  for (size_t k = 0; k < hn::Lanes(d); ++k)
    if (is_left[k] != 0) out.left.push_back(uint32_t(i + k));
}

void judge_lanes_simd(const LightColumns& lights, const LaneModel& model, const LanePixel& in, LaneSums& out) {
  const D d;
  const Pixel px = pixel_of(in, model);
  Sums sums;
  for (int k = 0; k < 3; ++k) sums.value[k] = sums.error[k] = sums.magnitude[k] = hn::Zero(d);
  for (size_t i = 0; i < lights.count; i += hn::Lanes(d))
    judge_vector(lights, i, model, px, in.shininess, hn::FirstN(d, lights.count - i), sums, out);
  for (int k = 0; k < 3; ++k) {
    out.value[k] += sum_of(sums.value[k]);
    out.error[k] += sum_of(sums.error[k]);
    out.magnitude[k] += sum_of(sums.magnitude[k]);
  }
}

void judge_lanes_apart_simd(const LightColumns& lights, const LaneModel& model, const LanePixel& in, LaneTerms& out) {
  const D d;
  const Pixel px = pixel_of(in, model);
  LaneSums counts;
  for (size_t i = 0; i < lights.count; i += hn::Lanes(d)) {
    Sums sums;
    for (int k = 0; k < 3; ++k) sums.value[k] = sums.error[k] = sums.magnitude[k] = hn::Zero(d);
    judge_vector(lights, i, model, px, in.shininess, hn::FirstN(d, lights.count - i), sums, counts);
    for (int k = 0; k < 3; ++k) {
      hn::StoreU(sums.value[k], d, &out.value[k][i]);
      hn::StoreU(sums.error[k], d, &out.error[k][i]);
    }
  }
  out.left = std::move(counts.left);
}

}  // namespace trueshade::oracle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(oracle::judge_lanes, oracle::HWY_NAMESPACE::judge_lanes_simd);
TRUESHADE_KERNEL(oracle::judge_lanes_apart, oracle::HWY_NAMESPACE::judge_lanes_apart_simd);
}  // namespace trueshade
