// What does the geometry pass of a frame cost once clusters are in bins? One thread; counters, of the least time that
// each tile took in any round, so that what else the machine does falls out: core ms a frame for visibility and for the
// surfaces of visible pixels, ns a covered pixel for these; clusters in bins. Rows "back" drop back faces. SIMD targets
// by --benchmark_filter: the name ends in one.
#include "raster/surfaces/surfaces.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <numeric>
#include <string>

#include "core/fp_env.h"
#include "core/simd/simd_target.h"
#include "raster/clusters/cluster_bins.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"

using namespace trueshade;

namespace {

constexpr int kTile = 64;

/// A frame up to its bins.
struct BinnedFrame {
  Scene scene;
  Pipeline pipeline;
  PreparedScene prepared;
  View view;
  ClusterBins bins;
  std::vector<TileRect> rect;

  BinnedFrame(const std::string& spec, const std::string& preset, CullFace cull, int width, int height)
      : scene(load_scene(spec)), pipeline(*preset_pipeline(preset)), prepared(scene) {
    pipeline.width = width;
    pipeline.height = height;
    pipeline.geometry.cull_face = cull;
    view = make_view(scene, pipeline);
    bin_clusters(scene, prepared.clusters(), view, kTile, true, 1, bins);
    for (int i = 0; i < int(bins.first.size()) - 1; ++i) {
      const int x = i % bins.tiles_x * kTile, y = i / bins.tiles_x * kTile;
      const auto in_tile = [](int v) { return std::clamp(v, 0, kTile); };
      rect.push_back({x, y, kTile, {0, 0, in_tile(width - x), in_tile(height - y)}});
    }
  }
  TileDraws draws(size_t i) const {
    return {prepared.clusters(), scene, view, pipeline.geometry, bins.draws, bins.tile_list(int(i)), true};
  }
};

/// Least times of tiles.
struct LeastTimes {
  std::vector<double> ns;
  template <class Run>
  void add(size_t tile, Run&& run) {
    const auto start = std::chrono::steady_clock::now();
    run();
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    ns[tile] = std::min(ns[tile], took.count());
  }
  double sum() const { return std::accumulate(ns.begin(), ns.end(), 0.0); }
};

const BinnedFrame& binned_frame(const std::string& spec, const std::string& preset, CullFace cull, int width,
                                int height) {
  static std::map<std::string, std::unique_ptr<BinnedFrame>> made;
  auto& slot = made[spec + preset + std::to_string(int(cull)) + std::to_string(width)];
  if (!slot) slot = std::make_unique<BinnedFrame>(spec, preset, cull, width, height);
  return *slot;
}

void geometry(benchmark::State& state, const std::string& spec, const std::string& preset, CullFace cull, int width,
              int height, const std::string& target) {
  const FpScope fp;
  const SimdScope simd(target);
  const BinnedFrame& in = binned_frame(spec, preset, cull, width, height);
  const GBufferState planes = surface_planes(in.pipeline);
  const auto visible = std::make_unique<VisibilityTile>();
  const auto surface = std::make_unique<SurfaceTile>();
  const auto work = std::make_unique<VisibleVertices>();
  const std::vector<double> never(in.rect.size(), 1e30);
  LeastTimes visibility{never}, surfaces{never};
  int64_t pixels = 0;
  for (auto _ : state) {
    pixels = 0;
    for (size_t i = 0; i < in.rect.size(); ++i) {
      RasterCounts counts;
      visibility.add(i, [&] { draw_visibility(in.draws(i), in.rect[i], true, *visible, counts); });
      surfaces.add(i, [&] {
        resolve_surfaces(in.draws(i), in.rect[i], planes, in.pipeline.light_model, *visible, UvPlanes::omitted, *work,
                         *surface);
      });
      pixels += surface->covered_pixels;
    }
  }
  state.counters["visibility ms"] = visibility.sum() * 1e-6;
  state.counters["surfaces ms"] = surfaces.sum() * 1e-6;
  state.counters["clusters"] = double(in.bins.draws.size());
  state.counters["ns/pixel"] = surfaces.sum() / double(pixels);
}

}  // namespace

int main(int argc, char** argv) {
  struct Row {
    const char *scene, *preset;
    CullFace cull = CullFace::none;
  };
  const Row rows[] = {{"builtin:city", "many-lights"},    {"builtin:sphere", "many-lights"},
                      {"builtin:rabbits", "many-lights"}, {"builtin:rabbits", "many-lights", CullFace::back},
                      {"builtin:red", "many-lights"},     {"builtin:red", "many-lights", CullFace::back},
                      {"builtin:red", "redsdk"}};
  for (const auto& [scene, preset, cull] : rows)
    for (const auto& [width, height] : {std::pair(800, 800), std::pair(1920, 1080)})
      for (const std::string_view target : simd_targets())
        benchmark::RegisterBenchmark(
            (std::string(scene) + " " + preset + (cull == CullFace::back ? " back " : " ") + std::to_string(width) +
             " " + std::string(target))
                .c_str(),
            [=, scene = scene, preset = preset, cull = cull, width = width, height = height](benchmark::State& state) {
              geometry(state, scene, preset, cull, width, height, std::string(target));
            })
            ->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
