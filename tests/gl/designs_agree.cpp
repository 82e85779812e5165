// The peers of the benchmarks draw our picture: a fast wrong picture is no peer.
#include <algorithm>
#include <cmath>

#include "oracle/gl/designs.h"
#include "scenes/builtin.h"
#include "scenes/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;

namespace {

/// Pixels of which a channel differs by more than `codes` of 255.
int pixels_over(const Image& a, const Image& b, double codes) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      double worst = 0;
      for (int k = 0; k < 4; ++k) worst = std::max(worst, std::fabs(a.value(x, y, k) - b.value(x, y, k)));
      count += worst * 255 > codes + 0.5 ? 1 : 0;
    }
  return count;
}

void check_designs(const Scene& scene, const Preset& preset) {
  const GlContext* context = driver(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Pipeline pipeline = preset.pipeline;
  pipeline.width = 150;  // no multiple of a tile
  pipeline.height = 110;
  const Image ours = render_frame(scene, pipeline).color;
  GlRenderer renderer(*context, scene);
  for (const GlDesign design : kGlDesigns)
    for (const int tile : {16, 32}) {
      GlPeer peer(renderer, pipeline, design, tile);
      const Image theirs = peer.draw(true).capture.color;
      INFO(scene.spec << ", " << preset.name << ", " << name_of(design) << ", tile " << tile);
      // Volumes and multipass round after each light: 9 codes at 64 lights (GL_RULES section 4), a little more where
      // all of them are faint.
      const bool blends = design == GlDesign::deferred_volumes || design == GlDesign::forward_multipass;
      CHECK(pixels_over(theirs, ours, blends ? 12 : 2) <= 16500 / 200);
      CHECK(peer.draw(true).capture.color.texels == theirs.texels);  // a second frame starts from nothing
    }
}

}  // namespace

TEST_CASE("Every OpenGL design draws our picture under every preset that sums lights") {
  const Scene scene = builtin_scene("city,objects=300,lights=50");
  // The designs bin lights by range and sum or blend them all alike: presets that draw lights as geometry are held to
  // OpenGL by strategies_agree.cpp.
  for (const Preset& preset : presets())
    if (preset.pipeline.strategy == Strategy::deferred_loop) check_designs(scene, preset);
}

TEST_CASE("Every OpenGL design knows ambient and directional lights, and eyes inside a light's range") {
  Scene scene = builtin_scene("city,objects=100,lights=8");
  Light ambient, sun, near;
  ambient.type = LightType::ambient;
  ambient.color = glm::vec3(0.1f);
  sun.type = LightType::directional;
  sun.direction = {0.0f, 0.0f, -1.0f};
  sun.color = glm::vec3(0.2f);
  near.position = scene.camera.eye;
  near.range = 200.0f;
  near.color = glm::vec3(0.5f);
  scene.lights.insert(scene.lights.begin() + 3, {ambient, sun, near});
  check_designs(scene, presets().front());
}

TEST_CASE("Every OpenGL design draws large meshes, a draw an instance, as we do") {
  check_designs(builtin_scene("rabbits,objects=3,lights=6"), presets().front());
}

TEST_CASE("Every OpenGL design draws our picture under Lambert's law alone") {
  Preset lambert = presets().front();
  lambert.pipeline.light_model.specular = Specular::none;  // drops the term where GLSL is emitted
  lambert.pipeline.light_model.specular_color = glm::vec3(0.0f);
  check_designs(builtin_scene("city,objects=300,lights=50"), lambert);
}
