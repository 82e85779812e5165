// What does each kernel of the geometry pass cost an item? One thread; the counter is the time of one item.
//   clusters   a triangle of a mesh split into clusters, when a scene is loaded
//   bounds     a cluster of which bins are made
//   overdraw   a fragment that is counted
//   reject     a triangle transformed and found to cover nothing: sub-pixel ones, mostly between samples
//   small      a fragment of triangles of a few samples
//   large      a 4x4 block of triangles over whole tiles
//   masked     a fragment whose colour map says by its alpha whether it is drawn
//   clipped    a 4x4 block of triangles that cross the near plane, by wide edges
//   resolve    a pixel that sees one large triangle, or one of its own; mapped: with colour, specular and normal maps
// `general`: by the paths that the fast ones are held against. Names end in the SIMD target.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "raster/clusters/cluster_bins.h"
#include "raster/clusters/clusters.h"
#include "raster/visibility/overdraw.h"
#include "core/simd/simd_target.h"
#include "raster/surfaces/surfaces.h"
#include "raster/view.h"
#include "raster/visibility/visibility.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

using namespace trueshade;

namespace {

constexpr int kSize = 64;  // one tile

enum class Grid { plain, masked, mapped, clipped };

// One picture for all maps: normals nearly upright, half of the texels too thin for the mask.
void use_maps(Scene& scene, bool mask) {
  constexpr int kSide = 64;
  Texture texture{"", TextureFormat::rgba8, {{kSide, kSide, {}}}};
  for (int i = 0; i < kSide * kSide; ++i)
    append_texel(texture.format, {0.5f, 0.5f, 1.0f, i / 4 % 2 == 0 ? 1.0f : 0.2f}, texture.levels[0].bytes);
  build_mip_chain(texture);
  scene.textures.push_back(std::move(texture));
  Material& material = scene.materials[0];
  material.color_map.texture = 0;
  if (mask) {
    material.alpha_cutoff = 0.5f;
  } else {
    material.normal_map.texture = material.specular_map.texture = 0;
  }
}

// A square grid over the tile, tilted in depth, of `side` x `side` quads.
Scene grid_scene(int side, Grid kind) {
  Scene scene;
  scene.materials.resize(1);
  scene.instances.resize(1);
  Mesh mesh;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x) {
      const float position[3] = {2.0f * float(x) / float(side) - 1.0f, 2.0f * float(y) / float(side) - 1.0f,
                                 0.25f * float(x + y) / float(side)};
      for (size_t c = 0; c < 3; ++c) {
        mesh.position[c].push_back(position[c]);
        mesh.normal[c].push_back(c == 2 ? 1.0f : 0.0f);
      }
      mesh.uv[0].push_back(float(x) / float(side)), mesh.uv[1].push_back(float(y) / float(side));
    }
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto corner = uint32_t(y * (side + 1) + x), above = corner + uint32_t(side) + 1;
      for (const uint32_t index : {corner, corner + 1, above, corner + 1, above + 1, above})
        mesh.indices.push_back(index);
    }
  scene.meshes.push_back(std::move(mesh));
  scene.camera.clip_from_world = std::array<float, 16>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 1};
  // The lower left corner lies before the near plane.
  if (kind == Grid::clipped) (*scene.camera.clip_from_world)[14] = -1.001f;
  if (kind == Grid::clipped) (*scene.camera.clip_from_world)[10] = 4.0f;
  if (kind == Grid::masked || kind == Grid::mapped) use_maps(scene, kind == Grid::masked);
  return scene;
}

struct OneTile {
  Scene scene;
  ClusteredScene clusters;
  Pipeline pipeline;
  View view;
  ClusterBins bins;
  std::unique_ptr<VisibilityTile> visible = std::make_unique<VisibilityTile>();
  std::unique_ptr<SurfaceTile> surface = std::make_unique<SurfaceTile>();
  std::unique_ptr<VisibleVertices> work = std::make_unique<VisibleVertices>();
  RasterCounts counts;

  explicit OneTile(int side, Grid kind = Grid::plain) : scene(grid_scene(side, kind)), clusters(cluster_scene(scene)) {
    pipeline.width = pipeline.height = kSize;
    pipeline.light_model.specular_source = SpecularSource::material;  // reads the specular map
    view = make_view(scene, pipeline);
    bin();
  }
  void bin() { bin_clusters(scene, clusters, view, kSize, true, 1, bins); }
  TileDraws draws(bool fast) const {
    return {clusters, scene, view, pipeline.geometry, bins.draws, bins.tile_list(0), fast};
  }
  void draw(bool fast) { draw_visibility(draws(fast), {0, 0, kSize, {0, 0, kSize, kSize}}, true, *visible, counts); }
  void resolve(bool fast) {
    resolve_surfaces(draws(fast), {0, 0, kSize, {0, 0, kSize, kSize}}, pipeline.gbuffer, pipeline.light_model, *visible,
                     UvPlanes::omitted, *work, *surface);
  }
};

template <class Run>
void time(benchmark::State& state, double items, Run&& run) {
  for (auto _ : state) run();
  state.counters["item"] =
      benchmark::Counter(items, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void bounds(benchmark::State& state) {
  OneTile tile(1000);
  time(state, double(tile.clusters.meshes[0].clusters.size()), [&] { tile.bin(); });
}

void made(benchmark::State& state) {
  const Scene scene = grid_scene(300, Grid::plain);
  time(state, double(scene.triangle_count()),
       [&] { benchmark::DoNotOptimize(cluster_scene(scene).meshes[0].clusters.data()); });
}

void overdraw(benchmark::State& state) {
  OneTile tile(48);
  std::vector<uint32_t> counts(kSize * kSize);
  time(state, kSize * kSize, [&] {
    count_fragments(tile.draws(true), {0, 0, kSize, {0, 0, kSize, kSize}}, counts.data());
  });
}

void reject(benchmark::State& state, bool fast) {
  OneTile tile(600);  // 720,000 triangles for 4,096 samples
  time(state, double(tile.scene.triangle_count()), [&] { tile.draw(fast); });
}

void small(benchmark::State& state, bool fast) {
  OneTile tile(48);
  time(state, kSize * kSize, [&] { tile.draw(fast); });
}

void masked(benchmark::State& state, bool fast) {
  OneTile tile(48, Grid::masked);
  time(state, kSize * kSize, [&] { tile.draw(fast); });
}

void large(benchmark::State& state, Grid kind, bool fast) {
  OneTile tile(1, kind);
  time(state, kSize * kSize / kBlockPixels, [&] { tile.draw(fast); });
}

void resolve(benchmark::State& state, int side, Grid kind, bool fast) {
  OneTile tile(side, kind);
  tile.draw(fast);
  time(state, kSize * kSize, [&] { tile.resolve(fast); });
}

}  // namespace

int main(int argc, char** argv) {
  const auto row = [](const std::string& name, auto run) { benchmark::RegisterBenchmark(name.c_str(), run); };
  row("clusters, a triangle", made);
  for (const std::string_view target : simd_targets()) {
    const auto on = [&](const std::string& name, auto run) {
      row(name + ' ' + std::string(target), [=](benchmark::State& s) {
        const SimdScope simd(target);
        run(s);
      });
    };
    on("bounds, a cluster", bounds);
    on("overdraw, a fragment", overdraw);
    for (const bool fast : {true, false}) {
      const std::string how = fast ? "" : " (general)";
      on("reject, a triangle" + how, [=](auto& s) { reject(s, fast); });
      on("small, a fragment" + how, [=](auto& s) { small(s, fast); });
      on("large, a block" + how, [=](auto& s) { large(s, Grid::plain, fast); });
      on("clipped, a block" + how, [=](auto& s) { large(s, Grid::clipped, fast); });
      on("masked, a fragment" + how, [=](auto& s) { masked(s, fast); });
      on("resolve large, a pixel" + how, [=](auto& s) { resolve(s, 4, Grid::plain, fast); });
      on("resolve small, a pixel" + how, [=](auto& s) { resolve(s, 64, Grid::plain, fast); });
      on("resolve mapped, a pixel" + how, [=](auto& s) { resolve(s, 4, Grid::mapped, fast); });
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
