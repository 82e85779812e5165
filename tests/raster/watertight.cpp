// Pairs of triangles that share an edge, fans and closed meshes in five families, against exact integers: no pixel hit
// twice, none missed (RELIABILITY R6; the families are those of the Khronos conformance tests' rasterization verifier).
#include <algorithm>
#include <cmath>
#include <random>

#include "oracle/exact_coverage.h"
#include "tests/catch.hpp"
#include "tests/raster/random_frame.h"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

enum class Family { inside, clipped_by_view, clipped_by_near, slivers, huge, any_clip_space };
constexpr Family kFamilies[] = {Family::inside, Family::clipped_by_view, Family::clipped_by_near, Family::slivers,
                                Family::huge};

struct Vertex {
  float clip[4];
};

struct RandomView {
  GeometryState state;
  int width, height;
};

RandomView random_view(Random& random) {
  RandomView view{{}, int(8 + random() % 9), int(8 + random() % 9)};
  if (random() % 16 == 0) view.width = view.height = 64;
  if (random() % 4 == 0)
    view.state.viewport = {int(random() % 9) - 4, int(random() % 9) - 4, int(1 + random() % 40),
                           int(1 + random() % 40)};
  if (random() % 4 == 0) view.state.clip_origin = ClipOrigin::upper_left;
  if (random() % 4 == 0) view.state.clip_depth = ClipDepth::zero_to_one;
  if (random() % 4 == 0) view.state.depth_clamp = true;
  return view;
}

/// A vertex of the family. Clip z follows w as under a projection, so near cuts where w falls below 1/6 (or 1/2).
Vertex random_vertex(Random& random, Family family) {
  double x = 0, y = 0, w = 1;
  const double spread = family == Family::huge ? std::exp2(between(random, 3, 40))
                        : family == Family::clipped_by_view || family == Family::clipped_by_near ? 4
                                                                                                 : 1;
  x = between(random, -spread, spread);
  y = between(random, -spread, spread);
  if (random() % 2 == 0) {  // on multiples of half a pixel of a 16 x 16 view: many samples lie on edges
    x = std::floor(x * 16) / 16;
    y = std::floor(y * 16) / 16;
  }
  if (random() % 2 == 0) w = std::exp2(std::floor(between(random, 0, 4)));
  if (family == Family::clipped_by_near) w = between(random, -3, 4);
  const double scale = family == Family::clipped_by_near ? 1 : w;
  if (family == Family::any_clip_space) {  // z and w of any sign: near and far may meet inside a triangle
    w = between(random, -2, 2);
    return {{float(x), float(y), float(between(random, -2, 2)), float(random() % 8 == 0 ? 0 : w)}};
  }
  return {{float(x * scale), float(y * scale), float(0.5 * w - 0.25), float(w)}};
}

ClipTriangle triangle(const Vertex& a, const Vertex& b, const Vertex& c) {
  ClipTriangle t{};
  const Vertex* corners[3] = {&a, &b, &c};
  for (size_t i = 0; i < 3; ++i) std::copy_n(corners[i]->clip, 4, t.vertex[i]);
  return t;
}

/// Moves c to within some subpixels of the line a-b.
void flatten(Random& random, const Vertex& a, const Vertex& b, Vertex& c) {
  const double t = between(random, -0.2, 1.2), w = double(c.clip[3]);
  for (int k = 0; k < 2; ++k) {
    const double along = double(a.clip[k]) / double(a.clip[3]) * (1 - t) + double(b.clip[k]) / double(b.clip[3]) * t;
    c.clip[k] = float((along + between(random, -0.002, 0.002)) * w);
  }
}

std::array<ClipTriangle, 2> random_pair(Random& random, Family family) {
  const Vertex a = random_vertex(random, family), b = random_vertex(random, family);
  Vertex c = random_vertex(random, family), d = random_vertex(random, family);
  if (family == Family::slivers) {
    flatten(random, a, b, c);
    if (random() % 2 == 0) flatten(random, a, b, d);
  }
  return {triangle(a, b, c), triangle(b, a, d)};
}

std::vector<ClipTriangle> random_fan(Random& random, Family family) {
  const int count = 3 + int(random() % 10);
  const Vertex hub = random_vertex(random, family);
  std::vector<Vertex> rim;
  for (int i = 0; i < count; ++i) {
    rim.push_back(random_vertex(random, family));
    if (family == Family::slivers) flatten(random, hub, rim.front(), rim.back());
  }
  std::vector<ClipTriangle> fan;
  for (size_t i = 0; i < rim.size(); ++i) fan.push_back(triangle(hub, rim[i], rim[(i + 1) % rim.size()]));
  return fan;
}

/// A closed, oriented surface: a grid of random vertices that wraps around both ways, split into triangles.
std::vector<ClipTriangle> random_torus(Random& random, Family family) {
  const size_t rows = 3 + random() % 3, columns = 3 + random() % 3;
  std::vector<Vertex> grid;
  for (size_t i = 0; i < rows * columns; ++i) grid.push_back(random_vertex(random, family));
  std::vector<ClipTriangle> mesh;
  const auto at = [&](size_t r, size_t c) -> const Vertex& { return grid[(r % rows) * columns + c % columns]; };
  for (size_t r = 0; r < rows; ++r)
    for (size_t c = 0; c < columns; ++c) {
      mesh.push_back(triangle(at(r, c), at(r, c + 1), at(r + 1, c)));
      mesh.push_back(triangle(at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)));
    }
  return mesh;
}

std::vector<uint16_t> exact_counts(std::span<const ClipTriangle> triangles, const RandomView& view) {
  std::vector<oracle::ClipTriangleValues> values(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) std::copy_n(triangles[t].vertex[i], 4, values[t].vertex[i]);
  std::vector<uint16_t> counts(size_t(view.width) * size_t(view.height));
  oracle::count_exactly(values, view.state, view.width, view.height, counts);
  return counts;
}

struct CoverageTally {
  uint64_t shapes = 0, samples = 0, hit_twice = 0, missed = 0;
};

/// Adds up what the targets make of `triangles`, which are `shapes` shapes in one buffer: an error could hide only
/// behind the opposite error of another shape of the batch at the same pixel.
void compare(std::span<const ClipTriangle> triangles, uint64_t shapes, const RandomView& view, int tile,
             std::span<const std::string_view> targets, CoverageTally& tally) {
  const std::vector<uint16_t> exact = exact_counts(triangles, view);
  std::vector<uint16_t> counts(exact.size());
  tally.shapes += shapes;
  for (const uint16_t count : exact) tally.samples += count;
  for (const std::string_view simd : targets) {
    Execution execution;
    execution.simd = simd;
    execution.threads = 1;
    execution.tile = tile;
    std::fill(counts.begin(), counts.end(), uint16_t(0));
    count_coverage(triangles, view.state, view.width, view.height, execution, counts);
    if (counts == exact) continue;
    for (size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] == exact[i]) continue;
      (counts[i] > exact[i] ? tally.hit_twice : tally.missed) += 1;
      if (tally.hit_twice + tally.missed > 8) continue;
      UNSCOPED_INFO("shapes up to " << tally.shapes << ", " << simd << ", tile " << tile << ", pixel ("
                                    << i % size_t(view.width) << ", " << i / size_t(view.width) << ") of " << view.width
                                    << " x " << view.height << ": " << counts[i] << " for " << exact[i]);
    }
  }
}

/// Half of the pairs lie inside, a fifth each are clipped by the view and slivers, a twentieth each cut by near and
/// huge; these last two take the careful path, some 100 times slower, and take turns on the SIMD targets.
void run_pairs(uint64_t seed, uint64_t pairs) {
  constexpr uint64_t kShare[] = {10, 4, 1, 4, 1}, kShares = 20, kBatch = 20;
  const std::vector<std::string_view> targets = simd_targets();
  for (const Family family : kFamilies) {
    Random random(seed + uint64_t(family));
    const bool careful = family == Family::clipped_by_near || family == Family::huge;
    CoverageTally tally;
    const uint64_t batches = pairs * kShare[size_t(family)] / kShares / kBatch;
    for (uint64_t batch = 0; batch < batches; ++batch) {
      const RandomView view = random_view(random);
      std::vector<ClipTriangle> triangles;
      for (uint64_t i = 0; i < kBatch; ++i)
        for (const ClipTriangle& t : random_pair(random, family)) triangles.push_back(t);
      std::span<const std::string_view> used = targets;
      if (careful) used = used.subspan(batch % targets.size(), 1);
      compare(triangles, kBatch, view, batch % 4 == 0 ? 8 : 64, used, tally);
    }
    INFO("family " << int(family) << ": " << tally.shapes << " pairs, " << tally.samples << " covered samples");
    CHECK(tally.hit_twice == 0);
    CHECK(tally.missed == 0);
    CHECK(tally.samples > tally.shapes / 4);
  }
}

void run_fans_and_meshes(uint64_t seed, uint64_t count) {
  const std::vector<std::string_view> targets = simd_targets();
  for (const Family family : kFamilies) {
    Random random(seed + uint64_t(family));
    CoverageTally tally;
    for (uint64_t i = 0; i < count / 5; ++i) {
      const RandomView view = random_view(random);
      const std::vector<ClipTriangle> shape = i % 2 == 0 ? random_fan(random, family) : random_torus(random, family);
      compare(shape, 1, view, i % 4 < 2 ? 16 : 48, std::span(targets).subspan(i / 4 % targets.size(), 1), tally);
    }
    INFO("family " << int(family) << ": " << tally.shapes << " shapes, " << tally.samples << " covered samples");
    CHECK(tally.hit_twice == 0);
    CHECK(tally.missed == 0);
    CHECK(tally.samples > tally.shapes);
  }
}

}  // namespace

TEST_CASE("A million pairs of triangles hit no pixel twice along their edge and miss none", "[slow]") {
  run_pairs(1000, 1000000);
}

TEST_CASE("Ten million pairs of triangles hit no pixel twice along their edge and miss none", "[.][long]") {
  run_pairs(2000, 10000000);
}

TEST_CASE("Ten thousand fans and closed meshes are covered as exact integers say") { run_fans_and_meshes(3000, 10000); }

TEST_CASE("A hundred thousand fans and closed meshes are covered as exact integers say", "[.][long]") {
  run_fans_and_meshes(4000, 100000);
}

TEST_CASE("Clip coordinates that no camera makes are cut as exact integers say") {
  Random random(7000);
  const std::vector<std::string_view> targets = simd_targets();
  CoverageTally tally;
  for (uint64_t i = 0; i < 8000; ++i) {
    const RandomView view = random_view(random);
    compare(random_pair(random, Family::any_clip_space), 1, view, 64, std::span(targets).subspan(i % targets.size(), 1),
            tally);
  }
  CHECK(tally.hit_twice == 0);
  CHECK(tally.missed == 0);
  CHECK(tally.samples > tally.shapes);
}

TEST_CASE("The box far away cuts triangles of any size and any range of w, and what lies inside it stays") {
  // Each second triangle has the first one's coverage, in coordinates so large, or of a w so small, that the cut at the
  // box must neither lose w to rounding nor leave its corner off the box.
  const std::vector<ClipTriangle> plain[] = {{triangle({{-8, -8, 0, 1}}, {{8, -8, 0, 1}}, {{0, 8, 0, 1}})},
                                             {triangle({{0, 0, 0, 1}}, {{20, -10, 0, 1}}, {{20, 10, 0, 1}})}};
  const std::vector<ClipTriangle> huge[] = {
      {triangle({{-1e30f, -1e30f, 0, 1}}, {{1e30f, -1e30f, 0, 1}}, {{0, 1e30f, 0, 1}})},
      {triangle({{0, 0, 0, 1e25f}}, {{2, -1, 0, 1e-10f}}, {{2, 1, 0, 1e-10f}})}};
  for (const Execution& execution : executions())
    for (size_t i = 0; i < std::size(plain); ++i) {
      std::vector<uint16_t> expected(16 * 16), counts(16 * 16);
      count_coverage(plain[i], {}, 16, 16, execution, expected);
      count_coverage(huge[i], {}, 16, 16, execution, counts);
      INFO(named(execution) << ", triangle " << i);
      CHECK(std::count(expected.begin(), expected.end(), 1) > 16);
      CHECK(counts == expected);
    }
}

TEST_CASE("Where two triangles lie on both sides of their edge no pixel is hit twice and none on the edge is missed") {
  // By the definition of watertight alone, without the oracle: corners on whole subpixels, so that the test can judge
  // sides and samples in integers by itself.
  Random random(5000);
  constexpr int kImage = 16;
  struct Point {
    int64_t x, y;
  };
  const auto side = [](Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y); };
  const std::vector<Execution> all = executions();
  int done = 0;
  while (done < 20000) {
    const int64_t grid = random() % 2 == 0 ? 128 : 1;
    Point p[4];
    for (Point& point : p)
      point = {int64_t(random() % uint64_t(kImage * 256 / grid)) * grid,
               int64_t(random() % uint64_t(kImage * 256 / grid)) * grid};
    if (!(side(p[0], p[1], p[2]) > 0 && side(p[0], p[1], p[3]) < 0)) continue;
    Vertex v[4];
    for (size_t i = 0; i < 4; ++i) v[i] = {{float(p[i].x - 2048) / 2048.0f, float(p[i].y - 2048) / 2048.0f, 0, 1}};
    const ClipTriangle pair[2] = {triangle(v[0], v[1], v[2]), triangle(v[1], v[0], v[3])};
    std::vector<uint16_t> counts(kImage * kImage);
    const Execution& execution = all[size_t(done) % all.size()];
    count_coverage(pair, {}, kImage, kImage, execution, counts);
    for (int y = 0; y < kImage; ++y)
      for (int x = 0; x < kImage; ++x) {
        const Point s = {x * 256 + 128, y * 256 + 128};
        const uint16_t count = counts[size_t(y * kImage + x)];
        const bool within = side(p[1], p[2], s) > 0 && side(p[2], p[0], s) > 0,
                   beside = side(p[0], p[3], s) > 0 && side(p[3], p[1], s) > 0;
        const int64_t across = side(p[0], p[1], s);
        const bool inside = (across > 0 && within) || (across < 0 && beside) || (across == 0 && within && beside);
        INFO(named(execution) << ", pair " << done << ", pixel (" << x << ", " << y << ")");
        REQUIRE(count <= 1);
        if (inside) REQUIRE(count == 1);
      }
    ++done;
  }
}

TEST_CASE("A closed mesh in front of the eye has as many front as back faces at every pixel") {
  Random random(6000);
  const std::vector<Execution> all = executions();
  for (int i = 0; i < 5000; ++i) {
    RandomView view = random_view(random);
    view.state.depth_clamp = true;  // nothing is cut away at near or far
    const Family families[] = {Family::inside, Family::clipped_by_view, Family::huge};
    std::vector<ClipTriangle> mesh = random_torus(random, families[i % 3]);
    std::vector<uint16_t> front(size_t(view.width) * size_t(view.height)), back = front;
    const Execution& execution = all[size_t(i) % all.size()];
    view.state.cull_face = CullFace::back;
    count_coverage(mesh, view.state, view.width, view.height, execution, front);
    view.state.cull_face = CullFace::front;
    count_coverage(mesh, view.state, view.width, view.height, execution, back);
    INFO(named(execution) << ", mesh " << i);
    REQUIRE(front == back);
  }
}
