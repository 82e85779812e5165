// docs/gl_rules.md section 8, rows 52 to 54, and what lossless culling must survive: lights that touch, are out of
// range or hold no numbers, and any number of them.
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>

#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/shading/light_sheet.h"

using namespace trueshade;

namespace {

/// A white square at z = 0 that faces the viewer, seen along -z by a camera at infinity's axis.
Scene flat_square() {
  Scene scene;
  Mesh mesh;
  const float corners[4][2] = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
  for (const auto& c : corners) {
    mesh.position[0].push_back(c[0]), mesh.position[1].push_back(c[1]), mesh.position[2].push_back(0);
    mesh.normal[0].push_back(0), mesh.normal[1].push_back(0), mesh.normal[2].push_back(1);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes = {mesh};
  scene.materials.resize(1);
  scene.instances.resize(1);
  scene.camera.eye = {0, 0, 4};
  scene.camera.fov_y_rad = 0.8f;
  return scene;
}

float red(const Result& result, int x, int y) {
  float value;
  std::memcpy(&value, result.frame.color.texel(x, y), sizeof value);
  return value;
}

Result render_on(const Scene& scene, const Pipeline& pipeline, std::string_view simd, bool culling = true) {
  Execution execution;
  execution.simd = simd;
  execution.light_culling = culling;
  return render(scene, pipeline, execution);
}

void require_culling_changes_nothing(const Scene& scene, const Pipeline& pipeline) {
  const Image expected = render_on(scene, pipeline, "scalar", false).frame.color;
  for (const std::string_view simd : simd_targets())
    for (const int tile : {8, 64})
      for (const bool culling : {true, false}) {
        Execution execution;
        execution.simd = simd;
        execution.tile = tile;
        execution.light_culling = culling;
        INFO(simd << ", tile " << tile << ", culling " << culling << ", " << pipeline_json(pipeline));
        REQUIRE(render(scene, pipeline, execution).frame.color.texels == expected.texels);
      }
}

/// Models whose lights end somewhere: in range, in a cone, or both.
std::vector<LightModel> bounded_models() {
  std::vector<LightModel> out;
  for (const Falloff falloff : {Falloff::linear_range, Falloff::inverse_square, Falloff::none, Falloff::attenuation})
    for (const Cone cone :
         {Cone::none, Cone::smooth_cutoff, Cone::smooth_penumbra, Cone::exponent, Cone::squared_penumbra}) {
      LightModel m;
      m.falloff = falloff;
      m.cone = cone;
      m.order = cone == Cone::exponent ? TermOrder::with_ambient : TermOrder::factored;
      out.push_back(m);
    }
  return out;
}

}  // namespace

TEST_CASE("Row 52: OpenGL's attenuation reads k0 too, a light at infinity has none") {
  Scene scene = flat_square();
  Pipeline pipeline = loop_pipeline("gl-fixed");
  pipeline.light_model.global_ambient = {0, 0, 0};
  pipeline.light_model.clamp_result = false;
  scene.materials[0].specular_color = {0, 0, 0};
  const Vec p = render(scene, pipeline).pixel(30, 20).position;
  Light light;
  light.position = {p.x, p.y, p.z + 2};
  for (const std::string_view simd : simd_targets()) {
    INFO(simd);
    scene.lights = {light};
    scene.lights[0].attenuation = {1, 0.14f, 0.07f};
    CHECK(std::abs(int64_t(std::bit_cast<uint32_t>(red(render_on(scene, pipeline, simd), 30, 20))) - 0x3F241A42) <= 1);
    scene.lights[0].attenuation = {0.5f, 0.25f, 0};
    CHECK(red(render_on(scene, pipeline, simd), 30, 20) == 1.0f);  // 1 / (0.5 + 0.25 * 2)
    scene.lights[0].type = LightType::directional;
    scene.lights[0].direction = {0, 0, -1};
    CHECK(red(render_on(scene, pipeline, simd), 30, 20) == 1.0f);
  }
}

TEST_CASE("Row 53: where N.L is 0 there is no specular term, though N.H is not") {
  Scene scene = flat_square();
  Pipeline pipeline = loop_pipeline("gl-fixed");
  pipeline.light_model.global_ambient = {0, 0, 0};
  Light light;
  light.type = LightType::directional;
  light.direction = {-1, 0, 0};  // L = (1, 0, 0), N = V = (0, 0, 1): N.H = 0.7071
  scene.lights = {light};
  scene.materials[0].specular_color = {1, 1, 1};
  scene.materials[0].shininess = 1;
  for (const std::string_view simd : simd_targets()) {
    INFO(simd);
    scene.lights[0].direction = {-1, 0, 0};
    scene.lights[0].ambient = {0, 0, 0};
    CHECK(red(render_on(scene, pipeline, simd), 30, 20) == 0.0f);
    scene.lights[0].ambient = {0.25f, 0, 0};  // the light's ambient share is not masked
    CHECK(red(render_on(scene, pipeline, simd), 30, 20) == 0.25f);
    // A little above the horizon it is there: about cos(45 degrees) in red, beside N.L.
    scene.lights[0].ambient = {0, 0, 0};
    scene.lights[0].direction = {-0.99999994f, 0, -0.0003f};
    CHECK(red(render_on(scene, pipeline, simd), 30, 20) == Approx(0.7071).margin(0.001));
    Pipeline unmasked = pipeline;
    unmasked.light_model.specular_masked = false;
    scene.lights[0].direction = {-1, 0, 0};
    CHECK(red(render_on(scene, unmasked, simd), 30, 20) == Approx(0.70710678).epsilon(1e-6));
  }
}

TEST_CASE("Row 54: a spot light's edge is inside: a cosine of cos(cutoff) is lit, one ulp less is not") {
  Scene scene = flat_square();
  Pipeline pipeline = loop_pipeline("gl-fixed");
  pipeline.light_model.global_ambient = {0, 0, 0};
  scene.materials[0].specular_color = {0, 0, 0};
  const Vec p = render(scene, pipeline).pixel(30, 20).position;
  Light light;
  light.type = LightType::spot;
  light.position = {p.x, p.y, p.z + 2};  // L = (0, 0, 1): the cosine is minus the direction's z
  scene.lights = {light};
  for (const float cutoff : {0.3f, 0.7f, 1.1f}) {
    const float edge = float(std::cos(double(cutoff)));
    for (const std::string_view simd : simd_targets())
      for (const float cosine : {std::nextafter(edge, 1.0f), edge, std::nextafter(edge, 0.0f)}) {
        const double sine = std::sqrt(1.0 - double(cosine) * double(cosine));
        scene.lights[0].direction = {float(sine), 0, -cosine};
        scene.lights[0].cone_rad = cutoff;
        INFO(simd << ", cutoff " << cutoff << ", cosine " << cosine);
        CHECK((red(render_on(scene, pipeline, simd), 30, 20) > 0) == (cosine >= edge));
      }
  }
  scene.lights[0].cone_rad = 3.14159265f;  // 180 degrees: no cone, whatever the exponent
  scene.lights[0].direction = {0, 0, 1};
  scene.lights[0].spot_exponent = 50;
  CHECK(red(render(scene, pipeline), 30, 20) == 1.0f);
}

/// Adds lights that just reach a pixel at a corner of a 4x4 block, that just do not, or end at it; the edges of their
/// cones pass through it.
static void add_touching_lights(Scene& scene, const Result& surface, int count, Random& random) {
  for (int i = 0; i < count; ++i) {
    const int x = 4 * int(random() % 13) + int(random() % 2) * 3, y = 4 * int(random() % 9) + int(random() % 2) * 3;
    if (!surface.covered(x, y)) continue;
    const Vec p = surface.pixel(x, y).position;
    Light light = random_light(random);
    light.type = i % 2 == 0 ? LightType::point : LightType::spot;
    const Vec d = minus(vec(light.position), p);
    const float distance = std::sqrt(dot(d, d));
    light.range = i % 3 == 0 ? distance : std::nextafter(distance, i % 3 == 1 ? 0.0f : 10.0f);
    const double axis = double(-light.direction.x) * double(d.x) - double(light.direction.y) * double(d.y) -
                        double(light.direction.z) * double(d.z);
    const double angle = std::acos(std::max(-1.0, std::min(1.0, axis / double(distance))));
    light.cone_rad = float(angle * 0.5), light.penumbra_rad = float(angle * 0.5);
    scene.lights.push_back(light);
  }
}

TEST_CASE("lights whose range or cone just touches a pixel, a block or a tile are culled without changing a bit") {
  Random random(65);
  for (const LightModel& model : bounded_models()) {
    Scene scene = sheet(random);
    Pipeline pipeline = loop_pipeline("many-lights");
    pipeline.light_model = model;
    add_touching_lights(scene, render(scene, pipeline), 40, random);
    require_culling_changes_nothing(scene, pipeline);
  }
}

TEST_CASE("lights that just touch are culled without changing a bit under every preset, strategy, target and profile",
          "[slow]") {
  Random random(68);
  Scene scene = sheet(random);
  add_touching_lights(scene, render(scene, loop_pipeline("many-lights")), 60, random);
  for (Light& light : scene.lights) light.color *= 0.2f;  // so that 8 bits do not saturate
  const PreparedScene prepared(scene);
  const auto drawn = [&](const Pipeline& pipeline, std::string_view simd, bool culling, int tile) {
    return render_frame(prepared, pipeline, {.tile = tile, .simd = simd, .light_culling = culling}).color;
  };
  for (const Preset& row : presets())
    for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy)
      for (const Format target : kTargetFormats)
        for (const NumericProfile profile : {NumericProfile::ideal, NumericProfile::mesa_llvmpipe_22_3}) {
          Pipeline pipeline = row.pipeline;
          pipeline.width = 57, pipeline.height = 43;
          pipeline.strategy = Strategy(strategy);
          pipeline.target = target;
          pipeline.profile = profile;
          INFO(row.name << ", " << kStrategyNames[strategy] << ", " << info(target).name << ", " << int(profile));
          const Image expected = drawn(pipeline, "scalar", false, 64);
          int unlike = 0;
          for (const std::string_view simd : simd_targets())
            for (const int tile : {8, 64}) unlike += drawn(pipeline, simd, true, tile).texels != expected.texels;
          CHECK(unlike == 0);
        }
}

TEST_CASE("lights in the plane of a surface, and a last bit above and below it, are culled without changing a bit") {
  Random random(67);
  for (const float length : {1.0f, 1e-18f, 3e15f}) {
    // Specks of about a pixel, apart, so that the boxes that culling asks hold one position and one normal.
    Scene scene;
    scene.materials.resize(1);
    scene.instances.resize(1);
    scene.camera.eye = {0.2f, -0.1f, 4};
    scene.camera.fov_y_rad = 0.9f;
    Mesh mesh;
    for (uint32_t i = 0; i < 24; ++i) {
      const float x = float(i % 6) * 0.83f - 2.1f, y = float(i / 6) * 0.9f - 1.4f;
      const float normal[3] = {float_between(random, -1, 1), float_between(random, -1, 1),
                               float_between(random, -1, 1)};
      for (const auto& [dx, dy] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        const float position[3] = {x + 0.06f * float(dx), y + 0.06f * float(dy), 0.0f};
        for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(position[k]);
        for (size_t k = 0; k < 3; ++k) mesh.normal[k].push_back(normal[k] * length);
      }
      for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(4 * i + corner);
    }
    scene.meshes = {mesh};
    Pipeline pipeline = loop_pipeline("many-lights");
    const Result surface = render(scene, pipeline);
    for (int i = 0; i < 6 * 57 * 43; ++i) {
      const int x = i / 6 % 57, y = i / 6 / 57;
      if (!surface.covered(x, y)) continue;
      const Vec p = surface.pixel(x, y).position, n = surface.pixel(x, y).normal;
      const glm::dvec3 normal = glm::dvec3(n.x, n.y, n.z) / double(length);
      const glm::dvec3 a(float_between(random, -1, 1), float_between(random, -1, 1), float_between(random, -1, 1));
      const glm::dvec3 along = a - normal * (glm::dot(a, normal) / glm::dot(normal, normal));
      Light light;
      light.position = glm::vec3(glm::dvec3(p.x, p.y, p.z) + along);
      for (int c = 0; c < 3; ++c)
        if (random() % 2 == 0) light.position[c] = std::nextafter(light.position[c], i % 2 == 0 ? -9.0f : 9.0f);
      light.range = 5.0f;
      scene.lights.push_back(light);
    }
    CHECK(scene.lights.size() >= 50);
    for (const bool renormalize : {true, false}) {
      pipeline.light_model.renormalize = renormalize;
      require_culling_changes_nothing(scene, pipeline);
    }
  }
}

TEST_CASE("a light without a number for a colour, where it does not reach, changes nothing, culled or not") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  Random random(66);
  for (const LightModel& model : bounded_models()) {
    const bool ends = model.falloff == Falloff::linear_range || model.falloff == Falloff::inverse_square;
    if (!ends && model.cone == Cone::none) continue;
    Scene scene = sheet(random);
    Pipeline pipeline = loop_pipeline("many-lights");
    pipeline.light_model = model;
    for (int i = 0; i < 5; ++i) scene.lights.push_back(random_light(random));
    const Image expected = render(scene, pipeline).frame.color;
    for (const float bad : {kNan, kInf}) {
      Scene injected = scene;  // after the scene was validated
      Light light;
      light.color = {bad, bad, bad};
      light.range = 1;
      light.position = {40, 0, 1};  // out of range; or, where nothing ends it, out of its cone
      light.type = ends ? LightType::point : LightType::spot;
      light.direction = {1, 0, 0};
      light.cone_rad = 0.3f, light.penumbra_rad = 0.1f;
      injected.lights.insert(injected.lights.begin() + 2, light);
      for (const std::string_view simd : simd_targets())
        for (const bool culling : {true, false}) {
          INFO(simd << ", culling " << culling << ", " << pipeline_json(pipeline));
          CHECK(render_on(injected, pipeline, simd, culling).frame.color.texels == expected.texels);
        }
    }
  }
}

TEST_CASE("a light of NaN or infinite colour out of its reach changes no bit under every preset, strategy and target") {
  Random random(69);
  Scene scene = sheet(random);
  for (int i = 0; i < 5; ++i) scene.lights.push_back(random_light(random));
  for (Light& light : scene.lights) light.color *= 0.2f;
  const PreparedScene plain(scene);
  std::vector<Scene> injected;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    injected.push_back(scene);  // after the scene was validated
    Light light;
    light.type = LightType::spot;
    light.color = {bad, bad, bad};
    light.range = 1;
    light.position = {40, 0, 1};  // out of range and, where nothing ends it there, out of its cone
    light.direction = {1, 0, 0};
    light.cone_rad = 0.3f, light.penumbra_rad = 0.1f;
    injected.back().lights.insert(injected.back().lights.begin() + 2, light);
  }
  for (const Scene& with : injected) {
    const PreparedScene prepared(with);
    for (const Preset& row : presets())
      for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy)
        for (const Format target : kTargetFormats) {
          Pipeline pipeline = row.pipeline;
          pipeline.width = 33, pipeline.height = 27;
          pipeline.strategy = Strategy(strategy);
          pipeline.target = target;
          INFO(row.name << ", " << kStrategyNames[strategy] << ", " << info(target).name << ", "
                        << with.lights[2].color.x);
          // This preset reads neither range nor cone: its lights reach everywhere.
          const bool ends = row.name != "touchdesigner";
          const Image expected =
              render_frame(ends ? plain : prepared, pipeline, {.simd = "scalar", .light_culling = false}).color;
          int unlike = 0;
          for (const std::string_view simd : simd_targets())
            for (const bool culling : {true, false})
              unlike +=
                  render_frame(prepared, pipeline, {.tile = 16, .simd = simd, .light_culling = culling}).color.texels !=
                  expected.texels;
          CHECK(unlike == 0);
        }
  }
}
