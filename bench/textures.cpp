// What do a frame's maps cost? 81 boxes on a plane under 121 lights at 400x400, maps of 512x512 texels read with
// trilinear filters. One thread; counters, of the least time that each tile took in any frame, so that what else the
// machine does falls out: core ms a frame, of the fastest frame those of its parts. The row without maps is what the
// others are held against. SIMD targets by --benchmark_filter: the name ends in one.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <string>

#include "core/simd/simd_target.h"
#include "scenes/pipeline/presets.h"
#include "scenes/shapes.h"
#include "scenes/builtin/texture_pattern.h"
#include "shading/frame.h"

using namespace trueshade;

namespace {

enum Maps : int { kNone, kColor, kColorAndNormal, kMasked, kRows };
constexpr const char* kNames[kRows] = {"no maps", "colour", "colour and normal", "masked"};

Texture with_levels(Pattern pattern, TextureFormat format, const glm::vec4& first, const glm::vec4& second) {
  TexturePattern made{pattern, 512, 512, format, {first, second}, 8, 8, 1};
  Texture texture = texture_of(made);
  build_mip_chain(texture);
  return texture;
}

Scene boxes(Maps maps) {
  constexpr int kBoxes = 9, kLights = 11;
  Scene scene;
  Mesh plane = plane_mesh(14), box = cube_mesh();
  add_face_uv(plane);
  add_face_uv(box);
  for (auto& coordinates : plane.uv)
    for (float& value : coordinates) value *= 8.0f;
  scene.meshes = {plane, box};
  const glm::vec4 light{0.9f, 0.85f, 0.8f, 1.0f}, dark{0.3f, 0.25f, 0.2f, maps == kMasked ? 0.0f : 1.0f};
  scene.textures = {
      with_levels(Pattern::noise, TextureFormat::srgb8_a8, light, dark),
      with_levels(Pattern::noise, TextureFormat::rgba8, {0.7f, 0.6f, 1.0f, 1.0f}, {0.3f, 0.4f, 0.9f, 1.0f})};
  Material material;
  if (maps != kNone) material.color_map.texture = 0;
  if (maps == kColorAndNormal) material.normal_map.texture = 1;
  if (maps == kMasked) material.alpha_cutoff = 0.3f;
  scene.materials = {material};
  scene.instances.push_back({0, 0, placed({0.0, 0.0, 0.0}, glm::dvec3(24.0))});
  for (int i = 0; i < kBoxes * kBoxes; ++i)
    scene.instances.push_back(
        {1, 0, placed({(i % kBoxes - 4) * 2.0, 0.6, (i / kBoxes - 4) * 2.0}, glm::dvec3(1.2), 0.3 * i)});
  for (int i = 0; i < kLights * kLights; ++i) {
    Light lamp;
    lamp.position = {float(i % kLights - 5) * 1.8f, 1.7f, float(i / kLights - 5) * 1.8f};
    lamp.color = {0.4f + float(i % 3) * 0.3f, 0.7f, 0.4f + float(i % 5) * 0.15f};
    lamp.range = 2.2f;
    scene.lights.push_back(lamp);
  }
  scene.camera.eye = {0.0f, 9.0f, 13.0f};
  scene.camera.target = {0.0f, 0.0f, 0.0f};
  scene.camera.far = 100.0f;
  validate(scene);
  return scene;
}

void draw(benchmark::State& state, Maps maps, std::string_view target) {
  static std::map<Maps, std::unique_ptr<Scene>> scenes;
  auto& scene = scenes[maps];
  if (!scene) scene = std::make_unique<Scene>(boxes(maps));
  const PreparedScene prepared(*scene);
  Pipeline pipeline = *preset_pipeline("many-lights");
  pipeline.width = pipeline.height = 400;
  Execution execution;
  execution.threads = 1;
  execution.tile = 64;
  execution.simd = target;
  std::vector<double> least;
  double visibility = 1e30, surfaces = 1e30, light = 1e30;
  for (auto _ : state) {
    const FrameStats stats = render_frame(prepared, pipeline, execution).stats;
    least.resize(stats.tile_ms.size(), 1e30);
    for (size_t i = 0; i < least.size(); ++i) least[i] = std::min(least[i], stats.tile_ms[i].sum());
    visibility = std::min(visibility, stats.core_ms.visibility);
    surfaces = std::min(surfaces, stats.core_ms.surfaces);
    light = std::min(light, stats.core_ms.light);
    state.counters["covered"] = double(stats.covered_pixels);
  }
  state.counters["core ms"] = std::accumulate(least.begin(), least.end(), 0.0);
  state.counters["visibility ms"] = visibility;
  state.counters["surfaces ms"] = surfaces;
  state.counters["light ms"] = light;
}

}  // namespace

int main(int argc, char** argv) {
  for (int maps = 0; maps < kRows; ++maps)
    for (const std::string_view target : simd_targets())
      benchmark::RegisterBenchmark((std::string(kNames[maps]) + " " + std::string(target)).c_str(),
                                   [=](benchmark::State& state) { draw(state, Maps(maps), target); })
          ->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
