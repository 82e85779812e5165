// OpenGL blending for vectors: a lane is a pixel. Included once per SIMD target. docs/arithmetic.md sections 10 and 11.
// Sources: OpenGL 4.6 core, 17.3.6; Mesa 22.3's lp_bld_blend.c and lp_bld_blend_aos.c, and measurement
// (docs/gl_rules.md section 4).
#if defined(TRUESHADE_SHADING_BLEND_BLEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_BLEND_INL_H_
#undef TRUESHADE_SHADING_BLEND_BLEND_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_BLEND_INL_H_
#endif

#include <hwy/highway.h>

#include <array>

#include "core/simd/store-inl.h"
#include "shading/blend/blend.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Compares, not Min and Max: where one side is NaN the second is taken, as by x86's minps, on every target.
HWY_INLINE VF lesser(VF a, VF b) { return hn::IfThenElse(hn::Lt(a, b), a, b); }
HWY_INLINE VF greater(VF a, VF b) { return hn::IfThenElse(hn::Gt(a, b), a, b); }

/// What the equations read: values, or codes with `one` the largest.
struct BlendInputs {
  VF source[4], destination[4], constant[4], one;
  VF source_alpha;  ///< source[3] as factors read it
};

HWY_INLINE VF factor_value(BlendFactor factor, int c, const BlendInputs& in) {
  switch (factor) {
    case BlendFactor::zero:
      return hn::Zero(DF());
    case BlendFactor::one:
      return in.one;
    case BlendFactor::src_color:
      return in.source[c];
    case BlendFactor::one_minus_src_color:
      return hn::Sub(in.one, in.source[c]);
    case BlendFactor::dst_color:
      return in.destination[c];
    case BlendFactor::one_minus_dst_color:
      return hn::Sub(in.one, in.destination[c]);
    case BlendFactor::src_alpha:
      return in.source_alpha;
    case BlendFactor::one_minus_src_alpha:
      return hn::Sub(in.one, in.source_alpha);
    case BlendFactor::dst_alpha:
      return in.destination[3];
    case BlendFactor::one_minus_dst_alpha:
      return hn::Sub(in.one, in.destination[3]);
    case BlendFactor::constant_color:
      return in.constant[c];
    case BlendFactor::one_minus_constant_color:
      return hn::Sub(in.one, in.constant[c]);
    case BlendFactor::constant_alpha:
      return in.constant[3];
    case BlendFactor::one_minus_constant_alpha:
      return hn::Sub(in.one, in.constant[3]);
    case BlendFactor::src_alpha_saturate:
      return c == 3 ? in.one : lesser(in.source_alpha, hn::Sub(in.one, in.destination[3]));
  }
  return in.one;
}

/// What a state comes to in a target, decided once for all pixels. What pixels hold, their stored form, is codes as
/// floats or the floats themselves; only the format's own channels are touched.
struct BlendPlan {
  struct Group {
    BlendTerm term;
    bool drop_source, drop_destination;  ///< a zero factor: no product, for 0 * inf would be NaN
  } rgb, alpha;
  bool factored;  ///< (S op D) * factor
  bool flushes;   ///< denormal operands and results of arithmetic count as 0, their sign kept
  bool copies;    ///< where one term is dropped the other has no product either: no arithmetic, nothing to flush

  BlendTarget target;
  FormatInfo layout;
  bool enabled;
  bool codes;                     ///< blended in codes, as llvmpipe does
  std::array<bool, 4> written;    ///< by channel: the format has it, and the mask lets it through
  std::array<float, 4> constant;  ///< as equations read it: clamped for unorm, or in codes
  bool wide = false;              ///< codes of 16 bits for those of 10 and 2
  bool sums_values = false;       ///< R, G and B: the source's values and the pixels', and nothing else

  const Group& group(int c) const { return c == 3 ? alpha : rgb; }
  bool unorm() const { return layout.number_class == NumberClass::unorm; }
  /// Light upon light in fixed point: codes are added (docs/gl_rules.md section 10, point 4); not where codes are no
  /// linear values.
  bool adds_codes(int c) const {
    return unorm() && target.profile == NumericProfile::ideal && !layout.srgb_channel(c) &&
           group(c).term == kAccumulate;
  }
  /// 0 where channels are floats of 32 bits, which have no codes.
  float largest(int c) const { return layout.bits[size_t(c)] < 32 ? float(layout.largest_code(c)) : 0.0f; }
  float blended_largest(int c) const { return wide ? 65535.0f : largest(c); }
};

inline BlendPlan blend_plan(const BlendState& state, const BlendTarget& target) {
  BlendPlan plan{{state.rgb, false, false},
                 {state.alpha, false, false},
                 false,
                 false,
                 false,
                 target,
                 info(target.format),
                 state.enabled,
                 false,
                 state.mask,
                 state.constant};
  if (plan.layout.channels < 4 && target.profile != NumericProfile::ideal) {
    // llvmpipe writes the missing alpha into the state: of float formats, all but the saturating factor.
    for (BlendFactor* factor : {&plan.rgb.term.src, &plan.rgb.term.dst}) {
      if (*factor == BlendFactor::dst_alpha) *factor = BlendFactor::one;
      if (*factor == BlendFactor::one_minus_dst_alpha) *factor = BlendFactor::zero;
    }
    plan.alpha = plan.rgb;
  }
  plan.codes = plan.unorm() && !plan.layout.srgb && target.profile != NumericProfile::ideal;
  plan.wide = widens(target.profile, target.format);
  for (int c = 0; c < 4; ++c) {
    plan.written[size_t(c)] = plan.written[size_t(c)] && c < plan.layout.channels;
    const VF constant = hn::Set(DF(), state.constant[size_t(c)]);
    if (plan.codes)
      plan.constant[size_t(c)] = hn::GetLane(unorm_code(constant, plan.blended_largest(c)));
    else if (plan.unorm())
      plan.constant[size_t(c)] = hn::GetLane(clamped_unit(constant));
  }
  for (BlendPlan::Group* group : {&plan.rgb, &plan.alpha}) {
    BlendTerm& term = group->term;
    if (term.equation == BlendEquation::min || term.equation == BlendEquation::max)
      term.src = term.dst = BlendFactor::one;
    group->drop_source = term.src == BlendFactor::zero;
    group->drop_destination = term.dst == BlendFactor::zero;
  }
  plan.sums_values =
      plan.enabled && target.profile == NumericProfile::ideal && plan.rgb.term == kAccumulate && !plan.adds_codes(0);
  if (target.profile == NumericProfile::ideal) return plan;
  plan.flushes = target.format == Format::rgba32f;  // llvmpipe turns flushing off for targets of small floats
  // llvmpipe works on whole RGBA vectors: it leaves a product out, or factors, only where both groups allow it.
  plan.factored = plan.rgb.term.src == plan.rgb.term.dst && plan.alpha.term.src == plan.alpha.term.dst;
  const BlendFactor kept = plan.rgb.drop_source ? plan.rgb.term.dst : plan.rgb.term.src;
  plan.copies = kept == BlendFactor::one && kept == (plan.rgb.drop_source ? plan.alpha.term.dst : plan.alpha.term.src);
  plan.rgb.drop_source = plan.alpha.drop_source = plan.rgb.drop_source && plan.alpha.drop_source;
  plan.rgb.drop_destination = plan.alpha.drop_destination = plan.rgb.drop_destination && plan.alpha.drop_destination;
  return plan;
}

HWY_INLINE VF flushed(const BlendPlan& plan, VF x) {
  if (!plan.flushes) return x;
  const DF d;
  return hn::IfThenElse(hn::Lt(hn::Abs(x), hn::Set(d, 0x1p-126f)), hn::And(x, hn::Set(d, -0.0f)), x);
}

HWY_INLINE VF combined(BlendEquation equation, VF source, VF destination) {
  switch (equation) {
    case BlendEquation::add:
      return hn::Add(source, destination);
    case BlendEquation::subtract:
      return hn::Sub(source, destination);
    case BlendEquation::reverse_subtract:
      return hn::Sub(destination, source);
    case BlendEquation::min:
      return lesser(source, destination);
    case BlendEquation::max:
      return greater(source, destination);
  }
  return destination;
}

HWY_INLINE VF scaled(const BlendPlan& plan, VF x, BlendFactor factor, int c, const BlendInputs& in) {
  const VF operand = flushed(plan, x);
  if (factor == BlendFactor::one) return operand;
  return flushed(plan, hn::Mul(operand, flushed(plan, factor_value(factor, c, in))));
}

/// Channel c in float32: fl(fl(S Sf) op fl(D Df)).
HWY_INLINE VF blended_values(const BlendPlan& plan, int c, const BlendInputs& in) {
  const BlendPlan::Group& group = plan.group(c);
  const BlendTerm& term = group.term;
  const VF zero = hn::Zero(DF());
  if (group.drop_source && group.drop_destination) return zero;
  if (plan.factored) {
    const VF source = flushed(plan, in.source[c]), destination = flushed(plan, in.destination[c]);
    return scaled(plan, combined(term.equation, source, destination), term.src, c, in);
  }
  if (group.drop_destination) {
    const VF source = scaled(plan, in.source[c], term.src, c, in);
    if (term.equation == BlendEquation::reverse_subtract) return hn::Sub(zero, source);
    return plan.copies ? in.source[c] : source;
  }
  const VF destination = scaled(plan, in.destination[c], term.dst, c, in);
  if (group.drop_source) {
    if (term.equation == BlendEquation::subtract) return hn::Sub(zero, destination);
    return plan.copies ? in.destination[c] : destination;
  }
  return flushed(plan, combined(term.equation, scaled(plan, in.source[c], term.src, c, in), destination));
}

/// llvmpipe's product of two codes of 8 or 16 bits: of 8, 24 of 65,536 are not RN(a b / 255). Below 2^32 throughout.
template <int kBits>
HWY_INLINE VF code_product(VF a, VF b) {
  const DI di;
  const DU du;
  const auto exact = hn::Mul(hn::BitCast(du, hn::ConvertTo(di, a)), hn::BitCast(du, hn::ConvertTo(di, b)));
  const auto t = hn::Add(hn::Add(exact, hn::ShiftRight<kBits>(exact)), hn::Set(du, 1u << (kBits - 1)));
  return hn::ConvertTo(DF(), hn::BitCast(di, hn::ShiftRight<kBits>(t)));
}

/// Channel c in codes, each product rounded, sums held to [0, one].
template <int kBits>
HWY_INLINE VF blended_codes(const BlendPlan& plan, int c, const BlendInputs& in) {
  const BlendTerm& term = plan.group(c).term;
  const VF source = code_product<kBits>(in.source[c], factor_value(term.src, c, in));
  const VF destination = code_product<kBits>(in.destination[c], factor_value(term.dst, c, in));
  return greater(lesser(combined(term.equation, source, destination), in.one), hn::Zero(DF()));
}

/// What blending off, or a clear, leaves of x in channel c.
HWY_INLINE VF encoded_alone(const BlendPlan& plan, VF x, int c) {
  if (plan.wide) return narrowed_code(unorm_code(x, 65535.0f), c);
  if (plan.layout.srgb_channel(c) && plan.target.profile != NumericProfile::ideal) return llvmpipe_srgb8_code(x);
  const VF held = encoded(x, plan.target.format, c, plan.target.half_round);
  return plan.unorm() ? held : hn::IfThenElse(hn::Eq(held, held), held, one_nan());
}

/// blend_vectors() of channel c below 3 where the plan sums values.
HWY_INLINE VF summed_values(const BlendPlan& plan, VF source, VF stored, int c) {
  if (!plan.unorm()) {
    const VF sum = encoded(hn::Add(source, stored), plan.target.format, c, plan.target.half_round);
    return hn::IfThenElse(hn::Eq(sum, sum), sum, one_nan());
  }
  const VF held = decoded(stored, plan.target.format, c, NumericProfile::ideal);
  return encoded(hn::Add(clamped_unit(source), held), plan.target.format, c, plan.target.half_round);
}

HWY_INLINE void set_inputs(const BlendPlan& plan, const VF source[4], const VF stored[4], BlendInputs& in) {
  const DF d;
  in.one = hn::Set(d, plan.codes ? plan.blended_largest(0) : 1.0f);
  for (int c = 0; c < 4; ++c) {
    in.constant[c] = hn::Set(d, plan.constant[size_t(c)]);
    if (plan.codes) {
      in.source[c] = unorm_code(source[c], plan.blended_largest(c));
      in.destination[c] = plan.wide ? widened_code(stored[c], c) : stored[c];
    } else {
      in.source[c] = plan.unorm() ? clamped_unit(source[c]) : source[c];
      in.destination[c] = decoded(stored[c], plan.target.format, c, plan.target.profile);
    }
  }
  if (plan.layout.channels < 4) in.destination[3] = in.one;  // a missing alpha is 1
  in.source_alpha = plan.codes ? in.source[3] : flushed(plan, in.source[3]);
}

/// Blends a vector of fragments into the pixels `stored` holds, in their stored form: blend_pixels() in registers.
/// Fixed point: `ideal` blends values and rounds once, except that light upon light adds codes; llvmpipe blends codes,
/// but those of sRGB.
inline void blend_vectors(const BlendPlan& plan, const VF source[4], VF stored[4]) {
  const DF d;
  VF out[4];
  if (!plan.enabled) {
    for (int c = 0; c < 4; ++c) out[c] = encoded_alone(plan, source[c], c);
  } else {
    BlendInputs in;
    set_inputs(plan, source, stored, in);
    for (int c = 0; c < 4; ++c) {
      if (plan.codes)
        out[c] = plan.layout.bits[0] == 8 ? blended_codes<8>(plan, c, in) : blended_codes<16>(plan, c, in);
      if (plan.wide) out[c] = narrowed_code(out[c], c);
      if (plan.codes) continue;
      if (plan.adds_codes(c))
        out[c] = lesser(hn::Add(stored[c], unorm_code(in.source[c], plan.largest(c))), hn::Set(d, plan.largest(c)));
      else
        out[c] = encoded_alone(plan, blended_values(plan, c, in), c);
    }
  }
  for (int c = 0; c < 4; ++c)
    if (plan.written[size_t(c)]) stored[c] = out[c];
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
