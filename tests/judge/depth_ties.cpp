// Depths that an offset takes to an end of their range, and attributes that are cut there: what OpenGL then draws is
// legal, and what it does not draw is found.
#include "judge/stages/validate.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"

using namespace trueshade;
using namespace trueshade::oracle;
using trueshade::testing::captured;

namespace {

Instance upright_quad(const glm::dvec3& at, uint32_t material) {
  Instance quad{0, material, placed(at, {2, 1, 2})};
  std::swap(quad.world_from_object[1], quad.world_from_object[2]);
  return quad;
}

/// Two walls, the second behind the first, tilted so that they have a slope, under three lights.
Scene two_walls() {
  Scene scene;
  scene.spec = "walls";
  scene.meshes = {plane_mesh(1)};
  scene.materials = {{"", {0.8f, 0.4f, 0.2f, 1.0f}}, {"", {0.1f, 0.3f, 0.7f, 1.0f}}};
  scene.instances = {upright_quad({0, 0, 0.5}, 0), upright_quad({0.5, 0.25, -1}, 1)};
  for (Instance& wall : scene.instances) wall.world_from_object[0].z = 0.75f;
  for (const float x : {-1.0f, 0.0f, 1.0f}) {
    Light light;
    light.position = {x, 0.5f, 3.0f};
    light.color = {0.3f, 0.4f, 0.2f};
    light.range = 9.0f;
    scene.lights.push_back(light);
  }
  return scene;
}

Pipeline multipass() {
  Pipeline p;
  p.width = 40, p.height = 30;
  p.strategy = Strategy::forward_multipass;
  p.light_model.specular_masked = false;
  return p;
}

uint64_t violations(const Scene& scene, const Pipeline& pipeline, const Capture& capture) {
  return validate_capture(scene, pipeline, capture, {testing::unknown_of_8_bits(), false, {}, {}}).violations();
}

void check_ties(DepthFunc func, float clear, float factor, float units, Format format) {
  const Scene scene = two_walls();
  Pipeline pipeline = multipass();
  GeometryState& g = pipeline.geometry;
  g.depth_func = func, g.clear_depth = clear, g.depth_format = format;
  g.polygon_offset_factor = factor, g.polygon_offset_units = units;
  const Capture right = captured(scene, pipeline);
  CAPTURE(int(func), clear, factor, units, info(format).name);
  CHECK(violations(scene, pipeline, right) == 0);
  // Where all fragments add their light, a picture by one of the walls alone is wrong.
  Scene alone = scene;
  alone.instances[0].mesh = 1, alone.meshes.emplace_back();
  Capture wrong = right;
  wrong.color = captured(alone, pipeline).color;
  CHECK(violations(scene, pipeline, wrong) > 50);
}

}  // namespace

TEST_CASE("Fragments that an offset takes to an end of the depth range tie, and each adds its light") {
  for (const auto& [format, units] : {std::pair(Format::d32f, 5e6f), {Format::d24, 5e6f}, {Format::d16, 3e4f}})
    for (const bool by_slope : {false, true}) {
      const float factor = by_slope ? 300.0f : 0.0f, more = by_slope ? 0.0f : units;
      check_ties(DepthFunc::always, 1, factor, more, format);
      check_ties(DepthFunc::lequal, 1, factor, more, format);
      check_ties(DepthFunc::less, 1, factor, more, format);  // all fail, and tie with the clear depth
      check_ties(DepthFunc::gequal, 0, -factor, -more, format);
      check_ties(DepthFunc::greater, 0, -factor, -more, format);
    }
}

TEST_CASE("What is noperspective is linear in the window where the near plane cuts a triangle (GL 4.6 core, 13.7.1)") {
  Scene scene;
  scene.spec = "floor";
  scene.meshes = {plane_mesh(1)};
  for (size_t k = 0; k < 2; ++k) scene.meshes[0].uv[k].resize(4);
  for (size_t v = 0; v < 4; ++v) {
    scene.meshes[0].uv[0][v] = scene.meshes[0].position[2][v] > 0 ? 1.0f : 0.0f;  // 1 behind the eye
    scene.meshes[0].uv[1][v] = 0.0f;
  }
  scene.materials = {{"", {1, 1, 1, 1}}};
  scene.instances = {{0, 0, placed({0, -1, 0}, {40, 1, 20})}};  // from z = -10 to 10
  scene.camera.eye = {0, 0, 0}, scene.camera.target = {0, 0, -1};
  scene.camera.fov_y_rad = 1.57079633f, scene.camera.near = 1.5f, scene.camera.far = 100.0f;
  Pipeline pipeline;
  pipeline.width = 40, pipeline.height = 30;
  pipeline.gbuffer.uv.interpolation = Interpolation::noperspective;
  Capture capture = captured(scene, pipeline);
  capture.color = {};
  std::erase_if(capture.planes, [](const NamedImage& p) { return p.name != "uv" && p.name != "id.object"; });
  const auto by_formula = [&](double more) {
    for (NamedImage& plane : capture.planes) {
      if (plane.name != "uv") continue;
      for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
          // The edges at z = -10 and 10 are at -1 / 10 and -1 / -10 of the window's half height.
          const double at = 1 - (y + 0.5) / 15, u = (at + 0.1) / 0.2 + more;
          if (capture.plane("id.object")->value(x, y, 0) != 0)
            plane.image.set_code(x, y, 0, std::bit_cast<uint32_t>(float(u)));
        }
    }
    return judge_gbuffer(scene, pipeline, testing::unknown_of_8_bits(), capture).count(PixelClass::violation);
  };
  CHECK(by_formula(0) == 0);
  CHECK(by_formula(0.02) > 300);
}
