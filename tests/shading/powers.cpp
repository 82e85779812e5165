// pow of the specular terms and cones, held to MPFR's value of 192 bits over every base and exponent that validation
// lets through; and the same bits on every SIMD target, of the kernels' powers themselves and of frames.
#include <mpfr.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/fp_env.h"
#include "shading/light/power.h"
#include "tests/catch.hpp"
#include "tests/shading/light_sheet.h"
#include "tests/shading/power_lanes.h"

using namespace trueshade;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity(), kLeast = 0x1p-149f, kMost = 0x1.fffffep127f;

/// x^p, right to 192 bits.
class RealPower {
 public:
  RealPower() { mpfr_inits2(192, x_, p_, real_, other_, nullptr); }
  ~RealPower() { mpfr_clears(x_, p_, real_, other_, nullptr); }
  RealPower(const RealPower&) = delete;
  RealPower& operator=(const RealPower&) = delete;

  void set(float x, double p) {
    mpfr_set_flt(x_, x, MPFR_RNDN);
    mpfr_set_d(p_, p, MPFR_RNDN);
    mpfr_pow(real_, x_, p_, MPFR_RNDN);
  }

  /// How far `computed` lies from it, in ulps of the float it lies in: of the least there is below 2^-126, of the
  /// largest from 2^127 on, where infinity counts as 2^128.
  double ulps_off(float computed) {
    if (mpfr_cmp_si_2exp(real_, 1, 128) >= 0) return computed == kInfinity ? 0.0 : HUGE_VAL;
    const long ulp = mpfr_zero_p(real_) ? -149 : std::clamp<long>(mpfr_get_exp(real_) - 24, -149, 104);
    if (computed == kInfinity)
      mpfr_set_ui_2exp(other_, 1, 128, MPFR_RNDN);
    else
      mpfr_set_flt(other_, computed, MPFR_RNDN);
    return distance(ulp);
  }

  /// The same of a double as a share of the real value.
  double share_off(double computed) {
    mpfr_set_d(other_, computed, MPFR_RNDN);
    mpfr_sub(other_, other_, real_, MPFR_RNDN);
    mpfr_div(other_, other_, real_, MPFR_RNDN);
    return std::fabs(mpfr_get_d(other_, MPFR_RNDN));
  }

 private:
  double distance(long exponent) {
    mpfr_sub(other_, other_, real_, MPFR_RNDN);
    mpfr_mul_2si(other_, other_, -exponent, MPFR_RNDN);
    return std::fabs(mpfr_get_d(other_, MPFR_RNDU));
  }

  mpfr_t x_, p_, real_, other_;
};

/// The largest error of some powers, and where.
struct WorstPower {
  double ulps = 0, share = 0, p = 0;
  float x = 0, computed = 0;
  void see(double error, float base, double exponent, float found) {
    if (error <= ulps) return;
    ulps = error, x = base, p = exponent, computed = found;
  }
};

/// The base of a number of bits between 0 and infinity, in some pattern: over all floats, over [2^-40, 1], crowded
/// against 1 from both sides, denormal, or about 2^k and 2^k sqrt(1/2), where log2 is taken apart.
float base_of(Random& random, uint64_t i) {
  switch (i % 6) {
    case 0:
      return std::bit_cast<float>(uint32_t(1 + random() % 0x7F7FFFFF));
    case 1:
      return std::bit_cast<float>(uint32_t(0x2B800000 + random() % (0x3F800001 - 0x2B800000)));
    case 2:
      return std::bit_cast<float>(uint32_t(0x3F800000 - random() % (uint64_t(1) << (1 + i / 6 % 24))));
    case 3:
      return std::bit_cast<float>(uint32_t(0x3F800000 + random() % (uint64_t(1) << (1 + i / 6 % 24))));
    case 4:
      return std::bit_cast<float>(uint32_t(1 + random() % (uint64_t(1) << (1 + i / 6 % 23))));
    default: {
      const float at = std::ldexp(random() % 2 ? 1.0f : 0.70710678f, int(random() % 252) - 125);
      return std::bit_cast<float>(std::bit_cast<uint32_t>(at) + uint32_t(random() % 65) - 32);
    }
  }
}

/// An exponent under which x^p is a float: its logarithm between -150 and 128, ends and halves of ulps among them.
double telling_exponent(Random& random, float x) {
  const double log = std::log2(double(x));
  constexpr double kEdges[] = {-150, -149.5, -149, -148.5, -126, -125.99999, 127.9999999, 128, -1, 1, -24, 0.5};
  const double t = random() % 3 == 0 ? kEdges[random() % std::size(kEdges)] : float_between(random, -151, 129);
  return std::fabs(log) > 0 ? std::clamp(std::fabs(t / log), 0.0, 1e18) : 1e18;
}

/// Every exponent a scene or a pipeline may hold is a float from 0 to 1e18; these are real ones.
constexpr double kExponents[] = {1e-38,  1e-7,   0.01,   0.25,   1 / 2.4, 0.5,   0.75, 1.5,    2.5, 2.75, 7.5, 33.3,
                                 127.01, 333.25, 1000.5, 8191.5, 8193,    65537, 1e5,  1.7e7f, 1e9, 1e12, 1e18};

WorstPower worst_real_powers(uint64_t count, uint64_t seed) {
  Random random(seed);
  RealPower real;
  WorstPower worst;
  for (uint64_t i = 0; i < count; ++i) {
    const float x = base_of(random, i);
    const double p =
        i % 2 == 0 ? kExponents[i / 2 % std::size(kExponents)] : double(float(telling_exponent(random, x)));
    real.set(x, p);
    const double computed = power(double(x), p);
    const auto rounded = float(computed);
    worst.see(real.ulps_off(rounded), x, p, rounded);
    if (rounded >= 0x1p-126f && rounded <= kMost) worst.share = std::max(worst.share, real.share_off(computed));
  }
  return worst;
}

/// Of integer exponents, as a vector of one exponent computes them.
WorstPower worst_integer_powers(int bases, uint64_t seed) {
  constexpr int kStep = 16;
  Random random(seed);
  RealPower real;
  WorstPower worst;
  std::vector<float> x(kStep), out(kStep);
  for (int p = 0; p <= 8192; ++p)
    for (int from = 0; from < bases; from += kStep) {
      for (int i = 0; i < kStep; ++i) {
        x[size_t(i)] = base_of(random, random());
        // Most powers of most floats are 0 or infinite: every other base has one between.
        if (i % 2 == 0 && p > 1) x[size_t(i)] = float(std::exp2(float_between(random, -150, 128) / double(p)));
      }
      testing::raise(x, float(p), false, out);
      for (size_t i = 0; i < x.size(); ++i) {
        real.set(x[i], p);
        worst.see(real.ulps_off(out[i]), x[i], p, out[i]);
      }
    }
  return worst;
}

/// Half an ulp is the one rounding to float; the rest is what the double may be off.
constexpr double kAtMost = 0.5 + 0x1p-15;

}  // namespace

TEST_CASE("pow of real exponents is within 0.50004 ulp of MPFR's over all positive floats and exponents",
          "[pow][slow]") {
  const FpScope fp;
  const WorstPower worst = worst_real_powers(600000, 62);
  CAPTURE(worst.ulps, worst.x, worst.p, worst.computed, std::log2(worst.share));
  CHECK(worst.ulps <= kAtMost);
  CHECK(worst.ulps > 0.49);
  CHECK(worst.share <= 0x1p-43);
}

TEST_CASE("pow of real exponents at 12 million bases and exponents", "[pow][long]") {
  const FpScope fp;
  const WorstPower worst = worst_real_powers(12000000, 65);
  CAPTURE(worst.ulps, worst.x, worst.p, worst.computed, std::log2(worst.share));
  WARN("largest error " << worst.ulps << " ulp, of the double 2^" << std::log2(worst.share));
  CHECK(worst.ulps <= kAtMost);
  CHECK(worst.share <= 0x1p-43);
}

TEST_CASE("binary powering is within 0.50004 ulp of MPFR's for every integer exponent up to 8192", "[pow]") {
  const FpScope fp;
  const WorstPower worst = worst_integer_powers(48, 63);
  CAPTURE(worst.ulps, worst.x, worst.p, worst.computed);
  CHECK(worst.ulps <= kAtMost);
  CHECK(worst.ulps > 0.49);
}

TEST_CASE("binary powering of 1,024 bases by every integer exponent", "[pow][long]") {
  const FpScope fp;
  const WorstPower worst = worst_integer_powers(1024, 66);
  CAPTURE(worst.ulps, worst.x, worst.p, worst.computed);
  WARN("largest error " << worst.ulps << " ulp");
  CHECK(worst.ulps <= kAtMost);
}

TEST_CASE("pow at the ends: of 0, 1 and infinity, by 0, and where a square or a root is exact", "[pow]") {
  const FpScope fp;
  for (const double p : kExponents) {
    CHECK(power(0.0, p) == 0.0);
    CHECK(power(1.0, p) == 1.0);
    CHECK(power(double(kInfinity), p) == double(kInfinity));
    CHECK(float(power(double(kLeast), p)) >= 0.0f);
  }
  for (int k = -74; k < 64; ++k) {
    CHECK(float(power(std::ldexp(1.0, 2 * k), 0.5)) == std::ldexp(1.0f, k));
    CHECK(float(power(std::ldexp(9.0, 2 * k), 0.5)) == std::ldexp(3.0f, k));
  }
  std::vector<float> x(16, 0.0f), out(16);
  x[1] = 1.0f, x[2] = kInfinity, x[3] = kLeast, x[4] = kMost;
  for (const std::string_view simd : simd_targets()) {
    const SimdScope scope(simd);
    testing::raise(x, 0.0f, false, out);
    for (const float one : out) CHECK(one == 1.0f);
    testing::raise(x, 8192.0f, false, out);
    CHECK(std::vector<float>(out.begin(), out.begin() + 5) == std::vector<float>{0, 1, kInfinity, 0, kInfinity});
  }
}

TEST_CASE("the kernels' powers have one set of bits on every SIMD target, of whatever lanes", "[pow]") {
  const FpScope fp;
  Random random(67);
  constexpr size_t kCount = 4096;
  std::vector<float> x(kCount), exponents(kCount), expected(kCount), out(kCount);
  const auto as_bits = [](float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); };
  for (const float p : {0.0f, 1.0f, 2.0f, 3.0f, 16.0f, 30.0f, 32.0f, 60.0f, 127.0f, 4095.0f, 8192.0f, 0.5f, 2.75f,
                        1000.25f, 8193.0f, 1e9f, 1e18f}) {
    for (size_t i = 0; i < kCount; ++i) x[i] = base_of(random, i);
    for (size_t i = 0; i < kCount; ++i) {  // docs/arithmetic.md section 9, once more
      const Exponent e = exponent_of(p);
      double result = 1.0;
      for (int bit = 8192; bit > 0; bit /= 2) {
        result = result * result;
        if ((e.integer & bit) != 0) result = result * double(x[i]);
      }
      expected[i] = e.integer >= 0 ? float(result) : float(power(double(x[i]), double(p)));
    }
    for (const std::string_view simd : simd_targets()) {
      INFO(simd << ", " << p);
      const SimdScope scope(simd);
      testing::raise(x, p, false, out);
      CHECK(std::equal(out.begin(), out.end(), expected.begin(), as_bits));
      if (p == 16 || p == 30 || p == 32) {
        testing::raise(x, p, true, out);
        CHECK(std::equal(out.begin(), out.end(), expected.begin(), as_bits));
      }
      if (exponent_of(p).integer < 0) continue;
      // The same among lanes of other exponents.
      for (size_t i = 0; i < kCount; ++i) exponents[i] = i % 3 == 0 ? p : float(random() % 8193);
      testing::raise(x, exponents, out);
      size_t wrong = 0;
      for (size_t i = 0; i < kCount; i += 3) wrong += as_bits(out[i], expected[i]) ? 0 : 1;
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("specular powers have one set of bits on every SIMD target, integers by one powering a lane too") {
  Random random(64);
  Scene scene = sheet(random);
  for (int i = 0; i < 8; ++i) scene.lights.push_back(random_light(random));
  for (const float shininess :
       {0.0f, 1.0f, 2.0f, 3.0f, 31.0f, 32.0f, 60.0f, 127.0f, 4095.0f, 8192.0f, 0.5f, 1000.25f}) {
    Pipeline pipeline = loop_pipeline("many-lights");
    pipeline.light_model.shininess = shininess;
    Execution scalar;
    scalar.simd = "scalar";
    const Image expected = render(scene, pipeline, scalar).frame.color;
    for (const std::string_view simd : simd_targets()) {
      Execution execution;
      execution.simd = simd;
      INFO(simd << ", " << shininess);
      CHECK(render(scene, pipeline, execution).frame.color.texels == expected.texels);
      if (shininess != std::floor(shininess)) continue;
      // The same numbers from the plane of the surfaces.
      Pipeline own = pipeline;
      own.light_model.specular_source = SpecularSource::material;
      Scene same = scene;
      same.materials[0].shininess = shininess;
      same.materials[0].specular_color = pipeline.light_model.specular_color;
      CHECK(render(same, own, execution).frame.color.texels == expected.texels);
    }
  }
}
