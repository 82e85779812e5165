// Sums whose codes are proved by bounds (docs/proofs.md sections 16 and 19) against the sums themselves.
#include <algorithm>
#include <glm/geometric.hpp>

#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/shading/light_sheet.h"

using namespace trueshade;

namespace {

const std::vector<std::string> kCountPlane{"light.count"};

Pipeline summing_pipeline(std::string_view preset, Format target) {
  Pipeline p = *preset_pipeline(preset);
  p.width = 57, p.height = 43;
  p.target = target;
  p.gbuffer.albedo.format = Format::rgba32f;
  return p;
}

// Point lights whose sum is now dark and now beyond 1.
void add_lights(Random& random, size_t count, double brightness, Scene& scene) {
  while (scene.lights.size() < count) {
    Light light = random_light(random);
    light.type = random() % 4 == 0 ? LightType::spot : LightType::point;
    light.color *= float(brightness / double(count));
    if (random() % 8 == 0) light.color = glm::vec3(0.0f);
    if (random() % 8 == 0) light.position = light.position * 30.0f;
    scene.lights.push_back(light);
  }
}

// What the kernels may be troubled by: surfaces brighter than white, normals of any length, some that face away.
void trouble(Random& random, Mesh& mesh) {
  const float size = float_between(random, 0.2, 1.9);
  for (size_t i = 0; i < mesh.normal[0].size(); ++i) {
    for (auto& stream : mesh.normal) stream[i] *= size;
    if (random() % 8 == 0) mesh.normal[2][i] = -mesh.normal[2][i];
    if (random() % 4 == 0) mesh.color[random() % 3][i] = float_between(random, -0.5, 8);
  }
}

}  // namespace

TEST_CASE("Codes that bounds prove are those of the sums, and so are the lights counted") {
  Random random(434);
  uint64_t fewer = 0, frames = 0;
  for (int i = 0; i < 48; ++i) {
    Scene scene = sheet(random);
    if (i % 3 == 1) trouble(random, scene.meshes[0]);
    add_lights(random, 32 + size_t(random() % 500), float_between(random, 0.5, 8), scene);
    if (i % 4 == 1) scene.lights[random() % scene.lights.size()].position = scene.camera.eye;
    const Format targets[] = {Format::rgba8, Format::rgb10_a2, Format::srgb8_a8};
    Pipeline p = summing_pipeline("touchdesigner", targets[i % 3]);
    if (i % 5 == 1) p.strategy = Strategy::forward_loop;
    if (i % 5 == 2) p.light_model.viewer = Viewer::infinite;
    if (i % 5 == 3) p.light_model.order = TermOrder::factored;
    const PreparedScene prepared(scene);
    const Frame sums = render_frame(prepared, p, {.light_culling = false, .bounded_codes = false}, kCountPlane);
    for (const std::string_view simd : simd_targets()) {
      INFO("scene " << i << ", " << simd);
      const Frame bounded = render_frame(prepared, p, {.simd = simd}, kCountPlane);
      CHECK(image_hash(bounded.color) == image_hash(sums.color));
      CHECK(image_hash(bounded.aovs[0].image) == image_hash(sums.aovs[0].image));
      CHECK(bounded.stats.lit_pixel_lights == sums.stats.lit_pixel_lights);
      fewer += bounded.stats.evaluated_pixel_lights < sums.stats.evaluated_pixel_lights;
      ++frames;
    }
  }
  CHECK(fewer >= frames / 2);  // that is, sums were settled
}

TEST_CASE("So are those of sums under lights with a linear window, among lights of all kinds") {
  Random random(436);
  int otherwise = 0, frames = 0;
  for (int i = 0; i < 32; ++i) {
    Scene scene = sheet(random);
    if (i % 4 == 1) trouble(random, scene.meshes[0]);
    // More than are listed, at times, and as many: all of them reach all of the sheet where they are large.
    const size_t edge[] = {255, 256, 257};
    const size_t count = i % 8 == 6 ? edge[i / 8 % 3] : 1 + size_t(random() % (i % 8 == 7 ? 400 : 100));
    while (scene.lights.size() < count) {
      Light light = random_light(random);
      if (i % 2 == 0) light.type = LightType::point;
      light.color *= float(float_between(random, 0.5, 8)) / float(count);
      if (i % 8 == 6) light.range = 1000.0f;
      scene.lights.push_back(light);
    }
    if (i % 4 == 2) scene.lights[random() % count].position = scene.camera.eye;
    if (i % 16 == 3) scene.lights[random() % count].color[1] = 65.0f;  // more than bounds are for
    constexpr Format kTargets[] = {Format::rgba8, Format::rgba8, Format::rgba8, Format::rgb10_a2, Format::srgb8_a8};
    Pipeline p = summing_pipeline("many-lights", kTargets[i % 5]);
    if (i % 3 == 1) p.strategy = Strategy::forward_loop;
    if (i % 7 == 2) p.light_model.viewer = Viewer::infinite;
    if (i % 11 == 5) p.light_model.global_ambient = glm::vec3(0.1f);
    if (i % 13 == 6) p.light_model.specular_color = {0.0f, 0.5f, 4.0f};
    const PreparedScene prepared(scene);
    const Frame sums = render_frame(prepared, p, {.light_culling = false, .bounded_codes = false}, kCountPlane);
    for (const std::string_view simd : simd_targets()) {
      INFO("scene " << i << ", " << simd);
      const Frame bounded = render_frame(prepared, p, {.tile = i % 2 == 0 ? 0 : 8, .simd = simd}, kCountPlane);
      CHECK(image_hash(bounded.color) == image_hash(sums.color));
      CHECK(image_hash(bounded.aovs[0].image) == image_hash(sums.aovs[0].image));
      CHECK(bounded.stats.lit_pixel_lights == sums.stats.lit_pixel_lights);
      const Frame added = render_frame(prepared, p, {.simd = simd, .bounded_codes = false}, kCountPlane);
      otherwise += bounded.stats.evaluated_pixel_lights != added.stats.evaluated_pixel_lights;
      ++frames;
    }
  }
  CAPTURE(otherwise, frames);
  CHECK(otherwise > frames / 4);  // that is, sums were settled, where lights and target allow it
}

TEST_CASE("So are codes of sums that lie on the edge between two of them, all over the picture") {
  Random random(435);
  for (int i = 0; i < 24; ++i) {
    const std::string_view preset = i % 2 == 0 ? "touchdesigner" : "many-lights";
    Scene scene = sheet(random);
    Mesh& mesh = scene.meshes[0];
    for (size_t v = 0; v < mesh.position[0].size(); ++v) {
      mesh.position[2][v] = 0.0f;
      for (size_t k = 0; k < 3; ++k) mesh.normal[k][v] = k == 2 ? 1.0f : 0.0f;
    }
    add_lights(random, i % 2 == 0 ? 100 + size_t(random() % 300) : 4 + size_t(random() % 200), 2, scene);
    for (Light& light : scene.lights) {  // so far away that they shine alike on all of the sheet
      light.position = glm::vec3(light.position.x, light.position.y, 0.3f + std::abs(light.position.z)) * 500.0f;
      light.attenuation = {1, 0, 0};
      light.range = 3.0f * glm::length(light.position);
    }
    // The sum is linear in the albedo: two sums give the one whose code is about to change.
    const auto with_albedo = [&](float albedo, Format target, const Execution& e) {
      for (size_t k = 0; k < 3; ++k) std::fill(mesh.color[k].begin(), mesh.color[k].end(), albedo);
      return render_frame(scene, summing_pipeline(preset, target), e).color;
    };
    scene.camera.eye = {0.0f, 0.0f, 2000.0f};
    scene.camera.fov_y_rad = 0.0015f;
    scene.camera.near = 1000.0f, scene.camera.far = 4000.0f;

    const double none = with_albedo(0.0f, Format::rgba32f, {}).value(28, 21, 0);
    const double one = with_albedo(1.0f, Format::rgba32f, {}).value(28, 21, 0);
    const int code = int(255.0 * (none + 0.5 * (one - none)));
    REQUIRE(one > none);
    const auto albedo = float(((code + 0.5) / 255.0 - none) / (one - none));
    const Image sums = with_albedo(albedo, Format::rgba8, {.bounded_codes = false});
    int low = 0, high = 0;
    for (int y = 0; y < sums.height; ++y)
      for (int x = 0; x < sums.width; ++x) {
        low += sums.code(x, y, 0) == uint32_t(code);
        high += sums.code(x, y, 0) == uint32_t(code) + 1;
      }
    INFO("scene " << i << ": " << low << " pixels below, " << high << " above");
    CHECK(low > 0);
    CHECK(high > 0);
    CHECK(low + high == sums.width * sums.height);
    for (const std::string_view simd : simd_targets())
      CHECK(image_hash(with_albedo(albedo, Format::rgba8, {.simd = simd})) == image_hash(sums));
  }
}
