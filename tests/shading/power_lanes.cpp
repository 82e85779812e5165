#include "tests/shading/power_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/shading/power_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shading/light/power-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <int kPower>
void raise_all(const float* x, size_t count, const Exponent& exponent, float* out) {
  const DF d;
  for (size_t i = 0; i < count; i += hn::Lanes(d))
    hn::StoreU(rounded_power<kPower>(hn::LoadU(d, x + i), exponent), d, out + i);
}

void raise_alike(const float* x, size_t count, float p, bool compiled, float* out) {
  const Exponent exponent = exponent_of(p);
  if (!compiled) return raise_all<-1>(x, count, exponent, out);
  if (p == 16) return raise_all<16>(x, count, exponent, out);
  if (p == 30) return raise_all<30>(x, count, exponent, out);
  raise_all<32>(x, count, exponent, out);
}

void raise_apart(const float* x, const float* p, size_t count, float* out) {
  const DF d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const VF zero = hn::Zero(d);
    const SurfaceExponents exponents = surface_exponents(hn::LoadU(d, p + i), hn::Eq(zero, zero), PowerBase::cosine);
    hn::StoreU(rounded_power(hn::LoadU(d, x + i), exponents), d, out + i);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(raise_alike);
HWY_EXPORT(raise_apart);

namespace testing {

void raise(std::span<const float> x, float exponent, bool compiled, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(raise_alike)(x.data(), x.size(), exponent, compiled, out.data());
}

void raise(std::span<const float> x, std::span<const float> exponents, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(raise_apart)(x.data(), exponents.data(), x.size(), out.data());
}

}  // namespace testing
}  // namespace trueshade
#endif  // HWY_ONCE
