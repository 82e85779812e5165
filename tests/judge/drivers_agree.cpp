// docs/gl_rules.md row 62: the scene of section 6's caveat by two drivers. Where they show different surfaces the judge
// explains it.
#include <cstdio>

#include "gl/driver/renderer.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/drivers.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

/// A hundred and sixty balls of 288 triangles on a floor, some through each other: 46,178 triangles; 64 lights.
Scene crowded_scene() {
  Scene scene;
  scene.spec = "crowded";
  scene.meshes = {sphere_mesh(6), plane_mesh(7)};
  Pcg32 random(62);
  scene.materials.push_back({"floor", {0.6f, 0.6f, 0.55f, 1.0f}});
  scene.instances.push_back({1, 0, placed({0.0, -1.5, 0.0}, {14.0, 1.0, 14.0}, 0.3)});
  for (uint32_t i = 0; i < 160; ++i) {
    scene.materials.push_back({"", {random.between(0.1, 1), random.between(0.1, 1), random.between(0.1, 1), 1}});
    const glm::dvec3 centre{random.between(-4, 4), random.between(-1.2, 2.2), random.between(-5, 2)};
    const glm::dvec3 size{random.between(0.2, 0.6), random.between(0.2, 0.6), random.between(0.2, 0.6)};
    scene.instances.push_back({0, i + 1, placed(centre, size, random.between(0, 6))});
  }
  for (int i = 0; i < 64; ++i) {
    Light light;
    light.position = {random.between(-5, 5), random.between(-1, 4), random.between(-5, 4)};
    light.color = {random.between(0.1, 0.5), random.between(0.1, 0.5), random.between(0.1, 0.5)};
    light.range = float(random.between(1.5, 4));
    scene.lights.push_back(light);
  }
  scene.camera.eye = {0.0f, 1.0f, 8.0f};
  scene.camera.near = 0.5f;
  scene.camera.far = 50.0f;
  return scene;
}

Pipeline caveat_pipeline() {
  Pipeline p;
  p.width = 512, p.height = 384;
  p.light_model.shininess = 64;
  p.gbuffer.normal.format = Format::rgba16f;
  return p;
}

void draw_and_hand_over(GlDriver which) {
  if (!testing::is_elsewhere()) return;
  const GlContext* context = testing::opened(which);
  if (context == nullptr) return;
  const Scene scene = crowded_scene();
  testing::hand_over(GlRenderer(*context, scene).draw(caveat_pipeline()).capture);
}

bool other_surface(PixelClass c) {
  return c == PixelClass::edge || c == PixelClass::depth_tie || c == PixelClass::clip;
}

}  // namespace

// Do nothing unless drawn_elsewhere() starts them; [long] keeps them out of the list of tests.
TEST_CASE("drawer: row 62 by llvmpipe", "[.][long][drawer]") { draw_and_hand_over(GlDriver::llvmpipe); }
TEST_CASE("drawer: row 62 by softpipe", "[.][long][drawer]") { draw_and_hand_over(GlDriver::softpipe); }

TEST_CASE("Row 62: llvmpipe and softpipe differ on a crowded scene, and each pixel of both is explained", "[slow]") {
  const Scene scene = crowded_scene();
  const Pipeline pipeline = caveat_pipeline();
  CHECK(scene.triangle_count() == 46178);
  const std::optional<Capture> captures[] = {testing::drawn_elsewhere("drawer: row 62 by llvmpipe"),
                                             testing::drawn_elsewhere("drawer: row 62 by softpipe")};
  if (!captures[0] || !captures[1]) return;
  Profile profile;
  profile.subpixel_bits = 8;  // softpipe says 4 and does not snap: within half of any grid
  Verdict verdicts[2];
  for (size_t i = 0; i < 2; ++i) {
    verdicts[i] = validate_capture(scene, pipeline, *captures[i], {profile, false});
    INFO(verdict_json(verdicts[i]));
    CHECK(verdicts[i].violations() == 0);
    for (const StageVerdict& s : verdicts[i].stages) {
      std::printf("%.40s %s:", captures[i]->driver.c_str(), s.stage.c_str());
      for (size_t c = 0; c < kPixelClasses; ++c)
        if (s.counts[c] > 0) std::printf(" %s %d", std::string(text(PixelClass(c))).c_str(), int(s.counts[c]));
      std::printf("; predicted %.1f, error / bound %.3f\n", s.predicted_other, s.worst_error);
    }
  }
  const std::vector<PixelClass>&a = verdicts[0].stages[0].classes, &b = verdicts[1].stages[0].classes;
  const Image *ids = captures[0]->plane("id.object"), *other_ids = captures[1]->plane("id.object");
  REQUIRE((ids != nullptr && other_ids != nullptr));
  int objects = 0, surfaces = 0, unexplained = 0, codes = 0, off_by_more = 0;
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x) {
      const size_t i = size_t(y) * size_t(pipeline.width) + size_t(x);
      const bool object = ids->value(x, y, 0) != other_ids->value(x, y, 0);
      const bool explained = other_surface(a[i]) || other_surface(b[i]);
      objects += object ? 1 : 0;
      surfaces += object || other_surface(a[i]) != other_surface(b[i]) ? 1 : 0;
      if (object && !explained) ++unexplained;
      int apart = 0;
      for (int k = 0; k < 3; ++k)
        apart =
            std::max(apart, std::abs(int(captures[0]->color.texel(x, y)[k]) - int(captures[1]->color.texel(x, y)[k])));
      codes += apart > 0 ? 1 : 0;
      off_by_more += apart > 1 ? 1 : 0;
    }
  std::printf(
      "llvmpipe and softpipe: %d px of another object, %d px of another surface, %d unexplained; %d lit px differ, %d "
      "by more than a code\n",
      objects, surfaces, unexplained, codes, off_by_more);
  CHECK(unexplained == 0);
  CHECK(surfaces > 0);  // else there was nothing to explain
}
