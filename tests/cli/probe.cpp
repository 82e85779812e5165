// `trueshade probe`, and the file that it writes.
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {

TEST_CASE("a probed profile explains other frames of its driver, and validate takes its file") {
  const ScratchFolder folder;
  const Outcome probed =
      run_command({"probe", "--driver", "llvmpipe", "-o", "profile.json", "--json"}, folder.path(""));
  if (probed.exit_code == 7) {
    WARN("SKIPPED: " << probed.err);
    return;
  }
  REQUIRE(probed.exit_code == 0);
  const auto json = nlohmann::json::parse(probed.out);
  CHECK(json["pass"] == true);
  CHECK(json["held_out"].size() >= 15);
  CHECK(json["profile"]["subpixel_bits"] == 8);
  CHECK(json["profile"]["name"] == std::string(json["driver"]).substr(0, 100));
  for (const auto& field : json["fields"])
    if (field["field"] == "half") CHECK(field["value"] == "toward_zero");
  const auto judged = [&](const char* profile) {
    return run_command(
        {"validate", "builtin:cornell", "--size", "64x48", "--driver", "llvmpipe", "--quick", "--profile", profile},
        folder.path(""));
  };
  CHECK(judged("profile.json").exit_code == 0);
  // The same but for halves of another rounding, and a grid that the driver does not have.
  folder.write("wrong.json", R"({"name": "wrong", "subpixel_bits": 12, "snap": "nearest", "plane_origin": "snapped"})");
  CHECK(judged("wrong.json").exit_code == 1);
}

TEST_CASE("profiles and probes that are none are refused in one line") {
  const ScratchFolder folder;
  const auto run = [&](std::vector<std::string> arguments) { return run_command(arguments, folder.path("")); };
  check_refused(run({"probe", "--driver", "nope"}), 2, "there is no driver 'nope'");
  check_refused(run({"probe", "-o", "profile.txt"}), 2, "end the name in .json");
  check_refused(run({"probe", "--name", ""}), 2, "the name is empty");
  check_refused(run({"validate", "builtin:cornell", "--profile", "absent.json"}), 5, "absent.json");
  folder.write("bits.json", R"({"name": "x", "subpixel_bits": 3})");
  check_refused(run({"validate", "builtin:cornell", "--profile", "bits.json"}), 3, "bits.json: /subpixel_bits");
  folder.write("key.json", R"({"name": "x", "grid": 8})");
  check_refused(run({"validate", "builtin:cornell", "--profile", "key.json"}), 3, "grid");
}

}  // namespace trueshade
