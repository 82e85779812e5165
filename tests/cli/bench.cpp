// What `trueshade bench` says and writes. No time is a verdict here.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("bench times the frame that render draws, beside Embree, and writes it as JSON") {
  const ScratchFolder folder;
  const Outcome bench =
      run_command({"bench", "builtin:circle,lights=3", "--size", "64x48", "--against", "embree", "--json", "b.json"},
                  folder.path(""));
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  CHECK(bench.out.find("embree primary-rays") != std::string::npos);
  const auto json = nlohmann::json::parse(contents(folder.path("b.json")));
  REQUIRE(json["scenes"].size() == 1);
  const auto& scene = json["scenes"][0];
  CHECK(scene["scene"] == "builtin:circle,lights=3");
  CHECK(scene["size"] == "64x48");
  CHECK(scene["ms"].get<double>() > 0.0);
  CHECK(scene["floor_ms"].get<double>() > 0.0);
  CHECK(scene["lights"] == 3);
  CHECK(scene["frames"] == 15);
  REQUIRE(scene["peers"].size() == 1);
  const auto& peer = scene["peers"][0];
  CHECK(peer["name"] == "embree");
  CHECK(peer["ratio"].get<double>() == Approx(peer["ms"].get<double>() / scene["ms"].get<double>()));
  const Outcome render = run_command({"render", "builtin:circle,lights=3", "--size", "64x48", "--hash"});
  CHECK(render.out.substr(0, render.out.find(' ')) == scene["hash"].get<std::string>());
  CHECK(json["machine"]["clock_ghz"].get<double>() > 0.0);
}

TEST_CASE("bench times OpenGL under presets that draw lights as geometry, and says which picture each design draws") {
  const ScratchFolder folder;
  for (const char* preset : {"light-volumes", "redsdk"}) {
    const Outcome bench = run_command({"bench", "builtin:city,objects=60,lights=5", "--size", "64x48", "--preset",
                                       preset, "--against", "gl", "--json", "b.json"},
                                      folder.path(""));
    if (bench.exit_code == 7) {
      WARN("SKIPPED: " << bench.err);
      return;
    }
    INFO(preset << bench.err);
    REQUIRE(bench.exit_code == 0);
    CHECK(bench.out.find("fastest peer of this picture: gl ") != std::string::npos);
    const auto json = nlohmann::json::parse(contents(folder.path("b.json")));
    int blended = 0, same = 0;
    for (const auto& peer : json["scenes"][0]["peers"]) {
      CAPTURE(peer["strategy"].get<std::string>());
      CHECK(peer["right_picture"] == true);
      const bool per_light = peer["rounding"] == "per light";
      blended += per_light ? 1 : 0;
      same += peer["same_picture"] == true ? 1 : 0;
      CHECK((per_light || peer["same_picture"] == false));  // what is timed is blended light by light
      CHECK(peer["pixels_off"].get<int>() <= 64 * 48 / 100);
    }
    CHECK(blended == 2);
    CHECK(same >= 1);
    CHECK(json["scenes"][0]["peers"].size() == 6);
  }
}

TEST_CASE("bench refuses what it cannot do, in one line") {
  const ScratchFolder folder;
  check_refused(run_command({"bench", "--against", "vulkan"}), 2, "no peer");
  check_refused(run_command({"bench", "--against", "gl,"}), 2, "no peer");
  check_refused(run_command({"bench", "builtin:nowhere"}), 3, "nowhere");
  check_refused(run_command({"bench", "--simd", "neon"}), 2, "neon");
  check_refused(run_command({"bench", "--size", "0x1"}), 2, "size");
  check_refused(run_command({"bench", "-o", "x.png"}), 2, ".html");
  check_refused(run_command({"bench", "builtin:cornell", "--json", folder.path("absent/x.json")}), 5, "folder");
}

}  // namespace trueshade
