// The profile mesa-llvmpipe-22.3 in whole frames: what llvmpipe draws and what render_frame() does, bit for bit, where
// nothing but what the profile promises takes part: triangles inside the viewport, constant colours and depths, ambient
// light. Lit frames hang on the last bits of GLSL's attributes and powers as well, which no profile promises.
#include <algorithm>

#include "oracle/blend.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"
#include "tests/gl/random_states.h"
#include "tests/stated_presets.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;

namespace {

float unit(Random& random) { return float(double(random() >> 11) * 0x1p-53); }

/// Triangles of one colour and depth each, inside the window, every fourth of glass; up to six ambient lights.
Scene flat_scene(Random& random) {
  std::vector<std::vector<Corners>> objects;
  for (int i = 0; i < 24; ++i) {
    const double z = 1.8 * unit(random) - 0.9;
    const std::array<float, 4> color{unit(random), 1.5f * unit(random), unit(random), unit(random)};
    Corners corners;
    for (Corner& c : corners) c = {1 + 254.0 * unit(random), 1 + 254.0 * unit(random), z, 1, {0, 0}, color};
    objects.push_back({corners});
  }
  Scene scene = window_objects(objects);
  scene.materials.resize(2);
  scene.materials[1].transparent = true;
  for (size_t i = 0; i < scene.instances.size(); ++i) scene.instances[i].material = i % 4 == 3 ? 1 : 0;
  scene.clear = {unit(random), unit(random), 1.2f * unit(random), unit(random)};
  scene.lights.assign(1 + random() % 6, {});
  for (Light& light : scene.lights) {
    light.type = LightType::ambient;
    light.color = {0.6f * unit(random), 0.6f * unit(random), 0.6f * unit(random)};
  }
  return scene;
}

void set_some_blend(Random& random, BlendState& blend) {
  blend.rgb = random_term(random);
  blend.alpha = random_term(random);
  for (float& constant : blend.constant) constant = unit(random);
  blend.mask[3] = true;
}

Pipeline some_pipeline(Random& random, Format target, Strategy strategy) {
  Pipeline p = window_pipeline();
  p.profile = NumericProfile::mesa_llvmpipe_22_3;
  p.target = target;
  p.strategy = strategy;
  p.light_model.alpha_from_albedo = random() % 2 == 0;
  p.gbuffer.albedo.format = kAlbedoFormats[random() % std::size(kAlbedoFormats)];
  p.transparency.mode = TransparencyMode(random() % 3);
  if (is_forward(strategy) && p.transparency.mode == TransparencyMode::into_albedo)
    p.transparency.mode = TransparencyMode::after_lights;
  if (random() % 2 == 0) set_some_blend(random, p.blend);
  if (random() % 2 == 0) set_some_blend(random, p.transparency.blend);
  return p;
}

/// Of the pixels that show something where `shown` is given: glass alone writes into planes that nobody reads.
size_t different_texels(const Image& a, const Image& b, const Image* shown = nullptr) {
  REQUIRE(a.format == b.format);
  REQUIRE(a.texels.size() == b.texels.size());
  size_t count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      if (shown != nullptr && shown->value(x, y, 0) == 0) continue;
      count += std::equal(a.texel(x, y), a.texel(x, y) + info(a.format).bytes_per_texel(), b.texel(x, y)) ? 0 : 1;
    }
  return count;
}

struct OtherCodes {
  size_t shown = 0, different = 0;  ///< pixels that show the same object in both; those of another code in any channel
  size_t far = 0;                   ///< those over two codes off
};

OtherCodes other_codes(const Capture& gl, const Scene& scene, const Pipeline& pipeline) {
  const std::string aovs[] = {"id.object"};
  const Frame ours = render_frame(scene, pipeline, {}, aovs);
  OtherCodes apart;
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x) {
      const double object = ours.aovs[0].image.value(x, y, 0);
      if (object == 0 || object != gl.plane("id.object")->value(x, y, 0)) continue;
      int worst = 0;
      for (int c = 0; c < 4; ++c)
        worst = std::max(worst, std::abs(int(gl.color.code(x, y, c)) - int(ours.color.code(x, y, c))));
      ++apart.shown;
      apart.different += worst > 0 ? 1 : 0;
      apart.far += worst > 2 ? 1 : 0;
    }
  return apart;
}

}  // namespace

TEST_CASE("Frames of constant colours are llvmpipe's bit for bit, every target format and strategy, glass and all",
          "[slow]") {
  const GlContext* context = opened_mesa_22_3();
  if (context == nullptr) return;
  Random random(223);
  const std::string aovs[] = {"id.object", "albedo"};
  size_t covered = 0;
  KeptPrograms programs;
  for (const Format target : kTargetFormats)
    for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy)
      for (int i = 0; i < 6; ++i) {
        if (target == Format::srgb8_a8 && !estimates_as_recorded()) continue;
        const Scene scene = flat_scene(random);
        const Pipeline pipeline = some_pipeline(random, target, Strategy(strategy));
        const Capture gl = GlRenderer(*context, scene, 0, &programs).draw(pipeline).capture;
        const Frame ours = render_frame(scene, pipeline, {}, aovs);
        INFO("frame " << i << ", " << info(target).name << ", " << name_of(pipeline.strategy) << ", albedo "
                      << info(pipeline.gbuffer.albedo.format).name << ", glass "
                      << kTransparencyNames[size_t(pipeline.transparency.mode)]);
        const Image& ids = ours.aovs[0].image;
        CHECK(different_texels(*gl.plane("id.object"), ids) == 0);
        CHECK(different_texels(*gl.plane("albedo"), ours.aovs[1].image, &ids) == 0);
        CHECK(different_texels(gl.color, ours.color) == 0);
        covered += ours.stats.covered_pixels;
      }
  CHECK(covered > 4000000);
}

TEST_CASE(
    "Lit frames of ten bits a channel are llvmpipe's codes under its profile, but where sums lie at a code's edge") {
  const GlContext* context = opened_mesa_22_3();
  if (context == nullptr) return;
  KeptPrograms programs;
  for (const char* name : {"city,objects=300,lights=30", "cornell"}) {
    const Scene scene = builtin_scene(name);
    GlRenderer renderer(*context, scene, 0, &programs);
    for (const Preset& preset : stated_presets())
      for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy) {
        Pipeline pipeline = preset.pipeline;
        pipeline.width = 120, pipeline.height = 90;
        pipeline.strategy = Strategy(strategy);
        pipeline.target = pipeline.gbuffer.albedo.format = pipeline.gbuffer.normal.format = Format::rgb10_a2;
        const Capture gl = renderer.draw(pipeline).capture;
        const OtherCodes ideal = other_codes(gl, scene, pipeline);
        pipeline.profile = NumericProfile::mesa_llvmpipe_22_3;
        const OtherCodes mesa = other_codes(gl, scene, pipeline);
        INFO(name << ", " << preset.name << ", " << name_of(pipeline.strategy));
        CAPTURE(mesa.shown, mesa.different, mesa.far, ideal.different, ideal.far);
        CHECK(mesa.shown > 800);
        CHECK(mesa.different <= mesa.shown / 12);  // the last bits of GLSL's attributes and powers
        CHECK(6 * mesa.different <= ideal.different);
        CHECK(mesa.far <= mesa.shown / 1000 + 4);  // silhouettes: the same object, but another of its faces
      }
  }
}
