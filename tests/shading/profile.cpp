// The profile of a pipeline: what it changes in a frame, and that nothing else does.
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "core/blend_state.h"
#include "core/simd/simd_target.h"
#include "raster/visibility/coverage_count.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

constexpr NumericProfile kMesaProfile = NumericProfile::mesa_llvmpipe_22_3;

/// 256 squares of 16 x 16 pixels, square k of albedo k / 255.
Scene ramp() {
  std::vector<Corners> triangles;
  for (int k = 0; k < 256; ++k) {
    const double x = 16.0 * (k % 16), y = 16.0 * (k / 16);
    const float c = float(k) / 255.0f;
    const Corner corner[4] = {{x, y, 0, 1, {}, {c, c, c, c}},
                              {x + 16, y, 0, 1, {}, {c, c, c, c}},
                              {x + 16, y + 16, 0, 1, {}, {c, c, c, c}},
                              {x, y + 16, 0, 1, {}, {c, c, c, c}}};
    triangles.push_back({corner[0], corner[1], corner[2]});
    triangles.push_back({corner[0], corner[2], corner[3]});
  }
  return window_scene(triangles);
}

/// An ambient light alone, so that the target holds the albedo as the light pass fetched it.
std::vector<float> fetched(NumericProfile profile, const Execution& execution) {
  Scene scene = ramp();
  Light light;
  light.type = LightType::ambient;
  light.color = {1, 1, 1};
  scene.lights = {light};
  Pipeline pipeline = window_pipeline();
  pipeline.gbuffer.albedo.format = Format::rgba8;
  pipeline.target = Format::rgba32f;
  pipeline.profile = profile;
  const Frame frame = render_frame(scene, pipeline, execution);
  std::vector<float> values(256);
  for (int k = 0; k < 256; ++k)
    std::memcpy(&values[size_t(k)], frame.color.texel(16 * (k % 16) + 8, kWindow - 1 - (16 * (k / 16) + 8)), 4);
  return values;
}

}  // namespace

TEST_CASE(
    "Row 38 in a frame: of the 256 codes of an rgba8 albedo the light pass reads 126 otherwise under llvmpipe's "
    "profile") {
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const std::vector<float> ideal = fetched(NumericProfile::ideal, execution), mesa = fetched(kMesaProfile, execution);
    int different = 0;
    for (size_t k = 0; k < 256; ++k) {
      CHECK(ideal[k] == float(double(k) / 255.0));
      CHECK(mesa[k] == float(k) * (1.0f / 255.0f));
      different += ideal[k] != mesa[k] ? 1 : 0;
    }
    CHECK(std::bit_cast<uint32_t>(mesa[3]) == 0x3C40C0C2);
    CHECK(different == 126);
  }
}

TEST_CASE("Without an 8-bit plane and where float32 snaps alike, the profiles draw the same bytes") {
  Pipeline pipeline = window_pipeline();
  const std::vector<Corners> triangles = {{{{10.25, 10.5}, {200.75, 20.125}, {30.5, 220}}}};
  const Planes ideal = drawn(window_scene(triangles), pipeline, {});
  pipeline.profile = kMesaProfile;
  CHECK(drawn(window_scene(triangles), pipeline, {}) == ideal);
}

TEST_CASE("The profile's snapping is float32's with one fused multiply-add, on every SIMD target and tile size") {
  std::mt19937_64 random(38);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (double(random() >> 11) * 0x1p-53); };
  std::vector<ClipTriangle> triangles(500);
  for (ClipTriangle& t : triangles)
    for (auto& v : t.vertex) {
      const double w = uniform(0.5, 40);
      v[0] = float(uniform(-0.999, 0.999) * w);
      v[1] = float(uniform(-0.999, 0.999) * w);
      v[2] = 0;
      v[3] = float(w);
    }
  std::vector<uint16_t> first;
  for (const Execution& execution : executions()) {
    std::vector<uint16_t> counts(800 * 600);
    count_coverage(triangles, {}, 800, 600, execution, counts, kMesaProfile);
    if (first.empty()) first = counts;
    INFO(named(execution));
    CHECK(counts == first);
  }
  std::vector<uint16_t> ideal(800 * 600);
  count_coverage(triangles, {}, 800, 600, {}, ideal, NumericProfile::ideal);
  CHECK(ideal != first);
}

TEST_CASE("Factors, equations and profiles are spelled as the enumerators") {
  CHECK(kBlendFactorNames[size_t(BlendFactor::one_minus_constant_alpha)] == "one_minus_constant_alpha");
  CHECK(kBlendFactorNames[size_t(BlendFactor::src_alpha_saturate)] == "src_alpha_saturate");
  CHECK(kBlendFactorNames[size_t(BlendFactor::dst_color)] == "dst_color");
  CHECK(kBlendEquationNames[size_t(BlendEquation::reverse_subtract)] == "reverse_subtract");
  CHECK(kBlendEquationNames[size_t(BlendEquation::max)] == "max");
  for (const NumericProfile profile : {NumericProfile::ideal, kMesaProfile})
    CHECK(profile_from_name(profile_name(profile)) == profile);
  CHECK(profile_name(kMesaProfile) == "mesa-llvmpipe-22.3");
  CHECK(!profile_from_name("mesa"));
}
