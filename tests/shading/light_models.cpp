// Every term of scenes/pipeline/light_model.h against the naive loop, bit for bit, and against the scalar twin within
// its roundings; the kernels compiled for the usual models against the general one.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "core/half.h"
#include "oracle/scalar_light.h"
#include "scenes/pipeline/presets.h"
#include "shading/light/fast/compiled_models.h"
#include "tests/catch.hpp"
#include "tests/shading/light_sheet.h"
#include "tests/shading/random_light_model.h"
#include "tests/stated_presets.h"

using namespace trueshade;

namespace {

/// Sheets through each other, of four materials: vectors of pixels see several.
Scene mixed_sheets(Random& random) {
  Scene scene = sheet(random);
  const float shininess[] = {0, 7, 32, 8192}, roughness[] = {1, 0.5f, 0.3f, 0.05f};
  scene.materials.resize(4);
  scene.textures = {{"occlusion", TextureFormat::rgba32f, {{1, 1, {}}}}};
  append_texel(TextureFormat::rgba32f, {kOcclusionTexel, 0.5f, 0.5f, 1.0f}, scene.textures[0].levels[0].bytes);
  for (size_t i = 0; i < 4; ++i) {
    Material& m = scene.materials[i];
    m.specular_color = {float_between(random, 0, 1), float_between(random, 0, 1), float_between(random, 0, 1)};
    m.emission = {float_between(random, 0, 0.3), 0, float_between(random, 0, 0.3)};
    m.shininess = shininess[i];
    m.metallic = i == 0 ? 0.0f : float_between(random, 0, 1);
    m.roughness = roughness[i];
    if (i % 2 == 0) m.occlusion_map.texture = 0;
    m.occlusion_strength = float_between(random, 0, 1);
    Instance instance;
    instance.material = uint32_t(i);
    instance.world_from_object[3] = {0.13f * float(i), -0.07f * float(i), 0.05f * float(i)};
    if (i > 0) scene.instances.push_back(instance);
  }
  return scene;
}

Execution on(std::string_view simd, bool compiled, bool culling = true) {
  Execution e;
  e.simd = simd;
  e.compiled_models = compiled;
  e.light_culling = culling;
  return e;
}

}  // namespace

namespace {

/// What a plane of the G-buffer holds of a value (docs/arithmetic.md section 7).
float as_stored(Format format, HalfRound round, float x) {
  if (info(format).bytes_per_channel == 4) return x;
  if (format == Format::rgba8) return std::nearbyint(255.0f * std::clamp(x, 0.0f, 1.0f)) / 255.0f;
  return float_from_half(half_from_float(x, round));
}

/// What lights read of a pixel's material through planes of those formats. `plain`: a frame whose albedo is what metals
/// are made of.
Pixel through_planes(const Result& result, const Result& plain, const GBufferState& planes, int x, int y) {
  Pixel p = result.pixel(x, y);
  const Pixel unmapped = plain.pixel(x, y);
  const Material& m = result.materials[size_t(result.frame.aovs[5].image.value(x, y, 0)) - 1];
  for (int k = 0; k < 3; ++k) {
    const float metal = m.metallic,
                own = result.metals ? 0.04f * (1.0f - metal) + unmapped.albedo[k] * metal : m.specular_color[k];
    p.specular[k] = as_stored(planes.specular, planes.half_round, own);
    p.emission[k] = as_stored(planes.emission, planes.half_round, p.emission[k]);
  }
  p.specular[3] = as_stored(planes.specular, planes.half_round, p.specular[3]);
  const bool has_alpha = info(planes.emission).channels > 3;
  p.ambient_share = has_alpha ? as_stored(planes.emission, planes.half_round, p.ambient_share) : 1.0f;
  return p;
}

/// Values of the planes `specular` and `emission`, and of the picture, that are not the formula's.
std::array<size_t, 3> unlike_through_planes(const Scene& scene, const Pipeline& pipeline, std::string_view simd) {
  const Execution execution = on(simd, simd != "scalar");
  const Result result = render(scene, pipeline, execution);
  Pipeline unmapped = pipeline;
  unmapped.light_model.specular_source = SpecularSource::material;
  const Result plain = render(scene, unmapped, execution);
  const std::string names[] = {"specular", "emission"};
  const Frame frame = render_frame(scene, pipeline, execution, names);
  std::array<size_t, 3> unlike{};
  REQUIRE(frame.aovs[0].image.format == pipeline.gbuffer.specular);
  REQUIRE(frame.aovs[1].image.format == pipeline.gbuffer.emission);
  const auto held = [](const Image& image, int x, int y, int k) {
    return image.format == Format::rgba8 ? float(image.texel(x, y)[k]) / 255.0f : float(image.value(x, y, k));
  };
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x) {
      if (!result.covered(x, y)) continue;
      const Pixel p = through_planes(result, plain, pipeline.gbuffer, x, y);
      for (int k = 0; k < 4; ++k) unlike[0] += held(frame.aovs[0].image, x, y, k) != p.specular[k];
      for (int k = 0; k < 3; ++k) unlike[1] += held(frame.aovs[1].image, x, y, k) != p.emission[k];
      if (info(pipeline.gbuffer.emission).channels > 3)
        unlike[1] += held(frame.aovs[1].image, x, y, 3) != p.ambient_share;
      const std::array<float, 4> expected = naive_sum(scene, pipeline.light_model, p);
      unlike[2] += std::memcmp(expected.data(), result.frame.color.texel(x, y), sizeof expected) != 0;
    }
  return unlike;
}

}  // namespace

TEST_CASE("specular colour, shininess and emission reach the lights through planes of every format they may have") {
  Random random(71);
  Scene scene = mixed_sheets(random);
  const float shininess[] = {8191, 2049, 4099, 7};  // halves hold the last of these alone
  for (size_t i = 0; i < 4; ++i) scene.materials[i].shininess = shininess[i];
  scene.materials[2].roughness = 0.15f;                // 3949, no half either
  scene.materials[3].emission = {3.7f, 0.001f, 0.6f};  // what 8 bits clamp
  for (int light = 0; light < 24; ++light) scene.lights.push_back(random_light(random));
  Pipeline pipeline = loop_pipeline("many-lights");
  pipeline.gbuffer.albedo.format = Format::rgba32f;
  pipeline.light_model.emission = true;
  for (const SpecularSource source : {SpecularSource::material, SpecularSource::metallic_roughness})
    for (const Format specular : kSpecularFormats)
      for (const Format emission : kEmissionFormats)
        for (const HalfRound round : {HalfRound::toward_zero, HalfRound::nearest})
          for (const std::string_view simd : simd_targets()) {
            pipeline.light_model.specular_source = source;
            pipeline.gbuffer.specular = specular, pipeline.gbuffer.emission = emission;
            pipeline.gbuffer.half_round = round;
            CAPTURE(int(source), info(specular).name, info(emission).name, int(round), simd);
            CHECK(unlike_through_planes(scene, pipeline, simd) == std::array<size_t, 3>{0, 0, 0});
          }
}

TEST_CASE("every term, falloff, cone and order of a light model has the naive loop's bits") {
  Random random(58);
  const std::vector<std::string_view> targets = simd_targets();
  for (int i = 0; i < 150; ++i) {
    Scene scene = mixed_sheets(random);
    for (int light = 0; light < 24; ++light) scene.lights.push_back(random_light(random));
    Pipeline pipeline = loop_pipeline("many-lights");
    pipeline.light_model = random_light_model(random);
    const Execution execution = on(targets[size_t(i) % targets.size()], i % 3 == 0, i % 5 != 0);
    INFO("model " << i << ", " << execution.simd << ", " << pipeline_json(pipeline));
    compare_with_loop(scene, pipeline, render(scene, pipeline, execution));
  }
}

TEST_CASE("every preset has the naive loop's bits on every target, by the compiled kernel and by the general one") {
  Random random(59);
  for (const Preset& row : stated_presets()) {
    Scene scene = mixed_sheets(random);
    for (int light = 0; light < 60; ++light) scene.lights.push_back(random_light(random));
    Pipeline pipeline = loop_pipeline(row.name);
    pipeline.strategy = Strategy::deferred_loop;  // whatever the preset's own: the model is what is held
    pipeline.light_volumes.point = pipeline.light_volumes.spot = LightExtent::unbounded;
    for (const std::string_view simd : simd_targets())
      for (const bool compiled : {true, false}) {
        INFO(row.name << ", " << simd << ", compiled " << compiled);
        compare_with_loop(scene, pipeline, render(scene, pipeline, on(simd, compiled)));
      }
  }
}

TEST_CASE("the kernels compiled for a model's shape and the general kernel give one image, culled or not") {
  Random random(60);
  for (const CompiledModel& row : kCompiledModels) {
    const LightShape& shape = row.shape;
    Scene scene = mixed_sheets(random);
    for (int light = 0; light < 100; ++light) scene.lights.push_back(random_light(random));
    Pipeline pipeline = loop_pipeline("many-lights");
    LightModel& m = pipeline.light_model;
    m.renormalize = shape.renormalize, m.specular_masked = shape.specular_masked, m.falloff = shape.falloff;
    m.order = shape.order, m.cone = shape.cone, m.diffuse = shape.diffuse, m.specular = shape.specular;
    m.specular_source = shape.source;
    m.shininess =
        shape.power < 0 ? (shape.squared ? 20.0f : 3.0f) : float(shape.squared ? 2 * shape.power : shape.power);
    REQUIRE((shape.power >= 0 ? shape_with_power(m) : shape_of(m)) == shape);
    const Image expected = render(scene, pipeline, on("scalar", false, false)).frame.color;
    for (const std::string_view simd : simd_targets())
      for (const bool compiled : {true, false})
        for (const bool culling : {true, false}) {
          INFO("shape " << &row - kCompiledModels << ", " << simd << " " << compiled << " " << culling);
          CHECK(render(scene, pipeline, on(simd, compiled, culling)).frame.color.texels == expected.texels);
        }
  }
}

TEST_CASE("Lambert's lights over torn sheets of any size are culled block by block without changing a bit") {
  Random random(62);
  const std::vector<std::string_view> targets = simd_targets();
  for (const int exponent : {-60, -20, 0, 0, 0, 30, 58}) {
    const float scale = std::ldexp(1.0f, exponent);
    Scene scene = sheet(random);
    for (auto& stream : scene.meshes[0].normal)
      for (float& value : stream) value = float_between(random, -1, 1);
    for (int light = 0; light < 150; ++light) scene.lights.push_back(random_light(random));
    for (int axis = 0; axis < 3; ++axis) scene.instances[0].world_from_object[axis][axis] = scale;
    for (Light& light : scene.lights) light.position *= scale, light.range *= 0.3f * scale;
    scene.camera.eye *= scale, scene.camera.near *= scale, scene.camera.far = 50 * scale;
    for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes})
      for (const Format format : {Format::rgba8, Format::rgba16f, Format::rgba32f}) {
        Pipeline pipeline = loop_pipeline(format == Format::rgba16f ? "lecture" : "light-volumes");
        pipeline.strategy = strategy;
        pipeline.target = format;
        const std::vector<std::string> aovs = {"light.count"};
        const Frame expected = render_frame(scene, pipeline, on("scalar", false, false), aovs);
        REQUIRE(expected.stats.lit_pixel_lights > 0);
        for (const std::string_view simd : targets) {
          const Frame frame = render_frame(scene, pipeline, on(simd, true), aovs);
          INFO("2^" << exponent << ", " << simd << ", " << pipeline_json(pipeline));
          CHECK(frame.color.texels == expected.color.texels);
          CHECK(frame.aovs[0].image.texels == expected.aovs[0].image.texels);
          CHECK(frame.stats.lit_pixel_lights == expected.stats.lit_pixel_lights);
          CHECK(frame.stats.evaluated_pixel_lights < frame.stats.pixel_lights);
        }
      }
  }
}

TEST_CASE("the light sums of all models are the real numbers' to within the bounds of their roundings") {
  Random random(61);
  for (int i = 0; i < 60; ++i) {
    Scene scene = mixed_sheets(random);
    for (int light = 0; light < 30; ++light) scene.lights.push_back(random_light(random));
    Pipeline pipeline = loop_pipeline("many-lights");
    LightModel& m = pipeline.light_model = random_light_model(random);
    m.renormalize = true;  // otherwise N.H is not bounded by 1
    m.viewer = Viewer::local;
    if (m.shininess > 60) m.shininess = 60;
    for (Material& material : scene.materials) material.shininess = std::min(material.shininess, 60.0f);
    for (Material& material : scene.materials) material.roughness = std::max(material.roughness, 0.5f);
    const Result result = render(scene, pipeline);
    for (int y = 0; y < pipeline.height; y += 3)
      for (int x = 0; x < pipeline.width; x += 2) {
        if (!result.covered(x, y)) continue;
        const Pixel p = result.pixel(x, y);
        oracle::Surface surface{{p.position.x, p.position.y, p.position.z}, {p.normal.x, p.normal.y, p.normal.z}};
        for (size_t k = 0; k < 3; ++k) {
          surface.albedo[k] = double(p.albedo[k]);
          surface.specular[k] = double(p.specular[k]);
          surface.emission[k] = double(p.emission[k]);
        }
        surface.ambient_share = double(p.ambient_share);
        surface.shininess = double(p.specular[3]);
        const oracle::LitSum real = oracle::lit_sum(surface, scene, m);
        if (real.nearest_threshold < 1e-5) continue;  // a rounding may put it on the other side
        const double s = std::max(double(m.shininess), surface.shininess);
        for (size_t k = 0; k < 3; ++k) {
          // Some twenty roundings a term, shininess times those of the cosine, up to 1000 times those of a cone's.
          const double steps = 40 + 8 * s + 30 + (m.cone == Cone::none ? 0 : 4000);
          const double bound = real.magnitude[k] * steps * 0x1p-24 + 1e-30;
          float stored;
          std::memcpy(&stored, result.frame.color.texel(x, y) + 4 * k, 4);
          CAPTURE(i, x, y, k, stored, real.color[k], bound, pipeline_json(pipeline));
          REQUIRE(std::fabs(double(stored) - real.color[k]) <= bound);
        }
      }
  }
}
