// Loops of one operation over the lanes of a batch. Included once per SIMD target.
#if defined(TRUESHADE_PROGRAMS_RUN_LANE_LOOPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_PROGRAMS_RUN_LANE_LOOPS_INL_H_
#undef TRUESHADE_PROGRAMS_RUN_LANE_LOOPS_INL_H_
#else
#define TRUESHADE_PROGRAMS_RUN_LANE_LOOPS_INL_H_
#endif

#include <hwy/highway.h>

#include "programs/run/code.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::programs::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using DU = hn::RebindToUnsigned<DF>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;

/// An operand that has a register.
struct FromLanes {
  const float* lanes;
  HWY_INLINE VF operator()(size_t block, size_t lane) const {
    return hn::Load(DF(), lanes + block * kBlockLanes + lane);
  }
};
/// An operand that lies in a plane, each block where it is there.
struct FromPlane {
  const float* plane;
  const uint32_t* first;
  HWY_INLINE VF operator()(size_t block, size_t lane) const { return hn::Load(DF(), plane + first[block] + lane); }
};
/// An operand that has one value a light.
struct FromLight {
  const float* value;
  const uint32_t* light;
  HWY_INLINE VF operator()(size_t block, size_t) const { return hn::Set(DF(), value[light[block]]); }
};
struct FromConstant {
  const float* value;
  HWY_INLINE VF operator()(size_t, size_t) const { return hn::Set(DF(), *value); }
};

HWY_INLINE float* register_of(const CodeView& view, uint32_t slot) { return view.registers + slot * kBatchLanes; }
HWY_INLINE FromLanes lanes_of(const CodeView& view, Source source) { return {register_of(view, source.slot)}; }
HWY_INLINE FromPlane plane_of(const CodeView& view, Source source) {
  return {view.planes[source.slot], view.plane_lane};
}
HWY_INLINE FromLight light_of(const CodeView& view, Source source) { return {view.lights[source.slot], view.light}; }
HWY_INLINE FromConstant constant_of(const CodeView& view, Source source) { return {view.constants + source.slot}; }

// Two blocks a turn, which is worth 10 to 15 % of a program; of a vector of one lane no more than four lanes.
template <class F, class A>
HWY_INLINE void each_1(F f, A a, const CodeView& view, float* to) {
  const size_t blocks = view.blocks;
#pragma GCC unroll 2
  for (size_t block = 0; block < blocks; ++block)
#pragma GCC unroll 4
    for (size_t lane = 0; lane < kBlockLanes; lane += hn::Lanes(DF()))
      hn::Store(f(a(block, lane)), DF(), to + block * kBlockLanes + lane);
}
template <class F, class A, class B>
HWY_INLINE void each_2(F f, A a, B b, const CodeView& view, float* to) {
  const size_t blocks = view.blocks;
#pragma GCC unroll 2
  for (size_t block = 0; block < blocks; ++block)
#pragma GCC unroll 4
    for (size_t lane = 0; lane < kBlockLanes; lane += hn::Lanes(DF()))
      hn::Store(f(a(block, lane), b(block, lane)), DF(), to + block * kBlockLanes + lane);
}
template <class F, class A, class B, class C>
HWY_INLINE void each_3(F f, A a, B b, C c, const CodeView& view, float* to) {
  const size_t blocks = view.blocks;
#pragma GCC unroll 2
  for (size_t block = 0; block < blocks; ++block)
#pragma GCC unroll 4
    for (size_t lane = 0; lane < kBlockLanes; lane += hn::Lanes(DF()))
      hn::Store(f(a(block, lane), b(block, lane), c(block, lane)), DF(), to + block * kBlockLanes + lane);
}

/// An operation of two operands, one of them in a register or both in a plane and beside it.
template <class F, class A>
HWY_INLINE void second_of(F f, A a, const CodeView& view, const Instruction& one, float* to) {
  const Source source = one.from[1];
  switch (source.place) {
    case Place::lanes:
      return each_2(f, a, lanes_of(view, source), view, to);
    case Place::plane:
      return each_2(f, a, plane_of(view, source), view, to);
    case Place::light:
      return each_2(f, a, light_of(view, source), view, to);
    case Place::constant:
      return each_2(f, a, constant_of(view, source), view, to);
  }
}
template <class F>
HWY_NOINLINE void any_2(F f, const CodeView& view, const Instruction& one) {
  float* const to = register_of(view, one.to);
  const Source source = one.from[0];
  switch (source.place) {
    case Place::lanes:
      return second_of(f, lanes_of(view, source), view, one, to);
    case Place::plane:
      return second_of(f, plane_of(view, source), view, one, to);
    case Place::light:
      return second_of(f, light_of(view, source), view, one, to);
    case Place::constant:
      return second_of(f, constant_of(view, source), view, one, to);
  }
}

/// A product and a third operand.
template <class F, class A>
HWY_INLINE void factor_of(F f, A a, const CodeView& view, const Instruction& one) {
  const Source source = one.from[1];
  const FromLanes c = lanes_of(view, one.from[2]);
  float* const to = register_of(view, one.to);
  switch (source.place) {
    case Place::lanes:
      return each_3(f, a, lanes_of(view, source), c, view, to);
    case Place::plane:
      return each_3(f, a, plane_of(view, source), c, view, to);
    case Place::light:
      return each_3(f, a, light_of(view, source), c, view, to);
    case Place::constant:
      return each_3(f, a, constant_of(view, source), c, view, to);
  }
}
template <class F>
HWY_NOINLINE void product(F f, const CodeView& view, const Instruction& one) {
  if (one.from[0].place == Place::lanes) return factor_of(f, lanes_of(view, one.from[0]), view, one);
  factor_of(f, plane_of(view, one.from[0]), view, one);
}

/// Operations whose operands all have registers.
template <class F>
HWY_NOINLINE void lanes_1(F f, const CodeView& view, const Instruction& one) {
  each_1(f, lanes_of(view, one.from[0]), view, register_of(view, one.to));
}
template <class F>
HWY_NOINLINE void lanes_2(F f, const CodeView& view, const Instruction& one) {
  each_2(f, lanes_of(view, one.from[0]), lanes_of(view, one.from[1]), view, register_of(view, one.to));
}

}  // namespace trueshade::programs::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
