// What `trueshade bench` says and writes. No time is a verdict here.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/cli/scratch_folder.h"

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
