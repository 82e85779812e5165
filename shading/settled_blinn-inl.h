// Codes of sums of Blinn-Phong terms under lights with a linear window, from estimates of the terms and a bound of what
// their sum may be off by; pixels that the bound leaves open are summed as docs/arithmetic.md section 8 says. The proof
// is section 19. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_SETTLED_BLINN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SETTLED_BLINN_INL_H_
#undef TRUESHADE_SHADING_SETTLED_BLINN_INL_H_
#else
#define TRUESHADE_SHADING_SETTLED_BLINN_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <utility>

#include "shading/plain_lights.h"
#include "shading/settled_codes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether the CPU's estimate of 1 / sqrt is as near as section 19 asks: 1.5 * 2^-12 as a share of it. That of targets
/// that emulate vectors is not.
constexpr bool kEstimatesRoots = HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128;

/// Whether sums of lights of this shape are settled here.
template <class Shape>
constexpr bool settles_window() {
  if constexpr (Shape::compiled && kEstimatesRoots) return is_window(Shape::shape);
  return false;
}

/// Lights of a vector of pixels, as places in PlainLights::window.
struct WindowList {
  static constexpr size_t kTogether = kLanes == kBlockPixels ? 4 : 2;
  HWY_ALIGN int32_t light[256 + 2 * kBlockPixels];  ///< kTogether more than `count` may be read: these light nothing
  size_t count;

  HWY_INLINE void end(uint32_t none) {
    for (size_t k = 0; k < kTogether; ++k) light[count + k] = int32_t(none);
  }
};

/// The lights of a region: those with a window, with the blocks that each reaches, a bit for each lane of BlockBalls;
/// and all others.
struct RegionWindows {
  static constexpr size_t kMost = 256;
  HWY_ALIGN int32_t light[kMost + kBlockPixels], reached[kMost + kBlockPixels];
  const LightRow* other[kMost];
  size_t count = 0, others = 0;
  const uint32_t none;  ///< the place of the light that lights nothing

  explicit RegionWindows(uint32_t nothing) : none(nothing) {}

  HWY_INLINE void add(uint32_t window, uint32_t blocks) {
    light[count] = int32_t(window);
    reached[count++] = int32_t(blocks);
  }
  /// Those that reach a lane's block.
  HWY_INLINE void list(size_t lane, WindowList& out) {
    const DI di;
    hn::StoreU(hn::Zero(di), di, reached + count);
    out.count = 0;
    for (size_t i = 0; i < count; i += kLanes) {
      const auto mask = hn::TestBit(hn::Load(di, reached + i), hn::Set(di, 1 << lane));
      hn::StoreU(hn::Compress(hn::Load(di, light + i), mask), di, out.light + out.count);
      out.count += hn::CountTrue(di, mask);
    }
    out.end(none);
  }
  /// Those that light one of the pixels.
  template <class Shape>
  HWY_INLINE void list(const LightTerms<Shape>& terms, const PixelVector& px, const WindowLight* lights,
                       WindowList& out) const {
    out.count = 0;
    for (size_t i = 0; i < count; ++i) {
      LightChain at;
      const WindowLight& of = lights[light[i]];
      terms.place(px, false, of.position, at);
      terms.reach(px.covered, false, of.cut2, at);
      out.light[out.count] = light[i];
      out.count += hn::AllFalse(DF(), at.term.adds) ? 0u : 1u;
    }
    out.end(none);
  }
};

/// Whether a region's surfaces are no farther away than section 19 has them.
inline bool plain_region(const Region& r) {
  bool near = true;
  for (int c = 0; c < 3; ++c) near = near && r.place.low[c] >= -0x1p30f && r.place.high[c] <= 0x1p30f;
  return near;
}

/// Pixels whose numbers are in the ranges of section 19. Those that are none light nothing, or settle nothing.
HWY_INLINE MF window_pixels(const PixelVector& px, VF view2) {
  const DF d;
  const VF zero = hn::Zero(d);
  const VF most = hn::Max(hn::Max(px.albedo[0], px.albedo[1]), px.albedo[2]),
           least = hn::Min(hn::Min(px.albedo[0], px.albedo[1]), px.albedo[2]);
  MF plain = less_within(px.covered, view2, hn::Set(d, 1.0f + 0x1p-10f));
  plain = less_within(plain, dot3(px.n, px.n), hn::Set(d, 1.0f + 0x1p-20f));
  plain = hn::And(plain, hn::And(hn::Ge(least, zero), hn::Le(most, hn::Set(d, kMostPlainAlbedo))));
  for (int c = 0; c < 3; ++c)
    plain = hn::AndNot(hn::And(hn::Lt(hn::Abs(px.p[c]), hn::Set(d, 0x1p-40f)), hn::Ne(px.p[c], zero)), plain);
  return plain;
}

/// Sums of a vector of pixels over estimates of their terms.
template <class Shape, class Root = EstimatedRoot>
struct WindowSum {
  const PixelVector& px;
  VF view4[3], half4, along2;  ///< 4 V, 4 (1 + V . V), 2 N . V
  MF plain;
  VF diffuse[3], shine[3];  ///< twice N . L, and powers: times falloffs and colours
  VF facing, least4;        ///< sum of twice N . L; the least 4 H . H
  hn::Vec<DI> lights;       ///< that light each pixel: exact

  HWY_INLINE explicit WindowSum(const PixelVector& pixels) : px(pixels) {
    const DF d;
    const VF four = hn::Set(d, 4.0f), along = dot3(px.n, px.v), view2 = dot3(px.v, px.v);
    for (int c = 0; c < 3; ++c) {
      view4[c] = hn::Mul(four, px.v[c]);
      diffuse[c] = shine[c] = hn::Zero(d);
    }
    half4 = hn::Mul(four, hn::Add(hn::Set(d, 1.0f), view2));
    along2 = hn::Add(along, along);
    plain = window_pixels(px, view2);
    facing = hn::Zero(d), least4 = hn::Set(d, 16.0f);
    lights = hn::Zero(DI());
  }

  HWY_INLINE void add(const LightTerms<Shape>& terms, const WindowLight* lights, const WindowList& list) {
    for (size_t k = 0; k < list.count; k += WindowList::kTogether)
      add(terms, lights, list.light + k, std::make_index_sequence<WindowList::kTogether>());
  }

  /// What is stored where it is settled; base: the sum of other lights, which came first.
  HWY_INLINE VF value(VF base, int c) const {
    const VF half = hn::Mul(px.albedo[c], hn::Set(DF(), 0.5f));
    return hn::Add(base, hn::Add(hn::Mul(half, diffuse[c]), hn::Mul(px.specular[c], shine[c])));
  }

  /// What |value - sum| is at most, for colours up to `most` and with some other lights.
  HWY_INLINE void bound(const VF value[3], float most, size_t others, VF out[3]) const {
    const DF d;
    constexpr float u = kSlack * 0x1p-24f;
    const VF n = hn::ConvertTo(d, lights), bright = hn::Mul(n, hn::Set(d, most));
    const VF relative = hn::Mul(hn::Add(hn::Add(n, n), hn::Set(d, 10.0f + 2.0f * float(others))), hn::Set(d, u));
    const VF edge = hn::Mul(facing, hn::Set(d, 0.5f * kEdge * u * most));
    const VF power = hn::Mul(hn::Add(hn::Set(d, kPower), hn::Div(hn::Set(d, 4.0f * kSlant), least4)), hn::Set(d, u));
    const VF faint = hn::Mul(bright, hn::Add(hn::Set(d, kEdge * u), hn::Mul(power, hn::Set(d, kFaint))));
    for (int c = 0; c < 3; ++c)
      out[c] = hn::Add(hn::Add(hn::Mul(relative, value[c]), hn::Mul(px.albedo[c], edge)),
                       hn::Mul(px.specular[c], hn::Add(faint, hn::Mul(power, shine[c]))));
  }

  /// Pixels whose codes of 8 bits are those of `value` for certain.
  HWY_INLINE MF settled(const VF value[3], float most, size_t others) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f), largest = hn::Set(d, 255.0f);
    VF off[3];
    bound(value, most, others, off);
    MF all = less_within(plain, hn::Set(d, 4.0f * kLeastHalf2), least4);
    for (int c = 0; c < 3; ++c) {
      const VF x = hn::Mul(hn::Min(value[c], one), largest);
      const VF away = hn::Add(hn::Abs(hn::Sub(x, hn::Round(x))), hn::Mul(off[c], largest));
      all = less_within(all, away, hn::Set(d, 0.5f - 0x1p-13f));  // which no NaN is
    }
    return all;
  }

 private:
  // Section 19, in units of u.
  static constexpr float kEdge = 11.4f, kPower = 627.0f, kSlant = 1026.0f, kFaint = 1.0f / 400.0f,
                         kLeastHalf2 = 0x1p-7f, kSlack = 1.02f;

  // Some lights, a step of each after the other.
  template <size_t... k>
  HWY_INLINE void add(const LightTerms<Shape>& terms, const WindowLight* lights, const int32_t* list,
                      std::index_sequence<k...>) {
    Step at[sizeof...(k)];
    ((at[k].light = lights + list[k]), ...);
    (terms.place(px, false, at[k].light->position, at[k].chain), ...);
    (estimate(at[k]), ...);
    (refine(at[k]), ...);
    (reflect(at[k]), ...);
    (fall_off(at[k]), ...);
    ((at[k].power = integer_power<Shape::shape.power>(at[k].power)), ...);
    (sum(at[k]), ...);
  }

  struct Step {
    const WindowLight* light;
    LightChain chain;
    MF lit;
    VF root, toward, half, power, falloff;
  };

  HWY_INLINE void estimate(Step& at) const {
    const DF d;
    at.lit = less_within(less_within(px.covered, at.chain.d2, hn::Set(d, at.light->cut2)), hn::Zero(d), at.chain.nl);
    at.root = Root::reciprocal(at.chain.d2);
  }
  HWY_INLINE void refine(Step& at) const {  // 2 / sqrt
    at.root = hn::Mul(at.root, hn::Sub(hn::Set(DF(), 3.0f), hn::Mul(at.chain.d2, hn::Mul(at.root, at.root))));
  }
  HWY_INLINE void reflect(Step& at) const {
    at.toward = hn::Mul(at.chain.nl, at.root);
    at.half = hn::Add(half4, hn::Mul(dot3(at.chain.to_light, view4), at.root));
    const VF t = positive(hn::Add(at.toward, along2));
    at.power = hn::Mul(t, t);
  }
  HWY_INLINE void fall_off(Step& at) const {
    const DF d;
    at.power = hn::Div(at.power, at.half);
    const VF share = hn::Mul(hn::Mul(at.chain.d2, hn::Set(d, at.light->half_share)), at.root);
    at.falloff = hn::Sub(hn::Set(d, 1.0f), share);
  }
  HWY_INLINE void sum(const Step& at) {
    const DF d;
    const DI di;
    const VF w = hn::IfThenElseZero(at.lit, hn::Mul(at.toward, at.falloff));
    const VF s = hn::IfThenElseZero(at.lit, hn::Mul(at.power, at.falloff));
    facing = hn::Add(facing, hn::IfThenElseZero(at.lit, at.toward));
    least4 = hn::IfThenElse(at.lit, hn::Min(at.half, least4), least4);
    lights = hn::Add(lights, hn::IfThenElseZero(hn::RebindMask(di, at.lit), hn::Set(di, 1)));
    for (int c = 0; c < 3; ++c) {
      const VF color = hn::Set(d, at.light->color[c]);
      diffuse[c] = hn::Add(diffuse[c], hn::Mul(color, w));
      shine[c] = hn::Add(shine[c], hn::Mul(color, s));
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
