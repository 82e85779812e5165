// How times are taken, with contenders that only say that they took some.
#include "bench/contest.h"

#include "bench/floor.h"
#include "bench/machine.h"
#include "bench/peers.h"
#include "bench/schedule.h"
#include "core/error.h"
#include "oracle/embree_peer.h"
#include "oracle/embree_rays.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

/// Draws nothing: its times are given, and each call notes who it was.
Contender pretender(const std::string& name, std::vector<double> ms, std::string& calls) {
  return {name, "", [name, ms, &calls, next = size_t(0)]() mutable {
            calls += name;
            return ms[next++ % ms.size()];
          }};
}

}  // namespace

TEST_CASE("Contenders draw in turn, and the warm-up is not timed") {
  std::string calls;
  const std::vector<Contender> two{pretender("a", {9, 3, 1, 2}, calls), pretender("b", {50, 7, 7, 7}, calls)};
  int steps = 0;
  const std::vector<Timing> t = contest(two, {3, 1000.0}, [&](int done, int most) {
    CHECK(done == ++steps);
    CHECK(most == 8);
  });
  CHECK(calls == "abababab");
  CHECK(steps == 8);
  CHECK(t[0].ms == std::vector<double>{1, 2, 3});
  CHECK(t[0].least() == 1.0);
  CHECK(t[0].median() == 2.0);
  CHECK(t[1].spread() == 0.0);
}

TEST_CASE("A contender sits out when its time is used up, one slow frame is better than none") {
  std::string calls;
  const std::vector<Contender> three{pretender("a", {1}, calls), pretender("b", {40}, calls),
                                     pretender("c", {500}, calls)};
  const std::vector<Timing> t = contest(three, {5, 100.0});
  CHECK(calls == "abcababaaa");
  CHECK(t[0].ms.size() == 5);
  CHECK(t[1].ms.size() == 2);
  CHECK(t[2].ms == std::vector<double>{500});
}

TEST_CASE("The spread is that of the middle half, as a share of the median") {
  Timing t{{10, 20, 30, 40, 50, 60, 70, 80}};
  CHECK(t.median() == 50.0);
  CHECK(t.spread() == Approx((70.0 - 30.0) / 50.0));
}

TEST_CASE("The machine has a clock that a CPU may have") {
  const Machine machine = this_machine();
  CHECK(machine.clock_ghz > 0.3);
  CHECK(machine.clock_ghz < 8.0);
  CHECK(machine.cores >= 1);
  CHECK_FALSE(machine.cpu.empty());
}

TEST_CASE("Embree the peer hits what Embree the judge hits, but for edges") {
  const Scene scene = load_scene("builtin:city");
  Pipeline pipeline = presets().front().pipeline;
  pipeline.width = 131, pipeline.height = 97;  // no multiple of 4
  const oracle::EmbreePeer peer(scene, pipeline);
  uint64_t hits = 0, expected = 0;
  for (int row = 0; row < peer.rows(); ++row) hits += peer.trace_row(row);
  for (const oracle::RayHit& hit : oracle::embree_visibility(scene, pipeline))
    expected += hit.instance != oracle::kNoInstance;
  CAPTURE(hits, expected);
  CHECK(expected > 131 * 97 / 2);
  CHECK(hits + 4 >= expected);
  CHECK(hits <= expected + 4);
}

TEST_CASE("Tasks scheduled on more cores take as long as the last core that is at work") {
  const std::vector<double> ms{4, 3, 2, 2, 1};
  CHECK(scheduled_ms(ms, 1) == 12.0);
  CHECK(scheduled_ms(ms, 2) == 6.0);   // 4 and 2; 3, 2 and 1
  CHECK(scheduled_ms(ms, 3) == 4.0);   // 4; 3 and 1; 2 and 2
  CHECK(scheduled_ms(ms, 64) == 4.0);  // no less than the dearest
  CHECK(scheduled_ms({}, 2) == 0.0);
}

TEST_CASE("What precedes the tiles is shared by as many cores as it has tasks, and the rest of it by none") {
  FrameStats stats;
  stats.threads = 2;
  stats.before_tiles_ms = 10.0;
  stats.loops_before_tiles = {{8.0, 4}, {6.0, 1}};  // 4 ms of two threads, 6 ms of one: nothing else
  const std::vector<double> tiles{3, 3, 2};
  CHECK(scheduled_frame_ms(stats, tiles, 1) == 8.0 + 6.0 + 8.0);
  CHECK(scheduled_frame_ms(stats, tiles, 2) == 4.0 + 6.0 + 5.0);
  CHECK(scheduled_frame_ms(stats, tiles, 64) == 2.0 + 6.0 + 3.0);
  stats.before_tiles_ms = 11.5;
  CHECK(scheduled_frame_ms(stats, tiles, 64) == 1.5 + 2.0 + 6.0 + 3.0);
}

TEST_CASE("Tiles are small where large ones are fewer than eight a thread") {
  CHECK(tile_for(800, 800, 1) == 64);
  CHECK(tile_for(800, 800, 21) == 64);  // 169 tiles
  CHECK(tile_for(800, 800, 22) == 32);
  CHECK(tile_for(1920, 1080, 63) == 64);  // 510
  CHECK(tile_for(1920, 1080, 64) == 32);
  CHECK(tile_for(64, 64, 1) == 32);
}

TEST_CASE("What a frame must move is its texels and its clusters") {
  FrameStats stats;
  stats.pixels = 1000, stats.clusters_drawn = 3;
  CHECK(frame_bytes(stats, Format::rgba8).stored == 4000);
  CHECK(frame_bytes(stats, Format::rgba16f).stored == 8000);
  CHECK(frame_bytes(stats, Format::rgba8).clusters == 3 * (64 * 12 + 126 * 3 + 64));
}

}  // namespace trueshade
