// Codes of sums of Blinn-Phong terms under lights with a linear window, from estimates of the terms and a bound of what
// their sum may be off by; pixels that the bound leaves undecided are summed as docs/arithmetic.md section 8 says. The
// proof is section 19. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_BLINN_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_BLINN_SUM_INL_H_
#undef TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_BLINN_SUM_INL_H_
#else
#define TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_BLINN_SUM_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <memory>
#include <utility>

#include "shading/light/bounded/estimates-inl.h"
#include "shading/light/lists/light_lists-inl.h"
#include "shading/sum/bounded/bounded_lights.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lights of the vectors of a region, as indices into BoundedLights::window: some of one vector a step, so that a
/// region is one loop and no branch depends on how many lights a vector has.
struct WindowSteps {
  static constexpr size_t kTogether = kLanes == kBlockPixels ? 4 : 2;
  static constexpr size_t kMostLights = 256, kVectors = kRegionBlockCount * kBlockPixels / kLanes;
  int32_t *light, *vector;       ///< kTogether a step; of each step
  size_t count = 0, listed = 0;  ///< steps; lights in them

  WindowSteps() {
    constexpr size_t kMost = kVectors * (kMostLights + kTogether) + 2 * kBlockPixels;
    struct Scratch {
      int32_t light[kMost], vector[kMost];
    };
    thread_local const std::unique_ptr<Scratch> scratch = std::make_unique<Scratch>();
    light = scratch->light, vector = scratch->vector;
  }

  /// Where the next lights go; room for a vector more.
  HWY_INLINE int32_t* next() const { return light + count * kTogether; }
  /// The next `lights` of them are those of a vector. `none`: a light that lights nothing.
  HWY_INLINE void end(size_t of, size_t lights, uint32_t none) {
    const DI di;
    for (size_t k = 0; k + 1 < kTogether; k += kLanes) hn::StoreU(hn::Set(di, int32_t(none)), di, next() + lights + k);
    const size_t steps = (lights + kTogether - 1) / kTogether;
    for (size_t k = 0; k < steps; k += kLanes) hn::StoreU(hn::Set(di, int32_t(of)), di, vector + count + k);
    count += steps, listed += lights;
  }
};

/// The lights of a region: those with a window, with the blocks that each reaches, a bit for each lane of BlockBalls;
/// and all others.
struct RegionWindows {
  static constexpr size_t kMost = WindowSteps::kMostLights;
  HWY_ALIGN int32_t light[kMost + kBlockPixels], reached[kMost + kBlockPixels];
  const LightRow* other[kMost];
  size_t count = 0, others = 0;
  const uint32_t none;  ///< the index of the light that lights nothing

  explicit RegionWindows(uint32_t nothing) : none(nothing) {}

  HWY_INLINE void add(uint32_t window, uint32_t blocks) {
    light[count] = int32_t(window);
    reached[count++] = int32_t(blocks);
  }
  /// After the last.
  HWY_INLINE void end() { hn::StoreU(hn::Zero(DI()), DI(), reached + count); }

  /// Lists those that reach a lane's block as those of a vector.
  HWY_INLINE void list(size_t lane, size_t vector, WindowSteps& out) const {
    const DI di;
    int32_t* const to = out.next();
    size_t listed = 0;
    for (size_t i = 0; i < count; i += kLanes) {
      const auto mask = hn::TestBit(hn::Load(di, reached + i), hn::Set(di, 1 << lane));
      hn::StoreU(hn::Compress(hn::Load(di, light + i), mask), di, to + listed);
      listed += size_t(lane_count(di, mask));
    }
    out.end(vector, listed, none);
  }
  /// The same of those that light one of the pixels.
  HWY_INLINE void list(const LightTerms<WindowBlinn>& terms, const PixelVector& px, const WindowLight* lights,
                       size_t vector, WindowSteps& out) const {
    int32_t* const to = out.next();
    size_t listed = 0;
    for (size_t i = 0; i < count; ++i) {
      LightChain at;
      const WindowLight& of = lights[light[i]];
      terms.offset_to_light(px, of.position, at);
      terms.reach(px.covered, of.cut2, at);
      to[listed] = light[i];
      listed += hn::AllFalse(DF(), at.term.adds) ? 0u : 1u;
    }
    out.end(vector, listed, none);
  }
};

/// Whether a region's surfaces are no farther away than section 19 has them.
inline bool region_in_proof_range(const Region& r) {
  bool near = true;
  for (int c = 0; c < 3; ++c) near = near && r.position.low[c] >= -0x1p30f && r.position.high[c] <= 0x1p30f;
  return near;
}

/// Pixels whose numbers are in the ranges of section 19. Those that are none light nothing, or prove nothing.
HWY_INLINE MF window_pixels(const PixelVector& px, VF view2) {
  const DF d;
  const VF zero = hn::Zero(d);
  const VF most = hn::Max(hn::Max(px.albedo[0], px.albedo[1]), px.albedo[2]),
           least = hn::Min(hn::Min(px.albedo[0], px.albedo[1]), px.albedo[2]);
  MF holds = less_within(px.covered, view2, hn::Set(d, 1.0f + 0x1p-10f));
  holds = less_within(holds, dot3(px.n, px.n), hn::Set(d, 1.0f + 0x1p-20f));
  holds = hn::And(holds, hn::And(hn::Ge(least, zero), hn::Le(most, hn::Set(d, kMostProvenAlbedo))));
  for (int c = 0; c < 3; ++c)
    holds = hn::AndNot(hn::And(hn::Lt(hn::Abs(px.p[c]), hn::Set(d, 0x1p-40f)), hn::Ne(px.p[c], zero)), holds);
  return holds;
}

/// Sums of a vector of pixels over estimates of their terms.
template <class Root = EstimatedRoot>
struct WindowSum {
  VF p[3], n[3];               ///< of the pixels
  VF view4[3], half4, along2;  ///< 4 V, 4 (1 + V . V), 2 N . V
  MF covered, in_range;
  VF diffuse[3], shine[3];  ///< twice N . L, and powers: times falloffs and colours
  VF facing, least4;        ///< sum of twice N . L; the least 4 H . H
  hn::Vec<DI> lights;       ///< that light each pixel: exact

  /// Before any light.
  HWY_INLINE void begin(const PixelVector& px) {
    const DF d;
    covered = px.covered;
    const VF four = hn::Set(d, 4.0f), along = dot3(px.n, px.v), view2 = dot3(px.v, px.v);
    for (int c = 0; c < 3; ++c) {
      p[c] = px.p[c], n[c] = px.n[c];
      view4[c] = hn::Mul(four, px.v[c]);
      diffuse[c] = shine[c] = hn::Zero(d);
    }
    half4 = hn::Mul(four, hn::Add(hn::Set(d, 1.0f), view2));
    along2 = hn::Add(along, along);
    in_range = window_pixels(px, view2);
    facing = hn::Zero(d), least4 = hn::Set(d, 16.0f);
    lights = hn::Zero(DI());
  }

  /// The lights of a step.
  HWY_INLINE void add(const LightTerms<WindowBlinn>& terms, const WindowLight* all, const int32_t* step) {
    add(terms, all, step, std::make_index_sequence<WindowSteps::kTogether>());
  }

  /// What is stored where it is proved; base: the sum of other lights, which came first. `px`: the same pixels.
  HWY_INLINE VF value(const PixelVector& px, VF base, int c) const {
    const VF half = hn::Mul(px.albedo[c], hn::Set(DF(), 0.5f));
    return hn::Add(base, hn::Add(hn::Mul(half, diffuse[c]), hn::Mul(px.specular[c], shine[c])));
  }

  /// What |value - sum| is at most, for colours up to `most` and with some other lights.
  HWY_INLINE void bound(const PixelVector& px, const VF value[3], float most, size_t others, VF out[3]) const {
    const DF d;
    constexpr float u = kSlack * 0x1p-24f;
    const VF m = hn::ConvertTo(d, lights), bright = hn::Mul(m, hn::Set(d, most));
    const VF relative = hn::Mul(hn::Add(hn::Add(m, m), hn::Set(d, 10.0f + 2.0f * float(others))), hn::Set(d, u));
    const VF edge = hn::Mul(facing, hn::Set(d, 0.5f * kEdge * u * most));
    const VF power = hn::Mul(hn::Add(hn::Set(d, kPower), hn::Div(hn::Set(d, 4.0f * kSlant), least4)), hn::Set(d, u));
    const VF faint = hn::Mul(bright, hn::Add(hn::Set(d, kEdge * u), hn::Mul(power, hn::Set(d, kFaint))));
    for (int c = 0; c < 3; ++c)
      out[c] = hn::Add(hn::Add(hn::Mul(relative, value[c]), hn::Mul(px.albedo[c], edge)),
                       hn::Mul(px.specular[c], hn::Add(faint, hn::Mul(power, shine[c]))));
  }

  /// Pixels whose codes of 8 bits are those of `value` for certain.
  HWY_INLINE MF proved(const PixelVector& px, const VF value[3], float most, size_t others) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f), largest = hn::Set(d, 255.0f);
    VF off[3];
    bound(px, value, most, others, off);
    MF all = less_within(in_range, hn::Set(d, 4.0f * kLeastHalf2), least4);
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
  HWY_INLINE void add(const LightTerms<WindowBlinn>& terms, const WindowLight* all, const int32_t* step,
                      std::index_sequence<k...>) {
    Step at[WindowSteps::kTogether];
    ((at[k].light = all + step[k]), ...);
    (terms.offset_to_light(*this, at[k].light->position, at[k].chain), ...);
    (estimate(at[k]), ...);
    (refine(at[k]), ...);
    (reflect(at[k]), ...);
    (fall_off(at[k]), ...);
    ((at[k].power = integer_power<WindowBlinn::shape.power>(at[k].power)), ...);
    sum(at);
  }

  struct Step {
    const WindowLight* light;
    LightChain chain;
    MF lit;
    VF root, toward, half, power, falloff;
  };

  HWY_INLINE void estimate(Step& at) const {
    const DF d;
    at.lit = less_within(less_within(covered, at.chain.d2, hn::Set(d, at.light->cut2)), hn::Zero(d), at.chain.nl);
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
  // Each number is read and written once.
  HWY_INLINE void sum(const Step (&at)[WindowSteps::kTogether]) {
    const DF d;
    const DI di;
    VF all_facing = facing, least = least4, w[WindowSteps::kTogether], s[WindowSteps::kTogether];
    auto count = lights;
    for (size_t k = 0; k < WindowSteps::kTogether; ++k) {
      const MF lit = at[k].lit;
      w[k] = hn::IfThenElseZero(lit, hn::Mul(at[k].toward, at[k].falloff));
      s[k] = hn::IfThenElseZero(lit, hn::Mul(at[k].power, at[k].falloff));
      all_facing = hn::Add(all_facing, hn::IfThenElseZero(lit, at[k].toward));
      least = hn::IfThenElse(lit, hn::Min(at[k].half, least), least);
      count = hn::Add(count, hn::IfThenElseZero(hn::RebindMask(di, lit), hn::Set(di, 1)));
    }
    facing = all_facing, least4 = least, lights = count;
    for (int c = 0; c < 3; ++c) {
      VF all = diffuse[c], all_shine = shine[c];
      for (size_t k = 0; k < WindowSteps::kTogether; ++k) {
        const VF color = hn::Set(d, at[k].light->color[c]);
        all = hn::Add(all, hn::Mul(color, w[k]));
        all_shine = hn::Add(all_shine, hn::Mul(color, s[k]));
      }
      diffuse[c] = all, shine[c] = all_shine;
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
