// Maps of metal and roughness, emission and occlusion, and unlit surfaces: planes against the formulas of glTF and the
// scalar oracle, light sums against the oracle, and what must not change either (docs/arithmetic.md sections 7, 13).
#include <algorithm>
#include <cmath>

#include "oracle/scalar_light.h"
#include "oracle/textured_surface.h"
#include "scenes/builtin/builtin.h"
#include "tests/catch.hpp"
#include "tests/raster/random_frame.h"
#include "tests/shading/two_squares.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

using Real = long double;

const std::vector<std::string> kMaterialAovs{"id.object", "albedo", "specular", "emission", "normal", "position"};

/// Maps of every kind for the materials of a random scene, some of them unlit.
void add_material_maps(Random& random, Scene& scene) {
  add_maps(random, scene);
  const auto slot = [&] {
    TextureSlot out = scene.materials[0].color_map;
    out.texture = int32_t(random() % scene.textures.size());
    if (random() % 2 == 0) out.sampler.mag_filter = Filter(random() % 2);
    return out;
  };
  const auto share = [&] { return float(between(random, 0, 1)); };
  for (Material& m : scene.materials) {
    if (random() % 4 == 0) m.color_map = {};
    if (random() % 2 == 0) m.specular_map = slot();
    if (random() % 4 != 0) m.metallic_roughness_map = slot();
    if (random() % 4 != 0) m.emission_map = slot();
    if (random() % 4 != 0) m.occlusion_map = slot();
    m.metallic = share(), m.roughness = share(), m.occlusion_strength = share();
    m.emission = {share(), 3 * share(), share()};
    m.unlit = random() % 6 == 0;
  }
}

/// Models that read maps of materials, each in its own way.
LightModel map_model(size_t i) {
  LightModel m = preset_pipeline(i % 2 == 0 ? "punctual" : "gl-fixed")->light_model;
  if (i % 4 == 2) m.emission = false;
  if (i % 8 == 3) m.specular_source = SpecularSource::metallic_roughness;
  if (i % 8 == 4) m.specular = Specular::none;
  if (i % 8 == 5) m.specular = Specular::phong;
  if (i % 8 == 7) m.order = TermOrder::albedo_last, m.specular = Specular::none;  // shows nothing unlit
  m.renormalize = true;
  m.clamp_result = false;
  m.alpha_from_albedo = true;
  return m;
}

Pipeline map_pipeline(Random& random, size_t i) {
  Pipeline p = random_pipeline(random);
  p.light_model = map_model(i);
  p.target = Format::rgba32f;
  p.strategy = i % 3 == 0 ? Strategy::forward_loop : Strategy::deferred_loop;
  for (PlaneState* plane : {&p.gbuffer.position, &p.gbuffer.normal, &p.gbuffer.albedo, &p.gbuffer.uv})
    plane->format = Format::rgba32f;
  p.gbuffer.specular = p.gbuffer.emission = Format::rgba32f;
  return p;
}

float value(const Frame& frame, size_t aov, int x, int y, int c) {
  const Image& image = frame.aovs[aov].image;
  return at<float>(image, x, image.height - 1 - y, c);  // y up
}

/// The largest step of texture coordinates' ulps in texels of any texture.
double moved_texels(const Scene& scene, const oracle::DrawnTriangle& t, Interpolation how, int x, int y) {
  double most = 0;
  for (const Texture& texture : scene.textures)
    most = std::max(most, value_at(t, oracle::kUv, how, x, y).ulp * texture.levels[0].width +
                              value_at(t, oracle::kUv + 1, how, x, y).ulp * texture.levels[0].height);
  return most;
}

}  // namespace

TEST_CASE("Planes of materials with maps of every kind are what the scalar renderer makes of them") {
  Random random(71);
  const std::vector<Execution> all = executions();
  size_t covered = 0, compared = 0, mapped = 0;
  for (size_t i = 0; i < 160; ++i) {
    Scene scene = random_scene(random);
    add_material_maps(random, scene);
    const Pipeline pipeline = map_pipeline(random, i);
    const LightModel& model = pipeline.light_model;
    const oracle::ScalarFrame expected = oracle::scalar_frame(scene, pipeline);
    const Execution& execution = all[i % all.size()];
    INFO("frame " << i << ", " << named(execution) << ", " << pipeline_json(pipeline));
    const Frame frame = render_frame(scene, pipeline, execution, kMaterialAovs);
    for (int y = 0; y < expected.height; ++y)
      for (int x = 0; x < expected.width; ++x) {
        const std::vector<oracle::Fragment>& fragments = expected.at(x, y);
        const oracle::Visible seen = visible_fragment(fragments, pipeline.geometry);
        if (!seen.certain || !seen.fragment) continue;
        ++covered;
        const oracle::Fragment& fragment = fragments[*seen.fragment];
        const oracle::DrawnTriangle& triangle = expected.triangles[fragment.window];
        const oracle::MaterialSurface s = material_surface(scene, pipeline, triangle, x, y);
        if (!s.certain) continue;
        ++compared;
        const Material& m = scene.materials[scene.instances[fragment.instance].material];
        mapped += m.metallic_roughness_map.used() && maps_metals(model) ? 1 : 0;
        // Of each of three factors up to 3: a texel that moved, and roundings.
        const double bound =
            9.0 * (4.0 * moved_texels(scene, triangle, pipeline.gbuffer.uv.interpolation, x, y) + 1e-6);
        CAPTURE(x, y, bound, m.unlit);
        for (size_t c = 0; c < 3; ++c) {
          const int k = int(c);
          CAPTURE(c, double(s.albedo[c]), double(s.specular[c]), double(s.emission[c]));
          REQUIRE(std::fabs(double(Real(value(frame, 1, x, y, k)) - s.albedo[c])) <= bound);
          if (reads_specular_plane(model))
            REQUIRE(std::fabs(double(Real(value(frame, 2, x, y, k)) - s.specular[c])) <= bound);
          if (model.emission) REQUIRE(std::fabs(double(Real(value(frame, 3, x, y, k)) - s.emission[c])) <= bound);
        }
        REQUIRE(std::fabs(double(Real(value(frame, 3, x, y, 3)) - (model.emission ? s.ambient_share : 1))) <= bound);
        if (!reads_specular_plane(model)) continue;
        // The nearest integer of an exponent whose roughness may be off.
        const Real r = std::max(s.roughness, Real(0.04)), steep = maps_metals(model) ? 8 / std::pow(r, 5.0L) : 0;
        const Real off = std::fabs(Real(value(frame, 2, x, y, 3)) - std::clamp<Real>(s.exponent, 1, 8192));
        CAPTURE(double(s.roughness), double(s.exponent), value(frame, 2, x, y, 3));
        if (maps_metals(model)) REQUIRE(double(off) <= 0.5 + 1e-9 + 2 * double(steep) * bound);
        if (!maps_metals(model)) REQUIRE(value(frame, 2, x, y, 3) == m.shininess);
      }
  }
  CAPTURE(covered, compared, mapped);
  CHECK(compared > covered / 100 * 97);
  CHECK(compared > 50000);
  CHECK(mapped > compared / 4);
}

TEST_CASE("Lights of surfaces with maps sum up to the scalar oracle's, ambient light by what arrives of it") {
  Random random(72);
  size_t compared = 0, shaded = 0;
  for (size_t i = 0; i < 64; ++i) {
    Scene scene = random_scene(random);
    add_material_maps(random, scene);
    for (Material& m : scene.materials) m.roughness = std::max(m.roughness, 0.7f), m.shininess = 8.0f;
    scene.lights.clear();
    for (int k = 0; k < 3; ++k) {
      scene.lights.push_back(ambient_light({0.3f, 0.2f, 0.4f}));
      scene.lights.push_back(bulb({float(k) - 1.0f, 1.0f, 2.0f}, 20.0f));
    }
    Pipeline pipeline = map_pipeline(random, i);
    if (i % 3 == 1) pipeline.light_model.global_ambient = {0.1f, 0.3f, 0.2f};
    const LightModel& model = pipeline.light_model;
    const Frame frame = render_frame(scene, pipeline, {}, kMaterialAovs);
    const oracle::ScalarFrame geometry = oracle::scalar_frame(scene, pipeline);
    for (int y = 0; y < pipeline.height; y += 2)
      for (int x = 0; x < pipeline.width; ++x) {
        if (at<uint32_t>(frame.aovs[0].image, x, pipeline.height - 1 - y) == 0) continue;
        oracle::Surface surface;
        for (size_t c = 0; c < 3; ++c) {
          const int k = int(c);
          surface.albedo[c] = double(value(frame, 1, x, y, k)), surface.specular[c] = double(value(frame, 2, x, y, k));
          surface.emission[c] = double(value(frame, 3, x, y, k)), surface.normal[c] = double(value(frame, 4, x, y, k));
          surface.position[c] = double(value(frame, 5, x, y, k));
        }
        surface.shininess = double(value(frame, 2, x, y, 3));
        surface.ambient_share = double(value(frame, 3, x, y, 3));
        if (surface.shininess > 64 || pipeline.gbuffer.position_from_depth) continue;
        LightModel local = model;
        local.viewer = Viewer::local;
        if (model.viewer != Viewer::local) continue;
        const oracle::LitSum real = lit_sum(surface, scene, local);
        if (real.nearest_threshold < 1e-5) continue;
        ++compared, shaded += surface.ambient_share < 0.9 && model.emission ? 1 : 0;
        for (size_t c = 0; c < 3; ++c) {
          const double bound = real.magnitude[c] * (100 + 8 * surface.shininess) * 0x1p-24 + 1e-30;
          const float sum = at<float>(frame.color, x, pipeline.height - 1 - y, int(c));
          CAPTURE(i, x, y, c, sum, real.color[c], bound, pipeline_json(pipeline));
          REQUIRE(std::fabs(double(sum) - real.color[c]) <= bound);
        }
      }
  }
  CHECK(compared > 5000);
  CHECK(shaded > compared / 8);
}

TEST_CASE("Pictures and planes of maps are the same bytes on every target, tile size, with and without short cuts") {
  Random random(73);
  for (size_t i = 0; i < 24; ++i) {
    Scene scene = random_scene(random);
    add_material_maps(random, scene);
    if (i % 2 == 0)
      for (Mesh& mesh : scene.meshes) mesh.color = {};
    if (i % 3 == 0)  // all maps read the same texels
      for (Material& m : scene.materials)
        m.metallic_roughness_map = m.emission_map = m.occlusion_map = m.normal_map = m.color_map;
    if (i % 6 == 5) scene.materials[0].transparent = true;
    scene.lights = {bulb({0.0f, 1.0f, 2.0f}, 30.0f), ambient_light({0.2f, 0.3f, 0.1f}),
                    bulb({1.0f, -1.0f, 1.0f}, 5.0f)};
    Pipeline pipeline = map_pipeline(random, i);
    pipeline.strategy = Strategy(i % std::size(kStrategyNames));
    for (PlaneState* plane :
         {&pipeline.gbuffer.position, &pipeline.gbuffer.normal, &pipeline.gbuffer.albedo, &pipeline.gbuffer.uv})
      if (i % 4 != 0) plane->interpolation = Interpolation::smooth;
    if (i % 5 == 0) pipeline.gbuffer.emission = Format::rgba8, pipeline.target = Format::rgba8;
    if (i % 5 == 1) pipeline.gbuffer.emission = Format::rgb16f, pipeline.gbuffer.specular = Format::rgba16f;
    Execution plain;
    plain.simd = "scalar";
    plain.fast_geometry = plain.compiled_models = plain.light_culling = plain.geometry_culling = false;
    const Frame expected = render_frame(scene, pipeline, plain, kMaterialAovs);
    for (Execution execution : executions())
      for (const bool culls : {false, true}) {
        execution.light_culling = execution.geometry_culling = execution.shuffle_tiles = culls;
        INFO(i << ", " << named(execution) << ", culling " << culls << ", " << pipeline_json(pipeline));
        const Frame frame = render_frame(scene, pipeline, execution, kMaterialAovs);
        REQUIRE(frame.color.texels == expected.color.texels);
        for (size_t k = 0; k < kMaterialAovs.size(); ++k)
          REQUIRE(frame.aovs[k].image.texels == expected.aovs[k].image.texels);
      }
  }
}

namespace {

/// A window whose column x shows texel x of a texture of 256 columns, one to one.
struct Columns {
  Scene scene;
  Pipeline pipeline = window_pipeline();

  explicit Columns(TextureFormat format) {
    const Corner low{0, 0, 0, 1, {0, 0}}, right{256, 0, 0, 1, {1, 0}}, top{0, 256, 0, 1, {0, 1}},
        high{256, 256, 0, 1, {1, 1}};
    scene = window_scene({{{low, right, top}}, {{right, high, top}}});
    Texture codes{"codes", format, {{256, 1, {}}}};
    for (int k = 0; k < 256; ++k)
      for (const int code : {k, k, 255 - k, 255}) codes.levels[0].bytes.push_back(uint8_t(code));
    scene.textures = {codes};
  }
  TextureSlot slot() const {
    TextureSlot slot;
    slot.texture = 0;
    slot.sampler.mag_filter = slot.sampler.min_filter = Filter::nearest;
    slot.sampler.mip_filter = MipFilter::none;
    return slot;
  }
};

bool within_ulps(float given, Real real, int ulps) {
  return std::fabs(Real(given) - real) <= ulps * 0x1p-24L * std::max(std::fabs(real), 1e-6L);
}

}  // namespace

TEST_CASE("Every code of a map of metal and roughness gives glTF's specular colour, albedo and exponent") {
  Columns columns(TextureFormat::rgba8);
  Scene& scene = columns.scene;
  scene.materials[0].base_color = {0.9f, 0.5f, 0.1f, 1.0f};
  scene.materials[0].metallic_roughness_map = columns.slot();
  columns.pipeline.light_model = preset_pipeline("punctual")->light_model;
  for (const float factor : {1.0f, 0.7f, 0.33f}) {
    scene.materials[0].metallic = scene.materials[0].roughness = factor;
    const Frame frame = render_frame(scene, columns.pipeline, {}, kMaterialAovs);
    int halves = 0;
    for (int k = 0; k < 256; ++k) {
      const Real green = Real(k) / 255, blue = Real(255 - k) / 255;  // roughness, metallic
      const Real r = std::max(Real(factor) * green, 0.04L), exponent = 2 / (r * r * r * r) - 2;
      const Real share = Real(factor) * blue;
      CAPTURE(factor, k, double(exponent));
      if (std::fabs(exponent - std::floor(exponent) - 0.5L) < 1e-3L * (1 + exponent * 1e-3L) && exponent < 8193)
        ++halves;  // the float roughness decides
      else
        CHECK(Real(value(frame, 2, k, 100, 3)) == std::clamp<Real>(std::round(exponent), 1, 8192));
      for (int c = 0; c < 3; ++c) {
        const Real base = scene.materials[0].base_color[c];
        CHECK(within_ulps(value(frame, 1, k, 100, c), base * (1 - share), 260));  // 1 - share cancels
        CHECK(within_ulps(value(frame, 2, k, 100, c), 0.04L * (1 - share) + base * share, 8));
      }
    }
    CHECK(halves < 8);
  }
}

TEST_CASE("The exponent of a looked-up roughness is the one that shininess_of_roughness() gives the same float") {
  Columns columns(TextureFormat::rgba32f);
  Texture& texture = columns.scene.textures[0];
  Random random(74);
  columns.pipeline.light_model = preset_pipeline("punctual")->light_model;
  Material& m = columns.scene.materials[0];
  m.metallic_roughness_map = columns.slot();
  m.roughness = 1.0f;
  for (int round = 0; round < 40; ++round) {
    std::vector<float> roughness;
    texture.levels[0].bytes.clear();
    for (int k = 0; k < 256; ++k) {
      roughness.push_back(float(between(random, 0, round % 2 == 0 ? 1.0 : 0.2)));
      append_texel(texture.format, {0.0f, roughness.back(), 0.5f, 1.0f}, texture.levels[0].bytes);
    }
    for (const Execution& execution : executions()) {
      const Frame frame = render_frame(columns.scene, columns.pipeline, execution, kMaterialAovs);
      for (int k = 0; k < 256; ++k) {
        CAPTURE(round, k, roughness[size_t(k)], named(execution));
        REQUIRE(value(frame, 2, k, 17, 3) == shininess_of_roughness(roughness[size_t(k)]));
      }
      if (round > 2) break;
    }
  }
}

TEST_CASE("Emission maps are sRGB where their texture is, and occlusion is 1 + strength (R - 1)") {
  for (const TextureFormat format : {TextureFormat::rgba8, TextureFormat::srgb8_a8}) {
    Columns columns(format);
    Material& m = columns.scene.materials[0];
    m.emission = {2.0f, 0.5f, 1.0f};
    m.emission_map = m.occlusion_map = columns.slot();
    m.occlusion_strength = 0.6f;
    columns.pipeline.light_model = preset_pipeline("punctual")->light_model;
    columns.pipeline.target = Format::rgba32f;
    columns.scene.lights = {ambient_light({0.25f, 0.5f, 0.75f})};
    const Frame frame = render_frame(columns.scene, columns.pipeline, {}, kMaterialAovs);
    for (int k = 0; k < 256; ++k) {
      const auto linear = [&](int code) {
        const Real c = Real(code) / 255;
        if (format == TextureFormat::rgba8) return c;
        return c <= 0.04045L ? c / 12.92L : std::pow((c + 0.055L) / 1.055L, 2.4L);
      };
      const Real codes[] = {linear(k), linear(k), linear(255 - k)};
      const Real arriving = 1 + 0.6L * (codes[0] - 1);
      CAPTURE(k, int(format));
      CHECK(within_ulps(value(frame, 3, k, 9, 3), arriving, 8));
      for (int c = 0; c < 3; ++c) {
        CHECK(within_ulps(value(frame, 3, k, 9, c), Real(m.emission[c]) * codes[c], 4));
        const Real lit = Real(m.emission[c]) * codes[c] + Real(columns.scene.lights[0].color[c]) * arriving;
        CHECK(within_ulps(at<float>(frame.color, k, 9, c), lit * 1.0L, 16));
      }
    }
  }
}

namespace {

/// The built-in lecture, textured, with lights of every kind.
Scene lit_lecture() {
  Scene scene = builtin_scene("lecture,lights=6");
  scene.lights.push_back(ambient_light({0.3f, 0.3f, 0.3f}));
  return scene;
}

}  // namespace

TEST_CASE("No light changes an unlit surface: it shows base colour times map, in every strategy, blended or masked") {
  Scene scene = lit_lecture();
  for (Material& m : scene.materials) {
    m.unlit = true;
    m.emission = {5.0f, 5.0f, 5.0f};  // not read
    m.occlusion_map = m.emission_map = m.metallic_roughness_map = m.color_map;
  }
  scene.materials[0].alpha_cutoff = 0.3f;
  scene.materials[1 % scene.materials.size()].transparent = true;
  scene.materials[1 % scene.materials.size()].base_color.a = 0.5f;
  Scene dark = scene, plain = scene;
  dark.lights.clear();
  for (Material& m : plain.materials) m.unlit = false;
  Pipeline as_it_is = pipeline_of("many-lights", 160, 120);  // its albedo plane is the colour
  as_it_is.gbuffer.albedo.format = Format::rgba32f;
  const Frame colors = render_frame(plain, as_it_is, {}, kMaterialAovs);
  for (const char* preset : {"punctual", "gl-fixed"})
    for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy) {
      Pipeline pipeline = pipeline_of(preset, 160, 120);
      pipeline.strategy = Strategy(strategy);
      pipeline.target = Format::rgba32f;
      pipeline.gbuffer.albedo.format = Format::rgba32f;
      INFO(preset << ", " << kStrategyNames[strategy]);
      const Frame lit = render_frame(scene, pipeline, {}, kMaterialAovs);
      CHECK(lit.color.texels == render_frame(dark, pipeline).color.texels);
      CHECK(lit.color.texels != render_frame(plain, pipeline).color.texels);
      Scene opaque = scene, opaque_plain = plain;
      for (Scene* s : {&opaque, &opaque_plain})
        for (Material& m : s->materials) m.transparent = false;
      const Frame shown = render_frame(opaque, pipeline, {}, kMaterialAovs);
      const Frame color = render_frame(opaque_plain, as_it_is, {}, kMaterialAovs);
      size_t covered = 0;
      for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
          if (at<uint32_t>(shown.aovs[0].image, x, y) == 0) continue;
          ++covered;
          for (int c = 0; c < 3; ++c) {
            REQUIRE(at<float>(shown.color, x, y, c) == at<float>(color.aovs[1].image, x, y, c));
            REQUIRE(at<float>(shown.aovs[1].image, x, y, c) == 0.0f);
            REQUIRE(at<float>(shown.aovs[2].image, x, y, c) == 0.0f);
          }
          REQUIRE(at<float>(shown.aovs[1].image, x, y, 3) == at<float>(color.aovs[1].image, x, y, 3));
          REQUIRE(at<float>(shown.aovs[3].image, x, y, 3) == 1.0f);
        }
      CHECK(covered > 5000);
    }
}

TEST_CASE("Unlit materials are lit where the model cannot show them as they are, and as glass in the albedo") {
  Scene scene = lit_lecture(), plain = scene;
  for (Material& m : scene.materials) m.unlit = true;
  Pipeline tinted = pipeline_of("gl-fixed", 80, 60), own = tinted, none = tinted;
  tinted.light_model.order = TermOrder::albedo_last, tinted.light_model.specular = Specular::none;
  own.light_model.specular_source = SpecularSource::model;
  none.light_model.emission = false;
  for (const Pipeline& pipeline : {tinted, own, none})
    CHECK(render_frame(scene, pipeline).color.texels == render_frame(plain, pipeline).color.texels);
  Pipeline glass = pipeline_of("punctual", 80, 60);
  glass.transparency.mode = TransparencyMode::into_albedo;
  for (Scene* s : {&scene, &plain}) s->materials[1 % s->materials.size()].transparent = true;
  for (size_t i = 0; i < scene.materials.size(); ++i) scene.materials[i].unlit = scene.materials[i].transparent;
  CHECK(render_frame(scene, glass).color.texels == render_frame(plain, glass).color.texels);
}

TEST_CASE("Maps that a model does not read change nothing") {
  Random random(75);
  for (int i = 0; i < 12; ++i) {
    Scene scene = random_scene(random);
    add_material_maps(random, scene);
    for (Material& m : scene.materials) m.unlit = false;
    scene.lights = {bulb({0.0f, 1.0f, 2.0f}, 30.0f), ambient_light({0.2f, 0.3f, 0.1f})};
    Scene without = scene;
    for (Material& m : without.materials) m.metallic_roughness_map = m.emission_map = m.occlusion_map = {};
    for (const char* preset : {"many-lights", "touchdesigner", "lecture", "light-volumes", "redsdk"}) {
      Pipeline pipeline = random_pipeline(random);
      const Pipeline row = *preset_pipeline(preset);
      pipeline.light_model = row.light_model, pipeline.strategy = row.strategy,
      pipeline.light_volumes = row.light_volumes;
      INFO(i << ", " << preset);
      const Frame with = render_frame(scene, pipeline, {}, kMaterialAovs);
      const Frame alone = render_frame(without, pipeline, {}, kMaterialAovs);
      CHECK(with.color.texels == alone.color.texels);
      for (size_t k = 0; k < kMaterialAovs.size(); ++k) CHECK(with.aovs[k].image.texels == alone.aovs[k].image.texels);
    }
  }
}

TEST_CASE("A scene without emission is drawn as if a material that nothing wears had some") {
  for (const char* name : {"lecture,lights=6", "city,objects=120,lights=20"}) {
    Scene scene = builtin_scene(name);
    scene.lights.push_back(ambient_light({0.1f, 0.2f, 0.3f}));
    scene.materials[0].transparent = true;
    Scene glowing = scene;
    glowing.materials.emplace_back().emission = glm::vec3(1.0f);
    for (const char* preset : {"punctual", "gl-fixed"})
      for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy)
        for (const Format target : {Format::rgba32f, Format::rgba8}) {
          Pipeline pipeline = pipeline_of(preset, 120, 90);
          pipeline.strategy = Strategy(strategy), pipeline.target = target;
          INFO(name << ", " << preset << ", " << kStrategyNames[strategy] << ", " << int(target));
          const Frame without = render_frame(scene, pipeline, {}, kMaterialAovs);
          const Frame with = render_frame(glowing, pipeline, {}, kMaterialAovs);
          CHECK(without.color.texels == with.color.texels);
          for (size_t k = 0; k < kMaterialAovs.size(); ++k)
            CHECK(without.aovs[k].image.texels == with.aovs[k].image.texels);
          CHECK(without.stats.gl.gbuffer_fragments_read == with.stats.gl.gbuffer_fragments_read);
        }
  }
}
