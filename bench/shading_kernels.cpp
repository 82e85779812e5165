// What does each kernel of lights, blending and lookups cost an item? One thread, one tile of a level floor; the
// counter is the time of one item.
//   sum, blended    a pixel-light of each preset's model, added in float or blended into rgba8; `general` by the kernel
//                   that reads the model's shape when it runs
//   left out        a pixel-light of lights that reach the tile's box and face away
//   lists           a light of 100,000 that are looked up for a tile of 16 regions, most of which reach none
//   blend           a pixel of a light draw by target format: ONE + ONE, and one of general factors
//   store           a pixel of a tile into the image, rounded or as blending left it
//   table, groups, outlines   a light, before the tiles
//   lookup          a texture lookup, by filter and format
//   power           x^p of an exponent that is no integer
//   picture         a pixel of the post chain's passes; a byte hashed
// SIMD targets by --benchmark_filter: names of what has kernels end in one.
#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>

#include "core/fp_env.h"
#include "core/simd/simd_target.h"
#include "raster/textures/texture.h"
#include "scenes/pipeline/presets.h"
#include "shading/blend/blend_pass.h"
#include "shading/sum/light_pass.h"
#include "shading/output/post.h"
#include "shading/light/power.h"
#include "shading/output/target.h"
#include "shading/blend/transparent_blend.h"

using namespace trueshade;

namespace {

constexpr int kTile = 64, kPixels = kTile * kTile, kLights = 64;

/// A level floor of 64 x 64 units that fills a tile, one unit a pixel, seen from above.
std::unique_ptr<SurfaceTile> level_floor() {
  auto out = std::make_unique<SurfaceTile>();  // of zeros
  out->covered_pixels = kPixels;
  for (int i = 0; i < kPixels; ++i) {
    out->covered[i] = -1;
    out->plane[kPosition][i] = float(i % kTile), out->plane[kPosition + 1][i] = float(i / kTile);
    out->plane[kNormal + 2][i] = 1.0f;
    for (int c = 0; c < 4; ++c) out->plane[kAlbedo + c][i] = 0.5f;
    for (int c = 0; c < 3; ++c) out->plane[kSpecular + c][i] = 0.25f;
    out->plane[kSpecular + 3][i] = 32.0f;
  }
  return out;
}

/// Spot lights at a height over a floor, shining down; all of them reach all of it.
std::vector<Light> lights_at(float height, int count = kLights) {
  std::vector<Light> out(size_t(count), Light{});
  for (int i = 0; i < count; ++i) {
    Light& light = out[size_t(i)];
    light.type = LightType::spot;
    light.position = {float(i * 37 % kTile), float(i * 11 % kTile), height};
    light.color = glm::vec3(1.0f / kLights);
    light.range = 200.0f;
    light.attenuation = {1.0f, 0.01f, 0.001f};
    light.cone_rad = 1.2f, light.penumbra_rad = 0.3f, light.spot_exponent = 2.0f;
  }
  return out;
}

void per_item(benchmark::State& state, double items, const std::function<void()>& run) {
  const FpScope fp;
  for (auto _ : state) run();
  state.counters["item"] =
      benchmark::Counter(items, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// A frame of one tile, up to its lights.
struct LitTile {
  std::unique_ptr<SurfaceTile> surface = level_floor();
  std::vector<Light> lights;
  Scene scene;
  Pipeline pipeline;
  View view;
  LightTable table;
  LightClusters clusters;
  LightMeshes meshes;
  LightOutlines outlines;
  std::unique_ptr<ColorTile> color = std::make_unique<ColorTile>();
  LightLists lists;
  BlendWork blend;
  LightCounts counts;

  LitTile(const Preset& preset, Strategy strategy, std::vector<Light> all)
      : lights(std::move(all)), pipeline(preset.pipeline), meshes(pipeline.light_volumes) {
    pipeline.strategy = strategy;
    pipeline.width = pipeline.height = kTile;
    pipeline.light_volumes.point = pipeline.light_volumes.spot = LightExtent::unbounded;
    scene.camera.clip_from_world = std::array<float, 16>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 1};
    view = make_view(scene, pipeline);
    table = make_light_table(lights, pipeline.light_model, scene.camera);
    if (blends_lights(strategy)) outlines = make_light_outlines(lights, pipeline, meshes, view, 1);
  }
  void draw(bool compiled) {
    constexpr float kClear[4] = {};
    LightVolumeDraws draws = light_volume_draws(lights, pipeline, {}, table, clusters, meshes, outlines, view);
    draws.compiled = compiled;
    if (blends_lights(pipeline.strategy))
      blend_tile(draws, *surface, nullptr, {0, 0, kTile, {0, 0, kTile, kTile}}, kClear, blend, *color, counts);
    else
      light_tile(*surface, kTile, table, clusters, pipeline.light_model, kClear,
                 {.compiled = compiled, .codes = pipeline.target}, lists, *color, counts);
  }
};

void light(benchmark::State& state, const Preset& preset, Strategy strategy, float height, bool compiled,
           std::string_view target) {
  const SimdScope simd(target);
  LitTile tile(preset, strategy, lights_at(height));
  per_item(state, double(kPixels) * kLights, [&] { tile.draw(compiled); });
}

void lists(benchmark::State& state, std::string_view target) {
  constexpr int kMany = 100000;
  const SimdScope simd(target);
  LitTile tile(presets()[0], Strategy::deferred_loop, lights_at(4.0f, kMany));
  for (int i = 0; i < kMany; ++i) {  // over a floor of 316 x 316 units, of which the tile is a corner
    Light& l = tile.lights[size_t(i)];
    l.position = {float(i % 316), float(i / 316), 1.0f};
    l.range = 2.0f;
  }
  make_light_table(tile.lights, tile.pipeline.light_model, tile.scene.camera, 1, tile.table);
  make_light_clusters(tile.table, 1, tile.clusters);
  per_item(state, kMany, [&] { tile.draw(true); });
}

void blend(benchmark::State& state, Format format, const BlendState& blending, std::string_view target) {
  const SimdScope simd(target);
  alignas(64) static float source[4][kPixels], stored[4][kPixels];
  for (int i = 0; i < kPixels; ++i)
    for (auto& plane : source) plane[i] = float(i % 97) * 0x1p-12f;
  const float* const from[4] = {source[0], source[1], source[2], source[3]};
  float* const to[4] = {stored[0], stored[1], stored[2], stored[3]};
  per_item(state, kPixels, [&] { blend_pixels(blending, {format}, from, to, kPixels); });
}

void store(benchmark::State& state, Format format, bool as_is, std::string_view target) {
  const SimdScope simd(target);
  auto color = std::make_unique<ColorTile>();
  for (auto& plane : color->plane)
    for (int i = 0; i < kPixels; ++i) plane[i] = float(i % 97) / 97.0f;
  Image image(kTile, kTile, format);
  const TileRect all{0, 0, kTile, {0, 0, kTile, kTile}};
  if (as_is) encode_colors({format}, kPixels, *color);
  per_item(state, kPixels, [&] {
    if (as_is)
      write_stored(*color, all, image);
    else
      store_target(*color, all, HalfRound::toward_zero, image);
  });
}

void prepare(benchmark::State& state, const std::string& what) {
  constexpr int kMany = 20000;
  LitTile tile(presets()[0], Strategy::deferred_volumes, lights_at(4.0f, kMany));
  tile.pipeline.light_volumes.spot = LightExtent::box;
  for (Light& l : tile.lights) {  // into the view, which is of [-1, 1]
    l.position = (l.position - float(kTile / 2)) / float(kTile / 2) * 0.9f;
    l.position.z = 0.5f, l.range = 0.1f;
  }
  make_light_table(tile.lights, tile.pipeline.light_model, tile.scene.camera, 1, tile.table);
  per_item(state, kMany, [&] {
    if (what == "table") make_light_table(tile.lights, tile.pipeline.light_model, tile.scene.camera, 1, tile.table);
    if (what == "groups") {
      tile.clusters.made_of = 0;  // of no table that it knows
      make_light_clusters(tile.table, 1, tile.clusters);
    }
    if (what == "outlines")
      benchmark::DoNotOptimize(make_light_outlines(tile.lights, tile.pipeline, tile.meshes, tile.view, 1).edges.data());
  });
}

void lookup(benchmark::State& state, TextureFormat format, Filter filter, MipFilter mip, std::string_view target) {
  const SimdScope simd(target);
  constexpr int kSide = 256;
  Texture texture{"", format, {{kSide, kSide, {}}}};
  for (int i = 0; i < kSide * kSide; ++i) {
    const float value = float(i * 7919 % 256) / 255.0f;
    append_texel(format, {value, value, value, 1.0f}, texture.levels[0].bytes);
  }
  build_mip_chain(texture);
  Sampler sampler;
  sampler.mag_filter = sampler.min_filter = filter, sampler.mip_filter = mip;
  const TextureView view = view_of(texture, sampler);
  std::vector<TexturePoint> points(kPixels);
  std::vector<std::array<float, 4>> out(kPixels);
  for (int i = 0; i < kPixels; ++i)
    points[size_t(i)] = {float(i % kTile) * 0.011f, float(i / kTile) * 0.013f, 0.011, 0.0, 0.0, 0.013};
  per_item(state, kPixels, [&] { look_up(view, points, out); });
}

void powers(benchmark::State& state) {
  per_item(state, 1024, [] {
    for (int i = 0; i < 1024; ++i) benchmark::DoNotOptimize(power(double(i) / 1024.0, 7.3));
  });
}

void picture(benchmark::State& state, const std::string& what) {
  constexpr int kSide = 512;
  Picture in(kSide, kSide);
  for (size_t i = 0; i < in.values.size(); ++i) in.values[i] = float(i * 2654435761u % 1024) / 512.0f;
  const Image image = stored(in, Format::rgba8, HalfRound::toward_zero);
  const bool hash = what == "hash";
  per_item(state, hash ? double(image.texels.size()) : kSide * kSide, [&] {
    if (hash) benchmark::DoNotOptimize(image_hash(image));
    if (what == "bloom") add_bloom({}, 1, in);
    if (what == "srgb") encode_srgb(1, in);
    if (what == "edges") benchmark::DoNotOptimize(smoothed_edges(in, 1).values.data());
    if (what == "store") benchmark::DoNotOptimize(stored(in, Format::rgba8, HalfRound::toward_zero).texels.data());
  });
}

void row(const std::string& name, const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run);
}

void register_target(std::string_view target) {
  const std::string on = " " + std::string(target);
  for (const Preset& preset : presets())
    for (const bool compiled : {true, false}) {
      const std::string of = " " + std::string(preset.name) + (compiled ? "" : " (general)") + on;
      row("sum, a pixel-light" + of,
          [=, &preset](auto& s) { light(s, preset, Strategy::deferred_loop, 4.0f, compiled, target); });
      row("blended, a pixel-light" + of,
          [=, &preset](auto& s) { light(s, preset, Strategy::deferred_volumes, 4.0f, compiled, target); });
    }
  const Preset& seldom =
      *std::find_if(presets().begin(), presets().end(), [](const Preset& p) { return p.name == "light-volumes"; });
  row("left out, a pixel-light" + on,
      [=, &seldom](auto& s) { light(s, seldom, Strategy::deferred_volumes, -4.0f, true, target); });
  row("lists, a light" + on, [=](auto& s) { lists(s, target); });
  BlendState general = kAddLight;
  general.rgb.src = BlendFactor::src_alpha, general.rgb.dst = BlendFactor::one_minus_src_alpha;
  for (const Format format : kTargetFormats) {
    const std::string of = std::string(info(format).name) + on;
    row("store, a pixel " + of, [=](auto& s) { store(s, format, false, target); });
    row("store as blended, a pixel " + of, [=](auto& s) { store(s, format, true, target); });
    row("blend, a pixel " + of, [=](auto& s) { blend(s, format, kAddLight, target); });
    row("blend by alpha, a pixel " + of, [=](auto& s) { blend(s, format, general, target); });
  }
  for (const auto& [format, name] :
       {std::pair(TextureFormat::rgba8, "rgba8"), std::pair(TextureFormat::srgb8_a8, "srgb8_a8"),
        std::pair(TextureFormat::rgba16f, "rgba16f")})
    for (const auto& [filter, mip, how] : {std::tuple(Filter::nearest, MipFilter::none, "nearest"),
                                           std::tuple(Filter::linear, MipFilter::none, "bilinear"),
                                           std::tuple(Filter::linear, MipFilter::linear, "trilinear")})
      row("lookup " + std::string(how) + " " + name + on,
          [=, format = format, filter = filter, mip = mip](auto& s) { lookup(s, format, filter, mip, target); });
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string_view target : simd_targets()) register_target(target);
  for (const std::string what : {"table", "groups", "outlines"})
    row(what + ", a light", [=](auto& s) { prepare(s, what); });
  row("power", powers);
  for (const std::string what : {"bloom", "srgb", "edges", "store", "hash"})
    row("picture, " + what, [=](auto& s) { picture(s, what); });
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
