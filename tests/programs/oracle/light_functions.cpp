// The oracle's functions of light programs, held to MPFR's value of 128 bits.
#include "oracle/light_functions.h"

#include <mpfr.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "tests/catch.hpp"

using namespace trueshade::oracle;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

float float_of(uint32_t bits) { return std::bit_cast<float>(bits); }
uint32_t bits_of(float x) { return std::bit_cast<uint32_t>(x); }

/// Numbers of MPFR for one function's arguments and value.
class Reals {
 public:
  Reals() { mpfr_inits2(128, x, y, value, nullptr); }
  ~Reals() { mpfr_clears(x, y, value, nullptr); }
  Reals(const Reals&) = delete;
  Reals& operator=(const Reals&) = delete;

  /// How far `computed` lies from `value`, in ulps of the float it lies in: of the least there is below 2^-126, of the
  /// largest from 2^127 on, where infinity counts as 2^128. A wrong NaN, infinity or sign of zero is infinitely far.
  double ulps_off(float computed) {
    if (mpfr_nan_p(value)) return std::isnan(computed) ? 0 : HUGE_VAL;
    if (std::isnan(computed)) return HUGE_VAL;
    if (mpfr_zero_p(value)) return computed == 0 && std::signbit(computed) == (mpfr_signbit(value) != 0) ? 0 : HUGE_VAL;
    const float most = mpfr_sgn(value) > 0 ? kInf : -kInf;
    if (mpfr_inf_p(value) || mpfr_get_exp(value) > 128) return computed == most ? 0 : HUGE_VAL;
    const long ulp = std::clamp<long>(mpfr_get_exp(value) - 24, -149, 104);
    if (std::isinf(computed))
      mpfr_set_si_2exp(x, computed > 0 ? 1 : -1, 128, MPFR_RNDN);
    else
      mpfr_set_flt(x, computed, MPFR_RNDN);
    mpfr_sub(x, x, value, MPFR_RNDN);
    mpfr_mul_2si(x, x, -ulp, MPFR_RNDN);
    return std::fabs(mpfr_get_d(x, MPFR_RNDU));
  }

  mpfr_t x, y, value;
};

struct Worst {
  double ulps = 0;
  float x = 0, y = 0, computed = 0;
  uint64_t seen = 0;
  void see(double error, float at_x, float at_y, float found) {
    ++seen;
    if (error > ulps) ulps = error, x = at_x, y = at_y, computed = found;
  }
};

struct OfOne {
  const char* name;
  float (*ours)(float);
  int (*real)(mpfr_t, const mpfr_t, mpfr_rnd_t);
  float most;  ///< |x| beyond which it is NaN by our definition
};

constexpr OfOne kOfOne[] = {
    {"log2", glsl::log2, mpfr_log2, kInf},    {"log", glsl::log, mpfr_log, kInf},
    {"exp2", glsl::exp2, mpfr_exp2, kInf},    {"exp", glsl::exp, mpfr_exp, kInf},
    {"sin", glsl::sin, mpfr_sin, 1e6f},       {"cos", glsl::cos, mpfr_cos, 1e6f},
    {"tan", glsl::tan, mpfr_tan, 1e6f},       {"asin", glsl::asin, mpfr_asin, kInf},
    {"acos", glsl::acos, mpfr_acos, kInf},    {"atan", glsl::atan, mpfr_atan, kInf},
    {"sinh", glsl::sinh, mpfr_sinh, kInf},    {"cosh", glsl::cosh, mpfr_cosh, kInf},
    {"tanh", glsl::tanh, mpfr_tanh, kInf},    {"asinh", glsl::asinh, mpfr_asinh, kInf},
    {"acosh", glsl::acosh, mpfr_acosh, kInf}, {"atanh", glsl::atanh, mpfr_atanh, kInf},
};

/// Floats where a formula changes or loses digits, each with its neighbours: `around` on either side, both signs.
std::vector<float> edges(uint32_t around) {
  std::vector<float> centres = {0x1p-126f, 0x1p-28f,    0x1p-12f,  0x1p-10f,    0x1p-8f,        0x1p-4f, 0.25f,
                                0.5f,      0.70710678f, 1.0f,      1.41421356f, 2.0f,           20.0f,   64.0f,
                                87.33654f, 88.72284f,   89.41599f, 103.97208f,  126.0f,         127.0f,  128.0f,
                                149.0f,    150.0f,      1e6f,      0x1p24f,     0x1.fffffep127f};
  // Multiples of pi/4, where sines and tangents come near to 0, 1 and infinity, up to 10^6.
  for (uint32_t n = 1; n < 1273239; n += n < 64 ? 1 : n / 7) centres.push_back(float(n * 0.7853981633974483));
  std::vector<float> all;
  for (const float centre : centres)
    for (uint32_t bits = bits_of(centre) - around; bits <= bits_of(centre) + around; ++bits)
      all.push_back(float_of(bits)), all.push_back(-float_of(bits));
  for (uint32_t bits = 0; bits <= around; ++bits) all.push_back(float_of(bits)), all.push_back(-float_of(bits));
  return all;
}

/// The floats up to 10^6 that lie nearest to multiples of pi/2 for their size: where a reduced angle has the fewest
/// right digits. Found among all floats from 1 on whose distance from a multiple is below 2^-20 of an ulp.
void see_one(const OfOne& function, float x, Reals& reals, Worst& worst) {
  if (std::fabs(x) > function.most) return;
  const float computed = function.ours(x);
  mpfr_set_flt(reals.x, x, MPFR_RNDN);
  function.real(reals.value, reals.x, MPFR_RNDN);
  worst.see(reals.ulps_off(computed), x, 0, computed);
}

Worst worst_of(const OfOne& function, uint32_t stride, uint32_t around) {
  Reals reals;
  Worst worst;
  for (uint64_t bits = 0; bits <= 0xFFFFFFFF; bits += stride) see_one(function, float_of(uint32_t(bits)), reals, worst);
  for (const float x : edges(around)) see_one(function, x, reals, worst);
  for (const float x : {kInf, -kInf, std::numeric_limits<float>::quiet_NaN()}) see_one(function, x, reals, worst);
  return worst;
}

void print(const char* name, const Worst& worst) {
  std::printf("%-6s %.6f ulp at %a %a, %llu values\n", name, worst.ulps, double(worst.x), double(worst.y),
              static_cast<unsigned long long>(worst.seen));
}

}  // namespace

TEST_CASE("functions of light programs at a stride", "[long]") {
  for (const OfOne& function : kOfOne) print(function.name, worst_of(function, 4099, 300));
}
