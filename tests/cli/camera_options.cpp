// --camera, --orbit, --eye, --look-at, --fov, --animation and --turntable: every command that shows a scene has them,
// pictures carry them, and what nobody asked for stays as it was.
#include <nlohmann/json.hpp>

#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using nlohmann::json;

/// A tall slab without a camera: 1 wide, 4 high.
constexpr const char* kSlab =
    "v -0.5 0 0\nv 0.5 0 0\nv 0.5 4 0\nv -0.5 4 0\nv -0.5 0 0.5\nv 0.5 0 0.5\nv 0.5 4 0.5\nv -0.5 4 0.5\n"
    "f 5 6 7 8\nf 4 3 2 1\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

/// The slab's front as glTF with two cameras, and two animations that move it.
constexpr const char* kSlabGltf =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
  "nodes": [{"mesh": 0}, {"name": "Front", "camera": 0, "translation": [0, 0.5, 4]},
            {"name": "Far out", "camera": 0, "translation": [0, 0.5, 9]}],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "animations": [
    {"name": "Right", "samplers": [{"input": 1, "output": 2}],
     "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]},
    {"name": "Left", "samplers": [{"input": 1, "output": 3}],
     "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"},
                {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                  {"buffer": 0, "byteOffset": 44, "byteLength": 24}, {"buffer": 0, "byteOffset": 68, "byteLength": 24}],
  "buffers": [{"byteLength": 92, "uri": "data:application/octet-stream;base64,)"
    R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAA)"
    R"(AAAAAAAAAAAAAAAAAAAAAAAAAIC/AAAAAAAAAAA="}]})";

class SlabFolder {
 public:
  SlabFolder() {
    folder_.write("slab.obj", kSlab);
    folder_.write("two.gltf", kSlabGltf);
  }
  Outcome run(const Arguments& words) const { return run_command(words, folder_.path("")); }
  std::string said(const Arguments& words) const {
    const Outcome outcome = run(words);
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    return outcome.out;
  }
  std::string hash(const std::string& scene, Arguments more, const std::string& size = "60x40") const {
    more.insert(more.begin(), {"render", scene, "--hash", "-q", "--size", size});
    return said(more);
  }
  std::string path(const std::string& name) const { return folder_.path(name); }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }

 private:
  ScratchFolder folder_;
};

std::string metadata_of(const std::string& path, const std::string& key) {
  for (const auto& [name, value] : read_image_info(path).metadata)
    if (name == key) return value;
  return "none";
}

/// Shares of width and height that the first object covers.
std::pair<double, double> covered(const SlabFolder& folder, const std::string& file) {
  Image ids;
  for (const NamedImage& plane : read_planes(folder.path(file)))
    if (plane.name == "id.object") ids = plane.image;
  int left = ids.width, right = -1, top = ids.height, bottom = -1;
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x)
      if (ids.code(x, y, 0) == 1) {
        left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
      }
  return {double(right - left + 1) / ids.width, double(bottom - top + 1) / ids.height};
}

}  // namespace

TEST_CASE("a model without a camera fills 80 to 90 % of pictures of every shape, from any side") {
  const SlabFolder folder;
  for (const char* size : {"300x300", "360x150", "150x360"})
    for (const Arguments& side : {Arguments{}, Arguments{"--orbit", "70,35"}, Arguments{"--fov", "60"}}) {
      Arguments words{"render", "slab.obj", "--size", size, "-o", "x.exr", "--aov", "id.object", "-q"};
      words.insert(words.end(), side.begin(), side.end());
      folder.said(words);
      const auto [wide, high] = covered(folder, "x.exr");
      CAPTURE(size, side, wide, high);
      CHECK((std::max(wide, high) > 0.8 && std::max(wide, high) < 0.9));
      CHECK(std::min(wide, high) < 0.9);
    }
}

TEST_CASE("pictures carry the options of the camera, and none where none is given") {
  const SlabFolder folder;
  folder.said({"render", "slab.obj", "--size", "40x40", "-o", "plain.png", "-q"});
  CHECK(metadata_of(folder.path("plain.png"), "trueshade:camera") == "none");
  folder.said(
      {"render", "slab.obj", "--size", "40x30", "-o", "orbit.png", "-q", "--orbit", "30,20,150%", "--fov", "40"});
  CHECK(json::parse(metadata_of(folder.path("orbit.png"), "trueshade:camera")) ==
        json::parse(R"({"orbit": [30, 20], "distance_percent": 150, "fov_deg": 40})"));
  folder.said({"render", "two.gltf", "--size", "40x30", "-o", "all.exr", "-q", "--camera", "Far out", "--animation",
               "1", "--eye", "0,0.5,7.1", "--look-at", "0,0,0"});
  CHECK(json::parse(metadata_of(folder.path("all.exr"), "trueshade:camera")) ==
        json::parse(R"({"name": "Far out", "eye": [0, 0.5, 7.1], "look_at": [0, 0, 0]})"));
  CHECK(metadata_of(folder.path("all.exr"), "trueshade:animation") == "1");
  const json told = json::parse(folder.said({"render", "slab.obj", "--size", "8x8", "--json", "--orbit", "5,6,7"}));
  CHECK(told["camera"] == json::parse(R"({"orbit": [5, 6], "distance": 7})"));
  CHECK_FALSE(told.contains("animation"));
}

TEST_CASE("compare judges a picture by the camera, the animation and the time that its reference was drawn with") {
  const SlabFolder folder;
  const std::vector<Arguments> ways = {{"slab.obj", "--orbit", "30,20,80%"},
                                       {"slab.obj"},
                                       {"two.gltf", "--camera", "Far out", "--animation", "Left", "--time", "0.5"},
                                       {"two.gltf", "--eye", "1,0.5,5", "--fov", "30", "--time", "0.3"}};
  for (const Arguments& way : ways) {
    Arguments words{"render"};
    words.insert(words.end(), way.begin(), way.end());
    words.insert(words.end(), {"--size", "48x24", "--preset", "many-lights", "-o", "ref.png", "-q"});
    folder.said(words);
    std::vector<NamedImage> planes = read_planes(folder.path("ref.png"));
    Image test = planes.front().image;
    test.texels[4 * (12 * 48 + 24)] ^= 64;
    write_image(folder.path("test.png"), test, {}, {});
    const Outcome outcome = folder.run({"compare", "ref.png", "test.png"});
    INFO(way.front() << ' ' << outcome.out << outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.out.find("judged by the reference's scene") != std::string::npos);
    CHECK(outcome.out.find("not judged") == std::string::npos);
  }
}

TEST_CASE("a turntable is the pictures of its orbits, also as raw video, and names them as frames are named") {
  const SlabFolder folder;
  const Arguments draw{"render", "slab.obj", "--size", "30x40", "-q"};
  const auto with = [&](Arguments more) {
    more.insert(more.begin(), draw.begin(), draw.end());
    return folder.said(more);
  };
  const std::string hashes = with({"--turntable", "3", "--orbit", "10,25", "-o", "t_##.png", "--hash"});
  const char* const names[] = {"t_00.png", "t_01.png", "t_02.png"};
  std::string one_by_one;
  for (int i = 0; i < 3; ++i) {
    const json camera = json::parse(metadata_of(folder.path(names[i]), "trueshade:camera"));
    CHECK(camera["orbit"] == json::array({10 + 120 * i, 25}));
    const std::string place = std::to_string(10 + 120 * i) + ",25," + camera["distance"].dump();
    one_by_one += with({"--orbit", place, "--hash"});
  }
  CHECK(hashes == one_by_one);
  CHECK(with({"--turntable", "3", "--orbit", "10,25", "--raw-video", "-o", "-"}).size() == 3u * 30 * 40 * 4);
  CHECK(with({"--turntable", "1", "--hash"}).size() == with({"--hash"}).size());
  const json told = json::parse(with({"--turntable", "2", "--json"}));
  CHECK(told["frames"].size() == 2);
  check_refused(folder.run({"render", "slab.obj", "--turntable", "3", "--frames", "0-2", "--hash"}), 2,
                "--turntable and --frames both number the pictures");
  check_refused(folder.run({"render", "slab.obj", "--turntable", "0", "--hash"}), 2, "--turntable");
  check_refused(folder.run({"render", "slab.obj", "--turntable", "3", "--cube-map", "eye", "--hash"}), 2,
                "--turntable: the faces of a cube map");
}

TEST_CASE("every command that shows a scene takes the options of the camera, and shows the same") {
  const SlabFolder folder;
  const Arguments seen{"--orbit", "40,10,90%", "--size", "40x30"};
  const auto with = [&](Arguments words) {
    words.insert(words.end(), seen.begin(), seen.end());
    return folder.said(words);
  };
  with({"render", "slab.obj", "-o", "x.png", "-q"});
  const std::string stored = with({"explain", "slab.obj", "--pixel", "20,15", "--against", "x.png", "-q"});
  CHECK(stored.find("the same as here") != std::string::npos);
  CHECK(stored.find("--orbit 40,10,90%") != std::string::npos);  // as the picture says
  const std::string eye = json::parse(with({"info", "slab.obj", "--resolved"}))["camera"].dump();
  CHECK(eye != json::parse(folder.said({"info", "slab.obj", "--resolved", "--size", "40x30"}))["camera"].dump());
  with({"glsl", "slab.obj", "-o", "frame", "-q"});
  folder.said({"export", "slab.obj", "-o", "x.glb", "-q", "--orbit", "40,10,90%"});
  CHECK(folder.hash("slab.obj", {"--orbit", "40,10,90%", "--samples", "1"}, "40x40") ==
        folder.hash("x.glb", {}, "40x40"));
  with({"bench", "slab.obj", "-q"});
  with({"render", "slab.obj", "-o", "g.exr", "--aov", "depth,position,normal,albedo,id.object", "-q"});
  CHECK(folder.said({"shade", "g.exr", "--lights", "slab.obj", "--orbit", "40,10,90%", "--hash", "-q"}) ==
        folder.hash("slab.obj", {"--orbit", "40,10,90%", "--samples", "1"}, "40x30"));
  const Outcome judged = folder.run({"validate", "slab.obj", "--gbuffer", "g.exr", "--orbit", "40,10,90%"});
  INFO(judged.out << judged.err);
  CHECK(judged.exit_code == 0);
}

TEST_CASE("info lists cameras and animations with their numbers and names") {
  const SlabFolder folder;
  const std::string told = folder.said({"info", "two.gltf"});
  for (const char* line : {"camera 0              Front (perspective, 28.65 degrees)\n",
                           "camera 1              Far out (perspective, 28.65 degrees)\n",
                           "animation 0           Right (1 seconds)\n", "animation 1           Left (1 seconds)\n"})
    CHECK(told.find(line) != std::string::npos);
  CHECK(folder.said({"info", "slab.obj"}).find("camera 0              made to see all") != std::string::npos);
  CHECK(folder.said({"info", "builtin:cornell"}).find("camera 0              perspective, ") != std::string::npos);
}

TEST_CASE("A time after a file's animations is told of, and draws their last step") {
  const SlabFolder folder;
  const auto drawn = [&](const char* time) {
    return folder.run({"render", "two.gltf", "--hash", "--size", "60x40", "--time", time});
  };
  const Outcome at_end = drawn("1"), after = drawn("7.5");
  CHECK(after.out == at_end.out);
  constexpr const char* kNote = "The time is after the end of what moves, 1 s: All stands as at its last step";
  CHECK(after.err.find(kNote) != std::string::npos);
  CHECK(at_end.err.find(kNote) == std::string::npos);
}

TEST_CASE("a choice of camera and animation is drawn, with a cache too") {
  const SlabFolder folder;
  const std::string first = folder.hash("two.gltf", {"--time", "1"});
  CHECK(folder.hash("two.gltf", {"--time", "1", "--camera", "Front", "--animation", "Right"}) == first);
  const std::string far = folder.hash("two.gltf", {"--time", "1", "--camera", "1"});
  const std::string left = folder.hash("two.gltf", {"--time", "1", "--animation", "Left"});
  CHECK(far != first);
  CHECK(left != first);
  for (int i = 0; i < 2; ++i) {
    CHECK(folder.hash("two.gltf", {"--time", "1", "--cache", "kept"}) == first);
    CHECK(folder.hash("two.gltf", {"--time", "1", "--cache", "kept", "--camera", "1"}) == far);
    CHECK(folder.hash("two.gltf", {"--time", "1", "--cache", "kept", "--animation", "Left"}) == left);
    CHECK(folder.hash("slab.obj", {"--cache", "kept"}) == folder.hash("slab.obj", {}));
  }
}

TEST_CASE("cameras that cannot be, and options that do not go together, end in one line with exit code 2") {
  const SlabFolder folder;
  const auto refused = [&](Arguments more, const std::string& about) {
    more.insert(more.begin(), {"render", "slab.obj", "--size", "8x8", "--hash"});
    check_refused(folder.run(more), 2, about);
  };
  for (const char* text :
       {"", "30", "30,20,", "30,20,1,2", "a,b", "30 20", "30,20%", "30,20,%", "30,20,2x", "nan,0", "0,inf"})
    refused({"--orbit", text}, "--orbit: ");
  refused({"--orbit", "0,91"}, "the elevation of '0,91' is not from -90 to 90 degrees");
  for (const char* text : {"0,0,0", "0,0,-1", "0,0,nan", "0,0,0%", "0,0,1e18"})
    refused({"--orbit", text}, "the distance of");
  for (const char* option : {"--eye", "--look-at"})
    for (const char* text : {"", "1,2", "1,2,3,4", "nan,0,0", "0,inf,0", "0,0,1e10", "1;2;3"})
      refused({option, text}, std::string(option) + ": '" + text + "'");
  for (const char* text : {"", "0", "180", "-20", "nan", "inf", "40deg"}) refused({"--fov", text}, "--fov: '");
  refused({"--eye", "1,2,3", "--look-at", "1,2,3"}, "--eye: eye, target and up leave no direction");
  refused({"--eye", "1,2,3", "--orbit", "1,2"}, "--orbit and --eye both say where the camera is");
  refused({"--camera", "Side"}, "--camera: slab.obj has no camera 'Side' (it has, by number: 0)");
  refused({"--animation", "0"}, "--animation: slab.obj has no animation '0'");
  check_refused(folder.run({"render", "two.gltf", "--hash", "--camera", "Frnot"}), 2,
                "no camera 'Frnot' (did you mean Front? it has, by number: 0 'Front', 1 'Far out')");
  check_refused(folder.run({"info", "two.gltf", "--orbit", "1,2"}), 2, "--orbit: only a scene's numbers");
  check_refused(folder.run({"glsl", "--preset", "redsdk", "--fov", "40", "-o", "x"}), 2, "--fov: there is no scene");
  refused({"--target", "1,2,3"}, "--look-at");
}

TEST_CASE("a look from straight above is drawn, with the front at the picture's lower edge") {
  const SlabFolder folder;
  folder.write("s.json", R"({"version": 1, "camera": {"eye": [0, 0, 5]}, "objects": [
    {"mesh": "cube", "position": [0, 0, 3], "scale": 0.5}, {"mesh": "cube", "position": [0, 0, -3], "scale": 0.5}]})");
  for (const Arguments& above : {Arguments{"--orbit", "0,90"}, Arguments{"--eye", "0,12,0", "--look-at", "0,0,0"}}) {
    Arguments words{"render", "s.json", "--size", "40x40", "-o", "x.exr", "--aov", "id.object", "-q"};
    words.insert(words.end(), above.begin(), above.end());
    folder.said(words);
    for (const NamedImage& plane : read_planes(folder.path("x.exr")))
      if (plane.name == "id.object") {
        bool upper = false, lower = false;
        for (int y = 0; y < 40; ++y)
          for (int x = 0; x < 40; ++x) {
            upper = upper || (y < 20 && plane.image.code(x, y, 0) == 2);
            lower = lower || (y >= 20 && plane.image.code(x, y, 0) == 1);
          }
        CHECK((upper && lower));
      }
  }
}

}  // namespace trueshade
