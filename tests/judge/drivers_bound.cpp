// docs/gl_rules.md row 57 on real drivers: 256 x 128 pixels, N lights, shininess s, lighting judged from the driver's
// own planes.
#include <cmath>
#include <cstdio>

#include "gl/driver/renderer.h"
#include "judge/stages/judge.h"
#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"
#include "tests/judge/drivers.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

constexpr int kCityWidth = 256, kCityHeight = 128;

/// A wavy sheet that fills the view, `count` lights before it whose colours add up to about one.
Scene wavy_scene(int count, float shininess) {
  Scene scene;
  scene.spec = "wavy";
  Mesh sheet;
  constexpr int kColumns = 64, kRows = 32;
  for (int r = 0; r <= kRows; ++r)
    for (int c = 0; c <= kColumns; ++c) {
      const double u = 2.0 * c / kColumns - 1, v = 2.0 * r / kRows - 1;
      const double p[] = {2.6 * u, 1.3 * v, 0.3 * std::sin(4 * u) * std::cos(3 * v)};
      const double n[] = {-0.6 * std::cos(4 * u) * std::cos(3 * v), 0.9 * std::sin(4 * u) * std::sin(3 * v), 1};
      for (size_t k = 0; k < 3; ++k) {
        sheet.position[k].push_back(float(p[k]));
        sheet.normal[k].push_back(float(n[k]));
      }
    }
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const auto a = uint32_t(r * (kColumns + 1) + c), above = a + uint32_t(kColumns) + 1;
      for (const uint32_t i : {a, a + 1, above + 1, a, above + 1, above}) sheet.indices.push_back(i);
    }
  scene.meshes.push_back(std::move(sheet));
  scene.materials.push_back({"", {0.5f, 0.75f, 0.25f, 1.0f}});
  scene.instances.push_back({});
  scene.camera.eye = {0.0f, 0.0f, 4.0f};
  scene.camera.fov_y_rad = 0.55f;
  Pcg32 random(uint64_t(count) * 1000 + uint64_t(shininess));
  for (int i = 0; i < count; ++i) {
    Light light;
    light.position = {random.between(-3, 3), random.between(-3, 3), random.between(0.5, 4)};
    light.color = glm::vec3(float(1.0 / count)) *
                  glm::vec3{random.between(0.2, 1), random.between(0.2, 1), random.between(0.2, 1)};
    light.range = float(random.between(3, 9));
    scene.lights.push_back(light);
  }
  return scene;
}

void judge_cases(GlDriver which, std::initializer_list<int> counts) {
  const GlContext* context = testing::opened(which);
  if (context == nullptr) return;
  KeptPrograms programs;
  const Profile unknown;
  double largest = 0;
  for (const int count : counts)
    for (const float s : {8.0f, 64.0f, 256.0f}) {
      const Scene scene = wavy_scene(count, s);
      GlRenderer renderer(*context, scene, 0, &programs);
      Pipeline pipeline;
      pipeline.width = kCityWidth, pipeline.height = kCityHeight;
      pipeline.light_model.shininess = s;
      pipeline.target = Format::rgba32f;
      const StageVerdict floats = judge_lighting(scene, pipeline, unknown, renderer.draw(pipeline).capture);
      pipeline.target = Format::rgba8;
      const StageVerdict codes = judge_lighting(scene, pipeline, unknown, renderer.draw(pipeline).capture);
      std::printf(
          "%s N %3d s %3.0f: rgba32f error / bound %.3f, %d BRANCH, %d VIOLATION; rgba8 %d EXACT, %d STORE-2, %d "
          "BRANCH, %d VIOLATION\n",
          which == GlDriver::softpipe ? "softpipe" : "llvmpipe", count, double(s), floats.worst_error,
          int(floats.count(PixelClass::branch)), int(floats.count(PixelClass::violation)),
          int(codes.count(PixelClass::exact)), int(codes.count(PixelClass::store_2)),
          int(codes.count(PixelClass::branch)), int(codes.count(PixelClass::violation)));
      std::fflush(stdout);
      CAPTURE(count, s);
      CHECK(floats.covered == uint64_t(kCityWidth) * kCityHeight);
      CHECK(floats.passes());
      CHECK(codes.passes());
      CHECK(floats.worst_error > 0);
      CHECK(floats.worst_error <= 0.2);
      largest = std::max(largest, floats.worst_error);
    }
  std::printf("largest error / bound %.3f, %s\n", largest, context->info().line().c_str());
}

}  // namespace

TEST_CASE("Row 57: what llvmpipe lights is within a fifth of the bound") {
  judge_cases(GlDriver::llvmpipe, {1, 8, 64});
}
TEST_CASE("Row 57: what softpipe lights is within a fifth of the bound") { judge_cases(GlDriver::softpipe, {1, 8}); }
TEST_CASE("Row 57: what llvmpipe lights with 256 lights is too", "[long]") { judge_cases(GlDriver::llvmpipe, {256}); }
TEST_CASE("Row 57: what softpipe lights with 64 and 256 lights is too", "[long]") {
  judge_cases(GlDriver::softpipe, {64, 256});
}
