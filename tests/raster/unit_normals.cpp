// docs/arithmetic.md sections 2 and 5: normals made unit length by the vertex shader, by the fragment shader, or by
// both, on a square whose object is scaled unevenly, against the formulas in double.
#include <array>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

using Vector = std::array<double, 3>;

constexpr float kScale = 0.25f;             ///< of the object's x: M^-T n is four times as long there
constexpr float kLeft[] = {0.6f, 0, 0.8f};  ///< normals of the object at the left and right edge
constexpr float kRight[] = {-0.28f, 0, 0.96f};

Scene stretched_square() {
  const Corner a{0, 0}, b{256, 0}, c{256, 256}, d{0, 256};
  Scene scene = window_scene({{a, b, c}, {a, c, d}});
  Mesh& mesh = scene.meshes[0];
  for (size_t i = 0; i < mesh.vertex_count(); ++i) {
    const bool left = mesh.position[0][i] < 0;
    for (size_t k = 0; k < 3; ++k) mesh.normal[k][i] = left ? kLeft[k] : kRight[k];
    mesh.position[0][i] /= kScale;
  }
  scene.instances[0].world_from_object[0] *= kScale;
  return scene;
}

Vector unit(const Vector& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

Vector expected(UnitNormals shader, int x) {
  Vector left{kLeft[0] / kScale, 0, kLeft[2]}, right{kRight[0] / kScale, 0, kRight[2]}, n{};
  if (shader != UnitNormals::fragment) left = unit(left), right = unit(right);
  const double t = (x + 0.5) / kWindow;
  for (size_t k = 0; k < 3; ++k) n[k] = left[k] + t * (right[k] - left[k]);
  return shader == UnitNormals::vertex ? n : unit(n);
}

}  // namespace

TEST_CASE("Normals are made unit length where the pipeline says so") {
  const Scene scene = stretched_square();
  for (const UnitNormals shader : {UnitNormals::vertex, UnitNormals::fragment, UnitNormals::both})
    for (const Interpolation way : {Interpolation::smooth, Interpolation::noperspective})
      for (const Execution& execution : executions()) {
        Pipeline pipeline = window_pipeline();
        pipeline.gbuffer.unit_normals = shader;
        pipeline.gbuffer.normal.interpolation = way;  // the path for usual surfaces, and the general one
        const Planes planes = drawn(scene, pipeline, execution);
        REQUIRE(planes.covered_count() == kWindow * kWindow);
        double worst = 0;
        for (int y = 0; y < kWindow; ++y)
          for (int x = 0; x < kWindow; ++x)
            for (size_t k = 0; k < 3; ++k)
              worst = std::max(worst, std::fabs(double(planes.normal[planes.index(x, y)][k]) - expected(shader, x)[k]));
        CAPTURE(int(shader), int(way), execution.simd, execution.tile);
        CHECK(worst < 4e-7);
      }
}
