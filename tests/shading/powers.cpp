// pow of the specular terms and cones: within 1 ulp of the real power over the whole domain used, the same bits on
// every SIMD target. The reference is long double's powl, good to an ulp of 2^-63: 2^-39 of a float's ulp.
#include <bit>
#include <cmath>
#include <cstring>

#include "shading/power.h"
#include "tests/catch.hpp"
#include "tests/shading/light_sheet.h"

using namespace trueshade;

namespace {

/// How far `computed` lies from x^p, in ulps of the float next to it; denormals count in their own spacing.
double ulps_off(float computed, float x, double p) {
  const long double real = std::pow(static_cast<long double>(x), static_cast<long double>(p));
  const float near = float(real);
  const float next = std::nextafter(near, std::numeric_limits<float>::infinity());
  return double(std::fabs(static_cast<long double>(computed) - real) / (static_cast<long double>(next) - near));
}

float integer_power(float x, int p) {
  double y = double(x), result = 1.0;
  for (int bit = 8192; bit > 0; bit /= 2) {
    result = result * result;
    if ((p & bit) != 0) result = result * y;
  }
  return float(result);
}

}  // namespace

TEST_CASE("pow of real exponents is within 1 ulp over [0, 1], densely") {
  Random random(62);
  double worst = 0;
  for (const double p : {0.01, 0.25, 0.5, 0.75, 1.5, 2.75, 7.5, 33.3, 127.01, 333.25, 1000.5, 8191.5, 1e5, 1e9})
    for (uint32_t i = 0; i < 60000; ++i) {
      // Half evenly spaced bit patterns of [2^-40, 1], half crowded against 1, where large exponents live.
      const uint32_t one = 0x3F800000u, low = one - (40u << 23);
      const uint32_t bits = i % 2 == 0 ? low + uint32_t(uint64_t(one - low) * i / 60000)
                                       : one - uint32_t(random() % (1u << (1 + i % 23)));
      const float x = std::bit_cast<float>(bits);
      const float computed = float(power(double(x), p));
      if (computed == 0 && std::pow(static_cast<long double>(x), static_cast<long double>(p)) < 0x1p-140L) continue;
      worst = std::max(worst, ulps_off(computed, x, p));
    }
  CAPTURE(worst);
  CHECK(worst <= 1.0);
  CHECK(power(0.0, 2.5) == 0.0);
  CHECK(power(1.0, 333.25) == 1.0);
}

TEST_CASE("binary powering in double is within 1 ulp for every integer exponent up to 8192") {
  Random random(63);
  double worst = 0;
  for (int p = 1; p <= 8192; ++p)
    for (int i = 0; i < 40; ++i) {
      const float x =
          i % 2 == 0 ? between(random, 0, 1) : 1.0f - std::ldexp(between(random, 0, 1), -int(random() % 20));
      const float computed = integer_power(x, p);
      if (!(computed > 0)) continue;
      worst = std::max(worst, ulps_off(computed, x, p));
    }
  CAPTURE(worst);
  CHECK(worst <= 1.0);
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
