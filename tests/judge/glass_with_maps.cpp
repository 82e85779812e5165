// Transparent surfaces with maps of metal and roughness, emission and occlusion: what OpenGL draws is explained, and a
// wrong map of glass alone is not.
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "gl/driver/renderer.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/texture_pattern.h"
#include "scenes/pipeline/presets.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/drivers.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

Mesh with_uv(Mesh mesh) {
  mesh.uv = {};
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    mesh.uv[0].push_back((mesh.position[0][v] + 0.37f * mesh.position[1][v]));
    mesh.uv[1].push_back((mesh.position[2][v] - 0.21f * mesh.position[1][v]));
  }
  return mesh;
}

Texture pattern_of(Pattern pattern, TextureFormat format) {
  TexturePattern p;
  p.pattern = pattern;
  p.width = 16, p.height = 12;  // magnified: where texels are smaller than pixels, much is legal
  p.format = format;
  p.colors = {glm::vec4(0.95f, 0.9f, 0.8f, 1.0f), glm::vec4(0.1f, 0.25f, 0.3f, 0.5f)};
  Texture texture = texture_of(p);
  build_mip_chain(texture);
  return texture;
}

TextureSlot slot_of(int texture) {
  TextureSlot slot;
  slot.texture = texture;
  return slot;
}

constexpr size_t kGlass = 1;  ///< the material of glass

/// A wall and a floor behind a pane and a ball of glass, as a file says it by alphaMode BLEND.
Scene glass_room() {
  Scene scene;
  scene.spec = "glass room";
  scene.meshes = {with_uv(plane_mesh(8)), with_uv(sphere_mesh(20))};
  scene.textures = {pattern_of(Pattern::checker, TextureFormat::srgb8_a8),
                    pattern_of(Pattern::brick, TextureFormat::rgba8), pattern_of(Pattern::noise, TextureFormat::rgba8)};
  Material wall;
  wall.base_color = {0.8f, 0.7f, 0.6f, 1.0f};
  wall.specular_color = glm::vec3(0.3f);
  wall.color_map = slot_of(0);
  Material glass;
  glass.base_color = {0.7f, 0.9f, 1.0f, 0.6f};
  glass.transparent = true;
  glass.color_map = slot_of(0);
  glass.metallic = 0.9f, glass.roughness = 0.7f, glass.occlusion_strength = 0.75f;
  glass.emission = {0.3f, 0.1f, 0.5f};
  glass.metallic_roughness_map = slot_of(1), glass.emission_map = slot_of(0), glass.occlusion_map = slot_of(2);
  scene.materials = {wall, glass};
  const auto placed = [](uint32_t mesh, uint32_t material, const glm::mat4x3& place) {
    return Instance{mesh, material, place};
  };
  scene.instances = {
      placed(0, 0, {glm::vec3(6, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 12), glm::vec3(0, -1, -3)}),
      placed(0, 0, {glm::vec3(4, 0, 0), glm::vec3(0, 0, 1), glm::vec3(0, -3, 0.5f), glm::vec3(0, 0, -4)}),
      placed(0, kGlass,
             {glm::vec3(1.6f, 0, 0.2f), glm::vec3(0, 0, 1), glm::vec3(0, -1.2f, 0), glm::vec3(-0.4f, 0, -1)}),
      placed(1, kGlass,
             {glm::vec3(0.6f, 0, 0), glm::vec3(0, 0.6f, 0), glm::vec3(0, 0, 0.6f), glm::vec3(0.7f, 0, -1.7f)})};
  Light lamp, sky;
  lamp.position = {1, 2, 1};
  lamp.range = 12.0f;
  sky.type = LightType::ambient;
  sky.color = {0.8f, 0.85f, 0.9f};
  scene.lights = {lamp, sky};
  scene.camera.eye = {0.1f, 0.2f, 1.5f};
  scene.camera.near = 0.1f, scene.camera.far = 50.0f;
  return scene;
}

/// A picture by a driver, and what it was seen to be before and after each transparent surface.
struct WatchedGlass {
  WatchedGlass(const GlContext& context, const Scene& scene, const Pipeline& pipeline, KeptPrograms& programs) {
    GlDraw how;
    how.after_object = [this](int i, const Image& target) { after_object.emplace_back(i, target); };
    capture = GlRenderer(context, scene, 0, &programs).draw(pipeline, how).capture;
  }

  uint64_t violations(const Scene& scene, const Pipeline& pipeline, const Profile& profile, bool by_object) const {
    const LightSteps objects = [this](const StepSink& sink) {
      for (const auto& [i, target] : after_object) sink(i, target);
    };
    const Verdict v =
        validate_capture(scene, pipeline, capture, {profile, false, {}, by_object ? objects : LightSteps{}});
    INFO(verdict_json(v));
    CHECK(v.stages.size() == (by_object ? 3 : 2));
    return v.violations();
  }

  Capture capture;
  std::vector<std::pair<int, Image>> after_object;
};

std::vector<Pipeline> glass_pipelines() {
  std::vector<Pipeline> out;
  for (const char* preset : {"punctual", "gl-fixed"})
    for (const Strategy strategy : {Strategy::deferred_loop, Strategy::forward_loop}) {
      Pipeline pipeline = *preset_pipeline(preset);
      pipeline.light_model.specular_source = SpecularSource::metallic_roughness;
      pipeline.strategy = strategy;
      pipeline.transparency.mode = TransparencyMode::after_lights;
      pipeline.width = 96, pipeline.height = 72;
      out.push_back(pipeline);
    }
  return out;
}

}  // namespace

TEST_CASE("Glass with maps of metal, emission and occlusion by llvmpipe is explained, and a wrong map of it is not") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  Profile profile = *profile_named("unknown");
  profile.subpixel_bits = context->info().subpixel_bits;
  struct Wrong {
    const char* name;
    void (*change)(Material& glass);
  };
  const Wrong kWrong[] = {
      {"no map of metal and roughness", [](Material& m) { m.metallic_roughness_map = {}; }},
      {"another map of metal and roughness", [](Material& m) { m.metallic_roughness_map = slot_of(2); }},
      {"no map of emission", [](Material& m) { m.emission_map = {}; }},
      {"another map of emission", [](Material& m) { m.emission_map = slot_of(2); }},
      {"no map of occlusion", [](Material& m) { m.occlusion_map = {}; }},
      {"occlusion half as strong", [](Material& m) { m.occlusion_strength = 0.375f; }}};
  const Scene scene = glass_room();
  for (const Pipeline& pipeline : glass_pipelines()) {
    const WatchedGlass right(*context, scene, pipeline, programs);
    CAPTURE(pipeline.preset, name_of(pipeline.strategy));
    for (const bool by_object : {false, true}) CHECK(right.violations(scene, pipeline, profile, by_object) == 0);
    for (const Wrong& wrong : kWrong) {
      Scene changed = scene;
      wrong.change(changed.materials[kGlass]);
      const WatchedGlass drawn(*context, changed, pipeline, programs);
      CAPTURE(wrong.name);
      const uint64_t by_picture = drawn.violations(scene, pipeline, profile, false),
                     by_object = drawn.violations(scene, pipeline, profile, true);
      std::printf("%-9s %-14s %-36s %5llu pixels by the picture, %5llu by object\n", pipeline.preset.c_str(),
                  std::string(name_of(pipeline.strategy)).c_str(), wrong.name, (unsigned long long)by_picture,
                  (unsigned long long)by_object);
      CHECK(by_picture > 100);
      CHECK(by_object >= by_picture);
    }
  }
}
