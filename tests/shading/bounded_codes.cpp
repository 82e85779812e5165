// Codes of single lights' terms that bounds prove (docs/proofs.md section 17) against the terms themselves.
#include <algorithm>
#include <cmath>

#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/shading/light_sheet.h"

using namespace trueshade;

namespace {

const std::vector<std::string> kCounts{"light.count"};

Pipeline blending_pipeline(std::string_view preset, Format target) {
  Pipeline p = *preset_pipeline(preset);
  p.width = 57, p.height = 43;
  p.target = target;
  p.light_volumes.cull_face = CullFace::front;  // once, wherever the camera is
  return p;
}

void check_ways(const Scene& scene, const Pipeline& p) {
  const PreparedScene prepared(scene);
  const Frame terms = render_frame(prepared, p, {.light_culling = false, .bounded_codes = false}, kCounts);
  for (const std::string_view simd : simd_targets()) {
    INFO(simd);
    const Frame bounded = render_frame(prepared, p, {.simd = simd}, kCounts);
    CHECK(image_hash(bounded.color) == image_hash(terms.color));
    CHECK(image_hash(bounded.aovs[0].image) == image_hash(terms.aovs[0].image));
    CHECK(bounded.stats.lit_pixel_lights == terms.stats.lit_pixel_lights);
  }
}

// A flat sheet seen from afar through a narrow field, so that what shines from far away is nearly even on it.
void flatten(Scene& scene) {
  Mesh& mesh = scene.meshes[0];
  for (size_t v = 0; v < mesh.position[0].size(); ++v) {
    mesh.position[2][v] = 0.0f;
    for (size_t k = 0; k < 3; ++k) mesh.normal[k][v] = k == 2 ? 1.0f : 0.0f;
  }
  scene.camera.eye = {0.0f, 0.0f, 2000.0f};
  scene.camera.fov_y_rad = 0.0015f;
  scene.camera.near = 1000.0f, scene.camera.far = 4000.0f;
}

// Holds pictures whose every pixel lies at the edge of two codes. The term is linear in the albedo.
// Returns whether both codes occur.
bool check_edges(Random& random, std::string_view preset, const Light& light, Scene scene) {
  flatten(scene);
  scene.lights = {light};
  const auto with_albedo = [&](const glm::vec3& albedo, Format target, const Execution& e) {
    for (size_t k = 0; k < 3; ++k)
      std::fill(scene.meshes[0].color[k].begin(), scene.meshes[0].color[k].end(), albedo[int(k)]);
    Pipeline p = blending_pipeline(preset, target);
    for (PlaneState* plane : {&p.gbuffer.position, &p.gbuffer.normal, &p.gbuffer.albedo})
      plane->format = Format::rgba32f;
    return render_frame(scene, p, e).color;
  };
  const Image one = with_albedo(glm::vec3(1.0f), Format::rgba32f, {});
  glm::vec3 albedo;
  int code[3];
  for (int k = 0; k < 3; ++k) {
    const double most = one.value(28, 21, k);
    REQUIRE(most > 0.01);
    code[k] = int(255.0 * std::min(most, 1.0) * float_between(random, 0.3, 0.99));
    albedo[k] = float((code[k] + 0.5) / 255.0 / most);
    if (albedo[k] > 1.0f) code[k] -= 1, albedo[k] = float((code[k] + 0.5) / 255.0 / most);
  }
  const Image terms = with_albedo(albedo, Format::rgba8, {.bounded_codes = false});
  int low = 0, high = 0;
  for (int y = 0; y < terms.height; ++y)
    for (int x = 0; x < terms.width; ++x)
      for (int k = 0; k < 3; ++k) {
        low += terms.code(x, y, k) == uint32_t(code[k]);
        high += terms.code(x, y, k) == uint32_t(code[k]) + 1;
      }
  INFO(low << " below, " << high << " above");
  for (const std::string_view simd : simd_targets())
    CHECK(image_hash(with_albedo(albedo, Format::rgba8, {.simd = simd})) == image_hash(terms));
  return low > 0 && high > 0 && low + high > terms.width * terms.height;  // a highlight may vary by more
}

Light far_light(Random& random, double brightest) {
  Light light;
  light.position =
      glm::vec3(float_between(random, -1, 1), float_between(random, -1, 1), float_between(random, 200, 3000));
  const glm::vec3 at = light.position;
  light.range = std::sqrt(at.x * at.x + at.y * at.y + at.z * at.z) * float_between(random, 1.2, 4.0);
  light.color = glm::vec3(float_between(random, 0.2, brightest), float_between(random, 0.2, brightest),
                          float_between(random, 0.2, brightest));
  return light;
}

// In the highlight or beside it; the sheet in the cone, in its penumbra or where a point shines.
Light phong_light(Random& random) {
  Light light = far_light(random, 0.95);
  if (random() % 2 == 0) light.position.x += light.position.z * float_between(random, 0, 0.6);
  light.range = 3.0f * light.position.z;
  if (random() % 4 == 0) return light;
  light.type = LightType::spot;
  light.cone_rad = 0.45f, light.penumbra_rad = 0.2f;
  const double away = float_between(random, 0, 0.58) + std::atan2(double(light.position.x), double(light.position.z));
  light.direction = glm::vec3(float(-std::sin(away)), 0.0f, float(-std::cos(away)));
  return light;
}

}  // namespace

TEST_CASE("Codes of lights that bounds prove are those of their terms, and so are the lights counted") {
  Random random(811);
  for (int i = 0; i < 32; ++i) {
    INFO("scene " << i);
    Scene scene = sheet(random);
    const size_t count = 1 + random() % 300;  // more than are listed at once, at times
    while (scene.lights.size() < count) {
      Light light = random_light(random);
      if (random() % 4 != 0) light.type = LightType::point;
      if (random() % 2 == 0) light.color *= float_between(random, 0, 0.5);
      if (random() % 16 == 0) light.color *= 20.0f;  // beyond what bounds are for
      scene.lights.push_back(light);
    }
    Mesh& mesh = scene.meshes[0];
    if (i % 4 == 1)
      for (auto& stream : mesh.normal)
        for (float& n : stream) n *= 1.5f;
    if (i % 4 == 2) scene.lights[random() % count].position = scene.camera.eye;
    if (i % 4 == 3)
      for (size_t v = 0; v < mesh.color[0].size(); v += 7) mesh.color[random() % 3][v] = float_between(random, -2, 8);
    constexpr Format kTargets[] = {Format::rgba8, Format::rgba8, Format::rgb10_a2, Format::rgba16f};
    Pipeline p = blending_pipeline(i % 8 < 4 ? "light-volumes" : "redsdk", kTargets[i % 4]);
    if (i % 2 == 1) p.gbuffer.albedo.format = Format::rgba32f;
    check_ways(scene, p);
  }
}

TEST_CASE("So are codes of terms that lie on the edge between two of them, all over the picture") {
  Random random(812);
  int crossed = 0;
  for (int i = 0; i < 200; ++i) {
    INFO("light " << i);
    crossed += check_edges(random, "light-volumes", far_light(random, i % 2 == 0 ? 1.1 : 1.8), sheet(random));
    crossed += check_edges(random, "redsdk", phong_light(random), sheet(random));
  }
  CHECK(crossed > 200);
}
