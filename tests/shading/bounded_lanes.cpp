#include "tests/shading/bounded_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/shading/bounded_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "core/simd/store-inl.h"
#include "shading/blend/bounded/bounded_phong-inl.h"
#include "shading/light/light_sum-inl.h"
#include "shading/sum/bounded/bounded_blinn_sum-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using testing::kBoundedPixels, testing::RootSource, testing::BoundedErrors, testing::BoundedPixels;

constexpr bool kBoundsCodes = kLanes == size_t(kBoundedPixels);

bool bounds_codes() { return kBoundsCodes; }

/// An estimate at an end of the range that is promised, or in its middle.
template <int kEnd, int kOff = 4>  // in units of 2^-16
struct RootAt {
  static HWY_INLINE VF reciprocal(VF x) {
    const DF d;
    const VF right = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(x));  // two roundings off: 2^-23
    return hn::Mul(right, hn::Set(d, 1.0f + float(kEnd) * (float(kOff) * 0x1p-16f - 0x1p-22f)));
  }
};

struct Estimates {
  alignas(64) float x[3][kBoundedPixels], code255[3][kBoundedPixels];
  double allowed[3][kBoundedPixels];  ///< units of 2^-14 of a code; 0 where nothing is estimated
  double proven[kBoundedPixels];      ///< the proof's bound for colour 1, in u
};

// Section 17: 9.1 f + 6.1 d / range of the estimate, 8 f + 2 d / range of the term: most where f is 1.
constexpr double kProvenLambert = 17.1;
constexpr double kProvenLength = 1.001;  // of N and V, whose squares may be 1 + 2^-10, and what is of second order

// Section 18, of one pixel, before what is there for slack.
inline double proven_phong(const BoundedPixels& in, int i, const LightRow& row) {
  double d2 = 0, nd = 0, nv = 0, dv = 0, da = 0;
  for (int c = 0; c < 3; ++c) {
    const double d = row.position[c] - in.number[c][i], n = in.number[3 + c][i], v = in.number[6 + c][i];
    d2 += d * d, nd += n * d, nv += n * v, dv += d * v, da += d * row.axis[c];
  }
  const double r = 1.0 / std::sqrt(d2), c = std::clamp(nd * r, 0.0, 1.0);
  const double s = std::pow(std::clamp(2.0 * c * nv - dv * r, 0.0, 1.0), 60.0), all = c + s;
  const double sum = 7.1 * c + 2950.0 * s + 5.2 + 10.0 * all;
  if (row.kind != LightKind::coned) return sum;
  const double t = std::clamp((da * r - row.edge) * row.slope, 0.0, 1.0), g = t * t * (3.0 - 2.0 * t);
  return g * sum + all * (6.0 * g + 6.0 * (t - t * t) * (13.1 * row.slope + 4.0));
}

inline void compare(const LightRow& row, const Estimates& of, BoundedErrors& out) {
  for (int i = 0; i < kBoundedPixels; ++i) {
    out.share[i] = out.window[i] = 0.0;
    for (int c = 0; c < 3; ++c) {
      if (of.allowed[c][i] == 0.0 || !std::isfinite(of.x[c][i])) continue;  // the latter must be left undecided
      const double units = std::fabs(double(of.x[c][i]) * 256.0 - double(of.code255[c][i])) * 0x1p14;
      const double proven = of.proven[i] * double(row.color[c]) * 255.0 * 0x1p-10 * kProvenLength + 0x1p-20;
      if (!(units / proven <= out.share[i])) out.share[i] = units / proven;
      if (!(proven / of.allowed[c][i] <= out.window[i])) out.window[i] = proven / of.allowed[c][i];
    }
  }
}

// What is not undecided must have counted as the term does, at most white, or not at all where that adds nothing.
inline void check_codes(const LightTerm& term, const BoundedCodes& codes, MF asked, MF undecided, BoundedErrors& out) {
  const DF d;
  const DI di;
  const MF closed = hn::AndNot(undecided, asked);
  MF wrong = hn::Lt(hn::Zero(d), hn::Zero(d));
  for (int c = 0; c < 3; ++c) {
    const VF code = hn::Round(hn::Mul(hn::IfThenElseZero(term.adds, term.color[c]), hn::Set(d, 255.0f)));
    wrong = hn::Or(wrong, hn::Ne(hn::Min(code, hn::Set(d, 255.0f)), codes.codes(c)));
  }
  const auto lights = hn::IfThenElseZero(hn::RebindMask(di, term.lit), hn::Set(di, 1));
  wrong = hn::Or(wrong, hn::RebindMask(d, hn::Ne(lights, codes.lit)));
  out.wrong = int(hn::CountTrue(d, hn::And(closed, wrong)));
  out.proved = int(hn::CountTrue(d, hn::And(closed, term.adds)));
}

HWY_INLINE PixelVector loaded(const BoundedPixels& in) {
  const DF d;
  PixelVector px;
  px.covered = hn::Eq(hn::Zero(d), hn::Zero(d));
  for (int c = 0; c < 3; ++c) {
    px.p[c] = hn::Load(d, in.number[c]), px.n[c] = hn::Load(d, in.number[3 + c]);
    px.v[c] = hn::Load(d, in.number[6 + c]), px.albedo[c] = hn::Load(d, in.number[9 + c]);
    px.specular[c] = hn::Zero(d);
  }
  return px;
}

template <class Terms>
HWY_INLINE LightTerm term_of(const Terms& terms, const PixelVector& px, Estimates& of) {
  const DF d;
  const LightTerm term = terms(px, terms.lights.row[0]);
  for (int c = 0; c < 3; ++c)
    hn::Store(hn::IfThenElseZero(term.adds, hn::Mul(term.color[c], hn::Set(d, 255.0f))), d, of.code255[c]);
  return term;
}

template <class Root>
void lambert_errors(const LightTable& table, const LightModel& model, const BoundedPixels& in, BoundedErrors& out) {
  using Shape = WindowLambert;
  const DF d;
  const LightTerms<Shape> terms(table, model, Shape());
  const PixelVector px = loaded(in);
  const MF asked = surfaces_in_proof_range(px);
  BoundedLight light;
  const LightRow& row = table.row[0];
  light.set({&row, {row.position[0], row.position[1], row.position[2]}, row.cut2, 0, 0, true});
  const BoundedLightLanes lanes(light);
  LambertPairs<1, Root> pairs;
  pairs.px[0] = &px, pairs.undecided[0] = asked;
  Estimates of;
  typename LambertPairs<1, Root>::Weights weights;
  pairs.weigh(lanes, weights);
  const LightTerm term = term_of(terms, px, of);
  const uint64_t lit = mask_bits(pairs.undecided[0]);
  for (int c = 0; c < 3; ++c) {
    hn::Store(pairs.estimate(lanes, 0, c, weights.weight[0]), d, of.x[c]);
    const int window = light.bias[c] - (1 << 30) - (1 << (kBelowCode - 1));
    for (int i = 0; i < kBoundedPixels; ++i)
      of.allowed[c][i] = (lit >> i & 1) != 0 && light.clear[c] != 0 ? window - 0.5 : 0.0;
  }
  std::fill_n(of.proven, kBoundedPixels, kProvenLambert);
  compare(row, of, out);
  out.edge = 0.0;
  BoundedCodes codes, *const to[1] = {&codes};
  codes.clear();
  pairs.undecided[0] = asked;
  pairs.weigh(lanes, weights);
  pairs.decide(lanes, weights, to);
  codes.saturate(CountedLights::all);
  check_codes(term, codes, asked, pairs.undecided[0], out);
}

template <class Root, bool kCone>
void phong_errors(const LightTable& table, const LightModel& model, const BoundedPixels& in, BoundedErrors& out) {
  using Shape = SpotPhong;
  using Pairs = PhongPairs<1, kCone, Root>;
  const DF d;
  const LightTerms<Shape> terms(table, model, Shape());
  const PixelVector px = loaded(in);
  const MF asked = hn::And(surfaces_in_proof_range(px), views_in_proof_range(px));
  const VF facing2 = twice_facing(px);
  const LightRow& row = table.row[0];
  BoundedSpot light;
  light.set({&row, {row.position[0], row.position[1], row.position[2]}, row.cut2, 0, 0, true});
  const SpotLanes lanes(light);
  Pairs pairs;
  pairs.px[0] = &px, pairs.facing2[0] = &facing2, pairs.undecided[0] = asked;
  Estimates of;
  typename Pairs::Weights weights;
  pairs.weigh(lanes, weights);
  const LightTerm term = term_of(terms, px, of);
  alignas(64) int32_t near[kBoundedPixels];
  hn::Store(hn::ConvertTo(DI(), weights.bound[0]), DI(), near);
  const uint64_t estimated = mask_bits(weights.estimated[0]);
  for (int c = 0; c < 3; ++c) {
    hn::Store(pairs.estimate(lanes, 0, c, weights.weight[0]), d, of.x[c]);
    for (int i = 0; i < kBoundedPixels; ++i)
      of.allowed[c][i] = (estimated >> i & 1) != 0 && near[i] < 1 << (kBelowCode - 1) ? near[i] + 0.5 : 0.0;
  }
  for (int i = 0; i < kBoundedPixels; ++i) of.proven[i] = proven_phong(in, i, row);
  compare(row, of, out);
  out.edge = kCone ? (13.1 * row.slope + 4.0) * kProvenLength * 0x1p-24 / light.away : 0.0;
  BoundedCodes codes, *const to[1] = {&codes};
  codes.clear();
  pairs.undecided[0] = asked;
  pairs.weigh(lanes, weights);
  pairs.decide(lanes, weights, to);
  codes.saturate(CountedLights::separately);
  check_codes(term, codes, asked, pairs.undecided[0], out);
}

template <class Root>
void errors_from(const LightTable& table, const LightModel& model, bool phong, const BoundedPixels& in,
                 BoundedErrors& out) {
  if constexpr (kBoundsCodes) {
    if (!phong) return lambert_errors<Root>(table, model, in, out);
    if (table.row[0].kind == LightKind::coned) return phong_errors<Root, true>(table, model, in, out);
    phong_errors<Root, false>(table, model, in, out);
  }
}

void bounded_errors_of(const LightTable& table, const LightModel& model, bool phong, RootSource root,
                       const BoundedPixels& in, BoundedErrors& out) {
  switch (root) {
    case RootSource::cpu:
      return errors_from<EstimatedRoot>(table, model, phong, in, out);
    case RootSource::low:
      return errors_from<RootAt<-1>>(table, model, phong, in, out);
    case RootSource::right:
      return errors_from<RootAt<0>>(table, model, phong, in, out);
    case RootSource::high:
      return errors_from<RootAt<1>>(table, model, phong, in, out);
  }
}

// Section 19: of one pixel and channel, as a share of u.
inline double proven_window(const BoundedPixels& in, int i, int channel, const LightTable& table,
                            const LightModel& model, double sum) {
  constexpr double kRoot = 6.4;
  const double albedo = in.number[9 + channel][i], ks = model.specular_color[channel];
  double proven = 0, lit = 0;
  for (const LightRow& row : table.row) {
    double d2 = 0, nd = 0, nv = 0, dv = 0, v2 = 0;
    for (int c = 0; c < 3; ++c) {
      const double d = row.position[c] - in.number[c][i], n = in.number[3 + c][i], v = in.number[6 + c][i];
      d2 += d * d, nd += n * d, nv += n * v, dv += d * v, v2 += v * v;
    }
    const double distance = std::sqrt(d2), cosine = nd / distance, f = 1.0 - distance / row.range;
    if (!(nd > 0 && f > 0)) continue;
    const double fall = (kRoot + 5) * (1 - f) + 2 * f, color = row.color[channel];
    const double h2 = 1 + v2 + 2 * dv / distance, h = std::sqrt(h2), t = std::max(cosine + nv, 0.0);
    const double root_x = t / h, s = std::pow(root_x, 32.0);
    const double of_x =
        root_x < 1e-3 ? 0 : 2 * (kRoot + 10 + 5 * h) / (root_x * h) + (16 + 2 * kRoot) / h2 + 6 / h + 10;
    proven += albedo * color * cosine * ((kRoot + 4) * f + fall);
    proven += ks * color * (f * 16 * s * (of_x + 1) + s * fall);
    ++lit;
  }
  return proven + (8 + 2 * lit) * sum;
}

template <class Root>
void window_errors_from(const LightTable& table, const BoundedLights& bounded, const LightModel& model,
                        const BoundedPixels& in, BoundedErrors& out) {
  if constexpr (kEstimatesRoots) {
    const DF d;
    const LightTerms<WindowBlinn> terms(table, model, WindowBlinn());
    WindowSteps steps;
    for (size_t k = 0; k < table.size(); ++k) steps.light[k] = int32_t(k);
    steps.end(0, table.size(), uint32_t(table.size()));
    for (int i = 0; i < kBoundedPixels; i += int(kLanes)) {
      PixelVector px;
      px.covered = hn::Eq(hn::Zero(d), hn::Zero(d));
      for (int c = 0; c < 3; ++c) {
        px.p[c] = hn::Load(d, in.number[c] + i), px.n[c] = hn::Load(d, in.number[3 + c] + i);
        px.v[c] = hn::Load(d, in.number[6 + c] + i), px.albedo[c] = hn::Load(d, in.number[9 + c] + i);
        px.specular[c] = hn::Set(d, model.specular_color[c]);
        px.covered = hn::And(px.covered, hn::Le(hn::Abs(px.p[c]), hn::Set(d, 0x1p30f)));  // region_in_proof_range()
      }
      LightSum sum;
      for (const LightRow& row : table.row) add_term(terms, px, terms(px, row), sum);
      WindowSum<Root> estimate;
      estimate.begin(px);
      for (size_t k = 0; k < steps.count; ++k)
        estimate.add(terms, bounded.window.data(), steps.light + k * WindowSteps::kTogether);
      VF value[3], bound[3];
      for (int c = 0; c < 3; ++c) value[c] = estimate.value(px, hn::Zero(d), c);
      estimate.bound(px, value, bounded.most_color, 0, bound);
      const MF proved = estimate.proved(px, value, bounded.most_color, 0);
      const uint64_t bits = mask_bits(proved);
      MF wrong = hn::RebindMask(d, hn::Ne(estimate.lights, sum.lights));
      wrong = hn::And(wrong, px.covered);
      HWY_ALIGN float off[kLanes], allowed[kLanes], right[kLanes];
      for (int c = 0; c < 3; ++c) {
        const MF other = hn::Ne(unorm8_code(value[c]), unorm8_code(sum.color[c]));
        wrong = hn::Or(wrong, hn::And(proved, other));
        hn::Store(hn::Abs(hn::Sub(value[c], sum.color[c])), d, off);
        hn::Store(bound[c], d, allowed);
        hn::Store(sum.color[c], d, right);
        for (size_t k = 0; k < kLanes; ++k) {
          const size_t pixel = size_t(i) + k;
          if (c == 0) out.share[pixel] = out.window[pixel] = 0.0;
          if ((bits >> k & 1) == 0) continue;
          const double proven =
              proven_window(in, int(pixel), c, table, model, double(right[k])) * 1.005 * 0x1p-24 + 0x1p-60;
          out.share[pixel] = std::max(out.share[pixel], double(off[k]) / proven);
          out.window[pixel] = std::max(out.window[pixel], proven / (double(allowed[k]) + 0x1p-58));
        }
      }
      out.proved += int(hn::CountTrue(d, proved));
      out.wrong += int(hn::CountTrue(d, wrong));
    }
  }
}

bool bounds_windows() { return kEstimatesRoots; }

void window_errors_of(const LightTable& table, const BoundedLights& bounded, const LightModel& model, RootSource root,
                      const BoundedPixels& in, BoundedErrors& out) {
  switch (root) {
    case RootSource::cpu:
      return window_errors_from<EstimatedRoot>(table, bounded, model, in, out);
    case RootSource::low:
      return window_errors_from<RootAt<-1, 24>>(table, bounded, model, in, out);
    case RootSource::right:
      return window_errors_from<RootAt<0, 24>>(table, bounded, model, in, out);
    case RootSource::high:
      return window_errors_from<RootAt<1, 24>>(table, bounded, model, in, out);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(bounds_windows);
HWY_EXPORT(window_errors_of);
HWY_EXPORT(bounds_codes);
HWY_EXPORT(bounded_errors_of);

namespace testing {

bool bounds_codes() { return HWY_DYNAMIC_DISPATCH(bounds_codes)(); }

bool bounds_windows() { return HWY_DYNAMIC_DISPATCH(bounds_windows)(); }

void window_errors(const LightTable& lights, const BoundedLights& bounded, const LightModel& model, RootSource root,
                   const BoundedPixels& pixels, BoundedErrors& errors) {
  errors = {};
  if (bounded.window.empty()) return;
  HWY_DYNAMIC_DISPATCH(window_errors_of)(lights, bounded, model, root, pixels, errors);
}

void bounded_errors(const LightTable& lights, const LightModel& model, bool phong, RootSource root,
                    const BoundedPixels& pixels, BoundedErrors& errors) {
  HWY_DYNAMIC_DISPATCH(bounded_errors_of)(lights, model, phong, root, pixels, errors);
}

}  // namespace testing
}  // namespace trueshade
#endif  // HWY_ONCE
