// Clusters all of whose triangles face away are left out before their vertices are touched, and nobody sees it.
#include <cmath>

#include "core/fp_env.h"
#include "raster/clusters/cluster_bins.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/raster/drawn_alike.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

Pipeline culling_pipeline(CullFace cull, int size) {
  Pipeline pipeline = window_pipeline();
  pipeline.width = pipeline.height = size;
  pipeline.geometry.cull_face = cull;
  return pipeline;
}

Scene one_mesh(Mesh mesh) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes.push_back(std::move(mesh));
  scene.instances.resize(1);
  return scene;
}

struct Drawn {
  size_t clusters, all;
};
Drawn clusters_drawn(const Scene& scene, const Pipeline& pipeline) {
  const FpScope fp;
  const ClusteredScene clusters = cluster_scene(scene);
  ClusterBins bins;
  bin_clusters(scene, clusters, make_view(scene, pipeline), 64, true, 1, bins);
  size_t all = 0;
  for (const Instance& instance : scene.instances) all += clusters.meshes[instance.mesh].clusters.size();
  return {bins.draws.size(), all};
}

/// With and without culling, by both vector widths that matter: one lane and many.
void check_culling_unseen(const Scene& scene, const Pipeline& pipeline) {
  Execution plain;
  plain.geometry_culling = false;
  const Planes expected = drawn(scene, pipeline, plain);
  for (const Execution& execution : executions()) {
    INFO(named(execution) << ", " << pipeline_json(pipeline));
    if (execution.tile == 48) REQUIRE(drawn(scene, pipeline, execution) == expected);
  }
}

/// A sheet of hills: open, its normals in a narrow or a wide cone.
Mesh hills(Random& random, double height) {
  Mesh mesh = plane_mesh(20);
  for (float& y : mesh.position[1]) y = float(between(random, -height, height));
  return mesh;
}

/// Triangles of one plane z = `z` whose widths are far below the snap's 1/256 pixel or near it, `turned` clockwise in
/// the window of 256 x 256 pixels.
std::vector<Corners> slivers(Random& random, double z, bool turned) {
  std::vector<Corners> out;
  const double width = std::exp2(between(random, -11, -7));  // pixels
  for (int i = 0; i < 600; ++i) {
    const double angle = between(random, 0, 6.28), dx = std::cos(angle), dy = std::sin(angle);
    const double x = between(random, 60, 196), y = between(random, 60, 196), length = between(random, 60, 200);
    Corner a{x, y, z}, b{x + length * dx, y + length * dy, z};
    const double along = between(random, 0, length), side = turned ? -width : width;
    out.push_back({a, b, Corner{x + along * dx - side * dy, y + along * dy + side * dx, z}});
  }
  return out;
}

}  // namespace

TEST_CASE("Under face culling a quarter and more of a sphere's clusters go by their cones, none without") {
  Scene scene = one_mesh(sphere_mesh(64));
  scene.camera.eye = {0.0f, 0.0f, 4.0f};
  const Drawn none = clusters_drawn(scene, culling_pipeline(CullFace::none, 800));
  REQUIRE(none.clusters == none.all);
  for (const CullFace cull : {CullFace::back, CullFace::front})
    for (const FrontFace front : {FrontFace::ccw, FrontFace::cw})
      for (const ClipOrigin origin : {ClipOrigin::lower_left, ClipOrigin::upper_left})
        for (const float mirror : {1.0f, -1.0f}) {
          Pipeline pipeline = culling_pipeline(cull, 800);
          pipeline.geometry.front_face = front, pipeline.geometry.clip_origin = origin;
          scene.instances[0].world_from_object[0][0] = mirror;
          const Drawn some = clusters_drawn(scene, pipeline);
          INFO(pipeline_json(pipeline) << mirror << ": " << some.clusters << " of " << some.all);
          // From 4 radii away (1 - 1/4) / 2 of a sphere shows its outside.
          const bool outside = (cull == CullFace::back) == ((front == FrontFace::ccw) == (mirror > 0.0f));
          CHECK(double(some.clusters) <= (outside ? 0.5 : 0.8) * double(some.all));
          CHECK(double(some.clusters) >= (outside ? 0.375 : 0.625) * double(some.all));
        }
}

TEST_CASE("Clusters that parallel rays see from behind go by their cones") {
  Scene scene = one_mesh(sphere_mesh(64));
  std::array<float, 16> m{};
  m[0] = m[5] = 0.8f, m[10] = -0.5f, m[15] = 1.0f;
  scene.camera.clip_from_world = m;
  for (const CullFace cull : {CullFace::back, CullFace::front}) {
    const Drawn some = clusters_drawn(scene, culling_pipeline(cull, 800));
    CHECK(double(some.clusters) <= 0.65 * double(some.all));
    CHECK(double(some.clusters) >= 0.5 * double(some.all));
  }
}

TEST_CASE("Slivers that the snap turns round are drawn as without culling") {
  Random random(41);
  const Pipeline pipeline = culling_pipeline(CullFace::back, kWindow);
  int seen = 0;
  for (int i = 0; i < 40; ++i) {
    const Projection projection = i % 2 == 0 ? Projection::w_is_one : Projection::w_is_z;
    std::vector<Corners> sheet = slivers(random, 0.25, true);
    if (projection == Projection::w_is_z)  // a leaning sheet; 1 < w < 3, clip z / w from -0.5 to 0.2
      for (Corners& triangle : sheet)
        for (Corner& corner : triangle) corner.w = 1.0 / (0.6 + (corner.x + corner.y) * 0x1p-11);
    const Scene scene = window_scene(sheet, projection);
    INFO("sheet " << i);
    check_culling_unseen(scene, pipeline);
    Execution general;
    general.geometry_culling = false;
    seen += drawn(scene, pipeline, general).covered_count();
  }
  CHECK(seen > 100);  // all of them face away, and yet
}

TEST_CASE("Wide triangles that face away go by their cones, and slivers as soon as they are wide enough") {
  Random random(42);
  const Pipeline pipeline = culling_pipeline(CullFace::back, kWindow);
  std::vector<Corners> sheet = slivers(random, 0.25, true);
  const auto widened = [&](double width) {
    for (Corners& t : sheet) {
      const double dx = t[1].x - t[0].x, dy = t[1].y - t[0].y, length = std::hypot(dx, dy);
      t[2].x = 0.5 * (t[0].x + t[1].x) + width * dy / length, t[2].y = 0.5 * (t[0].y + t[1].y) - width * dx / length;
    }
    return clusters_drawn(window_scene(sheet), pipeline);
  };
  const Drawn thin = widened(1e-3), wide = widened(0.1);
  CHECK(thin.clusters == thin.all);
  CHECK(wide.clusters == 0);
  CHECK(clusters_drawn(window_scene(slivers(random, 0.25, false)), pipeline).clusters > 0);
}

TEST_CASE("Frames under face culling are the same with and without the cones of clusters") {
  Random random(43);
  size_t drawn_under_culling = 0, drawn_without = 0;
  for (int i = 0; i < 60; ++i) {
    Scene scene = random_scene(random);  // mirrored, squashed, leaning; perspective or parallel rays
    scene.meshes[0] = i % 3 == 0 ? sphere_mesh(24) : i % 3 == 1 ? hills(random, 0.05) : cube_mesh();
    scene.meshes[1] = i % 4 == 0 ? plane_mesh(9) : hills(random, std::exp2(between(random, -12, -2)));
    for (Instance& instance : scene.instances) {
      if (random() % 3 == 0) instance.world_from_object[int(random() % 3)] *= float(std::exp2(between(random, -14, 0)));
      if (random() % 3 == 0) instance.world_from_object[3].z -= 3.0f;
    }
    for (const CullFace cull : {CullFace::back, CullFace::front}) {
      Pipeline pipeline = random_pipeline(random);
      pipeline.geometry.cull_face = cull;
      INFO("frame " << i);
      check_culling_unseen(scene, pipeline);
      drawn_under_culling += clusters_drawn(scene, pipeline).clusters;
      pipeline.geometry.cull_face = CullFace::none;
      drawn_without += clusters_drawn(scene, pipeline).clusters;
    }
  }
  CHECK(drawn_under_culling < drawn_without * 9 / 10);
}
