// Shapes whose clip coordinates are all small: OpenGL knows x / w, y / w and z / w alone, so a power of two that
// multiplies all four changes nothing (docs/arithmetic.md section 3: until w leaves the normal floats).
#include <cmath>
#include <random>

#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

/// City, its matrix in floats, all of them times 2^-k.
Scene scaled_city(int k) {
  Scene scene = builtin_scene("city,objects=60,lights=6");
  const Pipeline pipeline;
  const Matrix4 matrix = oracle::projection_of(scene.camera, pipeline.geometry, 96, 72);
  scene.camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*scene.camera.clip_from_world)[i] = std::ldexp(float(matrix[i]), -k);
  return scene;
}

ClipTriangle random_triangle(std::mt19937& random, int most) {
  std::uniform_real_distribution<float> place(-1.5f, 1.5f);
  std::uniform_int_distribution<int> exponent(0, most);
  ClipTriangle t{};
  const int common = exponent(random);
  const bool mixed = random() % 2 == 0;
  for (auto& v : t.vertex) {
    const float w = std::ldexp(1.0f, -(mixed ? exponent(random) : common));
    for (int k = 0; k < 3; ++k) v[k] = place(random) * w;
    v[3] = random() % 16 == 0 ? -w : w;
  }
  return t;
}

}  // namespace

TEST_CASE("A city drawn by a matrix of 2^-60, 2^-100 or 2^-110 is the same city") {
  for (const Preset& preset : presets()) {
    Pipeline pipeline = preset.pipeline;
    pipeline.width = 96, pipeline.height = 72;
    if (pipeline.gbuffer.position_from_depth) continue;  // whose matrix is another one
    const std::string hash = image_hash(render_frame(scaled_city(0), pipeline).color);
    for (const int k : {60, 100, 110}) {
      CAPTURE(preset.name, k);
      CHECK(image_hash(render_frame(scaled_city(k), pipeline).color) == hash);
    }
  }
}

TEST_CASE("Coverage of triangles whose corners have w from 1 to 2^-120, and below 0, is the exact one") {
  std::mt19937 random(7);
  std::vector<ClipTriangle> triangles;
  for (int i = 0; i < 200; ++i) triangles.push_back(random_triangle(random, 120));
  std::vector<oracle::ClipTriangleValues> values(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 4; ++k) values[t].vertex[i][k] = triangles[t].vertex[i][k];
  for (const bool clamp : {false, true}) {
    GeometryState state;
    state.depth_clamp = clamp;
    std::vector<uint16_t> exact(kWindow * kWindow), ours(kWindow * kWindow);
    oracle::count_exactly(values, state, kWindow, kWindow, exact);
    for (const Execution& execution : executions()) {
      INFO(named(execution) << ", depth clamp " << clamp);
      std::fill(ours.begin(), ours.end(), uint16_t(0));
      count_coverage(triangles, state, kWindow, kWindow, execution, ours);
      CHECK(ours == exact);
    }
    CHECK(std::count_if(exact.begin(), exact.end(), [](uint16_t n) { return n > 0; }) > 10000);
  }
}
