// What does the light pass alone cost, over the surfaces of a frame? One thread; surfaces are made once. Counters, of
// the least time that each tile took in any round, so that what else the machine does falls out: core ms a frame, ns a
// computed pixel-light, ns a pixel-light left by tiles. SIMD targets by --benchmark_filter: the name ends in one.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <map>
#include <memory>
#include <string>

#include "core/fp_env.h"
#include "core/simd/simd_target.h"
#include "raster/clusters/cluster_bins.h"
#include "scenes/pipeline/presets.h"
#include "shading/blend/blend_pass.h"
#include "shading/frame.h"
#include "shading/sum/light_pass.h"

using namespace trueshade;

namespace {

/// All of a tile but what captures alone have.
void copy_planes(const SurfaceTile& from, SurfaceTile& to) {
  std::memcpy(static_cast<void*>(&to), &from, offsetof(SurfaceTile, captured));
  to.covered_pixels = from.covered_pixels, to.x = from.x, to.y = from.y;
}

constexpr int kTile = 64;

/// A frame up to its lights.
struct Surfaces {
  Scene scene;
  Pipeline pipeline;
  View view;
  LightTable lights;
  LightClusters clusters;
  LightMeshes meshes;
  LightOutlines outlines;
  std::vector<TileRect> rect;
  std::vector<std::unique_ptr<SurfaceTile>> tile;

  Surfaces(const std::string& spec, const std::string& preset)
      : scene(load_scene(spec)), pipeline(*preset_pipeline(preset)), meshes(pipeline.light_volumes) {
    const PreparedScene prepared(scene);
    view = make_view(scene, pipeline);
    lights = make_light_table(scene.lights, pipeline.light_model, scene.camera);
    bound_by_extents(lights, scene.lights, pipeline.light_volumes, pipeline.strategy == Strategy::deferred_volumes);
    clusters = make_light_clusters(lights, 1);
    if (blends_lights(pipeline.strategy)) outlines = make_light_outlines(scene.lights, pipeline, meshes, view, 1);
    ClusterBins bins;
    bin_clusters(scene, prepared.clusters(), view, kTile, true, 1, bins);
    const auto visible = std::make_unique<VisibilityTile>();
    VisibleVertices vertices;
    for (int i = 0; i < int(bins.first.size()) - 1; ++i) {
      const int x = i % bins.tiles_x * kTile, y = i / bins.tiles_x * kTile;
      const auto in_tile = [](int v) { return std::clamp(v, 0, kTile); };
      rect.push_back({x, y, kTile, {0, 0, in_tile(pipeline.width - x), in_tile(pipeline.height - y)}});
      tile.push_back(std::make_unique<SurfaceTile>());
      const TileDraws draws{prepared.clusters(), scene, view, pipeline.geometry, bins.draws, bins.tile_list(i)};
      RasterCounts counts;
      draw_visibility(draws, rect.back(), true, *visible, counts);
      resolve_surfaces(draws, rect.back(), surface_planes(pipeline), pipeline.light_model, *visible, UvPlanes::omitted,
                       vertices, *tile.back());
    }
  }

  LightVolumeDraws draws() const {
    return light_volume_draws(scene.lights, pipeline, {}, lights, clusters, meshes, outlines, view);
  }
};

const Surfaces& surfaces(const std::string& spec, const std::string& preset) {
  static std::map<std::string, std::unique_ptr<Surfaces>> made;
  auto& slot = made[spec + preset];
  if (!slot) slot = std::make_unique<Surfaces>(spec, preset);
  return *slot;
}

void light(benchmark::State& state, const std::string& spec, const std::string& preset, const std::string& target) {
  const FpScope fp;
  const SimdScope simd(target);
  const Surfaces& in = surfaces(spec, preset);
  const LightVolumeDraws draws = in.draws();
  const bool blends = blends_lights(in.pipeline.strategy);
  const auto color = std::make_unique<ColorTile>();
  const auto surface = std::make_unique<SurfaceTile>();
  BlendWork blend;
  LightLists lists;
  constexpr float kClear[4] = {};
  std::vector<double> least(in.tile.size(), 1e30);
  LightCounts counts;
  for (auto _ : state) {
    counts = {};
    for (size_t i = 0; i < in.tile.size(); ++i) {
      copy_planes(*in.tile[i], *surface);  // as near in the caches as when it has just been resolved
      const auto start = std::chrono::steady_clock::now();
      if (blends)
        blend_tile(draws, *surface, nullptr, in.rect[i], kClear, blend, *color, counts);
      else
        light_tile(*surface, kTile, in.lights, in.clusters, in.pipeline.light_model, kClear,
                   {.codes = in.pipeline.target}, lists, *color, counts);
      least[i] = std::min(least[i],
                          std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());
    }
  }
  double sum = 0.0;
  for (const double ns : least) sum += ns;
  state.counters["core ms"] = sum * 1e-6;
  state.counters["ns/computed"] = sum / double(counts.evaluated_pairs);
  state.counters["ns/tile pair"] = sum / double(counts.tile_pairs);
  state.counters["computed"] = double(counts.evaluated_pairs);
}

}  // namespace

int main(int argc, char** argv) {
  const std::pair<const char*, const char*> rows[] = {{"builtin:city", "light-volumes"},
                                                      {"builtin:rabbits", "light-volumes"},
                                                      {"builtin:sphere", "light-volumes"},
                                                      {"builtin:red", "redsdk"},
                                                      {"builtin:city", "many-lights"},
                                                      {"builtin:rabbits", "many-lights"},
                                                      {"builtin:sphere", "many-lights"},
                                                      {"builtin:city", "touchdesigner"},
                                                      {"builtin:city,lights=10000,radius=overlap", "many-lights"},
                                                      {"builtin:city,lights=100000,radius=overlap", "many-lights"}};
  for (const auto& [scene, preset] : rows)
    for (const std::string_view target : simd_targets())
      benchmark::RegisterBenchmark((std::string(scene) + " " + preset + " " + std::string(target)).c_str(),
                                   [=, scene = scene, preset = preset](benchmark::State& state) {
                                     light(state, scene, preset, std::string(target));
                                   })
          ->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
