// --cache: the command draws a scene from its cache file as it draws it without, whatever becomes of the file.
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "tests/catch.hpp"
#include "tests/cli/output_of.h"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

/// A model with a picture as PNG, as OBJ with its library, as GLB, and a scene file that names two of them.
void write_models(const ScratchFolder& folder) {
  const std::string plain = folder.path("");
  REQUIRE(run_command({"render", "builtin:city", "--size", "64x64", "-o", "picture.png"}, plain).exit_code == 0);
  folder.write("model.mtl", "newmtl shown\nmap_Kd picture.png\nKs 0.2 0.2 0.2\n");
  folder.write("model.obj",
               "mtllib model.mtl\nv -1 0 0\nv 1 0 0\nv 1 1 0\nv -1 1 0\nv 0 2 -1\nvt 0 0\nvt 1 0\nvt 1 1\n"
               "vt 0 1\nusemtl shown\nf 1/1 2/2 3/3 4/4\nf 4/4 3/3 5/2\n");
  folder.write("scene.json", R"({"version": 1, "camera": {"eye": [0, 2, 6]},
    "lights": [{"type": "point", "position": [1, 4, 3], "color": [20, 20, 20]}],
    "objects": [{"geometry": "model.obj"}, {"mesh": "rabbit", "position": [2, 0, 0], "color": [1, 0.5, 0.2]}]})");
  REQUIRE(run_command({"export", "scene.json", "-o", "model.glb"}, plain).exit_code == 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

TEST_CASE("models, scene files and built-in scenes are drawn from cache files as without") {
  const ScratchFolder folder;
  write_models(folder);
  for (const char* scene : {"model.obj", "model.glb", "scene.json", "builtin:atrium"}) {
    INFO(scene);
    const Arguments draw = {"render", scene, "--size", "96x64", "--json"};
    const auto hashes = [](const std::string& json) {
      const auto document = nlohmann::json::parse(json);
      return document["scene"].dump() + document["hash"].dump();
    };
    const std::string expected = hashes(output_of(draw, folder));
    for (const Arguments& way : std::vector<Arguments>{{}, {}, {"--simd", "scalar"}, {"--threads", "5"}})
      CHECK(hashes(output_of(with(with(draw, way), {"--cache", "kept"}), folder)) == expected);
  }
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path("kept")), {}) == 4);
}

TEST_CASE("commands beside render read scenes from cache files") {
  const ScratchFolder folder;
  write_models(folder);
  const std::vector<Arguments> commands = {{"info", "scene.json"},
                                           {"info", "scene.json", "--resolved"},
                                           {"explain", "scene.json", "--size", "96x64", "--pixel", "48,30"},
                                           {"export", "scene.json", "-q", "-o", "-"}};
  // What lies in a cache file takes no memory.
  const auto without_memory = [](const std::string& text) {
    return std::regex_replace(text, std::regex("\nmemory  [^\n]*"), "");
  };
  for (const Arguments& command : commands) {
    const std::string expected = without_memory(output_of(command, folder));
    for (int run = 0; run < 2; ++run)
      CHECK(without_memory(output_of(with(command, {"--cache", "kept"}), folder)) == expected);
  }
}

TEST_CASE("where no cache file can be written a note says so, and the picture is drawn") {
  const ScratchFolder folder;
  const Arguments draw = {"render", "builtin:atrium", "--size", "96x64", "--hash"};
  const std::string expected = output_of(draw, folder);
  const Outcome full = run_command(with(draw, {"--cache", "kept"}), folder.path(""), "ulimit -f 512");
  CHECK(full.exit_code == 0);
  CHECK(full.out == expected);
  CHECK(full.err.starts_with("trueshade: note: There is no cache file: kept/builtin_atrium"));
  CHECK(std::filesystem::is_empty(folder.path("kept")));
  check_refused(run_command(with(draw, {"--cache", "none/kept"}), folder.path("")), 5, "none/kept");
  std::filesystem::create_directory(folder.path("open"));
  REQUIRE(chmod(folder.path("open").c_str(), 0777) == 0);
  check_refused(run_command(with(draw, {"--cache", "open"}), folder.path("")), 3, "open");
}

TEST_CASE("processes that make one cache file at once draw one picture") {
  const ScratchFolder folder;
  const Arguments draw = {"render", "builtin:atrium", "--size", "96x64", "--hash", "--cache", "kept"};
  const std::string expected = output_of({"render", "builtin:atrium", "--size", "96x64", "--hash"}, folder);
  std::vector<std::thread> processes;
  std::vector<Outcome> outcomes(6);
  for (Outcome& outcome : outcomes) processes.emplace_back([&] { outcome = run_command(draw, folder.path("")); });
  for (std::thread& process : processes) process.join();
  for (const Outcome& outcome : outcomes) {
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.out == expected);
  }
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path("kept")), {}) == 1);
}

TEST_CASE("a cache file that becomes shorter while frames are drawn ends the command in one line") {
  const ScratchFolder folder;
  const Arguments draw = {"render", "builtin:atrium", "--size", "96x64", "--hash", "--cache", "kept"};
  output_of(draw, folder);
  const Outcome cut =
      run_command(with(draw, {"--frames", "0-100000"}), folder.path(""), "{ (sleep 0.5; truncate -s 4096 kept/*) & }");
  CAPTURE(cut.err);
  CHECK(cut.exit_code == 5);
  CHECK((cut.err.starts_with("trueshade: error: --cache: ") || cut.err.starts_with("trueshade: error: kept/")));
  CHECK(cut.err.find('\n') == cut.err.size() - 1);
}

}  // namespace
}  // namespace trueshade
