// Clusters that the near plane cuts: which tiles they are drawn in.
#include <array>
#include <vector>

#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

namespace trueshade::testing {
namespace {

/// A triangle that the near plane cuts, w = 2 / 3: its first corner lies before that plane, the others behind. `turn`:
/// which edge of the window it lies beside, right, top, left or bottom; `gap` pixels are between the edge and its
/// nearest point. The box around it, in object space, lies beside the view too.
Corners cut_beside(int turn, double gap) {
  constexpr double kNearW = 0.4, kFarW = 2.0;
  const auto corner = [&](double out, double along, double w) {
    const double past = kWindow + gap + out;
    const double x = turn % 2 == 0 ? past : along, y = turn % 2 == 0 ? along : past;
    return turn < 2 ? Corner{x, y, 0, w} : Corner{turn == 2 ? kWindow - x : x, turn == 3 ? kWindow - y : y, 0, w};
  };
  return {corner(600, 100, kNearW), corner(0, 40, kFarW), corner(0, 220, kFarW)};
}

FrameStats stats_of(const Scene& scene) { return render_frame(scene, window_pipeline(), {.tile = 32}).stats; }

TEST_CASE("What the near plane cuts beside the view is set up in no tile") {
  for (int turn = 0; turn < 4; ++turn) {
    INFO("edge " << turn);
    CHECK(stats_of(window_scene({cut_beside(turn, 8)}, Projection::w_is_z)).clusters_drawn == 0);
    const FrameStats inside = stats_of(window_scene({cut_beside(turn, -40)}, Projection::w_is_z));
    CHECK(inside.clusters_drawn > 0);
    CHECK(inside.covered_pixels > 0);
  }
}

TEST_CASE("What the near plane cuts is drawn to its last pixel at every edge of the view") {
  Pipeline pipeline = window_pipeline();
  for (int turn = 0; turn < 4; ++turn)
    for (double gap = -3.0; gap <= 3.0; gap += 0.375) {
      INFO("edge " << turn << ", gap " << gap);
      const Scene scene = window_scene({cut_beside(turn, gap)}, Projection::w_is_z);
      const Planes culled = drawn(scene, pipeline, {}), all = drawn(scene, pipeline, {.geometry_culling = false});
      CHECK(culled == all);
      if (gap <= -1.0) CHECK(culled.covered_count() > 0);
    }
}

}  // namespace
}  // namespace trueshade::testing
