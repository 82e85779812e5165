#include <cmath>

#include "../expect_error.h"
#include "asset.h"
#include "round_trip.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

const float kHalf = float(std::sqrt(0.5));

glm::vec3 vertex(const Scene& scene, size_t mesh, size_t v) {
  const Mesh& m = scene.meshes.at(mesh);
  return {m.position[0][v], m.position[1][v], m.position[2][v]};
}

double distance(const glm::vec3& a, const glm::vec3& b) {
  const glm::dvec3 d = glm::dvec3(a) - glm::dvec3(b);
  return std::sqrt(dot(d, d));
}

/// A node with a triangle, moved by one channel from times 1 and 3. `path` of `values` of `type`.
std::string moving(const std::string& path, const std::vector<float>& values, const std::string& type,
                   const std::string& how, const std::string& node = "", const std::vector<float>& times = {1, 3}) {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(times, "SCALAR");
  asset.accessor(values, type);
  return asset.gltf(one_primitive(R"("attributes": {"POSITION": 0})", node,
                                  R"("animations": [{"samplers": [{"input": 1, "output": 2, "interpolation": ")" + how +
                                      R"("}], "channels": [{"sampler": 0, "target": {"node": 0, "path": ")" + path +
                                      R"("}}]}])"));
}

glm::mat4x3 at_time(const std::string& text, double time) {
  Scene scene = load_gltf(text);
  set_time(scene, time);
  return scene.instances.at(0).world_from_object;
}

TEST_CASE("translations and scales move by steps, lines and splines") {
  const std::vector<float> two{1, 2, 3, 5, 4, 3};
  for (const auto& [time, x] :
       {std::pair(0.0, 1.0f), {1.0, 1.0f}, {1.5, 2.0f}, {2.0, 3.0f}, {3.0, 5.0f}, {9.0, 5.0f}, {-4.0, 1.0f}})
    CHECK(at_time(moving("translation", two, "VEC3", "LINEAR"), time)[3].x == x);
  for (const auto& [time, x] : {std::pair(0.0, 1.0f), {1.5, 1.0f}, {2.999, 1.0f}, {3.0, 5.0f}})
    CHECK(at_time(moving("scale", two, "VEC3", "STEP"), time)[0].x == x);
  // Slopes of 0 at both ends: s^2 (3 - 2 s). A slope of 2 a second behind the first step adds 2 * 2 * s (1 - s)^2.
  const std::vector<float> spline{9, 9, 9, 1, 0, 0, 0, 2, 0, 0, 0, 0, 5, 0, 0, 9, 9, 9};
  const std::string cubic = moving("translation", spline, "VEC3", "CUBICSPLINE");
  for (const double s : {0.0, 0.25, 0.5, 0.75}) {
    const glm::vec3 p = at_time(cubic, 1.0 + 2.0 * s)[3];
    CHECK(p.x == float(1.0 + 4.0 * (s * s * (3.0 - 2.0 * s))));
    CHECK(p.y == float(4.0 * s * (1.0 - s) * (1.0 - s)));
  }
  CHECK(at_time(cubic, 3.0)[3] == glm::vec3(5, 0, 0));
}

TEST_CASE("of steps whose times have no data, and so are all 0, the last is kept: times of a track ascend") {
  for (const bool cubic : {false, true}) {
    Asset asset;
    asset.accessor(kTriangle, "VEC3");
    asset.accessor(R"("componentType": 5126, "count": 2, "type": "SCALAR")");
    asset.accessor(std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9}, "VEC3");
    asset.accessor(std::vector<float>{1, 2, 3, 4, 5, 6}, "VEC3");
    Scene scene = load_gltf(asset.gltf(
        one_primitive(R"("attributes": {"POSITION": 0})", "",
                      R"("animations": [{"samplers": [{"input": 1, "output": )" + std::string(cubic ? "2" : "3") +
                          R"(, "interpolation": ")" + (cubic ? "CUBICSPLINE" : "LINEAR") +
                          R"("}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}])")));
    const Track& track = *scene.timeline.node_motions.at(0).motion.position;
    CHECK(track.times == std::vector<double>{0.0});
    CHECK(track.values == std::vector<glm::dvec4>{{4, 5, 6, 0}});
    CHECK(track.arriving.size() == (cubic ? 1 : 0));
    CHECK(track.leaving == (cubic ? std::vector<glm::dvec4>{{7, 8, 9, 0}} : std::vector<glm::dvec4>{}));
    set_time(scene, 2.0);
    CHECK(scene.instances.at(0).world_from_object[3] == glm::vec3(4, 5, 6));
    const Scene again = written_and_loaded(scene);
    CHECK(scene_hash(again) == scene_hash(scene));
  }
}

TEST_CASE("rotations turn at even speed along the shorter arc") {
  // From 0 to 120 degrees about z; the second quaternion stands for the same turn with its sign reversed.
  const float c = 0.5f, s = float(std::sqrt(0.75));
  for (const float sign : {1.0f, -1.0f})
    for (const double part : {0.0, 0.1, 0.25, 0.5, 0.9}) {
      const glm::mat4x3 m =
          at_time(moving("rotation", {0, 0, 0, 1, 0, 0, sign * s, sign * c}, "VEC4", "LINEAR"), 1.0 + 2.0 * part);
      const double angle = part * 2.0 * kPi / 3.0;
      CHECK(std::fabs(m[0].x - std::cos(angle)) < 1e-7);
      CHECK(std::fabs(m[0].y - std::sin(angle)) < 1e-7);
    }
  const std::vector<float> same{0, kHalf, 0, kHalf, 0, kHalf, 0, kHalf};
  CHECK(at_time(moving("rotation", same, "VEC4", "LINEAR"), 1.7) ==
        at_time(moving("rotation", same, "VEC4", "STEP"), 1.0));
  const std::vector<float> cubic{0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
  const glm::mat4x3 half = at_time(moving("rotation", cubic, "VEC4", "CUBICSPLINE"), 2.0);  // normalized: 90 degrees
  CHECK(std::fabs(half[0].x) < 1e-7);
  CHECK(std::fabs(half[0].y - 1.0) < 1e-7);
}

TEST_CASE("the angle between two unit vectors is right to the last digits from 0 to 90 degrees") {
  for (int i = 0; i <= 1000; ++i) {
    const double angle = 0.5 * kPi * i / 1000;
    CHECK(std::fabs(angle_of(std::sin(angle), std::cos(angle)) - angle) < 4e-16 * (1.0 + angle));
  }
}

TEST_CASE("animations that say nothing certain are refused") {
  const auto refused = [](const std::string& text) { return gltf_refusal(text); };
  const std::vector<float> two{1, 2, 3, 5, 4, 3};
  CHECK_STARTS_WITH(refused(moving("translation", two, "VEC3", "LINEAR", "", {1, 1})),
                    ": /accessors/1: time 1 is negative or not above");
  CHECK_STARTS_WITH(refused(moving("translation", two, "VEC3", "LINEAR", "", {-1, 1})),
                    ": /accessors/1: time 0 is negative");
  CHECK_STARTS_WITH(refused(moving("translation", two, "VEC3", "LINEAR", "", {1, 2, 3})),
                    ": /animations/0/channels/0: the sampler has 2 values for 3 times (1 a time)");
  CHECK_STARTS_WITH(refused(moving("translation", two, "VEC3", "CUBICSPLINE")),
                    ": /animations/0/channels/0: the sampler has 2 values for 2 times (3 a time)");
  CHECK_STARTS_WITH(refused(moving("translation", two, "VEC3", "CUBICSPLINE", "", {1})),
                    ": /animations/0/samplers/0/input: a cubic spline has fewer");
  CHECK_STARTS_WITH(refused(moving("translation", two, "VEC2", "LINEAR")),
                    ": /animations/0/channels/0: the type of the sampler's output");
  CHECK_STARTS_WITH(refused(moving("rotation", {0, 0, 0, 1, 0, 0, 0, 0.9f}, "VEC4", "LINEAR")),
                    ": /accessors/2: the rotation of step 1 is not of unit length");
  CHECK_STARTS_WITH(refused(moving("weights", two, "SCALAR", "LINEAR")),
                    ": /animations/0/channels/0: the node has no mesh with targets");
  CHECK_STARTS_WITH(refused(moving("translation", two, "VEC3", "BEZIER")),
                    ": /animations/0/samplers/0/interpolation: found");
  CHECK_STARTS_WITH(refused(moving("translation", two, "VEC3", "LINEAR",
                                   R"("matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])")),
                    ": /animations/0/channels/0: the node has a matrix");
  Scene unknown = load_gltf(moving("pointer", two, "VEC3", "LINEAR"));  // of an extension
  CHECK(unknown.timeline.empty());
}

TEST_CASE("lights and the camera follow their nodes") {
  Asset asset;
  asset.accessor(std::vector<float>{0, 2}, "SCALAR");
  asset.accessor(std::vector<float>{0, 0, 0, 4, 0, 0}, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0}, "VEC4");
  Scene scene = load_gltf(asset.gltf(
      R"("nodes": [{"children": [1, 2]}, {"camera": 0}, {"translation": [0, 1, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}], "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}},
    "animations": [{"samplers": [{"input": 0, "output": 1}, {"input": 0, "output": 2}],
                    "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}, {"sampler": 1, "target": {"node": 1, "path": "rotation"}}]}])"));
  set_time(scene, 1.0);
  CHECK(scene.camera.eye == glm::vec3(2, 0, 0));
  CHECK(distance(scene.camera.target, glm::vec3(0, 0, 0)) < 1e-6);  // 90 degrees about y: it looks along -x, 2 ahead
  CHECK(scene.lights[0].position == glm::vec3(2, 1, 0));
  set_time(scene, 2.0);
  CHECK(scene.camera.target == glm::vec3(4, 0, 4));
}

// --- Morph targets -------------------------------------------------------------------------------------------------

Asset bending() {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");                                         // 0: positions
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");     // 1: normals
  asset.accessor(std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");     // 2: deltas
  asset.accessor(std::vector<float>{0, 0, 0, 0, 2, 0, 0, 0, 4}, "VEC3");     // 3: deltas
  asset.accessor(std::vector<float>{1, 0, -1, 1, 0, -1, 1, 0, -1}, "VEC3");  // 4: deltas of normals
  asset.accessor(std::vector<float>{0, 1}, "SCALAR");                        // 5: times
  asset.accessor(std::vector<float>{0, 0, 1, 0.5f}, "SCALAR");               // 6: weights
  return asset;
}
const std::string kTargets =
    R"("attributes": {"POSITION": 0, "NORMAL": 1}, "targets": [{"POSITION": 2, "NORMAL": 4}, {"POSITION": 3}])";

TEST_CASE("morph targets are added by their weights: the node's, else the mesh's, else the animation's") {
  const Asset asset = bending();
  const auto mesh = [&](const std::string& weights) {
    return R"("scenes": [{"nodes": [0]}], "meshes": [{"primitives": [{)" + kTargets + "}]" + weights + "}]";
  };
  const Scene rest = load_gltf(asset.gltf(mesh("") + R"(, "nodes": [{"mesh": 0}])"));
  CHECK(vertex(rest, 0, 1) == glm::vec3(1, 0, 0));
  CHECK(rest.meshes[0].normal[2][0] == 1.0f);
  const Scene of_mesh = load_gltf(asset.gltf(mesh(R"(, "weights": [0.5, 0.25])") + R"(, "nodes": [{"mesh": 0}])"));
  CHECK(vertex(of_mesh, 0, 1) == glm::vec3(1.5f, 0.5f, 0));
  CHECK(vertex(of_mesh, 0, 2) == glm::vec3(0.5f, 1, 1));
  CHECK(std::fabs(of_mesh.meshes[0].normal[0][0] - kHalf) < 1e-7f);  // unit(0.5, 0, 0.5)
  CHECK(of_mesh.timeline.empty());
  const Scene of_node =
      load_gltf(asset.gltf(mesh(R"(, "weights": [0.5, 0.25])") +
                           R"(, "nodes": [{"mesh": 0, "weights": [0, 1], "translation": [0, 0, 9]}])"));
  CHECK(vertex(of_node, 0, 2) == glm::vec3(0, 1, 4));
  CHECK(of_node.instances[0].world_from_object[3].z == 9.0f);
  Scene moved = load_gltf(
      asset.gltf(mesh("") + R"(, "nodes": [{"mesh": 0}], "animations": [{"samplers": [{"input": 5, "output": 6}],
    "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}])"));
  CHECK(vertex(moved, 0, 2) == glm::vec3(0, 1, 0));
  const uint32_t pose = moved.meshes[0].pose;
  set_time(moved, 0.5);
  CHECK(moved.meshes[0].pose == pose + 1);
  CHECK(vertex(moved, 0, 2) == glm::vec3(0.5f, 1, 1));
  set_time(moved, 0.0);
  CHECK(vertex(moved, 0, 2) == glm::vec3(0, 1, 0));
}

TEST_CASE("flat normals are those of the posed triangles") {
  const Asset asset = bending();
  const Scene scene =
      load_gltf(asset.gltf(R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"weights": [1],
    "primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 3}]}]}])"));
  // The corners lie at (0, 0, 0), (1, 2, 0), (0, 1, 4): the cross product is (8, -4, 1), of length 9.
  for (size_t v = 0; v < 3; ++v)
    for (size_t k = 0; k < 3; ++k)
      CHECK(scene.meshes[0].normal[k][v] == float((k == 0 ? 8.0 : k == 1 ? -4.0 : 1.0) * (1.0 / 9.0)));
}

TEST_CASE("targets and weights that do not go with their mesh are refused") {
  const Asset asset = bending();
  const auto refused = [&](const std::string& meshes, const std::string& node = "") {
    return gltf_refusal(asset.gltf(R"("meshes": [{)" + meshes + R"(}], "nodes": [{"mesh": 0)" + node + "}]"));
  };
  const std::string primitives = R"("primitives": [{)" + kTargets + "}]";
  CHECK_STARTS_WITH(refused(primitives + R"(, "weights": [1])"),
                    ": /meshes/0/weights: there are 1 weights for 2 targets");
  CHECK_STARTS_WITH(refused(primitives, R"(, "weights": [1])"),
                    ": /nodes/0/weights: there are 1 weights for 2 targets");
  CHECK_STARTS_WITH(refused(R"("primitives": [{)" + kTargets + R"(}, {"attributes": {"POSITION": 0}}])"),
                    ": /meshes/0/primitives/1: the primitives of a mesh differ");
  CHECK_STARTS_WITH(refused(R"("primitives": [{"attributes": {"POSITION": 0}, "targets": [{"NORMAL": 1}]}])"),
                    ": /meshes/0/primitives/0/targets/0: a target moves");
  CHECK_STARTS_WITH(refused(R"("primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 5}]}])"),
                    ": /meshes/0/primitives/0/targets/0/POSITION: the accessor has 2");
  CHECK_STARTS_WITH(refused(R"("primitives": [{"attributes": {"POSITION": 0}, "targets": [{"JOINTS_0": 0}]}])"),
                    ": /meshes/0/primitives/0/targets/0/JOINTS_0: this attribute");
}

// --- Skins ---------------------------------------------------------------------------------------------------------

/// Vertex 0 follows joint 0, vertex 1 joint 1, vertex 2 both by halves.
Asset skinned() {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");                                                 // 0
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");             // 1
  asset.accessor(std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");  // 2
  asset.accessor(std::vector<uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 100, 100, 0, 0}, "VEC4",
                 R"("normalized": true)");  // 3
  std::vector<float> matrices(32, 0.0f);
  for (size_t m = 0; m < 2; ++m)
    for (size_t k = 0; k < 4; ++k) matrices[16 * m + 5 * k] = 1.0f;
  matrices[16 + 12] = -1.0f;                                     // joint 1 stands at x = 1
  asset.accessor(matrices, "MAT4");                              // 4
  asset.accessor(std::vector<float>{0, 1}, "SCALAR");            // 5
  asset.accessor(std::vector<float>{1, 0, 0, 1, 0, 8}, "VEC3");  // 6
  return asset;
}
std::string skinned_rest(
    const std::string& more = "",
    const std::string& attributes = R"("POSITION": 0, "NORMAL": 1, "JOINTS_0": 2, "WEIGHTS_0": 3)") {
  return R"("scenes": [{"nodes": [0, 1]}], "meshes": [{"primitives": [{"attributes": {)" + attributes + R"(}}]}],
    "skins": [{"joints": [1, 2], "inverseBindMatrices": 4}],
    "nodes": [{"mesh": 0, "skin": 0, "translation": [70, 80, 90]}, {"children": [2]}, {"translation": [1, 0, 0]}])" +
         more;
}
const std::string kMoved =
    R"(, "animations": [{"samplers": [{"input": 5, "output": 6}], "channels": [{"sampler": 0, "target": {"node": 2, "path": "translation"}}]}])";

TEST_CASE("skins bring vertices to world space by their joints, and the node's own place has no say") {
  const Asset asset = skinned();
  Scene scene = load_gltf(asset.gltf(skinned_rest(kMoved)));
  REQUIRE(scene.instances.size() == 1);
  CHECK(scene.instances[0].world_from_object == glm::mat4x3(1.0f));
  CHECK(vertex(scene, 0, 1) == glm::vec3(1, 0, 0));  // as bound
  set_time(scene, 0.5);
  CHECK(vertex(scene, 0, 0) == glm::vec3(0, 0, 0));
  CHECK(vertex(scene, 0, 1) == glm::vec3(1, 0, 4));
  CHECK(vertex(scene, 0, 2) == glm::vec3(0, 1, 2));
  CHECK(scene.meshes[0].normal[2][1] == 1.0f);
  set_time(scene, 0.0);
  CHECK(vertex(scene, 0, 2) == glm::vec3(0, 1, 0));
}

TEST_CASE("two skins of one mesh are two meshes, and a node without a skin draws the mesh as it is") {
  const Asset asset = skinned();
  const Scene scene = load_gltf(asset.gltf(
      R"("scenes": [{"nodes": [0, 1, 2, 3]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}}]}],
    "skins": [{"joints": [1, 4]}],
    "nodes": [{"mesh": 0, "skin": 0}, {"translation": [0, 0, 5], "children": [4]}, {"mesh": 0, "skin": 0, "translation": [0, 0, 3]}, {"mesh": 0, "translation": [0, 0, 2]}, {}])"));
  REQUIRE(scene.meshes.size() == 3);
  CHECK(vertex(scene, 0, 1) == glm::vec3(1, 0, 5));
  CHECK(vertex(scene, 1, 1) == glm::vec3(1, 0, 5));
  CHECK(vertex(scene, 2, 1) == glm::vec3(1, 0, 0));
  CHECK(scene.instances[2].world_from_object[3].z == 2.0f);
}

TEST_CASE("copies of a skinned mesh, or of none, are named as ignored") {
  const Asset asset = skinned();
  const std::string copies = R"("extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 6}}})";
  std::string rest = skinned_rest();
  rest.replace(rest.find(R"("mesh": 0,)"), 10, R"("mesh": 0, )" + copies + ",");
  const Scene scene = load_gltf(asset.gltf(rest));
  CHECK(scene.instances.size() == 1);
  const std::string note = " EXT_mesh_gpu_instancing, which is ignored: Only a mesh without a skin is copied";
  CHECK(scene.notes == std::vector<std::string>{"1 node has" + note});
  const Scene without = load_gltf(asset.gltf(R"("nodes": [{)" + copies + "}, {" + copies + "}]"));
  CHECK(without.notes == std::vector<std::string>{"2 nodes have" + note});
}

TEST_CASE("matrices of joints and steps of animations may lie apart by a stride, which a note says") {
  Asset asset = skinned();
  std::vector<float> matrices(2 * 20, 0.0f);
  for (size_t m = 0; m < 2; ++m)
    for (size_t k = 0; k < 4; ++k) matrices[20 * m + 5 * k] = 1.0f;
  matrices[20 + 12] = -1.0f;
  const std::vector<float> steps{1, 0, 0, 99, 1, 0, 8, 99};
  const std::string of_matrices = std::to_string(asset.view(matrices, R"("byteStride": 80)")),
                    of_steps = std::to_string(asset.view(steps, R"("byteStride": 16)"));
  asset.accessor(R"("bufferView": )" + of_matrices + R"(, "componentType": 5126, "count": 2, "type": "MAT4")");  // 7
  asset.accessor(R"("bufferView": )" + of_steps + R"(, "componentType": 5126, "count": 2, "type": "VEC3")");     // 8
  std::string apart = skinned_rest(kMoved);
  apart.replace(apart.find(R"("inverseBindMatrices": 4)"), 24, R"("inverseBindMatrices": 7)");
  apart.replace(apart.find(R"("output": 6)"), 11, R"("output": 8)");
  Scene scene = load_gltf(asset.gltf(apart)), beside = load_gltf(asset.gltf(skinned_rest(kMoved)));
  CHECK(scene.notes == std::vector<std::string>{"2 accessors of joints or animations are read by the stride of the "
                                                "view, which glTF keeps for vertices"});
  CHECK(beside.notes.empty());
  for (const double time : {0.0, 0.5, 1.0}) {
    set_time(scene, time), set_time(beside, time);
    for (int v = 0; v < 3; ++v) CHECK(vertex(scene, 0, v) == vertex(beside, 0, v));
  }
}

TEST_CASE("skins that point nowhere are refused") {
  const Asset asset = skinned();
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string rest = skinned_rest();
    rest.replace(rest.find(from), from.size(), to);
    return gltf_refusal(asset.gltf(rest));
  };
  CHECK_STARTS_WITH(refused(R"("joints": [1, 2])", R"("joints": [1, 7])"), ": /skins/0/joints/1: there is no node 7");
  CHECK_STARTS_WITH(refused(R"("joints": [1, 2])", R"("joints": [2, 2])"),
                    ": /skins/0/joints/1: node 2 is named twice");
  CHECK_STARTS_WITH(refused(R"("joints": [1, 2])", R"("joints": [])"), ": /skins/0/joints: found an array of 0");
  CHECK_STARTS_WITH(refused(R"("joints": [1, 2])", R"("joints": [1])"),
                    ": /meshes/0/primitives/0: a vertex names joint 1 of 1");
  CHECK_STARTS_WITH(refused(R"("joints": [1, 2])", R"("joints": [1, 2, 2])"),
                    ": /skins/0/inverseBindMatrices: there are 2 matrices for 3 joints");
  CHECK_STARTS_WITH(refused(R"("joints": [1, 2])", R"("joints": [1, 0])"),
                    ": /skins/0/joints/1: the joints have no common root");
  CHECK_STARTS_WITH(refused(R"("joints": [1, 2])", R"("joints": [1, 2], "skeleton": 2)"),
                    ": /skins/0/skeleton: the skeleton is not above all joints");
  CHECK_STARTS_WITH(refused(R"("inverseBindMatrices": 4)", R"("inverseBindMatrices": 0)"),
                    ": /skins/0/inverseBindMatrices: the accessor is not of matrices");
  CHECK_STARTS_WITH(refused(R"("nodes": [0, 1])", R"("nodes": [0])"),
                    ": /skins/0/joints/0: the joint is not in the scene that is drawn");
  CHECK_STARTS_WITH(refused(R"("JOINTS_0": 2, "WEIGHTS_0": 3)", R"("_A": 2)"),
                    ": /nodes/0/skin: the node has a skin and its mesh has no joints");
  CHECK_STARTS_WITH(refused(R"("WEIGHTS_0": 3)", R"("WEIGHTS_1": 3)"),
                    ": /meshes/0/primitives/0/attributes: there are not as many JOINTS");
}

TEST_CASE("joints deep in a hierarchy are checked in a time that grows with the file") {
  constexpr int kNodes = 200000;  // walking up from each joint would take some 10^10 steps
  std::string nodes, joints;
  for (int i = 0; i < kNodes; ++i) {
    nodes += (i ? ", " : "") + (i + 1 < kNodes ? R"({"children": [)" + std::to_string(i + 1) + "]}" : "{}");
    if (i < kNodes / 2) joints += (i ? ", " : "") + std::to_string(kNodes - 1 - i);
  }
  SceneLimits limits;
  limits.node_depth = kNodes;
  const auto text = [&](const std::string& skeleton, const std::string& last) {
    return R"({"asset": {"version": "2.0"}, "nodes": [)" + nodes + last + R"(], "skins": [{"joints": [)" + joints +
           R"(], "skeleton": )" + skeleton + "}]}";
  };
  CHECK(load_gltf(text("0", ""), limits).instances.empty());
  CHECK(load_gltf(text(std::to_string(kNodes / 2 - 1), ""), limits).instances.empty());
  CHECK_STARTS_WITH(gltf_refusal(text(std::to_string(kNodes / 2 + 1), "")),
                    ": /skins/0/skeleton: the skeleton is not above");
  CHECK_STARTS_WITH(gltf_refusal(text(std::to_string(kNodes), ", {}")),
                    ": /skins/0/skeleton: the skeleton is not above");
}

TEST_CASE("normals of huge and tiny matrices are unit vectors") {
  for (const double scale : {1e100, 1e200, 1e-100, 1e-200}) {
    std::string rest = skinned_rest(kMoved);
    Scene scene = load_gltf(skinned().gltf(rest));
    for (glm::dmat4x3& matrix : scene.timeline.skins[0].joint_from_mesh) matrix = glm::dmat4x3(0.0);
    for (glm::dmat4x3& matrix : scene.timeline.skins[0].joint_from_mesh)
      for (int k = 0; k < 3; ++k) matrix[k][k] = scale;
    for (auto& stream : scene.timeline.shapes[0].position) std::fill(stream.begin(), stream.end(), 0.0f);
    set_time(scene, 0.0);
    for (size_t v = 0; v < 3; ++v) CHECK(scene.meshes[0].normal[2][v] == 1.0f);
  }
}

TEST_CASE("a pose beyond what can be drawn is refused with its time") {
  Asset asset = skinned();
  asset.accessor(std::vector<float>{0, 0, 0, 1e18f, 1e18f, 0}, "VEC3");  // 7
  std::string rest = skinned_rest(kMoved);
  rest.replace(rest.find(R"("output": 6)"), 11, R"("output": 7)");
  Scene scene =
      load_gltf(asset.gltf(rest + R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}])"));
  const std::string text = error_of(ErrorKind::bad_input, [&] {
    scene.timeline.node_motions[0].motion.position->values[1].x = 3e18;
    set_time(scene, 1.0);
  });
  CHECK_STARTS_WITH(text, "a.gltf: time 1: mesh 0: vertex 1: its pose takes it beyond 1e18");
}

}  // namespace
}  // namespace trueshade
