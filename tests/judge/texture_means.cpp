// Textures all over an image: faults that each pixel's latitude hides are convicted, and lookups that go one legal way
// are not.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "judge/legal/texel_changes.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/builtin/texture_pattern.h"
#include "scenes/pipeline/presets.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/loose_renderer.h"
#include "tests/judge/random_frames.h"

using namespace trueshade;
using namespace trueshade::oracle;
using trueshade::testing::captured;
using trueshade::testing::Liberties;

namespace {

Mesh with_slanted_uv(Mesh mesh, float times) {
  mesh.uv = {};
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    mesh.uv[0].push_back((mesh.position[0][v] + 0.37f * mesh.position[1][v]) * times);
    mesh.uv[1].push_back((mesh.position[2][v] - 0.21f * mesh.position[1][v]) * times);
  }
  return mesh;
}

Texture pattern(Pattern of, TextureFormat format, int cells, uint64_t seed) {
  TexturePattern p;
  p.pattern = of;
  p.width = p.height = 128;
  p.columns = p.rows = cells;
  p.format = format;
  p.seed = seed;
  p.colors = {glm::vec4(0.9f, 0.6f, 0.3f, 1.0f), glm::vec4(0.1f, 0.2f, 0.5f, 1.0f)};
  Texture t = texture_of(p);
  build_mip_chain(t);
  return t;
}

Sampler sampler_of(Filter filter, MipFilter mip) {
  Sampler s;
  s.mag_filter = s.min_filter = filter, s.mip_filter = mip;
  return s;
}

/// A floor that runs to the horizon and a ball before it, both with colour and normal maps.
Scene room(Pattern of, TextureFormat format, const Sampler& sampler, int segments = 28) {
  Scene scene;
  scene.spec = "room";
  scene.meshes = {with_slanted_uv(plane_mesh(segments / 2), 4.0f), with_slanted_uv(sphere_mesh(segments), 1.0f)};
  scene.textures = {pattern(of, format, 8, 1), pattern(Pattern::noise, TextureFormat::rgba8, 8, 2)};
  for (int i = 0; i < 2; ++i) {
    Material m;
    m.base_color = {0.9f, 1.0f, 0.8f, 1.0f};
    m.color_map.texture = 0, m.normal_map.texture = 1;
    m.color_map.sampler = m.normal_map.sampler = sampler;
    scene.materials.push_back(m);
  }
  scene.instances = {
      {0, 0, glm::mat4x3(glm::vec3(6, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 9), glm::vec3(0, -1, -3.6f))},
      {1, 1,
       glm::mat4x3(glm::vec3(0.8f, 0, 0), glm::vec3(0, 0.8f, 0), glm::vec3(0, 0, 0.8f), glm::vec3(0.2f, 0, -1.5f))}};
  scene.lights.emplace_back();
  scene.lights.back().position = {1, 2, 1}, scene.lights.back().range = 10.0f;
  scene.camera.eye = {0.1f, 0.2f, 1.5f};
  scene.camera.near = 0.1f, scene.camera.far = 50.0f;
  return scene;
}

struct TexturedCase {
  const char* name;
  Scene scene;
};

std::vector<TexturedCase> cases() {
  const Sampler trilinear = sampler_of(Filter::linear, MipFilter::linear);
  return {{"lecture", builtin_scene("lecture")},
          {"brick", room(Pattern::brick, TextureFormat::srgb8_a8, trilinear)},
          {"noise", room(Pattern::noise, TextureFormat::rgba8, trilinear)}};
}

Pipeline pipeline_of(Format albedo) {
  Pipeline p;
  p.width = 128, p.height = 96;
  p.gbuffer.albedo.format = albedo;
  return p;
}

Verdict judged_by_means(const Scene& scene, const Pipeline& pipeline, const Capture& capture) {
  ValidateOptions options;
  options.profile = testing::unknown_of_8_bits();
  return validate_capture(scene, pipeline, capture, options);
}

/// Whether a map is blamed: some pixels may be violations, too.
bool blames_textures(const Verdict& v) {
  return std::any_of(v.materials.begin(), v.materials.end(), [](const MaterialEvidence& e) { return e.against; });
}

struct TextureFault {
  const char* name;
  void (*plant)(Scene&);
  bool of_normals = false;
};

template <class Change>
void change_slots(Scene& s, const Change& change) {
  for (Material& m : s.materials)
    for (TextureSlot* slot : maps_of(m))
      if (slot->used()) change(slot->sampler);
}

constexpr TextureFault kTextureFaults[] = {
    {"base colour x0.99",
     [](Scene& s) {
       for (Material& m : s.materials) m.base_color *= glm::vec4(0.99f, 0.99f, 0.99f, 1);
     }},
    {"base colour x1.01",
     [](Scene& s) {
       for (Material& m : s.materials) m.base_color *= glm::vec4(1.01f, 1.01f, 1.01f, 1);
     }},
    {"levels +0.25", [](Scene& s) { change_slots(s, [](Sampler& m) { m.lod_bias += 0.25f; }); }},
    {"levels -0.25", [](Scene& s) { change_slots(s, [](Sampler& m) { m.lod_bias -= 0.25f; }); }},
    {"normal scale x1.05",
     [](Scene& s) {
       for (Material& m : s.materials) m.normal_scale *= 1.05f;
     },
     true},
};

}  // namespace

TEST_CASE("A gain, a level or a scale of all lookups is convicted though each of them is legal") {
  for (const TexturedCase& c : cases())
    for (const Format albedo : {Format::rgba8, Format::rgba16f}) {
      const Pipeline pipeline = pipeline_of(albedo);
      const Verdict right = judged_by_means(c.scene, pipeline, captured(c.scene, pipeline));
      INFO(c.name << ' ' << info(albedo).name);
      CHECK_FALSE(right.convicted());
      for (const TextureFault& fault : kTextureFaults) {
        if (fault.of_normals && !c.scene.materials[0].normal_map.used()) continue;
        Scene wrong = c.scene;
        fault.plant(wrong);
        const Verdict v = judged_by_means(c.scene, pipeline, captured(wrong, pipeline));
        INFO(fault.name);
        CHECK(blames_textures(v));
      }
    }
}

TEST_CASE(
    "Maps of which one is decoded after it is filtered, and the other before, are convicted together, not apart") {
  const Sampler trilinear = sampler_of(Filter::linear, MipFilter::linear);
  Scene scene = room(Pattern::noise, TextureFormat::srgb8_a8, trilinear, 8);
  scene.textures.push_back(scene.textures[0]);
  scene.materials[1].color_map.texture = 2;
  Pipeline pipeline = pipeline_of(Format::rgba8);
  const auto drawn = [&](bool late) {
    Liberties l;
    l.way.emplace(), l.decode_late = late;
    return testing::loose_frame(scene, pipeline, l, 1);
  };
  const Capture early = drawn(false), late = drawn(true);
  for (const Capture* one_way : {&early, &late}) CHECK_FALSE(judged_by_means(scene, pipeline, *one_way).convicted());
  Capture mixed = early;
  for (size_t i = 0; i < mixed.planes.size(); ++i) {
    if (mixed.planes[i].name != "albedo") continue;
    for (int y = 0; y < pipeline.height; ++y)
      for (int x = 0; x < pipeline.width; ++x)
        if (early.plane("id.object")->value(x, y, 0) == 2)
          std::copy_n(late.planes[i].image.texel(x, y), 4, mixed.planes[i].image.texel(x, y));
  }
  const Verdict v = judged_by_means(scene, pipeline, mixed);
  CHECK(v.violations() == 0);
  CHECK(v.convicted());
  CHECK(v.evidence_line().find("another order") != std::string::npos);
}

TEST_CASE("A nearest texel is in doubt where that of the next level is, which is read as well") {
  const Texture texture = pattern(Pattern::noise, TextureFormat::rgba8, 8, 1);
  const long double slope = 1.4L / 128;
  const auto is_told = [&](long double u) {
    const TexturePlace place{u, 0.3L, slope, 0, 0, slope};
    return texel_changes(texture, sampler_of(Filter::nearest, MipFilter::linear), place, false, {}).has_value();
  };
  CHECK(is_told(64.25L / 128));
  CHECK_FALSE(is_told(64.02L / 128));  // 0.01 of a texel off in level 1
}

namespace {

testing::TextureWay random_way(Pcg32& random) {
  testing::TextureWay w;
  w.rho = random.below(3) == 0 ? 0 : random.between(-1, 1);
  w.levels_off = random.between(-0.05, 0.05);
  w.weight_bits = random.below(3) == 0 ? 0 : 8;
  w.cuts_weights = random.below(2) == 0;
  if (random.below(3) != 0) w.step_threshold = random.below(2) == 0 ? 0.5 : random.between(0, 1);
  w.mesa_decode = random.below(4) == 0;
  return w;
}

int convicted_of(int count, uint64_t first_seed) {
  int alarms = 0;
  for (int i = 0; i < count; ++i) {
    Pcg32 random(first_seed + uint64_t(i));
    const Sampler sampler = sampler_of(Filter(random.below(2)), MipFilter(random.below(3)));
    Scene scene = room(Pattern(random.below(3)), TextureFormat(random.below(4)), sampler, 8);
    Pipeline pipeline = pipeline_of(random.below(2) == 0 ? Format::rgba8 : Format::rgba16f);
    pipeline.width = 64, pipeline.height = 48;
    Liberties l;
    l.any_rounding = random.below(2) == 0, l.snapped_planes = random.below(2) == 0;
    l.decode_late = random.below(3) == 0;
    l.way = random_way(random);
    const Verdict v =
        judged_by_means(scene, pipeline, testing::loose_frame(scene, pipeline, l, first_seed + uint64_t(i)));
    if (v.violations() == 0 && !v.convicted()) continue;
    ++alarms;
    WARN("image of seed " << first_seed + uint64_t(i) << ": " << v.violations() << " violations; "
                          << v.evidence_line());
  }
  return alarms;
}

}  // namespace

TEST_CASE("Lookups that go one legal way all over an image are not convicted") { CHECK(convicted_of(40, 1) == 0); }

TEST_CASE("Maps that agree on one order of decoding are not convicted where the other order leaves as little") {
  CHECK(convicted_of(1, 446) == 0);
}

TEST_CASE("A texel that is read alone shows no order of filtering and decoding") {
  const Texture texture = pattern(Pattern::noise, TextureFormat::srgb8_a8, 8, 1);
  for (int i = 0; i < 64; ++i) {
    const TexturePlace place{(i + 0.37L) / 64, 0.41L, 0.004L, 0.001L, 0.001L, 0.004L};
    const auto read = texel_changes(texture, sampler_of(Filter::nearest, MipFilter::nearest), place, false, {});
    if (read) CHECK(read->change[size_t(TexelCause::order)] == TexelChanges::Rgba{});
  }
}

// LEGAL_IMAGES=N in the environment judges N, from the seed LEGAL_FIRST on.
TEST_CASE("Of ten thousand images whose lookups go one legal way at most one is convicted", "[long]") {
  const char* const asked = std::getenv("LEGAL_IMAGES");
  const int count = asked != nullptr ? std::atoi(asked) : 10000, alarms = convicted_of(count, testing::long_first(1));
  std::printf("images whose lookups go one legal way: %d, convicted %d\n", count, alarms);
  CHECK(alarms <= 1);
}

namespace {

/// A built-in scene behind a pane of glass that fills most of the picture. Its vertices have colours of their own: what
/// few colours tell, the rounding of blends may make as well.
Scene behind_glass(const char* name, float alpha) {
  Scene scene = builtin_scene(name);
  Pcg32 random(7);
  for (Mesh& mesh : scene.meshes)
    for (auto& channel : mesh.color) {
      channel = {};
      for (size_t v = 0; v < mesh.vertex_count(); ++v) channel.push_back(float(random.between(0, 1)));
    }
  Material glass;
  glass.base_color = {0.3f, 0.5f, 0.6f, alpha};
  glass.transparent = true;
  scene.materials.push_back(glass);
  scene.meshes.push_back(plane_mesh(1));
  const glm::vec3 forward = glm::normalize(scene.camera.target - scene.camera.eye),
                  right = glm::normalize(glm::cross(forward, scene.camera.up)), up = glm::cross(right, forward);
  const float distance = 2 * scene.camera.near;
  scene.instances.push_back(
      {uint32_t(scene.meshes.size() - 1), uint32_t(scene.materials.size() - 1),
       glm::mat4x3(right * distance, -forward * distance, up * distance, scene.camera.eye + forward * distance)});
  return scene;
}

}  // namespace

TEST_CASE("Glass whose alpha is 0.49 for 0.5 is convicted though each pixel is legal, and right glass is not") {
  for (const char* name : {"city,lights=20,objects=300", "cornell", "circle,lights=20"})
    for (const TransparencyMode mode : {TransparencyMode::after_lights, TransparencyMode::into_albedo})
      for (const Format format : {Format::rgba8, Format::rgba16f}) {
        Pipeline pipeline = pipeline_of(format);
        pipeline.transparency.mode = mode;
        pipeline.target = format;
        const Scene right = behind_glass(name, 0.5f), wrong = behind_glass(name, 0.49f);
        INFO(name << ' ' << int(mode) << ' ' << info(format).name);
        const Verdict v = judged_by_means(right, pipeline, captured(wrong, pipeline));
        INFO(v.evidence_line());
        CHECK((v.violations() > 0 || v.convicted()));
        CHECK_FALSE(judged_by_means(right, pipeline, captured(right, pipeline)).convicted());
      }
}
