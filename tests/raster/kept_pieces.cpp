// Triangles that a thread keeps clipped from tile to tile are those that are clipped anew.
#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <thread>
#include <vector>

#include "raster/triangles/clipped_fan.h"
#include "tests/catch.hpp"

using namespace trueshade;

namespace {

struct Asked {
  std::array<ClipVertex, 3> v;
  WindowTransform window;
  int64_t x, y;
};

bool alike(const ClipCorner& a, const ClipCorner& b) {
  if (!std::equal(std::begin(a.c), std::end(a.c), b.c) || a.kind != b.kind || a.edges != b.edges) return false;
  if (a.kind == 0) return a.a == b.a;
  return a.a == b.a && a.b == b.b && (a.kind == 1 ? a.plane == b.plane : a.t == b.t);
}

bool alike(const ClippedFan& a, const ClippedFan& b) {
  if (a.count != b.count || a.facing != b.facing || a.folded != b.folded) return false;
  if (a.polygon.made != b.polygon.made || a.polygon.corners != b.polygon.corners) return false;
  bool same = true;
  for (int i = 0; i < a.polygon.made; ++i) same = same && alike(a.polygon.all[i], b.polygon.all[i]);
  for (int i = 0; i < a.polygon.corners; ++i) same = same && a.polygon.corner[i] == b.polygon.corner[i];
  for (int i = 0; i < a.count; ++i)
    for (int k = 0; k < 3; ++k) {
      const WindowTriangle &p = a.piece[i].triangle, &q = b.piece[i].triangle;
      same = same && p.x[k] == q.x[k] && p.y[k] == q.y[k] && p.z[k] == q.z[k];
      same = same && a.piece[i].corner[k] == b.piece[i].corner[k] && a.piece[i].sign == b.piece[i].sign;
    }
  return same;
}

/// By a thread that has none.
ClippedFan clipped_anew(const Asked& in) {
  ClippedFan out;
  std::thread([&] { out = clipped_fan(in.v.data(), in.window, in.x, in.y); }).join();
  return out;
}

/// Transforms, each before one that differs in a number.
std::vector<WindowTransform> windows() {
  WindowTransform plain{};
  for (int axis = 0; axis < 2; ++axis) {
    plain.scale[axis] = plain.offset[axis] = 128 * 800;
    plain.half_size[axis] = plain.center[axis] = 400.0f;
  }
  plain.z_scale = plain.z_offset = 0.5, plain.depth_low = 0.0f, plain.depth_high = 1.0f;
  WindowTransform snapped = plain;
  snapped.float_snap = true;
  std::vector<WindowTransform> out;
  const std::function<void(WindowTransform&)> changes[] = {
      [](auto& t) { t.scale[0] = 128 * 400; },  [](auto& t) { t.scale[1] = -128 * 800; },
      [](auto& t) { t.offset[0] += 256; },      [](auto& t) { t.offset[1] += 512; },
      [](auto& t) { t.z_scale = 1.0; },         [](auto& t) { t.z_offset = 0.0; },
      [](auto& t) { t.zero_to_one = true; },    [](auto& t) { t.depth_clamp = true; },
      [](auto& t) { t.half_size[0] = 200.0f; }, [](auto& t) { t.half_size[1] = -400.0f; },
      [](auto& t) { t.center[0] = 401.0f; },    [](auto& t) { t.center[1] = 402.0f; }};
  for (const auto& change : changes)
    for (const WindowTransform& from : {plain, snapped}) {
      out.insert(out.end(), 2, from);
      change(out.back());
    }
  return out;
}

}  // namespace

TEST_CASE("Clipped triangles that a thread keeps are those that are clipped anew") {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> place(-20.0f, 20.0f), w(-1.0f, 6.0f);
  std::vector<Asked> asked;
  for (int i = 0; i < 6; ++i) {
    std::array<ClipVertex, 3> v;
    for (ClipVertex& corner : v) corner = {{place(random), place(random), w(random), w(random)}};
    const std::vector<WindowTransform> all = windows();
    for (const WindowTransform& window : all) asked.push_back({v, window, 16384 * i + 128, 128});
    asked.push_back(asked.back());
    std::swap(asked.back().v[0], asked.back().v[1]);
  }
  // Each right after one that differs in a number, in another tile, and among others than it was first.
  int seen = 0;
  for (size_t step : {size_t(1), size_t(29)})
    for (size_t k = 0; k < asked.size(); ++k) {
      Asked& in = asked[k * step % asked.size()];
      in.x += 16384;
      for (int again = 0; again < 2; ++again, in.y += 16384) {
        const ClippedFan kept = clipped_fan(in.v.data(), in.window, in.x, in.y);
        CHECK(alike(kept, clipped_anew(in)));
        seen += kept.count;
      }
    }
  CHECK(seen > 100);
}
