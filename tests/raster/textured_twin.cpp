// Textured frames against the scalar renderer, and what must not change them.
#include <algorithm>
#include <cmath>

#include "oracle/textured_surface.h"
#include "tests/catch.hpp"
#include "tests/raster/drawn_alike.h"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

Scene textured_scene(Random& random) {
  Scene scene = random_scene(random);
  add_maps(random, scene);
  return scene;
}

}  // namespace

TEST_CASE("Textured frames show what the scalar renderer shows: masked surfaces, colours times texels") {
  Random random(41);
  const std::vector<Execution> all = executions();
  uint64_t pixels = 0, covered = 0, uncertain = 0, compared = 0, masked = 0;
  double worst = 0.0;
  for (int i = 0; i < 240; ++i) {
    Scene scene = textured_scene(random);
    if (i % 2 == 1) add_uv_sets(random, scene), add_faces(random, scene);
    const Pipeline pipeline = random_pipeline(random);
    const oracle::ScalarFrame frame = oracle::scalar_frame(scene, pipeline);
    const Execution& execution = all[size_t(i) % all.size()];
    INFO("frame " << i << ", " << named(execution) << ", " << pipeline_json(pipeline));
    const Planes planes = drawn(scene, pipeline, execution);
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        CAPTURE(x, y);
        const std::vector<oracle::Fragment>& fragments = frame.at(x, y);
        const oracle::Visible seen = visible_fragment(fragments, pipeline.geometry);
        ++pixels;
        if (!seen.certain) {
          ++uncertain;
          continue;
        }
        const size_t at = planes.index(x, y);
        REQUIRE(planes.object[at] == (seen.fragment ? fragments[*seen.fragment].instance + 1 : 0));
        if (!seen.fragment) continue;
        ++covered;
        const oracle::Fragment& fragment = fragments[*seen.fragment];
        const oracle::DrawnTriangle& triangle = frame.triangles[fragment.window];
        masked += scene.materials[scene.instances[fragment.instance].material].masked() ? 1 : 0;
        const oracle::SurfaceColor color = surface_color(scene, pipeline.gbuffer, triangle, x, y);
        if (!color.certain) continue;
        ++compared;
        // An ulp of uv moves a lookup by u_ulp * side texels, and a texel's neighbour may differ by 1 times the factor.
        const Material& material = scene.materials[scene.instances[fragment.instance].material];
        const TextureLevel& level = scene.textures[size_t(material.color_map.texture)].levels[0];
        const Interpolation how = pipeline.gbuffer.uv.interpolation;
        const size_t u = oracle::uv_index(material.color_map.uv_set);
        const double moved = oracle::value_at(triangle, u, how, x, y).ulp * level.width +
                             oracle::value_at(triangle, u + 1, how, x, y).ulp * level.height;
        for (size_t c = 0; c < 4; ++c) {
          const double bound = 2.0 * (2.0 * moved + 4e-7);  // the largest base colour is 2
          const double off = std::fabs(double((long double)(planes.albedo[at][c]) - color.value[c]));
          worst = std::max(worst, off / bound);
          CAPTURE(c, planes.albedo[at][c], double(color.value[c]), moved);
          REQUIRE(off <= bound);
        }
      }
    }
  }
  INFO(covered << " covered of " << pixels << ", " << uncertain << " uncertain, " << compared << " compared, " << masked
               << " masked, worst error " << worst << " of its bound");
  CHECK(covered > pixels / 20);
  CHECK(compared > covered / 100 * 99);
  CHECK(masked > covered / 10);
  CHECK(uncertain < pixels / 100);  // fixed-point depths and offsets, alphas near the cutoff
  CHECK(worst < 1.0);
}

TEST_CASE("Textured frames are the same on every SIMD target, tile size and thread count, with and without culling") {
  Random random(42);
  for (int i = 0; i < 40; ++i) {
    INFO("frame " << i);
    Scene scene = textured_scene(random);
    if (i % 2 == 1) add_uv_sets(random, scene);
    if (i % 4 == 1) drop_uv_sets(random, scene);
    if (i % 3 == 0) add_faces(random, scene);
    if (i % 5 < 3) add_tangents(random, scene);
    check_executions_alike(scene, random_pipeline(random));
  }
}

TEST_CASE("Textured frames are the same by every fast path and by none") {
  Random random(44);
  for (int i = 0; i < 60; ++i) {
    INFO("frame " << i);
    Scene scene = textured_scene(random);
    if (i % 2 == 0)
      for (Mesh& mesh : scene.meshes) mesh.color = {};
    if (i % 4 < 2)  // one normal a mesh
      for (Mesh& mesh : scene.meshes)
        for (auto& component : mesh.normal) std::fill(component.begin(), component.end(), component[0]);
    if (i % 3 == 0) scene.materials[1] = {};
    if (i % 4 == 0) scene.materials[0].normal_map.sampler = scene.materials[0].color_map.sampler;
    if (i % 6 == 1) add_uv_sets(random, scene);
    if (i % 3 == 0) add_faces(random, scene);
    if (i % 5 < 3) add_tangents(random, scene);
    Pipeline pipeline = random_pipeline(random);
    if (i % 5 != 0) pipeline.geometry.depth_func = DepthFunc::less;
    if (i % 3 == 0) pipeline.width *= 3, pipeline.height *= 2;
    GBufferState& planes = pipeline.gbuffer;
    for (PlaneState* plane : {&planes.position, &planes.normal, &planes.albedo, &planes.uv})
      plane->interpolation = Interpolation::smooth;
    check_general_alike(scene, pipeline);
  }
}

TEST_CASE("Textured frames do not depend on which vertex a triangle names first, and move with their viewport") {
  Random random(43);
  const std::vector<Execution> all = executions();
  for (int i = 0; i < 40; ++i) {
    INFO("frame " << i);
    Scene scene = textured_scene(random);
    if (i % 2 == 1) add_uv_sets(random, scene);
    if (i % 4 < 2) add_faces(random, scene);
    if (i % 3 == 0) add_tangents(random, scene);
    Pipeline pipeline = without_flat(random_pipeline(random));
    pipeline.gbuffer.uv.interpolation = Interpolation::smooth;
    const Execution& execution = all[size_t(i) % all.size()];
    check_moved_alike(scene, pipeline, execution);
    check_turned_alike(random, scene, pipeline, execution);
  }
}

TEST_CASE("A map reads the coordinates of its set: as if these were the first") {
  Random random(46);
  int different = 0;
  for (int i = 0; i < 40; ++i) {
    INFO("frame " << i);
    Scene scene = textured_scene(random);
    if (i % 3 == 0) add_faces(random, scene);
    const Pipeline pipeline = random_pipeline(random);
    const Planes expected = drawn(scene, pipeline, {});
    Scene other = scene;
    for (Mesh& mesh : other.meshes) {
      mesh.more_uv.resize(4);
      mesh.more_uv.back() = mesh.uv;
      for (auto& stream : mesh.uv)
        for (float& coordinate : stream) coordinate = 0.75f - 2.0f * coordinate;
    }
    different += drawn(other, pipeline, {}).albedo != expected.albedo ? 1 : 0;
    for (Material& m : other.materials)
      for (TextureSlot* map : maps_of(m)) map->uv_set = 4;
    for (const Execution& execution : executions()) {
      INFO(named(execution));
      Planes planes = drawn(other, pipeline, execution);
      planes.uv = expected.uv;  // the plane shows the first set
      REQUIRE(planes == expected);
    }
  }
  CHECK(different > 8);  // other pictures are empty, or their textures of one texel
}

TEST_CASE("A cutoff at 0 or a white texture changes no bit, and alpha below the cutoff opens what is behind") {
  const testing::Corners front{{{0, 0, 0, 1, {0, 0}, {1, 1, 1, 0.5f}},
                                {256, 0, 0, 1, {1, 0}, {1, 1, 1, 0.5f}},
                                {0, 256, 0, 1, {0, 1}, {1, 1, 1, 0.5f}}}};
  testing::Corners back = front;
  for (Corner& c : back) c.z = 0.5;
  Scene scene = window_objects({{front}, {back}});
  const Planes plain = drawn(scene, window_pipeline(), {});
  scene.materials.resize(2);
  scene.instances[1].material = 1;
  Texture white{"", TextureFormat::rgba8, {{1, 1, {255, 255, 255, 255}}}};
  scene.textures.push_back(white);
  scene.materials[0].color_map.texture = 0;
  Planes textured = drawn(scene, window_pipeline(), {});
  CHECK(textured.albedo == plain.albedo);
  CHECK(textured.object == plain.object);
  for (const float cutoff : {0.5f, std::nextafter(0.5f, 1.0f)}) {
    scene.materials[0].alpha_cutoff = cutoff;
    textured = drawn(scene, window_pipeline(), {});
    const uint32_t expected = cutoff > 0.5f ? 2 : 1;  // alpha below the cutoff goes; at it stays
    for (size_t i = 0; i < textured.object.size(); ++i)
      if (plain.object[i] != 0) REQUIRE(textured.object[i] == expected);
  }
}

TEST_CASE("A flat normal map gives the interpolated normal itself, another the one that OpenGL's frame gives") {
  const testing::Corners corners{{{10, 10, 0, 1, {0, 0}}, {200, 20, 0, 2, {1, 0.25f}}, {30, 220, 0, 3, {0.125f, 1}}}};
  Scene scene = window_scene({corners});
  scene.meshes[0].normal = {{{0.1f, 0.3f, -0.2f}, {0.2f, 0.1f, 0.5f}, {0.9f, 0.7f, 0.6f}}};
  const Planes plain = drawn(scene, window_pipeline(), {});
  const auto with_texel = [&](float r, float g, float b) {
    Texture texture{"", TextureFormat::rgba32f, {{1, 1, {}}}};
    append_texel(texture.format, {r, g, b, 1.0f}, texture.levels[0].bytes);
    scene.textures = {texture};
    scene.materials[0].normal_map.texture = 0;
    return drawn(scene, window_pipeline(), {});
  };
  CHECK(with_texel(0.5f, 0.5f, 1.0f).normal == plain.normal);
  const float texel[3] = {0.75f, 0.375f, 0.875f};
  const Planes bent = with_texel(texel[0], texel[1], texel[2]);
  const Mesh& mesh = scene.meshes[0];
  using V = std::array<long double, 3>;
  const auto dot = [](const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  V e[2];
  long double duv[2][2];
  for (size_t k = 0; k < 2; ++k) {
    for (size_t c = 0; c < 3; ++c) e[k][c] = (long double)mesh.position[c][k + 1] - mesh.position[c][0];
    for (size_t c = 0; c < 2; ++c) duv[k][c] = (long double)mesh.uv[c][k + 1] - mesh.uv[c][0];
  }
  // P = P0 + U u + V v on the triangle's plane: Cramer's rule.
  const long double det = duv[0][0] * duv[1][1] - duv[1][0] * duv[0][1];
  V u, v;
  for (size_t c = 0; c < 3; ++c) {
    u[c] = (e[0][c] * duv[1][1] - e[1][c] * duv[0][1]) / det;
    v[c] = (e[1][c] * duv[0][0] - e[0][c] * duv[1][0]) / det;
  }
  double worst = 0.0;
  for (int y = 0; y < kWindow; ++y)
    for (int x = 0; x < kWindow; ++x) {
      const size_t i = plain.index(x, y);
      if (plain.object[i] == 0) continue;
      const V n{plain.normal[i][0], plain.normal[i][1], plain.normal[i][2]};
      V t;
      for (size_t c = 0; c < 3; ++c) t[c] = u[c] - n[c] * dot(n, u) / dot(n, n);
      const long double length = std::sqrt(dot(t, t)), n_length = std::sqrt(dot(n, n));
      for (long double& c : t) c /= length;
      V b{n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
      const long double side = dot(b, v) < 0 ? -1 : 1;
      for (size_t c = 0; c < 3; ++c) {
        const long double expected =
            t[c] * (2 * texel[0] - 1) + side * b[c] / n_length * (2 * texel[1] - 1) + n[c] * (2 * texel[2] - 1);
        worst = std::max(worst, std::fabs(double(bent.normal[i][c] - expected)));
      }
    }
  CHECK(worst < 1e-7);
}

namespace {

/// Where a mesh is drawn.
glm::mat4x3 placed(const glm::vec3& x, const glm::vec3& y, const glm::vec3& z) { return {x, y, z, glm::vec3(0.0f)}; }

}  // namespace

TEST_CASE("Tangents along u of a plane bend normals as its texture coordinates do, mirrored, scaled, from both sides") {
  testing::Corners corners{{{20, 30, 0, 1, {0, 0}}, {220, 20, 0, 2, {1, 0}}, {40, 200, 0, 1.5, {0, 1}}}};
  int bent = 0;
  for (const bool mirrored_uv : {false, true})
    for (const bool double_sided : {false, true})
      for (const glm::mat4x3& object :
           {placed({1, 0, 0}, {0, 1, 0}, {0, 0, 1}), placed({-1, 0, 0}, {0, 1, 0}, {0, 0, 1}),
            placed({0, -1, 0}, {1, 0, 0}, {0, 0, -1}), placed({0.7f, 0.2f, 0}, {-0.3f, 0.9f, 0}, {0, 0, 0.5f})}) {
        Scene scene = window_scene({corners});
        scene.instances[0].world_from_object = object;
        Mesh& mesh = scene.meshes[0];
        mesh.normal = {{{0, 0, 0}, {0, 0, 0}, {1, 1, 1}}};
        if (mirrored_uv)
          for (float& u : mesh.uv[0]) u = -u;
        Texture texture{"", TextureFormat::rgba32f, {{1, 1, {}}}};
        append_texel(texture.format, {0.7f, 0.2f, 0.9f, 1.0f}, texture.levels[0].bytes);
        scene.textures = {texture};
        scene.materials[0].normal_map.texture = 0;
        scene.materials[0].double_sided = double_sided;
        const Planes of_triangle = drawn(scene, window_pipeline(), {});
        // u and v of the plane's own x and y: Cramer's rule, and the cross product's z is the side.
        const double x1 = double(mesh.position[0][1]) - double(mesh.position[0][0]),
                     y1 = double(mesh.position[1][1]) - double(mesh.position[1][0]),
                     x2 = double(mesh.position[0][2]) - double(mesh.position[0][0]),
                     y2 = double(mesh.position[1][2]) - double(mesh.position[1][0]), u1 = double(mesh.uv[0][1]);
        const float x = float(x1 / u1), y = float(y1 / u1), w = x1 / u1 * y2 - y1 / u1 * x2 < 0 ? -1.0f : 1.0f;
        mesh.tangent = {{{x, x, x}, {y, y, y}, {0, 0, 0}, {w, w, w}}};
        const Planes of_vertices = drawn(scene, window_pipeline(), {});
        CHECK(of_vertices.object == of_triangle.object);
        double worst = 0.0;
        for (size_t i = 0; i < of_triangle.normal.size(); ++i)
          for (size_t c = 0; c < 3; ++c)
            if (of_triangle.object[i] != 0)
              worst = std::max(worst, std::fabs(double(of_triangle.normal[i][c]) - double(of_vertices.normal[i][c])));
        CHECK(worst < 2e-7);
        Scene wrong = scene;
        for (float& side : wrong.meshes[0].tangent[3]) side = -side;
        const Planes other = drawn(wrong, window_pipeline(), {});
        bent += of_vertices.covered_count() > 1000 && other.normal != of_vertices.normal ? 1 : 0;
      }
  CHECK(bent > 8);  // others are culled
}
