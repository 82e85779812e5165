// What the light models that ship draw. tests/programs/light_models.cpp holds their formulas.
#include "scenes/pipeline/shipped_models.h"

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "core/image_hash.h"
#include "core/simd/simd_target.h"
#include "scenes/builtin/builtin.h"
#include "scenes/shapes.h"
#include "shading/frame.h"
#include "tests/catch.hpp"

using namespace trueshade;

namespace {

/// Balls of metal and of plastic, from rough to smooth, under a light of each type; the sun and the point light have no
/// end.
Scene balls() {
  Scene scene;
  scene.meshes = {sphere_mesh(12)};
  constexpr int kBalls = 4;
  for (int i = 0; i < 2 * kBalls; ++i) {
    Material material;
    material.base_color = {0.9f, 0.6f, 0.3f, 1.0f};
    material.metallic = i < kBalls ? 1.0f : 0.0f;
    material.roughness = float(i % kBalls) / float(kBalls - 1);
    scene.materials.push_back(material);
    Instance ball{0, uint32_t(i), glm::mat4x3(0.45f)};
    ball.world_from_object[3] = {float(i % kBalls) - 1.5f, i < kBalls ? 0.5f : -0.5f, 0.0f};
    scene.instances.push_back(ball);
  }
  scene.lights.resize(4);
  for (int i = 0; i < 4; ++i) scene.lights[size_t(i)].type = LightType(i);
  scene.lights[0].color = glm::vec3(0.05f);
  scene.lights[1].direction = {0.6f, -0.64f, -0.48f};
  scene.lights[2].position = {-2.0f, 1.0f, 2.0f}, scene.lights[2].color = {4.0f, 1.0f, 1.0f};
  scene.lights[3].position = {1.5f, 0.0f, 3.0f}, scene.lights[3].color = {1.0f, 4.0f, 8.0f};
  scene.lights[3].range = 6.0f, scene.lights[3].cone_rad = 0.2f, scene.lights[3].penumbra_rad = 0.2f;
  scene.camera.eye = {0.0f, 0.0f, 4.0f};
  return scene;
}

}  // namespace

TEST_CASE("Each light model that ships draws one frame on every SIMD target, without a NaN") {
  const std::map<std::string_view, ProgramParameter> parameters{
      {"charlie", {"sheen", {0.75f}}}, {"toon", {"steps", {3}}}, {"wrapped", {"wrap", {0.5f}}}};
  std::set<std::string> hashes;
  for (const Scene& scene : {builtin_scene("cornell"), balls()})
    for (const ShippedModel& model : shipped_models()) {
      INFO(model.name);
      Pipeline pipeline;
      pipeline.width = 96, pipeline.height = 64;
      pipeline.target = Format::rgba32f;
      pipeline.light_program = shipped_program(model.name);
      if (const auto found = parameters.find(model.name); found != parameters.end())
        pipeline.light_program.parameters = {found->second};
      std::string first;
      for (const std::string_view target : simd_targets()) {
        Execution execution;
        execution.simd = target;
        const Frame frame = render_frame(scene, pipeline, execution);
        const std::string hash = image_hash(frame.color);
        if (first.empty()) first = hash;
        CHECK(hash == first);
        int nans = 0, lit = 0;
        for (int y = 0; y < pipeline.height; ++y)
          for (int x = 0; x < pipeline.width; ++x)
            for (int c = 0; c < 3; ++c) {
              const double value = double(frame.color.value(x, y, c));
              nans += !(value >= 0 && std::isfinite(value)), lit += value > 0.01;
            }
        CHECK(nans == 0);
        CHECK(lit > 96 * 64 / 2);
      }
      CHECK(hashes.insert(first).second);  // no two models draw the same
    }
}
