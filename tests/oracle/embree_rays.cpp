// Embree and the scalar renderer judge each other; a spoilt image must be found out.
#include "oracle/embree_rays.h"

#include <cmath>
#include <random>

#include "oracle/scalar_renderer.h"
#include "tests/catch.hpp"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

/// Some random triangles as one mesh, drawn by instances that turn, scale and move it.
Scene random_scene(uint32_t seed, int triangles, int instances) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  Scene scene;
  Mesh mesh;
  for (int i = 0; i < 3 * triangles; ++i) {
    for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(unit(random));
    for (size_t k = 0; k < 3; ++k) mesh.normal[k].push_back(k == 2 ? 1.0f : 0.0f);
    mesh.indices.push_back(uint32_t(i));
  }
  scene.meshes = {mesh};
  scene.materials.resize(1);
  for (int i = 0; i < instances; ++i) {
    Instance instance;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) instance.world_from_object[c][r] = unit(random) + (c == r ? 1.0f : 0.0f);
    for (int r = 0; r < 3; ++r) instance.world_from_object[3][r] = 2 * unit(random);
    scene.instances.push_back(instance);
  }
  scene.camera.eye = {0.3f, 0.2f, 6};
  scene.camera.near = 1;
  scene.camera.far = 20;
  return scene;
}

struct SeenImage {
  std::vector<uint32_t> instances;
  std::vector<double> depths;
};

SeenImage scalar_image(const Scene& scene, const Pipeline& pipeline) {
  const ScalarFrame frame = scalar_frame(scene, pipeline);
  SeenImage image;
  for (const std::vector<Fragment>& fragments : frame.fragments) {
    const Visible seen = visible_fragment(fragments, pipeline.geometry);
    image.instances.push_back(seen.fragment ? fragments[*seen.fragment].instance : kNoInstance);
    image.depths.push_back(seen.fragment ? double(fragments[*seen.fragment].depth) : 1.0);
  }
  return image;
}

}  // namespace

TEST_CASE("Embree and the scalar renderer see the same surfaces, off edges and ties") {
  Pipeline pipeline;
  pipeline.width = 150;
  pipeline.height = 100;
  for (uint32_t seed = 0; seed < 6; ++seed) {
    Scene scene = random_scene(seed, 20, 5);
    pipeline.geometry.clip_origin = seed % 2 == 0 ? ClipOrigin::lower_left : ClipOrigin::upper_left;
    pipeline.geometry.clip_depth = seed % 3 == 0 ? ClipDepth::zero_to_one : ClipDepth::negative_one_to_one;
    if (seed >= 4) {  // orthographic, 6 units wide
      std::array<float, 16> m{};
      m[0] = 1 / 3.0f, m[5] = 1 / 2.0f, m[10] = -0.2f, m[15] = 1;
      m[4] = 0.1f;
      if (seed == 5) m[14] = 0.3f;
      scene.camera.clip_from_world = m;
    }
    const auto hits = embree_visibility(scene, pipeline);
    SeenImage image = scalar_image(scene, pipeline);
    const VisibilityReport report = judge_visibility(scene, pipeline, hits, image.instances, image.depths);
    INFO("seed " << seed << ": " << report.disagreements << " disagreements");
    CHECK(report.unexplained_count == 0);
    CHECK(report.embree_mistakes == 0);
    CHECK(report.disagreements < report.pixels / 2);
    size_t covered = 0;
    for (const uint32_t instance : image.instances) covered += instance != kNoInstance ? 1 : 0;
    CHECK(covered > report.pixels / 8);

    // Spoilt: the whole image moved by a pixel, one instance renamed, one pixel nearer than its surface.
    SeenImage moved = image;
    std::rotate(moved.instances.begin(), moved.instances.begin() + 1, moved.instances.end());
    std::rotate(moved.depths.begin(), moved.depths.begin() + 1, moved.depths.end());
    CHECK(judge_visibility(scene, pipeline, hits, moved.instances, moved.depths).unexplained_count > covered / 20);
    const size_t centre = size_t(50 * 150 + 75);
    const auto first = size_t(std::find_if(image.instances.begin() + int(centre), image.instances.end(),
                                           [](uint32_t i) { return i != kNoInstance; }) -
                              image.instances.begin());
    REQUIRE(first < image.instances.size());
    image.depths[first] -= 0.01;
    CHECK(judge_visibility(scene, pipeline, hits, image.instances, image.depths).unexplained_count == 1);
  }
}

TEST_CASE("A ray hits where the plane is") {
  Scene scene;
  Mesh mesh;
  const float x[3] = {-9, 9, 0}, y[3] = {-9, -9, 9};
  for (size_t i = 0; i < 3; ++i) {
    mesh.position[0].push_back(x[i]);
    mesh.position[1].push_back(y[i]);
    mesh.position[2].push_back(2);
    mesh.indices.push_back(uint32_t(i));
  }
  scene.meshes = {mesh};
  scene.instances.resize(2);
  scene.instances[0].world_from_object[3][2] = -1;  // behind the other
  scene.camera.eye = {0, 0, 5};
  Pipeline pipeline;
  pipeline.width = pipeline.height = 3;
  const RayHit hit = embree_visibility(scene, pipeline)[4];
  CHECK(hit.instance == 1);
  CHECK(hit.primitive == 0);
  CHECK(hit.distance == Approx(3));
  CHECK(hit.offset < 1e-6);
}
