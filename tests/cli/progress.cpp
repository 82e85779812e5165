// What the command says on a terminal while it works: under util-linux's `script`, which gives it one.
#include <cstdlib>

#include "cli/activity.h"
#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

/// What `trueshade ARGUMENTS` writes to a terminal.
std::string on_a_terminal(const std::string& arguments, const ScratchFolder& folder) {
  const std::string line = "cd '" + folder.path("") + "' && script -qec '" TRUESHADE_COMMAND " " + arguments +
                           "' terminal.txt >terminal.out 2>&1 </dev/null";
  INFO(line);
  CHECK(std::system(line.c_str()) == 0);
  return contents(folder.path("terminal.txt"));
}

}  // namespace

TEST_CASE("An activity inside another is silent, and none is left behind") {
  CHECK_FALSE(Activity::any());
  {
    Activity outer("reading");
    const Activity inner("writing");
    CHECK(Activity::any());
    outer.now("judging");
    outer.show(1, 2, "parts");
    const auto paused = Activity::pause();
  }
  CHECK_FALSE(Activity::any());
}

TEST_CASE("validate and sequences of frames say on a terminal what they do, and wipe it", "[slow]") {
  const ScratchFolder folder;
  const std::string frames = on_a_terminal("render builtin:city --size 1600x1200 --frames 0-39 -o f####.png", folder);
  CHECK(has(frames, "rendering frames ["));
  CHECK(has(frames, "frames/s"));
  CHECK(has(frames, " s left"));
  CHECK(has(frames, "wrote f0039.png"));
  on_a_terminal("render builtin:city --size 1600x1200 --aov depth,position,normal,albedo,id.object -o c.exr", folder);
  const std::string judged = on_a_terminal("validate builtin:city --gbuffer c.exr --subpixel-bits 8", folder);
  CHECK(has(judged, "judging the surfaces ["));
  CHECK(has(judged, "judging the lights ["));
  CHECK(has(judged, " s left"));
  const size_t last = judged.rfind("\x1b[K"), verdict = judged.find("every pixel is explained");
  CHECK((verdict != std::string::npos && last < verdict));
}

}  // namespace trueshade
