// Samples that lie on edges and corners: the explanation gives each to the triangle that the frame gives it to.
#include <vector>

#include "explain/explain.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

namespace trueshade {
namespace {

using testing::Corners;

/// A fan of triangles about a sample, whose corners are samples too.
std::vector<Corners> fan_about(double x, double y) {
  constexpr double kAround[8][2] = {{6, 0}, {6, 6}, {0, 6}, {-6, 6}, {-6, 0}, {-6, -6}, {0, -6}, {6, -6}};
  std::vector<Corners> fan;
  for (size_t i = 0; i < 8; ++i) {
    const auto *const a = kAround[i], *const b = kAround[(i + 1) % 8];
    fan.push_back({{{x, y}, {x + a[0], y + a[1]}, {x + b[0], y + b[1]}}});
  }
  return fan;
}

uint32_t object_at(const ExplainedFrame& frame, int x, int y_up) {
  const PixelHistory history = history_of(frame, x, frame.pipeline.height - 1 - y_up);
  return history.visible ? history.opaque.covering[*history.visible].instance + 1 : 0;
}

TEST_CASE("a sample on an edge belongs to the triangle that the frame gives it to, under both clip origins") {
  for (const ClipOrigin origin : {ClipOrigin::lower_left, ClipOrigin::upper_left}) {
    std::vector<std::vector<Corners>> objects;
    for (const Corners& triangle : fan_about(20.5, 20.5)) objects.push_back({triangle});
    const Scene scene = testing::window_objects(objects);
    Pipeline pipeline = testing::window_pipeline();
    pipeline.geometry.clip_origin = origin;
    const testing::Planes planes = testing::drawn(scene, pipeline, {});
    const ExplainedFrame frame(scene, pipeline);
    int covered = 0;
    for (int y = 0; y < 256; ++y)
      for (int x = 10; x < 32; ++x) {
        const bool near = (y >= 10 && y < 32) || (y >= 256 - 32 && y < 256 - 10);
        if (!near) continue;
        CAPTURE(x, y);
        const uint32_t there = planes.object[planes.index(x, y)];
        REQUIRE(object_at(frame, x, y) == there);
        covered += there != 0;
      }
    CHECK(covered >= 12 * 12);
  }
}

TEST_CASE("an explanation says which triangles nearly cover a sample, and how far they are") {
  // The left edge of a square stands a quarter of a pixel to the right of the sample of column 20.
  const Scene scene = testing::window_scene({{{{20.75, 10}, {40, 10}, {20.75, 40}}}});
  const ExplainedFrame frame(scene, testing::window_pipeline());
  const PixelHistory history = history_of(frame, 20, 255 - 20);
  CHECK_FALSE(history.visible.has_value());
  REQUIRE(history.opaque.nearest.size() == 1);
  CHECK(history.opaque.nearest[0].distance == Approx(0.25));
}

}  // namespace
}  // namespace trueshade
