#include "../expect_error.h"
#include "asset.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/shipped_models.h"

namespace trueshade {
namespace {

/// A strip's worth of vertices in two rows.
Asset rows(int vertices) {
  Asset asset;
  std::vector<float> positions, normals;
  for (int v = 0; v < vertices; ++v) {
    positions.insert(positions.end(), {float(v / 2), float(v % 2), 0.0f});
    normals.insert(normals.end(), {0.0f, 0.0f, 1.0f});
  }
  asset.accessor(positions, "VEC3");
  asset.accessor(normals, "VEC3");
  return asset;
}

Array<uint32_t> indices_of(int vertices, int mode, const std::vector<uint16_t>& indices = {}) {
  Asset asset = rows(vertices);
  std::string rest = R"("attributes": {"POSITION": 0, "NORMAL": 1}, "mode": )" + std::to_string(mode);
  if (!indices.empty()) rest += R"(, "indices": )" + std::to_string(asset.accessor(indices, "SCALAR"));
  return load_gltf(asset.gltf(one_primitive(rest))).meshes.at(0).indices;
}

TEST_CASE("strips and fans become lists in the format's order") {
  using Indices = std::vector<uint32_t>;
  CHECK(indices_of(5, 5) == Indices{0, 1, 2, 1, 3, 2, 2, 3, 4});
  CHECK(indices_of(5, 6) == Indices{1, 2, 0, 2, 3, 0, 3, 4, 0});
  CHECK(indices_of(6, 4) == Indices{0, 1, 2, 3, 4, 5});
  CHECK(indices_of(4, 5, {3, 1, 2, 0, 0}) == Indices{3, 1, 2, 1, 0, 2, 2, 0, 0});
  CHECK(indices_of(4, 6, {3, 1, 2, 0}) == Indices{1, 2, 3, 2, 0, 3});
}

TEST_CASE("corners that end no triangle are left out") {
  CHECK(indices_of(5, 4) == std::vector<uint32_t>{0, 1, 2});
  CHECK(indices_of(2, 4).empty());
  CHECK(indices_of(2, 5).empty());
  CHECK(indices_of(2, 6).empty());
  CHECK(indices_of(3, 5, {0, 1}).empty());
}

TEST_CASE("points and lines are named as not drawn") {
  for (int mode = 0; mode < 4; ++mode) {
    Asset asset = rows(4);
    const Scene scene =
        load_gltf(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0}, "mode": )" + std::to_string(mode))));
    CHECK(scene.instances.empty());
    REQUIRE(scene.notes.size() == 1);
    CHECK_STARTS_WITH(scene.notes[0],
                      mode == 0 ? "1 primitive of points is not drawn" : "1 primitive of lines is not drawn");
  }
  Asset asset = rows(4);
  const Scene without = load_gltf(asset.gltf(one_primitive(R"("attributes": {"_POSITION": 0})")));
  CHECK(without.instances.empty());
  CHECK(without.notes == std::vector<std::string>{"1 primitive has no POSITION and no triangles to draw"});
  CHECK_STARTS_WITH(gltf_refusal(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0}, "mode": 7)"))),
                    ": /meshes/0/primitives/0/mode: found 7");
}

TEST_CASE("indices beyond the vertices are refused, primitive restart among them") {
  const auto refused = [](const auto& indices, const std::string& more = "") {
    Asset asset = rows(4);
    const int i = asset.accessor(indices, "SCALAR", more);
    return gltf_refusal(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0}, "indices": )" + std::to_string(i))));
  };
  CHECK_STARTS_WITH(refused(std::vector<uint8_t>{0, 1, 4}),
                    ": /meshes/0/primitives/0/indices: index 4 at 2 is beyond the vertices");
  CHECK_STARTS_WITH(refused(std::vector<uint16_t>{0, 65535, 1}), ": /meshes/0/primitives/0/indices: index 65535 at 1");
  CHECK_STARTS_WITH(refused(std::vector<float>{0, 1, 2}), ": /meshes/0/primitives/0/indices: the accessor's type");
  CHECK_STARTS_WITH(refused(std::vector<int16_t>{0, 1, 2}), ": /meshes/0/primitives/0/indices: the accessor's type");
  CHECK_STARTS_WITH(refused(std::vector<uint8_t>{0, 1, 2}, R"("normalized": true)"),
                    ": /meshes/0/primitives/0/indices: the accessor's type");
  const auto of_many = [](uint8_t last) {  // 300 vertices, so that 255 is below them
    Asset asset;
    asset.accessor(R"("componentType": 5126, "count": 300, "type": "VEC3")");
    asset.accessor(std::vector<uint8_t>{0, 1, last}, "SCALAR");
    return asset.gltf(one_primitive(R"("attributes": {"POSITION": 0}, "indices": 1)"));
  };
  CHECK(load_gltf(of_many(254)).triangle_count() == 1);
  CHECK_STARTS_WITH(gltf_refusal(of_many(255)),
                    ": /meshes/0/primitives/0/indices: index 255 at 2 is the largest of its type");
  Asset broken = rows(3);  // drawn by no node
  broken.accessor(std::vector<uint8_t>{0, 1, 9}, "SCALAR");
  CHECK_STARTS_WITH(
      gltf_refusal(broken.gltf(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 2}]}])")),
      ": /meshes/0/primitives/0/indices: index 9");
}

TEST_CASE("a primitive without normals is flat: a triangle's own normal at corners of its own") {
  Asset asset;
  asset.accessor(std::vector<float>{0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2}, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}, "VEC2");
  asset.accessor(std::vector<uint8_t>{0, 1, 2, 0, 3, 1}, "SCALAR");
  const Scene scene = load_gltf(
      asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 1}, "indices": 2)")));
  const Mesh& mesh = scene.meshes.at(0);
  CHECK(mesh.indices == std::vector<uint32_t>{0, 1, 2, 3, 4, 5});
  CHECK(mesh.normal[2] == std::vector<float>{1, 1, 1, 0, 0, 0});
  CHECK(mesh.normal[1] == std::vector<float>{0, 0, 0, 1, 1, 1});
  CHECK(mesh.uv[0] == std::vector<float>{0, 1, 0, 0, 1, 1});
  CHECK(mesh.more_uv.at(0)[1] == std::vector<float>{0, 0, 1, 0, 1, 0});
}

TEST_CASE("vertex colours have three or four components, floats or normalized integers") {
  const auto colors = [](const auto& values, const char* type, const std::string& more = "") {
    Asset asset;
    asset.accessor(kTriangle, "VEC3");
    asset.accessor(kTriangle, "VEC3");
    asset.accessor(values, type, more);
    return load_gltf(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2})")))
        .meshes.at(0)
        .color;
  };
  const std::vector<float> floats{1, 0, 0.5f, 0, 1, 0.25f, 0, 0, 1};
  const auto three = colors(floats, "VEC3");
  CHECK(three[2] == std::vector<float>{0.5f, 0.25f, 1.0f});
  CHECK(three[3] == std::vector<float>{1, 1, 1});
  const auto bytes =
      colors(std::vector<uint8_t>{255, 0, 51, 128, 1, 2, 3, 4, 5, 6, 7, 8}, "VEC4", R"("normalized": true)");
  CHECK(bytes[0] == std::vector<float>{1.0f, 1.0f / 255.0f, 5.0f / 255.0f});
  CHECK(bytes[3] == std::vector<float>{128.0f / 255.0f, 4.0f / 255.0f, 8.0f / 255.0f});
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 1.5f, 0}, "VEC3");
  CHECK_STARTS_WITH(gltf_refusal(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "COLOR_0": 1})"))),
                    ": /accessors/1: the colour of vertex 2 is out of range");
}

TEST_CASE("attributes of a primitive have one element a vertex") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC3");
  CHECK_STARTS_WITH(gltf_refusal(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "NORMAL": 1})"))),
                    ": /meshes/0/primitives/0/attributes/NORMAL: the accessor has 2 elements and others have 3");
  CHECK_STARTS_WITH(gltf_refusal(asset.gltf(one_primitive(R"("attributes": {})"))),
                    ": /meshes/0/primitives/0/attributes: there is no attribute");
  CHECK(load_gltf(asset.gltf(one_primitive(R"("attributes": {"NORMAL": 0})"))).instances.empty());  // nothing to draw
  CHECK(load_gltf(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "_OWN": 0})"))).triangle_count() == 1);
}

TEST_CASE("primitives that name the same accessors are one mesh") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  const std::string primitive = R"({"attributes": {"POSITION": 0}})";
  const Scene scene =
      load_gltf(asset.gltf(R"("scenes": [{"nodes": [0, 1, 2]}], "nodes": [{"mesh": 0}, {"mesh": 1}, {"mesh": 0}],
    "meshes": [{"primitives": [)" +
                           primitive + ", " + primitive + R"(]}, {"primitives": [)" + primitive + "]}]"));
  CHECK(scene.meshes.size() == 1);
  CHECK(scene.instances.size() == 5);
}

// --- Nodes ---------------------------------------------------------------------------------------------------------

Scene nodes(const std::string& list, const std::string& roots = "0", const std::string& more = "") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  return load_gltf(
      asset.gltf(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "scenes": [{"nodes": [)" + roots +
                 R"(]}], "nodes": [)" + list + "]" + more));
}

std::string refused_nodes(const std::string& list, const std::string& roots = "0",
                          ErrorKind kind = ErrorKind::bad_input, const SceneLimits& limits = {}) {
  return gltf_refusal(
      R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [)" + roots + R"(]}], "nodes": [)" + list + "]}", kind,
      limits);
}

TEST_CASE("matrices and translation, rotation, scale give the same instances") {
  const Scene trs = nodes(R"({"mesh": 0, "translation": [1, 2, 3], "rotation": [0, 0, 1, 0], "scale": [2, 3, -4]})");
  const Scene matrix = nodes(R"({"mesh": 0, "matrix": [-2, 0, 0, 0, 0, -3, 0, 0, 0, 0, -4, 0, 1, 2, 3, 1]})");
  CHECK(trs.instances.at(0).world_from_object ==
        glm::mat4x3(glm::vec3(-2, 0, 0), glm::vec3(0, -3, 0), glm::vec3(0, 0, -4), glm::vec3(1, 2, 3)));
  CHECK(scene_hash(trs) == scene_hash(matrix));
  const Scene parts = nodes(
      R"({"children": [1], "translation": [1, 2, 3]}, {"children": [2], "rotation": [0, 0, 1, 0]}, {"mesh": 0, "scale": [2, 3, -4]})");
  CHECK(scene_hash(parts) == scene_hash(trs));
}

TEST_CASE("children stand on their parents, depth first in the file's order") {
  const Scene scene =
      nodes(R"({"mesh": 0, "translation": [1, 0, 0], "children": [3, 1]}, {"mesh": 0, "translation": [0, 1, 0]},
                              {"mesh": 0, "translation": [9, 9, 9]}, {"mesh": 0, "scale": [2, 2, 2], "children": [4]},
                              {"mesh": 0, "translation": [1, 1, 1]})",
            "2, 0");
  REQUIRE(scene.instances.size() == 5);
  const auto at = [&](size_t i) { return scene.instances[i].world_from_object[3]; };
  CHECK(at(0) == glm::vec3(9, 9, 9));
  CHECK(at(1) == glm::vec3(1, 0, 0));
  CHECK(at(2) == glm::vec3(1, 0, 0));
  CHECK(at(3) == glm::vec3(3, 2, 2));
  CHECK(at(4) == glm::vec3(1, 1, 0));
}

TEST_CASE("the default scene is drawn, else the first, else all root nodes") {
  const std::string two =
      R"("nodes": [{"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}])";
  const auto first_x = [&](const std::string& scenes, size_t count) {
    Asset asset;
    asset.accessor(kTriangle, "VEC3");
    const Scene scene = load_gltf(asset.gltf(two + scenes));
    CHECK(scene.instances.size() == count);
    return scene.instances.empty() ? -1.0f : scene.instances[0].world_from_object[3].x;
  };
  CHECK(first_x(R"(, "scene": 1, "scenes": [{"nodes": [0]}, {"nodes": [1]}])", 1) == 5.0f);
  CHECK(first_x(R"(, "scenes": [{"nodes": [1]}, {"nodes": [0]}])", 1) == 5.0f);
  CHECK(first_x("", 2) == 0.0f);
  CHECK(first_x(R"(, "scenes": [{}])", 0) == -1.0f);
}

TEST_CASE("hierarchies that are none are refused") {
  CHECK_STARTS_WITH(refused_nodes(R"({"children": [0]})"), ": /nodes/0: the node is below itself");
  CHECK_STARTS_WITH(refused_nodes(R"({"children": [1]}, {"children": [2]}, {"children": [0]})"), ": /nodes/");
  CHECK_STARTS_WITH(refused_nodes(R"({"children": [2]}, {"children": [2]}, {})"),
                    ": /nodes/1/children/0: node 2 has two parents, 0 and 1");
  CHECK_STARTS_WITH(refused_nodes(R"({"children": [1, 1]}, {})"), ": /nodes/0/children/1: node 1 has two parents");
  CHECK_STARTS_WITH(refused_nodes(R"({"children": [1]}, {})", "1"), ": /scenes/0/nodes/0: node 1 is no root");
  CHECK_STARTS_WITH(refused_nodes("{}", "0, 0"), ": /scenes/0/nodes/1: node 0 is named twice");
  CHECK_STARTS_WITH(refused_nodes("{}", "1"), ": /scenes/0/nodes/0: there is no node 1");
  CHECK_STARTS_WITH(refused_nodes(R"({"children": []})"), ": /nodes/0/children: found an array of 0");
  CHECK(nodes(R"({"mesh": 0, "rotation": [0, 0, 1.0000001192092896, 0]})").instances.size() == 1);  // a rounded float
  CHECK_STARTS_WITH(refused_nodes(R"({"rotation": [0, 0, 0, 0.99]})"),
                    ": /nodes/0/rotation: the quaternion is not of unit length");
  CHECK_STARTS_WITH(refused_nodes(R"({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]})"),
                    ": /nodes/0/matrix: the matrix does more");
  CHECK_STARTS_WITH(
      refused_nodes(R"({"scale": [1, 1, 1], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]})"),
      ": /nodes/0: a node has a matrix and");
  CHECK_STARTS_WITH(refused_nodes(R"({"skin": 0})"), ": /nodes/0/skin: there is no skin 0");
  CHECK_STARTS_WITH(refused_nodes(R"({"weights": [1]})"), ": /nodes/0/weights: the node has weights and no mesh");
  SceneLimits limits;
  limits.nodes = 2, limits.node_depth = 2;
  CHECK_STARTS_WITH(refused_nodes("{}, {}, {}", "0", ErrorKind::limit, limits),
                    ": /nodes: 3 nodes are over the limit (at most 2, or a higher --max-nodes)");
  limits.nodes = 3;
  CHECK_STARTS_WITH(refused_nodes(R"({"children": [1]}, {"children": [2]}, {})", "0", ErrorKind::limit, limits),
                    ": /nodes/2: the node lies deeper than the limit (at most 2 levels, or a higher --max-node-depth)");
}

TEST_CASE("a chain of a thousand nodes is read without recursion") {
  std::string list;
  for (int i = 0; i < 1000; ++i)
    list += (i ? ", " : "") + std::string(R"({"translation": [1, 0, 0])") +
            (i < 999 ? R"(, "children": [)" + std::to_string(i + 1) + "]}" : R"(, "mesh": 0})");
  CHECK(nodes(list).instances.at(0).world_from_object[3].x == 1000.0f);
}

TEST_CASE("copies of a node are instances of one mesh") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{1, 0, 0, 0, 5, 0}, "VEC3");
  asset.accessor(std::vector<int8_t>{0, 0, 127, 0, 0, 0, 0, 127}, "VEC4", R"("normalized": true)");
  asset.accessor(std::vector<float>{2, 2, 2, 1, 1, 1}, "VEC3");
  const auto rest = [](const std::string& attributes) {
    return R"("extensionsUsed": ["EXT_mesh_gpu_instancing"], )" +
           one_primitive(R"("attributes": {"POSITION": 0})",
                         R"("translation": [10, 0, 0], "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {)" +
                             attributes + "}}}");
  };
  const Scene scene = load_gltf(asset.gltf(rest(R"("TRANSLATION": 1, "ROTATION": 2, "SCALE": 3)")));
  REQUIRE(scene.instances.size() == 2);
  CHECK(scene.meshes.size() == 1);
  CHECK(scene.instances[0].world_from_object ==
        glm::mat4x3(glm::vec3(-2, 0, 0), glm::vec3(0, -2, 0), glm::vec3(0, 0, 2), glm::vec3(11, 0, 0)));
  CHECK(scene.instances[1].world_from_object[3] == glm::vec3(10, 5, 0));
  const std::string place = ": /nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
  CHECK_STARTS_WITH(gltf_refusal(asset.gltf(rest(""))), place + ": there is no TRANSLATION");
  CHECK_STARTS_WITH(gltf_refusal(asset.gltf(rest(R"("TRANSLATION": 0, "SCALE": 3)"))),
                    place + "/SCALE: the attributes differ");
  CHECK_STARTS_WITH(gltf_refusal(asset.gltf(rest(R"("TRANSLATION": 2)"))), place + "/TRANSLATION: the accessor's type");
  CHECK_STARTS_WITH(gltf_refusal(asset.gltf(rest(R"("SCALE": 9)"))), place + "/SCALE: there is no accessor 9");
  SceneLimits limits;
  limits.instances = 1;
  CHECK_STARTS_WITH(gltf_refusal(asset.gltf(rest(R"("SCALE": 3)")), ErrorKind::limit, limits),
                    ": /nodes/0: the instances are over the limit");
}

// --- Cameras and lights ----------------------------------------------------------------------------------------------

TEST_CASE("the scene's first camera is looked through") {
  const Scene scene = nodes(
      R"({"children": [1, 2]}, {"camera": 1, "translation": [0, 0, 7], "rotation": [0, 1, 0, 0]}, {"camera": 0})", "0",
      R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5}},
                               {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.25, "zfar": 8, "aspectRatio": 2}}])");
  CHECK(scene.camera.eye == glm::vec3(0, 0, 7));
  CHECK(scene.camera.target == glm::vec3(0, 0, 14));
  CHECK(scene.camera.up == glm::vec3(0, 1, 0));
  CHECK(scene.camera.fov_y_rad == 0.5f);
  CHECK(scene.camera.near == 0.25f);
  CHECK(scene.camera.far == 8.0f);
  REQUIRE(scene.notes.size() == 1);
  CHECK_STARTS_WITH(scene.notes[0], "1 camera is ignored: The file's first camera is the scene's");
}

TEST_CASE("an orthographic camera shows xmag and ymag to each side") {
  const Scene scene = nodes(
      R"({"camera": 0, "translation": [1, 2, 3]})", "0",
      R"(, "cameras": [{"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 4, "znear": 1, "zfar": 5}}])");
  REQUIRE(scene.camera.clip_from_world);
  const Matrix4 m = clip_from_world(scene.camera, 1.0);
  const auto clip = [&](double x, double y, double z, size_t r) {
    return m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r];
  };
  CHECK(clip(3, 6, 2, 0) == 1.0);  // 2 to the right, 4 up, 1 ahead
  CHECK(clip(3, 6, 2, 1) == 1.0);
  CHECK(clip(3, 6, 2, 2) == -1.0);
  CHECK(clip(3, 6, -2, 2) == 1.0);
  CHECK(clip(3, 6, -2, 3) == 1.0);
  const Matrix4 half = clip_from_world(scene.camera, 1.0, ClipRange::zero_to_one);
  const auto depth = [&](double z) { return half[2] * 3 + half[6] * 6 + half[10] * z + half[14]; };
  CHECK(depth(2) == 0.0);
  CHECK(depth(-2) == 1.0);
  for (size_t i = 0; i < 16; ++i)
    if (i % 4 != 2) CHECK(half[i] == m[i]);
}

TEST_CASE("lights and cameras on nodes that are scaled to nothing keep a direction") {
  const std::string turned = R"("rotation": [0.7071067811865476, 0, 0, 0.7071067811865476], "scale": )";  // z to -y
  const auto camera = [&](const std::string& scale) {
    return nodes(R"({"camera": 0, )" + turned + scale + "}", "0",
                 R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}])")
        .camera;
  };
  for (const char* scale : {"[1, 1, 1]", "[2, 3, 0]", "[0, 1, 1]"}) {
    CHECK(std::fabs(camera(scale).target.y - 1.0f) < 1e-6f);
    CHECK(std::fabs(camera(scale).up.z - 1.0f) < 1e-6f);
  }
  CHECK(camera("[0, 0, 0]").target == glm::vec3(0, 0, -1));
  for (const char* scale : {"[1, 1, 1]", "[2, 3, 0]"}) {
    const Scene scene = nodes(R"({"extensions": {"KHR_lights_punctual": {"light": 0}}, )" + turned + scale + "}", "0",
                              R"(, "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional"}]}})");
    CHECK(std::fabs(scene.lights[0].direction.y - 1.0f) < 1e-6f);
  }
}

TEST_CASE("cameras out of range are refused") {
  const auto refused = [](const std::string& camera) {
    return gltf_refusal(R"({"asset": {"version": "2.0"}, "nodes": [{"camera": 0}], "cameras": [)" + camera + "]}");
  };
  const std::string start = R"({"type": "perspective", "perspective": {)",
                    flat = R"({"type": "orthographic", "orthographic": {)";
  CHECK_STARTS_WITH(refused(start + R"("yfov": 0, "znear": 1}})"), ": /cameras/0/perspective/yfov: found 0");
  CHECK_STARTS_WITH(refused(start + R"("yfov": 3.15, "znear": 1}})"),
                    ": /cameras/0/perspective/yfov: the angle is pi or more");
  CHECK_STARTS_WITH(refused(start + R"("yfov": 1, "znear": 0}})"), ": /cameras/0/perspective/znear: found 0");
  CHECK_STARTS_WITH(refused(start + R"("yfov": 1, "znear": 1, "zfar": 1}})"),
                    ": /cameras/0/perspective: zfar is not above znear");
  CHECK_STARTS_WITH(refused(start + R"("yfov": 1, "znear": 1, "zfar": 1.00000000001}})"),
                    ": /cameras/0/perspective: znear and zfar are too close");
  CHECK_STARTS_WITH(refused(start + R"("yfov": 1}})"), ": /cameras/0/perspective: 'znear' is missing");
  CHECK_STARTS_WITH(refused(R"({"type": "perspective"})"), ": /cameras/0: 'perspective' is missing");
  CHECK_STARTS_WITH(refused(R"({"type": "fisheye"})"), ": /cameras/0/type: this type is not in glTF");
  CHECK_STARTS_WITH(refused(flat + R"("xmag": 0, "ymag": 1, "znear": 0, "zfar": 1}})"),
                    ": /cameras/0/orthographic: xmag or ymag is 0");
  CHECK_STARTS_WITH(refused(flat + R"("xmag": 1, "ymag": 1, "znear": 2, "zfar": 1}})"),
                    ": /cameras/0/orthographic: zfar is not above znear");
  CHECK_STARTS_WITH(refused(flat + R"("xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}, "perspective": {}})"),
                    ": /cameras/0: a camera is perspective and");
}

std::string lights(const std::string& light, const std::string& node = "") {
  return R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [)" +
         light + R"(]}}, "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}})" +
         (node.empty() ? "" : ", " + node) + "}]}";
}

TEST_CASE("lights stand at their nodes and shine along -z, in candela and lux") {
  const Scene scene = load_gltf(lights(
      R"({"type": "spot", "color": [1, 0.5, 0], "intensity": 10, "range": 4, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.75}})",
      R"("translation": [1, 2, 3], "rotation": [0, 1, 0, 0], "scale": [3, 3, 3])"));
  REQUIRE(scene.lights.size() == 1);
  const Light& spot = scene.lights[0];
  CHECK(spot.type == LightType::spot);
  CHECK(spot.position == glm::vec3(1, 2, 3));
  CHECK(spot.direction == glm::vec3(0, 0, 1));
  CHECK(spot.color == glm::vec3(10, 5, 0));
  CHECK(spot.range == 4.0f);
  CHECK(spot.cone_rad == 0.25f);
  CHECK(spot.penumbra_rad == 0.5f);
  CHECK(scene.photometric);
  CHECK(!scene.lights_of_ours);
  CHECK(default_pipeline(scene).preset == "gltf");
  CHECK(default_pipeline(scene).light_program == shipped_program("gltf"));
  CHECK(default_pipeline(scene, false).preset == "punctual");  // of a build without light programs
  CHECK_FALSE(default_pipeline(scene, false).light_program.used());
  for (const bool by_program : {true, false})
    CHECK(default_pipeline(scene, by_program).geometry.cull_face == CullFace::back);
  const Light point = load_gltf(lights(R"({"type": "point"})")).lights.at(0);
  CHECK(point.type == LightType::point);
  CHECK(point.color == glm::vec3(1));
  CHECK(std::isinf(point.range));
  CHECK(load_gltf(lights(R"({"type": "directional", "range": 3})")).lights.at(0).direction == glm::vec3(0, 0, -1));
}

TEST_CASE("lights out of range are refused") {
  CHECK_STARTS_WITH(gltf_refusal(lights(R"({"type": "spherical"})")),
                    ": /extensions/KHR_lights_punctual/lights/0/type: this type is not");
  CHECK_STARTS_WITH(gltf_refusal(lights(R"({})")), ": /extensions/KHR_lights_punctual/lights/0: 'type' is missing");
  CHECK_STARTS_WITH(gltf_refusal(lights(R"({"type": "spot"})")),
                    ": /extensions/KHR_lights_punctual/lights/0: 'spot' is missing");
  CHECK_STARTS_WITH(gltf_refusal(lights(R"({"type": "spot", "spot": {"innerConeAngle": 1, "outerConeAngle": 1}})")),
                    ": /extensions/KHR_lights_punctual/lights/0/spot: inner");
  CHECK_STARTS_WITH(gltf_refusal(lights(R"({"type": "spot", "spot": {"outerConeAngle": 2}})")),
                    ": /extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle: found 2");
  CHECK_STARTS_WITH(gltf_refusal(lights(R"({"type": "point", "intensity": -1})")),
                    ": /extensions/KHR_lights_punctual/lights/0/intensity: found -1");
  CHECK_STARTS_WITH(gltf_refusal(lights(R"({"type": "point", "range": 0})")),
                    ": /extensions/KHR_lights_punctual/lights/0/range: found 0");
  CHECK_STARTS_WITH(gltf_refusal(lights(R"({"type": "point", "color": [1, 1]})")),
                    ": /extensions/KHR_lights_punctual/lights/0/color: found an array of 2");
}

TEST_CASE("a scene file may name a glTF file as geometry: a mesh a material, in the file's space") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  const std::string primitives =
      R"([{"attributes": {"POSITION": 0}, "material": 1}, {"attributes": {"POSITION": 0}, "material": 0}])";
  const std::string text = asset.gltf(
      R"("materials": [{"name": "a"}, {"name": "b", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}], "meshes": [{"primitives": )" +
      primitives + R"(}], "nodes": [{"mesh": 0, "translation": [1, 0, 0]}, {"mesh": 0, "scale": [1, 1, -2]}])");
  const ScratchFolder scratch;
  scratch.write("sub/a.gltf", text);
  const auto load = [&](const std::string& object) {
    return load_scene(scratch.write(
        "s.json",
        R"({"version": 1, "materials": [{"name": "own", "color": [0, 1, 0]}], "objects": [{"geometry": "sub/a.gltf")" +
            object + "}]}"));
  };
  const Scene scene = load(R"(, "position": [0, 5, 0])");
  REQUIRE(scene.instances.size() == 2);
  CHECK(scene.meshes.size() == 2);
  CHECK(scene.materials.at(scene.instances[0].material).name == "b");
  CHECK(scene.materials.at(scene.instances[1].material).name == "a");
  CHECK(scene.instances[1].world_from_object[3] == glm::vec3(0, 5, 0));
  const Mesh& mesh = scene.meshes[0];
  CHECK(mesh.position[0] == std::vector<float>{1, 2, 1, 0, 1, 0});
  CHECK(mesh.indices == std::vector<uint32_t>{0, 1, 2, 3, 5, 4});  // the second node mirrors
  CHECK(mesh.normal[2] == std::vector<float>{1, 1, 1, -1, -1, -1});
  CHECK(load(R"(, "material": "own")").instances.at(1).material == 0);
  CHECK(load(R"(, "color": [0, 0, 1])")
            .materials.at(load(R"(, "color": [0, 0, 1])").instances.at(0).material)
            .base_color.z == 1.0f);
  CHECK(load(R"(, "grid": {"count": [3, 1, 1], "spacing": 2})").instances.size() == 6);
  CHECK(error_of(ErrorKind::bad_input, [&] {
          load(R"(, "normals": "smooth")");
        }).find("/objects/0/normals: missing normals of a glTF file are flat") != std::string::npos);
  scratch.write("sub/a.gltf", text.substr(1));
  CHECK(error_of(ErrorKind::bad_input, [&] { load(""); }).find("sub/a.gltf: line 1") != std::string::npos);
}

TEST_CASE("a file without camera and lights gets ours") {
  const Scene scene = nodes(R"({"mesh": 0, "scale": [10, 10, 10]})");
  CHECK(scene.lights.size() == 4);
  CHECK(scene.lights_of_ours);
  CHECK(scene.camera.fov_y_rad == 0.5f);
  CHECK(scene.timeline.empty());
}

}  // namespace
}  // namespace trueshade
