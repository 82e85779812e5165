// No false alarm on a driver: random scenes by llvmpipe, triangles begun at any vertex, the picture moved by whole
// pixels.
#include <cstdio>

#include "gl/driver/renderer.h"
#include "judge/stages/validate.h"
#include "tests/catch.hpp"
#include "tests/judge/drivers.h"
#include "tests/judge/random_scene.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

struct Alarms {
  int images = 0, rejected = 0, rejected_by_own = 0;
};

/// Every stage; light by light and object by object where `watched` draws the image again.
bool alarm(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
           GlRenderer* watched, const std::string& what) {
  ValidateOptions options{profile, false, {}, {}};
  const auto shown = [&](StepSink GlDraw::*show) -> LightSteps {
    return [watched, show, pipeline](const StepSink& sink) {
      GlDraw draw;
      draw.*show = sink;
      watched->draw(pipeline, draw);
    };
  };
  if (watched != nullptr && blends_lights(pipeline.strategy)) options.steps = shown(&GlDraw::after_light);
  if (watched != nullptr) options.objects = shown(&GlDraw::after_object);
  bool alarm = false;
  for (const StageVerdict& v : validate_capture(scene, pipeline, capture, options).stages) {
    if (v.passes()) continue;
    alarm = true;
    const WorstPixel& w = v.worst.front();
    WARN(what << ", " << profile.name << " " << v.stage << " " << v.count(PixelClass::violation) << " px, (" << w.x
              << ", " << w.y << ") " << w.plane << " [" << w.low << ", " << w.high << "] given " << w.given << " "
              << w.note);
  }
  return alarm;
}

/// Any strategy, with any extents of lights that it may have, into any target.
void any_way_of_light_volumes(Pipeline& pipeline, Pcg32& random) {
  pipeline.strategy = Strategy(random.below(uint32_t(std::size(kStrategyNames))));
  pipeline.target = kTargetFormats[random.below(uint32_t(std::size(kTargetFormats)))];
  if (pipeline.strategy == Strategy::deferred_volumes)
    for (LightExtent* extent : {&pipeline.light_volumes.point, &pipeline.light_volumes.spot})
      *extent = LightExtent(random.below(5));
  if (pipeline.light_volumes.point == LightExtent::cone) pipeline.light_volumes.point = LightExtent::sphere;
  pipeline.light_volumes.base = random.below(4) != 0;
  if (is_forward(pipeline.strategy) && pipeline.transparency.mode == TransparencyMode::into_albedo)
    pipeline.transparency.mode = TransparencyMode::after_lights;
  validate(pipeline);
}

/// `scenes` scenes, each by a pipeline of its own in three rotations, each rotation where it is and moved three ways.
Alarms turned_and_moved(const GlContext& context, int scenes, uint64_t first_seed) {
  Profile unknown;
  unknown.subpixel_bits = context.info().subpixel_bits;
  const Profile own = *profile_named("mesa-llvmpipe-22.3");
  const bool known = testing::is_of_known_profile(context);
  Alarms alarms;
  for (int i = 0; i < scenes; ++i) {
    Pcg32 random(first_seed + uint64_t(i));
    const Scene scene = testing::random_scene(random);
    Pipeline pipeline = testing::random_pipeline(random);
    any_way_of_light_volumes(pipeline, random);
    for (int rotation = 0; rotation < 3; ++rotation) {
      GlRenderer renderer(context, scene, rotation);
      for (int move = 0; move < 4; ++move) {
        GlDraw draw;
        if (move > 0) {
          draw.shift_x = int(random.below(200));
          draw.shift_y = int(random.below(200));
        }
        const Capture capture = renderer.draw(pipeline, draw).capture;
        const std::string what = "scene " + std::to_string(first_seed + uint64_t(i)) + " turned by " +
                                 std::to_string(rotation) + ", moved by (" + std::to_string(draw.shift_x) + ", " +
                                 std::to_string(draw.shift_y) + ")";
        GlRenderer* const watched = move == 0 ? &renderer : nullptr;
        ++alarms.images;
        alarms.rejected += alarm(scene, pipeline, unknown, capture, watched, what) ? 1 : 0;
        if (known) alarms.rejected_by_own += alarm(scene, pipeline, own, capture, watched, what) ? 1 : 0;
      }
    }
  }
  std::printf("llvmpipe turned and moved: %d images, %d rejected, %d by its own profile\n", alarms.images,
              alarms.rejected, alarms.rejected_by_own);
  return alarms;
}

}  // namespace

TEST_CASE("Of seventy-two images by llvmpipe, triangles turned and pictures moved, none is rejected") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Alarms alarms = turned_and_moved(*context, 6, 1);
  CHECK(alarms.images == 72);
  CHECK(alarms.rejected == 0);
  CHECK(alarms.rejected_by_own == 0);
}

TEST_CASE("Of ten thousand images by llvmpipe, triangles turned and pictures moved, at most one is rejected",
          "[long]") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Alarms alarms = turned_and_moved(*context, 834, 1000);
  CHECK(alarms.images == 10008);
  CHECK(alarms.rejected <= 1);
  CHECK(alarms.rejected_by_own <= 1);
}
