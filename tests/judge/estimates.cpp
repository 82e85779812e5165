// sRGB codes that llvmpipe makes of the CPU's estimate of 1/sqrt: what each maker's CPUs draw is a legal image, and the
// judge says whose it is.
#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

#include <bit>
#include <cmath>
#include <cstring>

#include "judge/legal/intel_srgb.h"
#include "judge/stages/validate.h"
#include "tests/catch.hpp"
#include "tests/judge/loose_renderer.h"
#include "tests/judge/random_scene.h"

using namespace trueshade;
using namespace trueshade::oracle;

TEST_CASE("sRGB codes by the estimates of AMD's and of Intel's CPUs are told apart, and neither is convicted") {
  for (const bool intel : {false, true}) {
    Pcg32 random(11);
    const Scene scene = testing::random_scene(random);
    Pipeline pipeline = testing::random_pipeline(random);
    pipeline.width = 320, pipeline.height = 240;
    pipeline.target = Format::srgb8_a8;
    pipeline.strategy = Strategy::deferred_loop;
    testing::Liberties liberties;
    liberties.mesa_codes = true, liberties.intel_estimates = intel;
    const Capture capture = testing::loose_frame(scene, pipeline, liberties, 5);
    Profile unknown;
    unknown.subpixel_bits = 8;
    const Verdict v = validate_capture(scene, pipeline, capture, {unknown, false, {}, {}});
    INFO(v.evidence_line());
    CHECK(v.violations() == 0);
    CHECK_FALSE(v.convicted());
    CHECK(v.evidence.back().rule.mesa_codes);
    CHECK(v.evidence.back().rule.intel_estimates == intel);
  }
}

#if defined(__x86_64__)
namespace {

bool is_intel() {
  unsigned a = 0, name[3] = {};
  __get_cpuid(0, &a, &name[0], &name[2], &name[1]);
  return std::memcmp(name, "GenuineIntel", sizeof name) == 0;
}

float estimate(float x) { return _mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(x))); }

/// Mesa 22.3, lp_bld_format_srgb.c.
int code_here(float x) {
  if (x <= 0.0031308f) return int(std::nearbyint(x * (12.92f * 255.0f)));
  const float root = x * estimate(x), power = estimate(estimate(root * x));
  const auto a = float(0.675f * 1.0622 * 255.0f), b = float(0.325f * 1.0622 * 255.0f);
  return int(std::nearbyint(a * power + std::fma(b, root, -0.0620f * 255.0f)));
}

}  // namespace

TEST_CASE("The steps of sRGB on Intel's CPUs are those of the instruction") {
  if (!is_intel()) return;
  int code = 0;
  size_t other = 0;
  for (const uint32_t step : kIntelSrgbSteps) {
    const uint32_t bits = step & 0x7FFFFFFFu;
    other += code_here(std::bit_cast<float>(bits - 1)) != code;
    code += (step >> 31) != 0 ? -1 : 1;
    other += code_here(std::bit_cast<float>(bits)) != code;
  }
  CHECK(code == 255);
  CHECK(other == 0);
}
#endif
