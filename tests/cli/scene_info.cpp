// `trueshade info`: what it says of a scene and of a picture, as text and as JSON, and that both say the same.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

using nlohmann::json;

class InfoFolder : public ScratchFolder {
 public:
  std::string said(const Arguments& words) const {
    const Outcome outcome = run_command(words, path(""));
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    return outcome.out;
  }
  json told(Arguments words) const {
    words.emplace_back("--json");
    return json::parse(said(words));
  }
  Outcome run(const Arguments& words) const { return run_command(words, path("")); }
};

/// A triangle under a light, with a colour and a normal map, and two extensions beside that of the light.
std::string textured_gltf(const std::string& more) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
  "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform", "EXT_of_others"],
  "extensionsRequired": ["KHR_texture_transform"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "name": "lamp", "spot": {}}]}},
  "nodes": [{"mesh": 0}, {"translation": [0, 0, 4], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "images": [{"uri": "bricks.png", "name": "bricks"}], "textures": [{"source": 0}],
  "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "normalTexture": {"index": 0}},
                {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0},
                             {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 1}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteLength": 24}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
         R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}])" +
         more + "}";
}

TEST_CASE("info says which textures, extensions and lights a model has") {
  const InfoFolder folder;
  folder.said({"render", "builtin:cornell", "--size", "16x8", "-q", "-o", "bricks.png"});
  folder.write("model.gltf", textured_gltf(""));
  const std::string text = folder.said({"info", "model.gltf"});
  INFO(text);
  CHECK(has(text, "bounds                0,0,0 to 1,1,0 (1 x 1 x 0)\n"));
  CHECK(has(text, "lights                1 (1 spot)\n"));
  CHECK(has(text, "(16x8, 4 x 8 bits, sRGB, 5 levels): color of 2 materials\n"));
  CHECK(has(text, "(16x8, 4 x 8 bits, linear, 5 levels): normal of 1 material\n"));
  CHECK(has(text,
            "extensions            KHR_lights_punctual, KHR_texture_transform (required), "
            "EXT_of_others (passed over)\n"));
  const json all = folder.told({"info", "model.gltf"});
  CHECK(all.at("lights") == json::parse(R"({"count": 1, "spot": 1, "of_ours": false})"));
  CHECK(all.at("bounds") == json::parse(R"({"least": [0, 0, 0], "most": [1, 1, 0]})"));
  CHECK(all.at("extensions") == json::parse(R"([
    {"name": "KHR_lights_punctual", "required": false, "read": true},
    {"name": "KHR_texture_transform", "required": true, "read": true},
    {"name": "EXT_of_others", "required": false, "read": false}])"));
  REQUIRE(all.at("textures").size() == 2);
  json colors = all.at("textures").at(0), normals = all.at("textures").at(1);
  if (colors.at("color_space") != "srgb") std::swap(colors, normals);
  const json expected = json::parse(R"({"width": 16, "height": 8, "channels": 4, "bits": 8, "type": "unorm",
    "color_space": "srgb", "levels": 5, "bytes": 684, "materials_by_map": {"color": 2}})");
  for (const auto& [key, value] : expected.items()) CHECK(colors.at(key) == value);  // 684: 4 (128 + 32 + 8 + 2 + 1)
  CHECK(normals.at("materials_by_map") == json::parse(R"({"normal": 1})"));
  CHECK(normals.at("color_space") == "linear");
  REQUIRE(all.at("notes").size() == 1);
  CHECK(has(all.at("notes").at(0).get<std::string>(), "EXT_of_others"));
  CHECK(has(text, "note 0                " + all.at("notes").at(0).get<std::string>()));
}

TEST_CASE("info cuts long lists, and its JSON does not") {
  const InfoFolder folder;
  std::string nodes = R"({"name": "root"})", extensions;
  for (int i = 0; i < 9; ++i) {
    nodes += R"(, {"name": "c)" + std::to_string(i) + R"(", "camera": 0})";
    extensions += (i > 0 ? ", " : "") + ('"' + ("EXT_" + std::to_string(i)) + '"');
  }
  folder.write("many.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]}],
    "extensionsUsed": [)" + extensions +
                                R"(], "nodes": [)" + nodes + R"(],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}]})");
  const std::string text = folder.said({"info", "many.gltf"});
  INFO(text);
  CHECK(has(text, "camera 5              c5 (perspective, 28.65 degrees)\n                      and 3 more\n"));
  CHECK(has(text, "EXT_5 (passed over), and 3 more\n"));
  CHECK(has(text, "bounds                nothing is drawn\n"));
  const json all = folder.told({"info", "many.gltf"});
  CHECK(all.at("cameras").size() == 9);
  CHECK(all.at("cameras").at(8).at("node") == "c8");
  CHECK(all.at("extensions").size() == 9);
  CHECK(all.at("bounds").is_null());
}

TEST_CASE("the bounds that info says are those of the vertices that are drawn, at the time that is asked for") {
  const InfoFolder folder;
  folder.write("octahedron.obj",
               "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\nv 9 9 9\n"
               "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
  folder.write("scene.json", R"({"version": 1, "camera": {"eye": [0, 0, 9], "target": [0, 0, 0]}, "objects": [
    {"geometry": "octahedron.obj", "rotation_deg": [0, 45, 0], "steps": [{"time": 0, "position": [0, 0, 0]},
                                                    {"time": 2, "position": [4, 0, 0]}]}]})");
  const double half = std::sqrt(0.5);  // the box around the octahedron's turned box would be twice as wide
  const auto expect = [&](const json& all, double x) {
    INFO(all.dump());
    const json &least = all.at("bounds").at("least"), &most = all.at("bounds").at("most");
    const double expected[] = {x - half, -1, -half, x + half, 1, half};
    for (size_t k = 0; k < 3; ++k) {
      CHECK(std::abs(least.at(k).get<double>() - expected[k]) < 1e-6);
      CHECK(std::abs(most.at(k).get<double>() - expected[k + 3]) < 1e-6);
    }
  };
  expect(folder.told({"info", "scene.json"}), 0);
  expect(folder.told({"info", "scene.json", "--time", "1"}), 2);
  CHECK(folder.told({"info", "scene.json", "--time", "1"}).at("time") == 1.0);
  // A model alone gets a ground, which is eight times as wide.
  const json alone = folder.told({"info", "octahedron.obj"});
  CHECK(alone.at("ground_of_ours") == true);
  CHECK(alone.at("bounds") == json::parse(R"({"least": [-1, -1, -1], "most": [1, 1, 1]})"));
}

TEST_CASE("the memory that info says is what --max-memory is held against") {
  const InfoFolder folder;
  const Arguments size = {"--size", "2000x1500", "--preset", "many-lights"};
  Arguments asked = {"info", "builtin:cornell"}, drawn = {"render", "builtin:cornell", "-q", "-o", "a.png"};
  asked.insert(asked.end(), size.begin(), size.end());
  drawn.insert(drawn.end(), size.begin(), size.end());
  const json memory = folder.told(asked).at("memory");
  CHECK(memory.at("width") == 2000);
  CHECK(memory.at("in_bands") == false);
  const double bytes = memory.at("render_bytes").get<double>();
  CHECK(bytes == memory.at("process_bytes").get<double>() + memory.at("needed_bytes").get<double>());
  const auto within = [&](double share) {
    Arguments words = drawn;
    words.insert(words.end(), {"--max-memory", std::to_string(uint64_t(bytes * share))});
    return folder.run(words);
  };
  check_refused(within(0.8), 4, "--max-memory");
  CHECK(within(1.2).exit_code == 0);
  CHECK(folder.told({"info", "builtin:cornell", "--max-memory", "3G"}).at("memory").at("limit_bytes") == 3ull << 30);
  const json large = folder.told({"info", "builtin:cornell", "--size", "65536x65536"}).at("memory");
  CHECK(large.at("in_bands") == true);
  CHECK(!large.contains("render_bytes"));
  CHECK(has(folder.said({"info", "builtin:cornell", "--size", "65536x65536"}), "65536x65536 is rendered in bands"));
}

TEST_CASE("info of a picture says the same in JSON, and options of scenes are refused there") {
  const InfoFolder folder;
  folder.said({"render", "builtin:cornell", "--size", "20x10", "-q", "-o", "a.png", "-o", "a.exr"});
  for (const std::string file : {"a.png", "a.exr"}) {
    const std::string text = folder.said({"info", file});
    const json all = folder.told({"info", file});
    CHECK(all.at("image") == file);
    CHECK(all.at("width") == 20);
    CHECK(all.at("height") == 10);
    CHECK(all.at("read_whole") == (file == "a.png"));
    CHECK(all.at("channels").size() == 4);
    size_t rows = 2 + all.at("channels").size() + all.at("metadata").size() + (file == "a.png" ? 1 : 0);
    CHECK(rows == size_t(std::count(text.begin(), text.end(), '\n')));
    for (const json& channel : all.at("channels"))
      CHECK(has(text, channel.at("name").get<std::string>() + ' ' + channel.at("type").get<std::string>() + '\n'));
    for (const auto& [key, value] : all.at("metadata").items()) CHECK(has(text, value.get<std::string>() + '\n'));
  }
  check_refused(folder.run({"info", "a.png", "--size", "8x8"}), 2, "--size: nothing in a picture's file depends on it");
}

TEST_CASE("info tells of a scene whose light program is not here, which render refuses") {
  const InfoFolder folder;
  folder.write("scene.json", R"({"version": 1, "objects": [{"mesh": "plane"}],
    "pipeline": {"light_program": {"file": "mine.glsl"}}})");
  CHECK(has(folder.said({"info", "scene.json"}), "mine.glsl"));
  CHECK(folder.told({"info", "scene.json"}).at("pipeline").at("light_program").at("file") == "mine.glsl");
  check_refused(folder.run({"render", "scene.json", "--hash"}), 2, "--light-shader");
}

}  // namespace
}  // namespace trueshade
