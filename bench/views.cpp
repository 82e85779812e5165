// What do views and transparent layers cost an item? One thread; the counter is the time of one item.
//   paint      a pixel of a view, of planes that are there
//   draw       a triangle of lights' boxes or of their bars, drawn upon a frame's depths; `general` by the path that the
//              fast ones are held against
//   layers     a fragment of glass over a tile, found; found and blended into the albedo; found, lit and blended
// SIMD targets by --benchmark_filter: names of what has kernels end in one.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/fp_env.h"
#include "raster/clusters/cluster_bins.h"
#include "core/simd/simd_target.h"
#include "scenes/light_shapes.h"
#include "scenes/pipeline/presets.h"
#include "shading/output/derived_planes.h"
#include "shading/frame.h"
#include "shading/output/heat_map.h"
#include "shading/output/overlay.h"
#include "shading/blend/transparent_blend.h"
#include "shading/blend/transparent_pass.h"
#include "shading/output/view_image.h"

using namespace trueshade;

namespace {

template <class Run>
void per_item(benchmark::State& state, double items, Run&& run) {
  for (auto _ : state) run();
  state.counters["item"] =
      benchmark::Counter(items, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// City, and planes of its frame.
struct City {
  Scene scene = load_scene("builtin:city,lights=100");
  Pipeline pipeline = *preset_pipeline("many-lights");
  std::vector<NamedImage> planes;

  City() {
    pipeline.width = pipeline.height = 512;
    std::vector<std::string> names{"id.object", "depth", "light.count", "overdraw"};
    for (const ImageView view : kPainted)
      for (const std::string& name : planes_of_view(view)) names.push_back(name);
    planes = render_frame(scene, pipeline, {.threads = 1}, names).aovs;
  }
  double pixels() const { return double(pipeline.width) * pipeline.height; }

  static constexpr ImageView kPainted[] = {ImageView::albedo, ImageView::specular, ImageView::depth,
                                           ImageView::normal, ImageView::position, ImageView::uv};
};

const City& city() {
  static const City made;
  return made;
}

void paint(benchmark::State& state, ImageView view) {
  const FpScope fp;
  per_item(state, city().pixels(), [&] {
    if (const std::string_view counts = heat_plane(view); !counts.empty())
      benchmark::DoNotOptimize(heat_image(plane_named(city().planes, counts), 64).texels.data());
    else
      benchmark::DoNotOptimize(view_image(view, 1, city().planes).texels.data());
  });
}

void boxes(benchmark::State& state, bool bars, bool fast, std::string_view target) {
  const FpScope fp;
  const SimdScope simd(target);
  const Scene scene = bars ? light_box_edges(city().scene) : light_boxes(city().scene);
  const Execution execution{.threads = 1, .simd = target, .fast_geometry = fast};
  const Image& depth = plane_named(city().planes, "depth");
  per_item(state, double(scene.triangle_count()), [&] {
    benchmark::DoNotOptimize(overlay(scene, city().pipeline, execution, depth).texels.data());
  });
}

/// A tile that sees an opaque square through four of glass.
struct GlassTile {
  static constexpr int kTile = 64, kLayers = 4;
  Scene scene;
  Pipeline pipeline = *preset_pipeline("many-lights");
  ClusteredScene clusters;
  View view;
  ClusterBins bins;
  std::unique_ptr<VisibilityTile> visible = std::make_unique<VisibilityTile>();
  std::unique_ptr<SurfaceTile> surface = std::make_unique<SurfaceTile>();
  std::unique_ptr<ColorTile> color = std::make_unique<ColorTile>();
  std::unique_ptr<VisibleVertices> vertices = std::make_unique<VisibleVertices>();
  std::unique_ptr<TransparentWork> work = std::make_unique<TransparentWork>();
  LightLists lists;
  RasterCounts counts;
  TileRect rect{0, 0, kTile, {0, 0, kTile, kTile}};

  explicit GlassTile(TransparencyMode mode) {
    Mesh square;
    for (int k = 0; k < 4; ++k) {
      const float corner[3] = {k % 2 == 0 ? -1.0f : 1.0f, k / 2 == 0 ? -1.0f : 1.0f, 0.0f};
      for (size_t c = 0; c < 3; ++c)
        square.position[c].push_back(corner[c]), square.normal[c].push_back(c == 2 ? 1.0f : 0.0f);
    }
    square.indices = {0, 1, 2, 1, 3, 2};
    scene.meshes.push_back(std::move(square));
    scene.materials = {{"wall", {0.5f, 0.5f, 0.5f, 1.0f}}, {"glass", {0.9f, 0.7f, 0.5f, 0.25f}}};
    scene.materials[1].transparent = true;
    for (uint32_t i = 0; i <= kLayers; ++i) {
      glm::mat4x3 place(1.0f);
      place[3][2] = -0.1f * float(i);  // nearer, layer by layer
      scene.instances.push_back({0, i == 0 ? 0u : 1u, place});
    }
    for (int i = 0; i < 16; ++i) {
      Light light{};
      light.position = {float(i % 4) / 2.0f - 0.75f, float(i / 4) / 2.0f - 0.75f, 0.5f}, light.range = 1.0f;
      scene.lights.push_back(light);
    }
    scene.camera.clip_from_world = std::array<float, 16>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 1};
    pipeline.width = pipeline.height = kTile;
    pipeline.transparency.mode = mode;
    clusters = cluster_scene(scene);
    view = make_view(scene, pipeline);
    bin_clusters(scene, clusters, view, kTile, true, 1, bins);
  }
  TileDraws all() const { return {clusters, scene, view, pipeline.geometry, bins.draws, bins.tile_list(0)}; }
};

enum class Glass { found, into_albedo, lit };

void layers(benchmark::State& state, Glass what, std::string_view target) {
  const FpScope fp;
  const SimdScope simd(target);
  GlassTile t(what == Glass::lit ? TransparencyMode::after_lights : TransparencyMode::into_albedo);
  const Execution execution{.threads = 1, .simd = target};
  const TransparentPass pass(t.scene, t.pipeline, nullptr, execution);
  const TileDraws all = t.all(), opaque = pass.opaque_draws(all, *t.work);
  draw_visibility(opaque, t.rect, true, *t.visible, t.counts);
  resolve_surfaces(opaque, t.rect, surface_planes(t.pipeline), t.pipeline.light_model, *t.visible, UvPlanes::omitted,
                   *t.vertices,
                   *t.surface);
  encode_colors({t.pipeline.target}, GlassTile::kTile * GlassTile::kTile, *t.color);
  per_item(state, double(GlassTile::kLayers) * GlassTile::kTile * GlassTile::kTile, [&] {
    if (pass.find_fragments(all, t.rect, true, *t.visible, *t.work) == 0) state.SkipWithError("no fragments");
    if (what == Glass::into_albedo) pass.blend_into_albedo(all, t.rect, *t.vertices, *t.work, *t.surface);
    if (what == Glass::lit) pass.blend_after_lights(all, t.rect, execution, *t.vertices, t.lists, *t.work, *t.color);
  });
}

void row(const std::string& name, const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run);
}

}  // namespace

int main(int argc, char** argv) {
  for (const ImageView view : City::kPainted)
    row("paint " + std::string(kViewNames[size_t(view)]) + ", a pixel", [=](auto& s) { paint(s, view); });
  for (const ImageView view : {ImageView::light_count, ImageView::overdraw})
    row("paint " + std::string(kViewNames[size_t(view)]) + ", a pixel", [=](auto& s) { paint(s, view); });
  for (const std::string_view target : simd_targets()) {
    const std::string on = ' ' + std::string(target);
    for (const bool bars : {true, false}) {
      const std::string of = bars ? "bars" : "boxes";
      row("draw " + of + ", a triangle" + on, [=](auto& s) { boxes(s, bars, true, target); });
      row("draw " + of + ", a triangle (general)" + on, [=](auto& s) { boxes(s, bars, false, target); });
    }
    row("layers found, a fragment" + on, [=](auto& s) { layers(s, Glass::found, target); });
    row("layers in the albedo, a fragment" + on, [=](auto& s) { layers(s, Glass::into_albedo, target); });
    row("layers lit, a fragment" + on, [=](auto& s) { layers(s, Glass::lit, target); });
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
