// What `trueshade info --resolved` writes, against the scene as the library loads it.
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "scenes/pipeline/light_mesh.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using Json = nlohmann::json;

Outcome resolve(const std::string& scene, const ScratchFolder& folder, const Arguments& more = {},
                const std::string& setup = "true") {
  Arguments arguments{"info", scene, "--resolved"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_command(arguments, folder.path(""), setup);
}

Json printed(const std::string& scene, const ScratchFolder& folder, const Arguments& more = {}) {
  const Outcome outcome = resolve(scene, folder, more);
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return Json::parse(outcome.out);
}

/// The float of a number or of one of the words for numbers that JSON has not.
float value_of(const Json& json) {
  if (json.is_string()) return json == "inf" ? INFINITY : json == "-inf" ? -INFINITY : NAN;
  return float(json.get<double>());
}

template <typename Vector>
bool same_bits(const Json& json, const Vector& vector) {
  if (json.size() != size_t(vector.length())) return false;
  for (int i = 0; i < vector.length(); ++i)
    if (std::bit_cast<uint32_t>(value_of(json[size_t(i)])) != std::bit_cast<uint32_t>(vector[i])) return false;
  return true;
}

bool same_bits(const Json& json, float value) {
  return std::bit_cast<uint32_t>(value_of(json)) == std::bit_cast<uint32_t>(value);
}

void check_lights(const Json& json, const Scene& scene) {
  REQUIRE(json.size() == scene.lights.size());
  for (size_t i = 0; i < json.size(); ++i) {
    const Light& light = scene.lights[i];
    CHECK(same_bits(json[i]["position"], light.position));
    CHECK(same_bits(json[i]["direction"], light.direction));
    CHECK(same_bits(json[i]["color"], light.color));
    CHECK(same_bits(json[i]["attenuation"], light.attenuation));
    CHECK(same_bits(json[i]["range"], light.range));
    CHECK(same_bits(json[i]["cone_rad"], light.cone_rad));
    CHECK(same_bits(json[i]["penumbra_rad"], light.penumbra_rad));
  }
}

TEST_CASE("numbers and times are the same whatever rounding mode a library has left the process") {
  const ScratchFolder folder;
  const Arguments drawn = {"render", "builtin:cornell", "--size", "16x16", "--time", "0.1", "--hash", "--json"};
  const auto said = [&](const char* way) {
    const std::string setup =
        *way == '\0' ? "true" : std::string("export TRUESHADE_ROUNDING=") + way + " PRELOADED='" ROUNDS_OTHERWISE "'";
    // An aspect that no number of 24 bits is, so that the projection rounds.
    const Outcome outcome = resolve("builtin:city,objects=3,lights=2", folder, {"--size", "97x61"}, setup);
    CHECK(outcome.exit_code == 0);
    const Outcome json = run_command(drawn, folder.path(""), setup);
    const Json of_frame = Json::parse(json.out.substr(json.out.find('{')));
    return outcome.out + of_frame["scene"]["time"].dump();
  };
  const std::string usual = said("");
  CHECK(usual.size() > 1000);
  CHECK(said("up") == usual);
  CHECK(said("down") == usual);
}

TEST_CASE("no command minds traps or rounding that a library has left the process, also before main") {
  const ScratchFolder folder;
  for (const char* scene : {"cornell", "city"})
    run_command({"render", "builtin:" + std::string(scene), "--size", "40x30", "-o", scene + std::string(".png")},
                folder.path(""));
  for (const Arguments& arguments : {Arguments{"--version"}, Arguments{"render", "builtin:cornell", "--hash"},
                                     Arguments{"compare", "cornell.png", "city.png", "--flip", "0.01", "--json"}}) {
    const Outcome usual = run_command(arguments, folder.path(""));
    CHECK(usual.exit_code < 2);
    for (const char* way : {"traps", "up", "down"}) {
      CAPTURE(arguments.front(), way);
      const Outcome outcome =
          run_command(arguments, folder.path(""),
                      std::string("export TRUESHADE_ROUNDING=") + way + " PRELOADED='" ROUNDS_OTHERWISE "'");
      CHECK(outcome.exit_code == usual.exit_code);
      CHECK(outcome.out == usual.out);
    }
  }
}

TEST_CASE("info --resolved prints each float of a scene so that it reads back to the bit") {
  const ScratchFolder folder;
  for (const char* spec : {"builtin:cornell", "builtin:cornell,lights=40,seed=7"}) {
    CAPTURE(spec);
    const Scene scene = load_scene(spec);
    const Json json = printed(spec, folder);
    CHECK(json["hash"] == "sha256:" + scene_hash(scene));
    check_lights(json["lights"], scene);
    REQUIRE(json["objects"].size() == scene.instances.size());
    for (size_t i = 0; i < scene.instances.size(); ++i)
      for (int r = 0; r < 3; ++r)
        CHECK(same_bits(
            json["objects"][i]["world_from_object"][size_t(r)],
            glm::vec4(scene.instances[i].world_from_object[0][r], scene.instances[i].world_from_object[1][r],
                      scene.instances[i].world_from_object[2][r], scene.instances[i].world_from_object[3][r])));
    for (size_t i = 0; i < scene.materials.size(); ++i)
      CHECK(same_bits(json["materials"][i]["base_color"], scene.materials[i].base_color));
    for (size_t m = 0; m < scene.meshes.size(); ++m)
      for (size_t c = 0; c < 3; ++c)
        for (size_t v = 0; v < scene.meshes[m].vertex_count(); ++v)
          if (!same_bits(json["meshes"][m]["position"][c][v], scene.meshes[m].position[c][v]))
            FAIL_CHECK("vertex " << v << " of mesh " << m);
    CHECK(json["camera"]["clip_from_world"][3][3].get<double>() == clip_from_world(scene.camera, 1.0)[15]);
  }
}

TEST_CASE("info --resolved -o puts arrays into a file at the places that the document names") {
  const ScratchFolder folder;
  const Outcome outcome =
      resolve("builtin:lecture", folder, {"--preset", "redsdk", "--size", "64x48", "--time", "1.5", "-o", "out"});
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.out == "out/resolved.json\nout/resolved.bin\n");
  const Json json = Json::parse(contents(folder.path("out/resolved.json")));
  const std::string bytes = contents(folder.path("out/resolved.bin"));
  Scene scene = load_scene("builtin:lecture");
  set_time(scene, 1.5);
  const auto holds = [&](const Json& place, const void* values, size_t size, const Json& shape) {
    const size_t offset = place["offset"].get<size_t>();
    return place["shape"] == shape && offset + size <= bytes.size() &&
           std::memcmp(bytes.data() + offset, values, size) == 0;
  };
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    std::vector<float> position;
    for (const auto& stream : mesh.position) position.insert(position.end(), stream.begin(), stream.end());
    CHECK(holds(json["meshes"][m]["position"], position.data(), 4 * position.size(), {3, mesh.vertex_count()}));
    CHECK(holds(json["meshes"][m]["triangles"], mesh.indices.data(), 4 * mesh.indices.size(),
                {mesh.triangle_count(), 3}));
  }
  for (size_t t = 0; t < scene.textures.size(); ++t)
    for (size_t k = 0; k < scene.textures[t].levels.size(); ++k) {
      const TextureLevel& level = scene.textures[t].levels[k];
      CHECK(holds(json["textures"][t]["levels"][k], level.bytes.data(), level.bytes.size(),
                  {level.height, level.width, 4}));
    }
  const LightMeshes meshes(preset_pipeline("redsdk")->light_volumes);
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    if (!json["lights"][i].contains("vertices")) continue;
    std::vector<glm::vec3> vertices(
        meshes[drawn_extent(scene.lights[i], preset_pipeline("redsdk")->light_volumes)].unit.size());
    light_vertices(meshes[drawn_extent(scene.lights[i], preset_pipeline("redsdk")->light_volumes)], scene.lights[i],
                   vertices);
    CHECK(holds(json["lights"][i]["vertices"], vertices.data(), 12 * vertices.size(), {vertices.size(), 3}));
  }
  CHECK(json["viewport"] == Json{{"x", 0}, {"y", 0}, {"width", 64}, {"height", 48}});
}

TEST_CASE("info --resolved says infinities in words, and keeps the sign of zero") {
  const ScratchFolder folder;
  folder.write("s.json", R"({"version": 1, "camera": {"eye": [0, 0, 4], "fov_deg": 60},
    "objects": [{"mesh": "cube", "position": [-0.0, 0, 1]}],
    "lights": [{"type": "point", "position": [-0.0, 1, 0.1], "color": [0.9, 0.9, 0.9], "intensity": 1.5},
               {"type": "directional", "direction": [1, 2, 3]}]})");
  const Json json = printed("s.json", folder);
  CHECK(json["lights"][0]["range"] == "inf");
  CHECK(std::signbit(json["lights"][0]["position"][0].get<double>()));
  CHECK(same_bits(json["lights"][0]["color"][0], 0.9f * 1.5f));  // not RN32(0.9 * 1.5)
  CHECK(same_bits(json["camera"]["fov_y_rad"], float(60.0 * (3.14159265358979323846 / 180.0))));
  CHECK(same_bits(json["lights"][1]["direction"][0], float(1.0 * (1.0 / std::sqrt(14.0)))));
}

TEST_CASE("info --resolved writes both files or none") {
  const ScratchFolder folder;
  check_refused(resolve("builtin:cornell", folder, {"-o", "out"}, "ulimit -f 1"), 5, "out/resolved.");
  CHECK(folder.entries().empty());
  check_refused(resolve("builtin:nothing", folder, {"-o", "out"}), 3, "builtin:nothing");
  folder.write("file", "x");
  check_refused(resolve("builtin:cornell", folder, {"-o", "file"}), 5, "file");
  check_refused(resolve("builtin:cornell", folder, {"-o", "no/" + std::string(300, 'x')}), 5, "cannot make the folder");
  CHECK(contents(folder.path("file")) == "x");
}

TEST_CASE("info --resolved prints no scene of millions of numbers, and other options belong to --resolved") {
  const ScratchFolder folder;
  check_refused(resolve("builtin:cornell,lights=5000", folder, {"--preset", "redsdk"}), 4, "add -o FOLDER");
  for (const Arguments& more : {Arguments{"-o", "out"}, {"--orbit", "1,2"}, {"--fov", "40"}, {"--camera", "0"}}) {
    Arguments arguments{"info", "builtin:cornell"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    check_refused(run_command(arguments, folder.path("")), 2, more[0]);
  }
  check_refused(resolve("builtin:cornell", folder, {"--preset", "none"}), 2, "none");
  check_refused(resolve("builtin:cornell", folder, {"--time", "soon"}), 2, "soon");
  folder.write("a.png", "not a picture");
  check_refused(resolve("a.png", folder), 3, "a.png");
  CHECK(folder.entries() == std::vector<std::string>{"a.png"});
}

}  // namespace
}  // namespace trueshade
