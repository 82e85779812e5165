// The peers of the benchmarks draw our picture: a fast wrong picture is no peer.
#include <algorithm>
#include <cmath>
#include <span>

#include "gl/driver/designs.h"
#include "gl/emit/designs_glsl.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;

namespace {

constexpr int kTiles[] = {16, 32};

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

/// Each design against ours drawn the same way: rounded light by light or once, ended by the same extents. What is left
/// are edges, and light terms that round to the next code: of textured surfaces, whose 8-bit texels differ by parts of
/// a code, and of colours that glass was blended into, each of the lights may, so that blending them walks sqrt(lights)
/// codes away.
/// Binned designs by each of `tiles`.
void check_designs(const Scene& scene, const Preset& preset, std::span<const int> tiles = kTiles) {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Pipeline pipeline = preset.pipeline;
  pipeline.width = 150;  // no multiple of a tile
  pipeline.height = 110;
  const PreparedScene prepared(scene);
  GlRenderer renderer(*context, scene);
  for (const GlDesign design : kGlDesigns) {
    if (!draws_glass(design, pipeline.transparency.mode)) continue;
    const Image ours = render_frame(prepared, design_pipeline(pipeline, design)).color;
    for (const int tile : tiles) {
      GlPeer peer(renderer, pipeline, design, tile);
      const Image theirs = peer.draw(true).capture.color;
      INFO(scene.spec << ", " << preset.name << ", " << name_of(design) << ", tile " << tile << ", glass "
                      << kTransparencyNames[size_t(pipeline.transparency.mode)]);
      const bool other_codes = !scene.textures.empty() || (draws_transparent(scene, pipeline) &&
                                                           pipeline.transparency.mode == TransparencyMode::into_albedo);
      const bool walks = other_codes && blends_lights(strategy_of(design));
      CHECK(pixels_over(theirs, ours, walks ? 2 + std::sqrt(double(scene.lights.size())) : 2) <= 16500 / 200);
      CHECK(peer.draw(true).capture.color.texels == theirs.texels);  // a second frame starts from nothing
      if (!is_binned(design)) break;
    }
  }
}

/// Under every preset, one of the tiles each in turn: a driver takes longer to compile a design than to draw it.
void check_presets(const Scene& scene, TransparencyMode mode) {
  for (size_t i = 0; i < presets().size(); ++i) {
    Preset preset = presets()[i];
    preset.pipeline.transparency.mode = mode;
    check_designs(scene, preset, std::span(kTiles).subspan(i % std::size(kTiles), 1));
  }
}

}  // namespace

TEST_CASE("Every OpenGL design draws our picture under every preset") {
  check_presets(builtin_scene("city,objects=300,lights=50"), TransparencyMode::after_lights);
}

TEST_CASE("Every OpenGL design draws textured materials, and spot lights in their cones") {
  check_presets(builtin_scene("lecture,lights=8"), TransparencyMode::after_lights);
}

TEST_CASE("Every OpenGL design draws maps of metal, emission and occlusion, and unlit surfaces") {
  Scene scene = builtin_scene("lecture,lights=5");
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    m.metallic = 0.8f, m.roughness = 0.9f;
    m.emission = {0.1f, 0.05f, 0.2f};
    m.metallic_roughness_map = m.emission_map = m.occlusion_map = m.color_map;
    m.unlit = i % 3 == 2;
  }
  Light sky;
  sky.type = LightType::ambient;
  sky.color = {0.1f, 0.2f, 0.1f};
  scene.lights.push_back(sky);
  for (const char* name : {"punctual", "gl-fixed"})
    for (const Preset& preset : presets())
      if (preset.name == name) check_designs(scene, preset, std::span(kTiles).subspan(1));
}

TEST_CASE("Every OpenGL design draws by a light program, which knows each light's number and its parameters") {
  Scene scene = builtin_scene("cornell,lights=9");
  for (size_t i = 0; i < scene.materials.size(); ++i) scene.materials[i].unlit = i % 3 == 1;
  Preset preset = presets().front();
  Pipeline& p = preset.pipeline;
  p.light_volumes.point = p.light_volumes.spot = LightExtent::range;
  p.light_program = {"lights.glsl",
                     R"glsl(
layout(std140) uniform Parameters { vec3 tint; };
vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position;
  float share = max(dot(s.normal, normalize(d)), 0.0) * max(1.0 - length(d) / l.range, 0.0);
  return s.albedo.rgb * l.color * tint * (l.index % 2u == 0u ? share : 0.25 * share);
}
vec3 start(Surface s, View v) { return 0.05 * s.albedo.rgb; }
vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum.brg, 1.0); }
)glsl",
                     {},
                     {{"tint", {1.5f, 1.0f, 0.5f}}}};
  check_designs(scene, preset);
  scene.materials.back().transparent = true, scene.materials.back().base_color.a = 0.5f;
  check_designs(scene, preset, std::span(kTiles).first(1));
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

TEST_CASE("Every OpenGL design draws glass after the lights, and the deferred ones in the colour plane") {
  Scene scene = builtin_scene("city,objects=200,lights=20");
  for (size_t i = 0; i < scene.materials.size(); i += 3) {
    scene.materials[i].base_color.a = 0.4f;
    scene.materials[i].transparent = true;
  }
  for (const TransparencyMode mode : {TransparencyMode::after_lights, TransparencyMode::into_albedo})
    check_presets(scene, mode);
}
