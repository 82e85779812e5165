// The scalar renderer against numbers computed by hand: docs/gl_rules.md section 8 rows 20, 21, 28, 31, 52 and simple
// lights.
#include "oracle/scalar_renderer.h"

#include <cmath>

#include "oracle/scalar_light.h"
#include "tests/catch.hpp"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

/// One triangle in clip space: object x, y, z are clip x, y and `z`; clip w is the third object coordinate where the
/// matrix says so.
Scene one_triangle(const std::array<std::array<float, 3>, 3>& points, bool w_is_object_z, const float attribute[3]) {
  Scene scene;
  Mesh mesh;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(points[i][k]);
    for (size_t k = 0; k < 3; ++k) mesh.normal[k].push_back(k == 2 ? 1.0f : 0.0f);
    for (size_t k = 0; k < 2; ++k) mesh.uv[k].push_back(attribute[i]);
    mesh.indices.push_back(uint32_t(i));
  }
  scene.meshes = {mesh};
  scene.materials.resize(1);
  scene.instances.resize(1);
  std::array<float, 16> m{};
  m[0] = m[5] = 1;
  m[w_is_object_z ? 11 : 10] = 1;
  if (!w_is_object_z) m[15] = 1;
  scene.camera.clip_from_world = m;
  return scene;
}

Pipeline pipeline_256() {
  Pipeline pipeline;
  pipeline.width = pipeline.height = 256;
  return pipeline;
}

float ndc(double pixel) { return float((pixel - 128) / 128); }

}  // namespace

TEST_CASE("Scalar renderer, rows 20 and 21: depth planes are exact, clipped ones too") {
  const float none[3] = {0, 0, 0};
  auto frame = scalar_frame(one_triangle({{{-1, -1, -1}, {1, -1, 1}, {-1, 1, -1}}}, false, none), pipeline_256());
  REQUIRE(frame.at(127, 3).size() == 1);
  CHECK(frame.at(127, 3)[0].depth == 0.498046875L);
  CHECK(frame.at(127, 3)[0].depth_bound == 0);
  frame = scalar_frame(one_triangle({{{-1, -1, -2}, {1, -1, -2}, {0, 1, 2}}}, false, none), pipeline_256());
  REQUIRE(frame.at(128, 64).size() == 1);
  CHECK(frame.at(128, 64)[0].depth == Approx(0.00390625).epsilon(1e-12));
  CHECK(frame.at(128, 127)[0].depth == Approx(0.49609375).epsilon(1e-12));
  CHECK(frame.at(128, 63).empty());
}

TEST_CASE("Scalar renderer, row 28: smooth, noperspective and fragment w along an edge whose w goes from 1 to 3") {
  const float attribute[3] = {0, 1, 0};
  const float x0 = ndc(0.5), x1 = 3 * ndc(8.5), y0 = ndc(0.5), y1 = 3 * ndc(0.5), y2 = ndc(200.5);
  const auto frame =
      scalar_frame(one_triangle({{{x0, y0, 1}, {x1, y1, 3}, {x0, y2, 1}}}, true, attribute), pipeline_256());
  const DrawnTriangle& t = frame.triangles.at(0);
  REQUIRE(frame.at(4, 0).size() == 1);
  CHECK(double(value_at(t, kUv, Interpolation::smooth, 4, 0).value) == Approx(0.25).epsilon(1e-15));
  CHECK(double(value_at(t, kUv, Interpolation::noperspective, 4, 0).value) == Approx(0.5).epsilon(1e-15));
  CHECK(double(value_at(t, kUv, Interpolation::flat, 4, 0).value) == 0.0);
  CHECK(double(fragment_w(t, 4, 0)) == Approx(2.0 / 3.0).epsilon(1e-15));
}

TEST_CASE("Scalar renderer, row 31: attributes come from the snapped plane") {
  const float attribute[3] = {0, 1, 0.25f};
  const auto frame =
      scalar_frame(one_triangle({{{ndc(10.3), ndc(10.2), 0}, {ndc(74.7), ndc(12.1), 0}, {ndc(20.4), ndc(60.9), 0}}},
                                false, attribute),
                   pipeline_256());
  const ValueRange value = value_at(frame.triangles.at(0), kUv, Interpolation::smooth, 30, 25);
  CHECK(std::fabs(double(value.value) - 0.3408505577) < 1e-10);
  CHECK(value.lo == 0);
  CHECK(value.hi == 1);
  CHECK(value.ulp == 0x1p-23);
}

TEST_CASE("Scalar renderer: depth functions choose the fragment that GL would") {
  std::vector<Fragment> fragments(4);
  const float depths[4] = {0.5f, 0.25f, 0.25f, 0.75f};
  for (size_t i = 0; i < 4; ++i) fragments[i].depth_code = depths[i];
  GeometryState state;
  const auto chosen = [&](DepthFunc func, float clear) {
    state.depth_func = func;
    state.clear_depth = clear;
    return visible_fragment(fragments, state).fragment;
  };
  CHECK(chosen(DepthFunc::less, 1) == 1);
  CHECK(chosen(DepthFunc::lequal, 1) == 2);
  CHECK(chosen(DepthFunc::greater, 0) == 3);
  CHECK(chosen(DepthFunc::gequal, 0.75f) == 3);
  CHECK(chosen(DepthFunc::always, 0) == 3);
  CHECK(!chosen(DepthFunc::never, 1));
  CHECK(chosen(DepthFunc::equal, 0.25f) == 2);
  CHECK(chosen(DepthFunc::notequal, 0.25f) == 3);
  fragments[2].depth_bound = 0x1p-24f;
  state.depth_func = DepthFunc::less;
  state.clear_depth = 1;
  CHECK(!visible_fragment(fragments, state).certain);
}

TEST_CASE("Scalar renderer: the perspective matrix puts near and far on their planes") {
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.near = 1;
  camera.far = 9;
  camera.fov_y_rad = 1.5707963267948966f;
  GeometryState state;
  for (const ClipDepth depth : {ClipDepth::negative_one_to_one, ClipDepth::zero_to_one}) {
    state.clip_depth = depth;
    const Matrix4 m = projection_of(camera, state, 200, 100);
    const auto row = [&](size_t r, double x, double y, double z) {
      return m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r];
    };
    CHECK(row(3, 0, 0, 4) == Approx(1));
    CHECK(row(2, 0, 0, 4) == Approx(depth == ClipDepth::zero_to_one ? 0 : -1).margin(1e-12));
    CHECK(row(2, 0, 0, -4) == Approx(9));
    CHECK(row(1, 0, 2, 3) / row(3, 0, 2, 3) == Approx(1));
    CHECK(row(0, 4, 0, 3) / row(3, 4, 0, 3) == Approx(1));
  }
}

TEST_CASE("Scalar renderer, row 52: falloffs and terms by hand") {
  Scene scene;
  scene.camera.eye = {0, 0, 2};
  Light light;
  light.position = {0, 0, 2};
  light.attenuation = {1, 0.14f, 0.07f};
  light.range = 8;
  scene.lights = {light};
  LightModel model;
  model.falloff = Falloff::quadratic;
  model.specular_color = {0.5f, 0.5f, 0.5f};
  const Surface surface{{0, 0, 0}, {0, 0, 3}, {0.25, 0.5, 1}};
  // Straight above: N.L = N.H = 1, f = 1 / 1.56.
  CHECK(lit_color(surface, scene, model)[0] == Approx(0.75 / 1.56).epsilon(1e-7));
  model.falloff = Falloff::linear_range;
  CHECK(lit_color(surface, scene, model)[1] == Approx(0.75).epsilon(1e-12));
  scene.lights[0].range = 2;
  CHECK(lit_color(surface, scene, model)[1] == 0);
  // From the side, N.L = 0: a masked specular is dark, an unmasked one is (N.H)^s = (1/sqrt 2)^2.
  scene.lights[0].type = LightType::directional;
  scene.lights[0].direction = {-1, 0, 0};
  model.shininess = 2;
  CHECK(lit_color(surface, scene, model)[2] == 0);
  model.specular_masked = false;
  CHECK(lit_color(surface, scene, model)[2] == Approx(0.25).epsilon(1e-12));
  scene.lights[0].type = LightType::ambient;
  scene.lights[0].color = {1, 2, 3};
  CHECK(lit_color(surface, scene, model)[2] == 3);
}
