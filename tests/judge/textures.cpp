// Textured surfaces judged: class TEX (docs/gl_rules.md sections 5 and 9). Our own frames and real drivers pass, wrong
// lookups do not.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "gl/driver/renderer.h"
#include "judge/legal/texture_range.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/texture_pattern.h"
#include "scenes/pipeline/presets.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/drivers.h"
#include "tests/judge/srgb_in_double.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

constexpr int kTexturedWidth = 200, kTexturedHeight = 150;

Mesh with_stretched_uv(Mesh mesh, float times) {
  mesh.uv = {};
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    mesh.uv[0].push_back((mesh.position[0][v] + 0.37f * mesh.position[1][v]) * times);
    mesh.uv[1].push_back((mesh.position[2][v] - 0.21f * mesh.position[1][v]) * times);
  }
  return mesh;
}

/// A floor that runs to the horizon, a wall and a ball with holes, in all formats, wraps and filters by turns.
Scene textured_room(int variant) {
  Scene scene;
  scene.spec = "textured room " + std::to_string(variant);
  scene.meshes = {with_stretched_uv(plane_mesh(14), 8.0f), with_stretched_uv(sphere_mesh(28), 1.3f)};
  const Pattern patterns[] = {Pattern::checker, Pattern::brick, Pattern::noise};
  for (int i = 0; i < 3; ++i) {
    TexturePattern p;
    p.pattern = patterns[i];
    p.width = i == 1 ? 96 : 128, p.height = i == 1 ? 60 : 128;
    p.format = TextureFormat((variant + i) % 4);
    p.colors = {glm::vec4(0.9f, 0.6f, 0.3f, 1.0f), glm::vec4(0.1f, 0.2f, 0.5f, 0.0f)};
    scene.textures.push_back(texture_of(p));
    build_mip_chain(scene.textures.back());
    Material m;
    m.base_color = {0.9f, 1.0f, 0.8f, 1.0f};
    m.color_map.texture = i;
    Sampler& s = m.color_map.sampler;
    s.wrap = {Wrap(size_t(variant + i) % std::size(kWrapNames)), Wrap(size_t(variant + 2 * i) % std::size(kWrapNames))};
    s.mag_filter = Filter((variant + i) % 2), s.min_filter = Filter((variant / 2 + i) % 2);
    s.mip_filter = MipFilter((variant + 2 * i) % 3);
    s.lod_bias = variant % 3 == 2 ? -0.75f : 0.0f;
    s.border = {0.5f, 0.25f, 0.125f, 1.0f};
    m.alpha_cutoff = i == 2 ? 0.45f : 0.0f;
    scene.materials.push_back(m);
  }
  scene.instances = {
      {0, 0, glm::mat4x3(glm::vec3(6, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 12), glm::vec3(0, -1, -3))},
      {0, 1, glm::mat4x3(glm::vec3(4, 0, 0), glm::vec3(0, 0, 1), glm::vec3(0, -3, 0.5f), glm::vec3(0, 0, -4))},
      {1, 2,
       glm::mat4x3(glm::vec3(0.8f, 0, 0), glm::vec3(0, 0.8f, 0), glm::vec3(0, 0, 0.8f), glm::vec3(0.2f, 0, -1.5f))}};
  Light light;
  light.position = {1, 2, 1};
  light.range = 10.0f;
  scene.lights = {light};
  scene.camera.eye = {0.1f, 0.2f, 1.5f};
  scene.camera.near = 0.1f, scene.camera.far = 50.0f;
  return scene;
}

Pipeline pipeline_of() {
  Pipeline pipeline = presets().front().pipeline;
  pipeline.width = kTexturedWidth, pipeline.height = kTexturedHeight;
  return pipeline;
}

Verdict judged(const Scene& scene, const Pipeline& pipeline, const Capture& capture, const char* profile_name,
               int bits) {
  Profile profile = *profile_named(profile_name);
  if (profile.name == "unknown") profile.subpixel_bits = bits;
  const Verdict v = validate_capture(scene, pipeline, capture, {profile, false});
  for (const StageVerdict& s : v.stages) {
    std::printf("%-16s %-19s %-9s", scene.spec.c_str(), profile_name, s.stage.c_str());
    for (size_t c = 0; c < kPixelClasses; ++c)
      if (s.counts[c] > 0)
        std::printf(" %s %llu", std::string(text(PixelClass(c))).c_str(), static_cast<unsigned long long>(s.counts[c]));
    std::printf("\n");
  }
  return v;
}

TEST_CASE("Our own textured frames are EXACT or TEX to the ideal profile, and legal for any GPU") {
  for (int variant = 0; variant < 12; ++variant) {
    const Scene scene = textured_room(variant);
    const Pipeline pipeline = pipeline_of();
    const Capture capture = captured(scene, pipeline);
    for (const char* profile : {"ideal", "unknown"}) {
      const Verdict v = judged(scene, pipeline, capture, profile, 8);
      INFO(verdict_json(v));
      CHECK(v.violations() == 0);
      CHECK(v.evidence_line() == "");
    }
  }
}

TEST_CASE("What llvmpipe makes of textures is legal: every format, wrap and filter, and masks") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  uint64_t pixels = 0, tex = 0;
  for (int variant = 0; variant < 12; ++variant) {
    const Scene scene = textured_room(variant);
    const Pipeline pipeline = pipeline_of();
    GlRenderer renderer(*context, scene, 0, &programs);
    const Capture capture = renderer.draw(pipeline).capture;
    const Verdict v = judged(scene, pipeline, capture, "unknown", context->info().subpixel_bits);
    INFO(verdict_json(v));
    CHECK(v.violations() == 0);
    CHECK(v.evidence_line() == "");
    if (context->info().line().find("Mesa 22.3") != std::string::npos) {
      const Verdict own = judged(scene, pipeline, capture, "mesa-llvmpipe-22.3", 8);
      INFO(verdict_json(own));
      CHECK(own.violations() == 0);
      CHECK(own.stages[0].count(PixelClass::tex) <= v.stages[0].count(PixelClass::tex));
    }
    tex += v.stages[0].count(PixelClass::tex);
    pixels += v.stages[0].covered;
  }
  CHECK(pixels > 12 * 10000);
  CHECK(tex > 0);
}

/// The room whose materials have maps of metal and roughness, emission and occlusion, under ambient light. `variant`
/// chooses which of the maps are left out, and the one surface that is unlit.
Scene metal_room(int variant) {
  Scene scene = textured_room(variant);
  scene.spec = "metal room " + std::to_string(variant);
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    const auto slot = [&](size_t texture) {
      TextureSlot out = scene.materials[texture % 3].color_map;
      out.sampler.wrap = m.color_map.sampler.wrap;
      return out;
    };
    m.metallic = 0.9f, m.roughness = 0.8f, m.occlusion_strength = 0.75f;
    m.emission = {0.3f, 0.1f, 0.5f};
    if (variant % 4 != 3) m.metallic_roughness_map = slot(i + 1);
    if (variant % 5 != 4) m.emission_map = slot(i + 2);
    if (variant % 3 != 2) m.occlusion_map = slot(i + size_t(variant));
    m.unlit = i == size_t(variant) % 6;
  }
  Light sky;
  sky.type = LightType::ambient;
  sky.color = {0.2f, 0.3f, 0.4f};
  scene.lights.push_back(sky);
  return scene;
}

Pipeline metal_pipeline(int variant) {
  Pipeline pipeline = *preset_pipeline(variant % 2 == 0 ? "punctual" : "gl-fixed");
  if (variant % 4 == 1) pipeline.light_model.specular_source = SpecularSource::metallic_roughness;
  if (variant % 8 == 6) pipeline.gbuffer.emission = Format::rgba8, pipeline.gbuffer.specular = Format::rgba16f;
  if (variant % 8 == 4) pipeline.gbuffer.emission = Format::rgb16f;
  constexpr Strategy kLoops[] = {Strategy::deferred_loop, Strategy::forward_loop, Strategy::deferred_loop,
                                 Strategy::forward_multipass};
  pipeline.strategy = kLoops[variant % 4];
  pipeline.width = 120, pipeline.height = 90;
  return pipeline;
}

TEST_CASE(
    "Our own frames with maps of metal, emission and occlusion are legal, for the ideal profile and for any GPU") {
  for (int variant = 0; variant < 12; ++variant) {
    const Scene scene = metal_room(variant);
    const Pipeline pipeline = metal_pipeline(variant);
    const Capture capture = captured(scene, pipeline);
    for (const char* profile : {"ideal", "unknown"}) {
      const Verdict v = judged(scene, pipeline, capture, profile, 8);
      INFO(variant << verdict_json(v));
      CHECK(v.violations() == 0);
    }
  }
}

TEST_CASE("What llvmpipe makes of maps of metal, emission and occlusion, and of unlit surfaces, is legal") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  for (int variant = 0; variant < 12; ++variant) {
    const Scene scene = metal_room(variant);
    const Pipeline pipeline = metal_pipeline(variant);
    GlRenderer renderer(*context, scene, 0, &programs);
    const Capture capture = renderer.draw(pipeline).capture;
    const Verdict v = judged(scene, pipeline, capture, "unknown", context->info().subpixel_bits);
    INFO(variant << verdict_json(v));
    CHECK(v.violations() == 0);
    CHECK(v.evidence_line() == "");
    CHECK(v.stages[0].covered > 5000);
  }
}

TEST_CASE("A shininess that is no integer, and a share of ambient light that is not there, are violations") {
  const Scene scene = metal_room(0);
  const Pipeline pipeline = metal_pipeline(0);
  const auto violations = [&](const char* plane, int channel, auto&& change) {
    Capture wrong = captured(scene, pipeline);
    for (NamedImage& p : wrong.planes)
      for (int y = 0; y < p.image.height && p.name == plane; ++y)
        for (int x = 0; x < p.image.width; ++x) {
          float number = float(p.image.value(x, y, channel));
          number = change(number);
          std::memcpy(p.image.texels.data() + p.image.row_bytes() * size_t(y) + size_t(4 * (4 * x + channel)), &number,
                      sizeof number);
        }
    return judged(scene, pipeline, wrong, "unknown", 8).violations();
  };
  CHECK(violations("specular", 3, [](float s) { return s; }) == 0);
  CHECK(violations("specular", 3, [](float s) { return s + 0.5f; }) > 5000);
  CHECK(violations("emission", 3, [](float) { return 1.0f; }) > 1000);
}

TEST_CASE("Wrong lookups are violations: another wrap, another filter, a shifted texture, a mask not applied") {
  const Scene scene = textured_room(4);  // magnified and minified surfaces of all patterns
  const Pipeline pipeline = pipeline_of();
  const auto violations = [&](auto&& change) {
    Scene wrong = scene;
    change(wrong);
    return judged(scene, pipeline, captured(wrong, pipeline), "unknown", 8).violations();
  };
  CHECK(violations([](Scene&) {}) == 0);
  CHECK(violations([](Scene& s) { s.materials[2].alpha_cutoff = 0.0f; }) > 50);
  CHECK(violations([](Scene& s) { s.materials[2].alpha_cutoff = 0.6f; }) > 20);
  for (int i = 0; i < 3; ++i) {
    INFO("material " << i);
    const auto half_a_texel = [i](Scene& s) {  // of the texture, not of the picture
      const size_t mesh = s.instances[size_t(i)].mesh;
      for (float& u : s.meshes[mesh].uv[0]) u += 0.13f;
    };
    CHECK(violations(half_a_texel) > 100);
    CHECK(violations([i](Scene& s) {
            Texture& t = s.textures[size_t(i)];
            t.format = t.format == TextureFormat::rgba8      ? TextureFormat::srgb8_a8
                       : t.format == TextureFormat::srgb8_a8 ? TextureFormat::rgba8
                                                             : t.format;
            if (t.format >= TextureFormat::rgba16f) t.levels.resize(1), s.materials[size_t(i)].base_color.x *= 0.9f;
          }) > 100);
  }
}

/// A texture of one row of texels, rgb alike.
Texture row_of(TextureFormat format, const std::vector<uint8_t>& codes) {
  Texture t;
  t.format = format;
  t.levels.resize(1);
  t.levels[0].width = int(codes.size()), t.levels[0].height = 1;
  for (const uint8_t c : codes) t.levels[0].bytes.insert(t.levels[0].bytes.end(), {c, c, c, 255});
  return t;
}

TextureSample at(double u) {
  return {
      {u, u, u}, {0.5, 0.5, 0.5}, {u, 0.5, 1e-3, 0, 0, 1e-3}, {u, 0.5, 1e-3, 0, 0, 1e-3}, {u, 0.5, 1e-3, 0, 0, 1e-3}};
}

bool allows(std::string_view profile, const Texture& texture, const Sampler& sampler, double u, double value) {
  const oracle::Range r = texel_range(texture, sampler, at(u), *profile_named(profile))[0];
  return value >= r.low && value <= r.high;
}

Sampler clamped(Filter filter) {
  Sampler s;
  s.wrap = {Wrap::clamp_to_edge, Wrap::clamp_to_edge};
  s.mag_filter = s.min_filter = filter, s.mip_filter = MipFilter::none;
  return s;
}

TEST_CASE("An sRGB texture decoded after it was filtered is OpenGL, and neither Direct3D nor llvmpipe") {
  const Texture ends = row_of(TextureFormat::srgb8_a8, {0, 255});
  const Sampler linear = clamped(Filter::linear);
  // Row 59: the middle of codes 0 and 255 is 0.5 where decoded first.
  for (const char* profile : {"unknown", "d3d-class", "mesa-llvmpipe-22.3", "ideal"}) {
    CAPTURE(profile);
    CHECK(allows(profile, ends, linear, 0.5, 0.5));
    CHECK(allows(profile, ends, linear, 0.5, testing::srgb_decoded(0.5)) == (std::string(profile) == "unknown"));
  }
  CHECK_FALSE(allows("unknown", ends, linear, 0.5, 0.7));
  CHECK_FALSE(allows("unknown", ends, linear, 0.5, 0.15));
}

TEST_CASE("A decoded code may be off by what its profile says, and not by a code more") {
  const Sampler nearest = clamped(Filter::nearest);
  for (const int code : {3, 20, 64, 128, 200, 254}) {
    const Texture one = row_of(TextureFormat::srgb8_a8, {uint8_t(code)});
    CAPTURE(code);
    const auto off_by = [&](double codes) { return testing::srgb_decoded((code + codes) / 255.0); };
    CHECK(allows("ideal", one, nearest, 0.5, double(float(off_by(0)))));
    CHECK_FALSE(allows("ideal", one, nearest, 0.5, off_by(0.01)));
    for (const double sign : {-1.0, 1.0}) {
      CHECK(allows("d3d-class", one, nearest, 0.5, off_by(0.45 * sign)));
      CHECK_FALSE(allows("d3d-class", one, nearest, 0.5, off_by(0.6 * sign)));
      CHECK(allows("unknown", one, nearest, 0.5, off_by(0.45 * sign)));
      CHECK_FALSE(allows("unknown", one, nearest, 0.5, off_by(0.6 * sign)));
    }
  }
}

TEST_CASE("Weights have 7 bits for any GPU, 8 for Direct3D's class, and all of a float in llvmpipe's wide formats") {
  Texture ends = row_of(TextureFormat::rgba8, {0, 255});
  const Sampler linear = clamped(Filter::linear);
  const double u = 0.5 + 0.25 / 2;  // 3/4 of the way
  for (const double sign : {-1.0, 1.0}) {
    CHECK(allows("unknown", ends, linear, u, 0.75 + sign * (0x1p-7 + 1.9 / 255)));
    CHECK_FALSE(allows("unknown", ends, linear, u, 0.75 + sign * (0x1p-7 + 2.1 / 255)));
    CHECK(allows("d3d-class", ends, linear, u, 0.75 + sign * (0x1p-8 + 1.9 / 255)));
    CHECK_FALSE(allows("d3d-class", ends, linear, u, 0.75 + sign * (0x1p-8 + 2.1 / 255)));
    CHECK_FALSE(allows("ideal", ends, linear, u, 0.75 + sign * 1e-5));
  }
  ends.format = TextureFormat::rgba32f;
  ends.levels[0].bytes.assign(32, 0);
  const float one = 1;
  std::memcpy(&ends.levels[0].bytes[16], &one, sizeof one);
  for (const double sign : {-1.0, 1.0}) {
    CHECK(allows("unknown", ends, linear, u, 0.75 + sign * 0.99 * 0x1p-7));
    CHECK_FALSE(allows("unknown", ends, linear, u, 0.75 + sign * 1.02 * 0x1p-7));
    CHECK_FALSE(allows("mesa-llvmpipe-22.3", ends, linear, u, 0.75 + sign * 1e-5));
  }
}

TEST_CASE("llvmpipe decodes sRGB by the polynomial of its profile: all 256 codes, most of them not the formula's") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  if (context->info().line().find("Mesa 22.3") == std::string::npos) {
    std::printf("SKIPPED: not Mesa 22.3\n");
    return;
  }
  Scene scene;
  scene.meshes = {with_stretched_uv(plane_mesh(1), 1.0f)};
  for (size_t v = 0; v < 4; ++v)
    for (size_t k = 0; k < 2; ++k) scene.meshes[0].uv[k][v] = scene.meshes[0].position[2 * k][v] + 0.5f;
  std::vector<uint8_t> codes(256);
  for (size_t k = 0; k < 256; ++k) codes[k] = uint8_t(k);
  scene.textures = {row_of(TextureFormat::srgb8_a8, codes)};
  Material m;
  m.color_map.texture = 0;
  m.color_map.sampler = clamped(Filter::nearest);
  scene.materials = {m};
  scene.instances = {
      {0, 0, glm::mat4x3(glm::vec3(1, 0, 0), glm::vec3(0, 0, 1), glm::vec3(0, 1, 0), glm::vec3(0, 0, 0))}};
  scene.camera.clip_from_world = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  Pipeline pipeline = pipeline_of();
  pipeline.width = 256, pipeline.height = 4;
  pipeline.gbuffer.albedo.format = Format::rgba32f;
  GlRenderer renderer(*context, scene);
  const Capture capture = renderer.draw(pipeline).capture;
  int off = 0;
  for (int k = 0; k < 256; ++k) {
    const double given = capture.plane("albedo")->value(k, 1, 0);
    CAPTURE(k, given);
    CHECK(allows("mesa-llvmpipe-22.3", scene.textures[0], m.color_map.sampler, (k + 0.5) / 256, given));
    CHECK(allows("unknown", scene.textures[0], m.color_map.sampler, (k + 0.5) / 256, given));
    CHECK(allows("d3d-class", scene.textures[0], m.color_map.sampler, (k + 0.5) / 256, given));
    off += !allows("ideal", scene.textures[0], m.color_map.sampler, (k + 0.5) / 256, given);
  }
  std::printf("llvmpipe's sRGB decode: %d of 256 codes are not the formula's\n", off);
  CHECK(off > 200);
}

}  // namespace
