// Which of a glTF file's cameras and animations a scene is made with.
#include <cmath>

#include "../expect_error.h"
#include "asset.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

/// A triangle and three cameras; `Walk` moves it along x and a camera along y, `Jump` it along y, `Turn` it along x.
std::string file() {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 2}, "SCALAR", R"("min": [0], "max": [2])");
  asset.accessor(std::vector<float>{0, 0, 0, 4, 0, 0}, "VEC3");
  asset.accessor(std::vector<float>{1, 1, 1, 3, 1, 1}, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 0, 9, 0, 0}, "VEC3");
  asset.accessor(std::vector<float>{0, 1.5}, "SCALAR", R"("min": [0], "max": [1.5])");
  return asset.gltf(R"("scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
    "nodes": [{"mesh": 0},
              {"name": "Tripod", "camera": 1, "translation": [0, 0, 5], "children": [3]},
              {"name": "Crane", "camera": 0, "translation": [0, 7, 0]},
              {"name": "Rig", "camera": 2, "translation": [1, 0, 0]}],
    "cameras": [{"name": "Main", "type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
                {"name": "Side", "type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}},
                {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 10}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "animations": [
      {"name": "Walk", "samplers": [{"input": 1, "output": 2}],
       "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]},
      {"name": "Grow", "samplers": [{"input": 5, "output": 3}],
       "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}]},
      {"samplers": [{"input": 1, "output": 4}],
       "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}])");
}

class Loaded {
 public:
  Loaded() { folder_.write("file.gltf", file()); }
  Scene with(const std::optional<std::string>& camera, const std::optional<std::string>& animation = {},
             const std::string& name = "file.gltf") const {
    return load_scene(folder_.path(name), {}, {}, {camera, animation});
  }
  glm::mat4x3 at_two(const std::optional<std::string>& animation) const {
    Scene scene = with({}, animation);
    set_time(scene, 2.0);
    return scene.instances.at(0).world_from_object;
  }
  const ScratchFolder& folder() const { return folder_; }

 private:
  ScratchFolder folder_;
};

bool has_note(const Scene& scene, const std::string& part) {
  for (const std::string& note : scene.notes)
    if (note.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("a glTF file's cameras have numbers in the order of its nodes, and names of their own and of their nodes") {
  const Loaded loaded;
  const Scene scene = loaded.with({});
  REQUIRE(scene.cameras.size() == 3);
  CHECK(scene.cameras[0] == SceneCamera{"Side", "Tripod", 0.7});
  CHECK(scene.cameras[1] == SceneCamera{"", "Rig", 0.0});
  CHECK(scene.cameras[2] == SceneCamera{"Main", "Crane", 0.5});
  CHECK(scene.camera.eye == glm::vec3(0, 0, 5));
  CHECK_FALSE(scene.camera_of_ours);
  CHECK(has_note(scene, "2 cameras are ignored"));
  for (const char* first : {"0", "Side", "Tripod"}) CHECK(scene_hash(loaded.with(first)) == scene_hash(scene));
  CHECK_FALSE(has_note(loaded.with("0"), "ignored: The picture"));
  for (const char* last : {"2", "Main", "Crane"}) {
    CHECK(loaded.with(last).camera.eye == glm::vec3(0, 7, 0));
    CHECK(loaded.with(last).camera.fov_y_rad == 0.5f);
  }
  CHECK(loaded.with("Rig").camera.clip_from_world.has_value());
}

TEST_CASE("a camera or an animation that a file has not is refused with those that it has") {
  const Loaded loaded;
  const auto refused = [&](const char* camera, const char* animation) {
    return error_of(ErrorKind::usage, [&] {
      loaded.with(camera ? std::optional<std::string>(camera) : std::nullopt,
                  animation ? std::optional<std::string>(animation) : std::nullopt);
    });
  };
  CHECK_THAT(refused("3", nullptr),
             Catch::StartsWith("--camera: ") &&
                 Catch::EndsWith("file.gltf has no camera '3' (it has, by number: "
                                 "0 'Side' of node 'Tripod', 1 'Rig', 2 'Main' of node 'Crane')"));
  CHECK_THAT(refused("Mian", nullptr), Catch::Contains("did you mean Main? it has"));
  CHECK_THAT(refused("", nullptr), Catch::Contains("no camera ''"));
  CHECK_THAT(refused(nullptr, "Run"), Catch::StartsWith("--animation: ") &&
                                          Catch::EndsWith("(it has, by number: 0 'Walk', 1 'Grow', 2, or all)"));
  for (const char* other : {"builtin:cornell", "file.ply"}) {
    loaded.folder().write("file.ply",
                          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                          "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                          "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const std::string spec = std::string(other) == "file.ply" ? loaded.folder().path(other) : other;
    CHECK(scene_hash(load_scene(spec, {}, {}, {"0", {}})) == scene_hash(load_scene(spec)));
    CHECK_THAT(error_of(ErrorKind::usage,
                        [&] {
                          load_scene(spec, {}, {}, {"1", {}});
                        }),
               Catch::Contains("has no camera '1' (it has, by number: 0)"));
    CHECK_THAT(error_of(ErrorKind::usage,
                        [&] {
                          load_scene(spec, {}, {}, {{}, "all"});
                        }),
               Catch::Contains("has no animation 'all' (leave it out)"));
  }
}

TEST_CASE(
    "the first animation is played, or the one that is named, or all of which the first that moves a thing does") {
  const Loaded loaded;
  const Scene scene = loaded.with({});
  CHECK(scene.animations == std::vector<SceneAnimation>{{"Walk", 2.0}, {"Grow", 1.5}, {"", 2.0}});
  CHECK(loaded.at_two({})[3] == glm::vec3(4, 0, 0));
  CHECK(loaded.at_two("Walk")[3] == glm::vec3(4, 0, 0));
  CHECK(loaded.at_two("Grow")[3] == glm::vec3(0, 0, 0));
  CHECK(loaded.at_two("1")[0] == glm::vec3(3, 0, 0));
  CHECK(loaded.at_two("2")[3] == glm::vec3(9, 0, 0));
  CHECK(loaded.at_two("all")[3] == glm::vec3(4, 0, 0));
  CHECK(loaded.at_two("all")[0] == glm::vec3(3, 0, 0));
  CHECK(has_note(scene, "2 animations are ignored"));
  CHECK_FALSE(has_note(loaded.with({}, "Grow"), "animation"));
  CHECK(has_note(loaded.with({}, "all"), "1 channel of an animation is ignored"));
}

TEST_CASE("two parts of one name are told apart by their numbers alone") {
  const std::vector<SceneCamera> cameras{{"A", "", 1.0}, {"A", "7", 1.0}, {"B", "A", 1.0}};
  CHECK(camera_named("B", cameras, "f") == 2);
  CHECK(camera_named("1", cameras, "f") == 1);
  CHECK(camera_named("7", cameras, "f") == 1);  // no number of a camera, so a name
  CHECK_THAT(error_of(ErrorKind::usage, [&] { camera_named("A", cameras, "f"); }),
             Catch::Contains("f has 3 cameras of the name 'A'"));
}

TEST_CASE("a scene file hands the choice on to the file that it refers to, unless it has a camera of its own") {
  const Loaded loaded;
  loaded.folder().write("other.json", R"({"version": 1, "scene": "file.gltf"})");
  loaded.folder().write("own.json", R"({"version": 1, "scene": "file.gltf", "camera": {"eye": [3, 3, 3]}})");
  CHECK(loaded.with("Main", "Grow", "other.json").camera.eye == glm::vec3(0, 7, 0));
  const Scene own = loaded.with("0", {}, "own.json");
  CHECK(own.camera.eye == glm::vec3(3, 3, 3));
  CHECK(own.cameras.empty());
  CHECK_THAT(error_of(ErrorKind::usage, [&] { loaded.with("1", {}, "own.json"); }),
             Catch::Contains("own.json has no camera '1'"));
}

}  // namespace trueshade
