// Transparent surfaces against a naive twin: every triangle drawn alone, as if opaque, and its fragments blended one by
// one by the scalar oracle where a depth comparison lets them through.
#include <algorithm>
#include <bit>
#include <vector>

#include "core/simd/simd_target.h"
#include "oracle/blend.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/raster/random_frame.h"
#include "tests/shading/blend_pixels.h"
#include "tests/stated_presets.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

using oracle::Rgba;
constexpr TransparencyMode kIntoAlbedo = TransparencyMode::into_albedo, kAfterLights = TransparencyMode::after_lights;

/// What a pixel's texel holds: codes, or the floats.
Rgba stored_at(const Image& image, int x, int y) {
  const FormatInfo layout = info(image.format);
  Rgba out{0, 0, 0, 1};
  for (int c = 0; c < layout.channels; ++c)
    out[size_t(c)] =
        layout.number_class == NumberClass::unorm ? float(image.code(x, y, c)) : float(image.value(x, y, c));
  return out;
}

bool passes(DepthFunc func, double z, double there) {
  const bool less = z<there, equal = z == there, greater = z> there;
  const bool lets[] = {false, less, equal, less || equal, greater, less || greater, greater || equal, true};
  return lets[size_t(func)];
}

/// One triangle of an instance and nothing else.
Scene alone(const Scene& scene, const Instance& instance, size_t triangle) {
  Scene out = scene;
  out.instances = {instance};
  out.instances[0].mesh = 0;
  Mesh mesh = scene.meshes[instance.mesh];
  mesh.indices.assign(&scene.meshes[instance.mesh].indices[3 * triangle],
                      &scene.meshes[instance.mesh].indices[3 * triangle] + 3);
  out.meshes = {mesh};
  return out;
}

/// The image of a mode, or its albedo plane, made of frames without transparency.
struct Twin {
  Image plane;
  size_t blended = 0;  ///< fragments
};

Twin naive(const Scene& scene, const Pipeline& pipeline) {
  const bool albedo = pipeline.transparency.mode == kIntoAlbedo;
  const std::string aovs[] = {"depth", "albedo", "id.object"};
  Pipeline plain = pipeline;
  plain.transparency.mode = TransparencyMode::none;
  Scene opaque = scene;
  std::erase_if(opaque.instances, [&](const Instance& i) { return scene.materials[i.material].transparent; });
  const Frame under = render_frame(opaque, plain, {}, aovs);
  Twin twin{albedo ? under.aovs[1].image : under.color};
  std::vector<Rgba> stored;
  for (int y = 0; y < twin.plane.height; ++y)
    for (int x = 0; x < twin.plane.width; ++x) stored.push_back(stored_at(twin.plane, x, y));

  Pipeline fragment = plain;  // whose frame of a triangle is what its fragments write
  fragment.strategy = Strategy::forward_loop;
  fragment.target = Format::rgba32f;
  fragment.light_model.alpha_from_albedo = true;
  fragment.geometry.depth_func = DepthFunc::always;
  for (const Instance& instance : scene.instances) {
    if (!scene.materials[instance.material].transparent) continue;
    for (size_t t = 0; t < scene.meshes[instance.mesh].triangle_count(); ++t) {
      const Frame drawn = render_frame(alone(scene, instance, t), fragment, {}, aovs);
      for (int y = 0; y < pipeline.height; ++y)
        for (int x = 0; x < pipeline.width; ++x) {
          if (drawn.aovs[2].image.value(x, y, 0) == 0) continue;
          if (!passes(pipeline.geometry.depth_func, drawn.aovs[0].image.value(x, y, 0),
                      under.aovs[0].image.value(x, y, 0)))
            continue;
          ++twin.blended;
          if (albedo && under.aovs[2].image.value(x, y, 0) == 0) continue;
          Rgba& pixel = stored[size_t(y) * size_t(pipeline.width) + size_t(x)];
          pixel = oracle::blended_pixel(pipeline.transparency.blend, pipeline.profile, twin.plane.format,
                                        pipeline.gbuffer.half_round,
                                        stored_at(albedo ? drawn.aovs[1].image : drawn.color, x, y), pixel);
        }
    }
  }
  const FormatInfo layout = info(twin.plane.format);
  twin.plane.format = Format::rgba32f;  // of what is stored
  Image held(pipeline.width, pipeline.height, Format::rgba32f);
  for (int y = 0; y < held.height; ++y)
    for (int x = 0; x < held.width; ++x)
      for (int c = 0; c < layout.channels; ++c)
        held.set_code(x, y, c, std::bit_cast<uint32_t>(stored[size_t(y * held.width + x)][size_t(c)]));
  twin.plane = held;
  return twin;
}

void compare(const Scene& scene, const Pipeline& pipeline, size_t& blended) {
  const Twin twin = naive(scene, pipeline);
  const bool albedo = pipeline.transparency.mode == kIntoAlbedo;
  const std::string aovs[] = {"albedo"};
  const Frame frame = render_frame(scene, pipeline, {}, aovs);
  const Image& ours = albedo ? frame.aovs[0].image : frame.color;
  CHECK(frame.stats.transparent_fragments == twin.blended);
  blended += twin.blended;
  for (int y = 0; y < ours.height; ++y)
    for (int x = 0; x < ours.width; ++x)
      for (int c = 0; c < info(ours.format).channels; ++c) {
        const float found = stored_at(ours, x, y)[size_t(c)], expected = stored_at(twin.plane, x, y)[size_t(c)];
        if (same(found, expected)) continue;
        CAPTURE(x, y, c, found, expected, info(ours.format).name, name_of(pipeline.strategy), pipeline.preset);
        REQUIRE(same(found, expected));
      }
}

void add_lights(Random& random, Scene& scene) {
  for (int i = 0; i < 9; ++i) {
    Light light;
    light.type = LightType(i % 4);
    for (int k = 0; k < 3; ++k) light.position[k] = float(between(random, -2, 2));
    for (int k = 0; k < 3; ++k) light.color[k] = float(between(random, 0, 0.5));
    light.range = float(between(random, 0.5, 5));
    light.attenuation = {1.0f, 0.5f, 0.25f};
    light.cone_rad = float(between(random, 0.2, 1.0)), light.penumbra_rad = 0.2f;
    scene.lights.push_back(light);
  }
}

/// Some of the materials transparent, in any order of drawing; alphas come from vertices, materials and textures.
Scene scene_with_glass(Random& random, bool maps) {
  Scene scene = random_scene(random);
  add_lights(random, scene);
  scene.clear = {0.25f, 0.5f, 0.125f, 0.75f};
  if (maps) add_maps(random, scene);
  const Material base = scene.materials[0];
  scene.materials.push_back(base);
  scene.materials[2].base_color = {1.0f, 0.6f, 0.5f, 0.7f};
  scene.materials[2].transparent = true;
  scene.materials[1].transparent = random() % 2 == 0;
  for (Instance& i : scene.instances) i.material = uint32_t(random() % 3);
  return scene;
}

Pipeline some_pipeline(Random& random, TransparencyMode mode) {
  const Pipeline geometry = random_pipeline(random);
  const std::vector<Preset> rows = stated_presets();
  Pipeline p = rows[random() % rows.size()].pipeline;
  p.width = 20 + int(random() % 24);
  p.height = 20 + int(random() % 24);
  p.geometry = geometry.geometry;
  p.gbuffer.position.interpolation = geometry.gbuffer.position.interpolation;
  p.gbuffer.albedo.interpolation = geometry.gbuffer.albedo.interpolation;
  p.gbuffer.albedo.format = kAlbedoFormats[random() % std::size(kAlbedoFormats)];
  p.gbuffer.half_round = HalfRound(random() % 2);
  p.target = kTargetFormats[random() % std::size(kTargetFormats)];
  p.strategy = mode == kIntoAlbedo ? Strategy(2 + random() % 2) : Strategy(random() % 4);
  p.transparency.mode = mode;
  if (random() % 3 == 0) {
    BlendState& b = p.transparency.blend;
    b.rgb = {BlendEquation(random() % kBlendEquations), BlendFactor(random() % kBlendFactors),
             BlendFactor(random() % kBlendFactors)};
    b.alpha = {BlendEquation::add, BlendFactor(random() % kBlendFactors), BlendFactor(random() % kBlendFactors)};
    b.constant = {0.5f, 0.25f, 1.5f, 0.75f};
    b.mask[random() % 4] = false;
  }
  if (random() % 4 == 0 && (p.target != Format::srgb8_a8 || oracle::estimates_as_recorded()))
    p.profile = NumericProfile::mesa_llvmpipe_22_3;
  return p;
}

}  // namespace

TEST_CASE("Transparent fragments are blended as the naive twin blends them, bit for bit, in both modes") {
  Random random(61);
  for (const TransparencyMode mode : {kIntoAlbedo, kAfterLights}) {
    size_t blended = 0;
    for (int i = 0; i < 120; ++i) {
      const Scene scene = scene_with_glass(random, i % 3 == 0);
      const Pipeline pipeline = some_pipeline(random, mode);
      INFO("frame " << i << ", " << kTransparencyNames[size_t(mode)]);
      compare(scene, pipeline, blended);
    }
    CHECK(blended > 10000);
  }
}

TEST_CASE("Frames with transparent surfaces are one image, whatever draws them") {
  Random random(62);
  for (int i = 0; i < 40; ++i) {
    const Scene scene = scene_with_glass(random, i % 3 == 0);
    const PreparedScene prepared(scene);
    const Pipeline pipeline = some_pipeline(random, i % 2 == 0 ? kIntoAlbedo : kAfterLights);
    const std::string aovs[] = {"albedo"};
    const Frame once = render_frame(prepared, pipeline, {}, aovs);
    const auto check = [&](const Execution& execution) {
      const Frame again = render_frame(prepared, pipeline, execution, aovs);
      INFO("frame " << i << ", " << name_of(pipeline.strategy) << ", tile " << execution.tile << ", "
                    << execution.simd);
      CHECK(image_hash(again.color) == image_hash(once.color));
      CHECK(image_hash(again.aovs[0].image) == image_hash(once.aovs[0].image));
      CHECK(again.stats.transparent_fragments == once.stats.transparent_fragments);
    };
    check({.threads = 1, .tile = 8, .light_culling = false});
    check({.threads = 3, .tile = 16, .geometry_culling = false, .shuffle_tiles = true});
    check({.tile = 32, .compiled_models = false, .fast_geometry = false, .bounded_codes = false});
    check({.tile = 48, .compiled_models = false});
    for (const std::string_view simd : simd_targets()) check({.tile = 32, .simd = simd});
  }
}

TEST_CASE("What lies behind glass is lit in the mixed colour, and by nothing else") {
  Scene scene = builtin_scene("atrium,glass=1");
  Light white;
  white.type = LightType::ambient;
  scene.lights = {white};
  Pipeline p = *preset_pipeline("many-lights");
  p.width = 160;
  p.height = 120;
  p.gbuffer.albedo.format = Format::rgba32f;
  p.target = Format::rgba32f;
  p.transparency.mode = kIntoAlbedo;
  const std::string aovs[] = {"albedo", "id.object", "depth", "normal", "light.0"};
  const Frame frame = render_frame(scene, p, {}, aovs);
  p.transparency.mode = TransparencyMode::none;
  std::erase_if(scene.instances, [&](const Instance& i) { return scene.materials[i.material].transparent; });
  const Frame without = render_frame(scene, p, {}, aovs);
  int mixed = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      if (without.aovs[1].image.value(x, y, 0) == 0) continue;
      for (int c = 0; c < 3; ++c) {
        // Ambient light of 1 shows the albedo; one light alone is the whole sum.
        REQUIRE(frame.color.value(x, y, c) == frame.aovs[0].image.value(x, y, c));
        REQUIRE(frame.aovs[4].image.value(x, y, c) == frame.color.value(x, y, c));
        mixed += frame.aovs[0].image.value(x, y, c) != without.aovs[0].image.value(x, y, c);
      }
    }
  CHECK(mixed > 3000);
  for (const size_t plane : {1u, 2u, 3u}) CHECK(frame.aovs[plane].image.texels == without.aovs[plane].image.texels);
}

TEST_CASE("Without transparent materials no mode changes a frame, and `none` draws them as opaque ones") {
  for (const char* name : {"atrium", "cornell"}) {
    const Scene scene = builtin_scene(name);
    const PreparedScene prepared(scene);
    Pipeline p = *preset_pipeline("many-lights");
    p.width = p.height = 80;
    std::string hashes[3];
    for (const auto mode : {TransparencyMode::none, kIntoAlbedo, kAfterLights}) {
      p.transparency.mode = mode;
      const Frame frame = render_frame(prepared, p);
      hashes[size_t(mode)] = image_hash(frame.color);
      CHECK(frame.stats.transparent_fragments == 0);
    }
    CHECK(hashes[0] == hashes[1]);
    CHECK(hashes[0] == hashes[2]);
  }
  Scene glass = builtin_scene("atrium,glass=1");
  Pipeline p = *preset_pipeline("many-lights");
  p.width = p.height = 80;
  p.transparency.mode = TransparencyMode::none;
  const std::string as_it_is = image_hash(render_frame(glass, p).color);
  for (Material& m : glass.materials) m.transparent = false;
  p.transparency.mode = kAfterLights;
  CHECK(image_hash(render_frame(glass, p).color) == as_it_is);
}

TEST_CASE("Counters count each transparent fragment once for each light, and its draw once") {
  const Scene scene = builtin_scene("atrium,glass=1,lights=7");
  const auto glass = uint64_t(std::count_if(scene.instances.begin(), scene.instances.end(), [&](const Instance& i) {
    return scene.materials[i.material].transparent;
  }));
  const uint64_t solid = scene.instances.size() - glass;
  Pipeline p = *preset_pipeline("many-lights");
  p.width = p.height = 60;
  for (const Strategy strategy : {Strategy::forward_multipass, Strategy::forward_loop, Strategy::deferred_loop}) {
    p.strategy = strategy;
    p.transparency.mode = kAfterLights;
    const FrameStats s = render_frame(scene, p).stats;
    const uint64_t n = s.covered_pixels, t = s.transparent_fragments;
    INFO(name_of(strategy));
    CHECK(t > 500);
    CHECK(s.gl.material_computations == (n + t) * 7);
    CHECK(s.gl.target_fragments_read == t + (strategy == Strategy::forward_multipass ? 6 * n : 0));
    CHECK(s.gl.draws == glass + (strategy == Strategy::forward_multipass ? 7 * solid : solid) +
                            uint64_t(strategy == Strategy::deferred_loop));
  }
  p.transparency.mode = kIntoAlbedo;
  const FrameStats s = render_frame(scene, p).stats;
  CHECK(s.gl.material_computations == s.covered_pixels * 7);
  CHECK(s.gl.gbuffer_fragments_read == 3 * s.covered_pixels + s.transparent_fragments);
  CHECK(s.gl.fragments_written == 4 * s.covered_pixels + s.transparent_fragments);
}

TEST_CASE("An albedo plane without alpha reads back as 1") {
  const Scene scene = builtin_scene("atrium,glass=1");
  Pipeline p = *preset_pipeline("touchdesigner");
  p.width = p.height = 60;
  p.gbuffer.albedo.format = Format::rgb16f;
  p.transparency.mode = TransparencyMode::none;
  const std::string aovs[] = {"id.object"};
  const Frame frame = render_frame(scene, p, {}, aovs);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) REQUIRE((frame.aovs[0].image.value(x, y, 0) == 0 || frame.color.code(x, y, 3) == 255));
}
