// What `trueshade validate` says of a capture with a known fault.
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

/// Our own frame of builtin:cornell with fronts culled, as c.exr.
void write_culled(const ScratchFolder& folder) {
  folder.write("culled.json", R"({"geometry": {"cull_face": "front"}})");
  const Outcome outcome = run_command({"render", "builtin:cornell", "--size", "96x72", "--pipeline", "culled.json",
                                       "-o", "c.exr", "--aov", "depth,position,normal,albedo,id.object"},
                                      folder.path(""));
  REQUIRE(outcome.exit_code == 0);
}

Outcome judged_capture(const ScratchFolder& folder, const Arguments& options) {
  Arguments arguments = {"validate", "builtin:cornell", "--gbuffer", "c.exr", "--quick"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return run_command(arguments, folder.path(""));
}

}  // namespace

TEST_CASE("A capture with a known fault: text, JSON and page name it, prove it, and say what shows it") {
  const ScratchFolder folder;
  write_culled(folder);
  const Outcome text = judged_capture(folder, {});
  INFO(text.out << text.err);
  CHECK(text.exit_code == 1);
  CHECK(has(text.out, "looks like  cull-face=front (G-buffer): the face culled is `front`; explains "));
  CHECK(has(text.out, ", by this fault "));
  CHECK(has(text.out, "try: trueshade validate builtin:cornell --gbuffer c.exr --quick --suppose cull-face=front\n"));
  const Outcome json = judged_capture(folder, {"--json", "-o", "page.html"});
  const nlohmann::json first = nlohmann::json::parse(json.out).at("diagnosis").at(0);
  CHECK(first.at("name") == "cull-face=front");
  CHECK(first.at("plane") == "G-buffer");
  CHECK(first.at("explained") > 0.95);
  CHECK(first.at("proof").at("given") == first.at("proof").at("predicted"));
  CHECK(has(first.at("command"), "--suppose cull-face=front"));
  CHECK(has(contents(folder.path("page.html")), "<h2>What it looks like</h2>"));
}

TEST_CASE("What is supposed is answered alone, and a fault that is not known is a usage error") {
  const ScratchFolder folder;
  write_culled(folder);
  const Outcome right = judged_capture(folder, {"--suppose", "cull-face=front"}),
                wrong = judged_capture(folder, {"--suppose", "depth-reversed"});
  CHECK(right.exit_code == 1);  // whatever explains it, the capture does not pass
  CHECK(has(right.out, "looks like  cull-face=front"));
  CHECK(has(wrong.out, "looks like  depth-reversed (depth): the depths are reversed: 1 - z; explains 0.0 %"));
  CHECK_FALSE(has(wrong.out, "cull-face"));
  const std::pair<const char*, const char*> refusals[] = {
      {"no-such-fault", "is no fault that is known"},
      {"light-missing", "needs its parameter after `=` (light-missing takes a whole number from 0 to "},
      {"cull-face=sideways", "has a parameter that it does not take (cull-face takes none, front, back)"},
      {"tile-lists-16=1e10", "has a parameter that it does not take (tile-lists-16 takes 0, 1, 2, 3, 4, 5, 6, 7)"},
      {"light-intensity=nan",
       "has a parameter that it does not take (light-intensity takes a number from 0.001 to 1000)"},
      {"picture-flip-y=1", "has a parameter (picture-flip-y takes none)"},
      {"light-shader-line-13", "cannot be supposed: slips of a light program"}};
  for (const auto& [name, reason] : refusals) {
    const Outcome refused = judged_capture(folder, {"--suppose", name});
    CAPTURE(name, refused.err);
    CHECK(refused.exit_code == 2);
    CHECK(has(refused.err, "--suppose: '" + std::string(name) + "' " + reason));
  }
}

}  // namespace trueshade
