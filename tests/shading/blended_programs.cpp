// Light programs under the strategies that blend light by light: against presets whose formula a program states, and
// against a dull loop that blends what the sum gives of one light at a time by the oracle's blender.
#include "core/simd/simd_target.h"
#include "oracle/blend.h"
#include "scenes/builtin/builtin.h"
#include "scenes/light_models/stated_model.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/shading/many_lights_text.h"
#include "tests/shading/square_mesh.h"
#include "tests/stated_presets.h"

using namespace trueshade;
using trueshade::testing::kManyLights;

namespace {

struct Formula {
  const char* preset;
  const char* text;
};

// The preset light-volumes, for lights of every type.
constexpr const char* kLightVolumes = R"glsl(
vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return s.albedo.rgb * l.color;
  vec3 D = l.position - s.position;
  float d = length(D), r = d > 0.0 ? 1.0 / d : 0.0, f = 1.0 - d / l.range, a = dot(s.normal, D);
  if (l.type == light_type_directional) a = dot(s.normal, -l.direction), r = 1.0, f = 1.0;
  if (!(a > 0.0) || !(f > 0.0)) return vec3(0.0);
  return (s.albedo.rgb * (a * r)) * (l.color * f);
}
)glsl";

constexpr Formula kFormulas[] = {{"many-lights", kManyLights}, {"light-volumes", kLightVolumes}};

struct Way {
  const char* what;
  Strategy strategy;
  LightExtent extent = LightExtent::unbounded;
  CullFace cull = CullFace::none;
  bool base = true, alpha = false;
  TransparencyMode glass = TransparencyMode::after_lights;
};

constexpr Way kWays[] = {
    {"passes", Strategy::forward_multipass},
    {"passes that end", Strategy::forward_multipass, LightExtent::range},
    {"quads, glass in the albedo", Strategy::deferred_volumes, LightExtent::unbounded, CullFace::none, true, false,
     TransparencyMode::into_albedo},
    {"quads that end, alpha too", Strategy::deferred_volumes, LightExtent::range, CullFace::none, true, true},
    {"boxes", Strategy::deferred_volumes, LightExtent::box, CullFace::front},
    {"boxes drawn twice, no base", Strategy::deferred_volumes, LightExtent::box, CullFace::none, false, true},
    {"spheres", Strategy::deferred_volumes, LightExtent::sphere, CullFace::back},
};

Pipeline drawn_by(const Way& way, Pipeline p, Format target) {
  p.width = 96, p.height = 64;
  p.strategy = way.strategy, p.target = target;
  p.light_volumes.point = p.light_volumes.spot = way.extent;
  p.light_volumes.cull_face = way.cull, p.light_volumes.base = way.base;
  p.blend.mask[3] = way.alpha;
  p.transparency.mode = way.glass;
  return p;
}

LightProgram program_with(const std::string& text) { return {"lights.glsl", text, {}, {}}; }

std::string hashes(const Frame& frame) {
  std::string all = image_hash(frame.color);
  for (const NamedImage& plane : frame.aovs) all += ' ' + image_hash(plane.image);
  return all;
}

/// What never changes a pixel.
std::vector<Execution> executions() {
  std::vector<Execution> all{{.threads = 1, .tile = 8, .shuffle_tiles = true},
                             {.threads = 3, .tile = 48, .geometry_culling = false},
                             {.tile = 32, .light_culling = false}};
  for (const std::string_view simd : simd_targets()) all.push_back({.tile = 16, .simd = simd, .count_as_gl = true});
  return all;
}

/// Names of the executions, by number, that draw something else.
std::string others(const PreparedScene& scene, const Pipeline& pipeline, const std::vector<std::string>& planes,
                   const std::string& expected) {
  std::string out;
  const std::vector<Execution> all = executions();
  for (size_t i = 0; i < all.size(); ++i)
    if (hashes(render_frame(scene, pipeline, all[i], planes)) != expected) out += ' ' + std::to_string(i);
  return out;
}

}  // namespace

TEST_CASE("A program that states a preset's formula blends the preset's frame, bit for bit") {
  for (const char* name : {"city,objects=300,lights=60", "cornell", "atrium,lights=32,glass=1"}) {
    const Scene scene = builtin_scene(name);
    const PreparedScene prepared(scene);
    for (const Formula& formula : kFormulas)
      for (const Way& way : kWays)
        for (const Format target : {Format::rgba8, Format::rgba16f, Format::rgba32f}) {
          std::vector<std::string> planes{"light.0", "light.2"};
          if (formula.text == kManyLights) planes.push_back("light.count");
          const Pipeline preset = drawn_by(way, *preset_pipeline(formula.preset), target);
          Pipeline asked = preset;
          asked.light_program = program_with(formula.text);
          INFO(name << ", " << formula.preset << ", " << way.what << ", " << info(target).name);
          CHECK(others(prepared, asked, planes, hashes(render_frame(prepared, preset, {}, planes))) == "");
        }
  }
}

TEST_CASE("Presets whose models are programs blend their own frames, bit for bit") {
  Scene scene = builtin_scene("cornell,lights=6");
  for (size_t i = 0; i < scene.lights.size(); i += 2) {
    Light& light = scene.lights[i];
    light.type = LightType::spot, light.direction = {0.0f, -1.0f, 0.0f};
    light.cone_rad = 0.6f, light.penumbra_rad = 0.3f, light.spot_exponent = 3.0f;
  }
  const PreparedScene prepared(scene);
  const std::vector<std::string> planes{"light.1"};
  for (const Preset& preset : stated_presets()) {
    // Its surfaces have metal and roughness made into another pair, which programs are not given.
    if (preset.pipeline.light_model.specular_source == SpecularSource::metallic_roughness) continue;
    for (const Way& way : kWays)
      for (const Format target : {Format::rgba8, Format::rgba16f}) {
        const Pipeline own = drawn_by(way, preset.pipeline, target);
        Pipeline asked = own;
        asked.light_program = program_of(own.light_model);
        INFO(preset.name << ", " << way.what << ", " << info(target).name);
        CHECK(others(prepared, asked, planes, hashes(render_frame(prepared, own, {}, planes))) == "");
      }
  }
}

namespace {

constexpr const char* kLight = R"glsl(
vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position;
  return s.albedo.rgb * l.color * (dot(normalize(d), s.normal) / (0.5 + dot(d, d))) - 0.01;
}
)glsl";
constexpr const char* kFinish =
    "vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum.gbr * s.albedo.a + 0.02, "
    "0.25 + 0.5 * sum.g); }\n";
constexpr const char* kStart =
    "vec3 start(Surface s, View v) { return 0.1 * s.albedo.rgb + 0.001 * float(s.pixel_x); }\n";
constexpr BlendTerm kOver{BlendEquation::add, BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha};

/// What the documented rule draws, a pixel and a light at a time, from frames of sums that have one light each.
class DullFrame {
 public:
  DullFrame(const Scene& scene, const Pipeline& pipeline, bool finishes) : scene_(scene), pipeline_(pipeline) {
    const bool passes = pipeline.strategy == Strategy::forward_multipass;
    const std::string rest = finishes ? kFinish : "";
    first_ = sum(std::string(kLight) + kStart + rest, passes ? std::span(scene.lights).first(1) : std::span<Light>());
    material_ = std::move(first_.aovs[0].image);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
      const std::span<const Light> alone = std::span(scene.lights).subspan(i, 1);
      light_.push_back(sum(kLight + rest, alone).color);
      reach_.push_back(sum("vec3 light(Surface s, Light l, View v) { return vec3(1); }", alone).color);
    }
  }

  oracle::Rgba pixel(int x, int y) const {
    const bool passes = pipeline_.strategy == Strategy::forward_multipass;
    const uint32_t material = uint32_t(material_.code(x, y, 0));
    const glm::vec4& clear = scene_.clear;
    oracle::Rgba stored = drawn(BlendState{}, {clear.r, clear.g, clear.b, clear.a}, {});
    if (material == 0) return stored;
    if (passes || pipeline_.light_volumes.base) stored = drawn(BlendState{}, at(first_.color, x, y), stored);
    for (size_t i = passes ? 1 : 0; i < light_.size() && !scene_.materials[material - 1].unlit; ++i)
      if (reach_[i].value(x, y, 0) == 1.0)
        stored = drawn(passes ? kAddLight : pipeline_.blend, at(light_[i], x, y), stored);
    return stored;
  }

 private:
  static oracle::Rgba at(const Image& image, int x, int y) {
    oracle::Rgba out;
    for (int c = 0; c < 4; ++c) out[size_t(c)] = float(image.value(x, y, c));
    return out;
  }
  oracle::Rgba drawn(const BlendState& state, const oracle::Rgba& source, const oracle::Rgba& stored) const {
    return oracle::blended_pixel(state, pipeline_.profile, pipeline_.target, pipeline_.gbuffer.half_round, source,
                                 stored);
  }
  Frame sum(const std::string& text, std::span<const Light> lights) const {
    Scene scene = scene_;
    scene.lights.assign(lights.begin(), lights.end());
    Pipeline p = pipeline_;
    p.strategy = is_forward(p.strategy) ? Strategy::forward_loop : Strategy::deferred_loop;
    p.target = Format::rgba32f, p.profile = NumericProfile::ideal;
    p.light_program = program_with(text);
    return render_frame(scene, p, {}, std::vector<std::string>{"id.material"});
  }

  const Scene& scene_;
  const Pipeline& pipeline_;
  Frame first_;
  Image material_;
  std::vector<Image> light_, reach_;
};

float stored_value(const Image& image, int x, int y, int c) {
  return info(image.format).number_class == NumberClass::unorm ? float(image.code(x, y, c))
                                                               : float(image.value(x, y, c));
}

}  // namespace

TEST_CASE("Draws of a program are what the sum gives of one light, blended one after the other by the oracle") {
  Scene scene = builtin_scene("cornell,lights=5");
  scene.clear = {0.25f, 0.5f, 0.125f, 0.75f};
  for (size_t i = 0; i < scene.materials.size(); ++i) scene.materials[i].unlit = i % 3 == 1;
  const PreparedScene prepared(scene);
  const BlendState over{true, kOver, kOver, {}, {true, true, true, true}};
  int lit = 0;
  for (const bool finishes : {false, true})
    for (const Way& way : kWays) {
      if (way.extent > LightExtent::range) continue;
      for (const Format target : {Format::rgba8, Format::rgba16f, Format::rgba32f, Format::srgb8_a8}) {
        Pipeline p = drawn_by(way, *preset_pipeline("many-lights"), target);
        p.width = 48, p.height = 40;
        if (way.alpha) p.blend = over;
        p.light_program = program_with(std::string(kLight) + kStart + (finishes ? kFinish : ""));
        INFO(way.what << ", " << info(target).name << (finishes ? ", with finish" : ""));
        const Frame frame = render_frame(prepared, p);
        CHECK(others(prepared, p, {}, image_hash(frame.color)) == "");
        const DullFrame dull(scene, p, finishes);
        std::string wrong;
        for (int y = 0; y < p.height && wrong.empty(); ++y)
          for (int x = 0; x < p.width && wrong.empty(); ++x) {
            const oracle::Rgba expected = dull.pixel(x, y);
            for (int c = 0; c < 4; ++c)
              if (const float value = stored_value(frame.color, x, y, c); value != expected[size_t(c)])
                wrong += std::to_string(x) + ", " + std::to_string(y) + ", channel " + std::to_string(c) + ": " +
                         std::to_string(value) + ", not " + std::to_string(expected[size_t(c)]) + "; ";
            lit += frame.stats.lit_pixel_lights > 0;
          }
        CHECK(wrong == "");
      }
    }
  CHECK(lit > 0);
}

TEST_CASE("Fragments that share a pixel's depth are drawn by every light of a program but the first") {
  for (const char* const end : {"", "vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum + 0.5, 1); }"})
    for (const int times : {1, 2, 5}) {
      Scene scene;
      scene.camera.eye = {0.0f, 0.0f, 5.0f};
      scene.meshes.push_back(testing::square_mesh());
      scene.materials.resize(1);
      for (int i = 0; i < times; ++i) scene.instances.push_back({0, 0, glm::mat4x3(4.0f)});
      for (const float strength : {0.125f, 0.03125f, 0.0625f}) {
        scene.lights.emplace_back();
        scene.lights.back().color = glm::vec3(strength), scene.lights.back().range = 100.0f;
      }
      Pipeline p = drawn_by(kWays[0], *preset_pipeline("many-lights"), Format::rgba32f);
      p.light_program = program_with(std::string("vec3 light(Surface s, Light l, View v) { return l.color; }") + end);
      const double each = *end == 0 ? 0.0 : 0.5;
      for (const std::string_view simd : simd_targets()) {
        const Frame frame = render_frame(scene, p, {.simd = simd}, std::vector<std::string>{"light.count"});
        CHECK(frame.color.value(48, 32, 0) == 0.125 + each + times * (0.03125 + 0.0625 + 2 * each));
        CHECK(frame.color.value(48, 32, 3) == 1.0);
        CHECK(frame.aovs[0].image.code(48, 32, 0) == uint32_t(1 + 2 * times));
      }
    }
}
