// --timeout and --max-pixels, and pictures that are larger than any frame.
#include <chrono>

#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
TEST_CASE("A run with --timeout ends within a second, in one line, and every file is whole") {
  const ScratchFolder folder;
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = run_command({"render", "builtin:city", "--frames", "0-99999", "--size", "96x64", "--threads",
                                       "1", "-q", "-o", "f.png", "--timeout", "1"},
                                      folder.path(""));
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  check_refused(outcome, 4, "--timeout: the time is over");
  CHECK(taken.count() > 0.99);
  CHECK(taken.count() < 2.0);
  const std::vector<std::string> names = folder.entries();
  CHECK(names.size() > 1);
  for (const std::string& name : names) {
    INFO(name);
    CHECK(name.ends_with(".png"));
    CHECK(contents(folder.path(name)).ends_with("IEND\xae\x42\x60\x82"));
  }
}

TEST_CASE("A picture that --timeout has ended goes on with --resume") {
  const ScratchFolder folder;
  const std::vector<std::string> draw = {"render", "builtin:city", "--size", "16640x4096", "-q", "-o", "x.png"};
  std::vector<std::string> ended = draw, resumed = draw;
  ended.insert(ended.end(), {"--threads", "1", "--timeout", "2"});
  resumed.insert(resumed.end(), {"--resume", "--timeout", "60"});
  const Outcome outcome = run_command(ended, folder.path(""));
  if (outcome.exit_code == 0) return;  // this machine is fast
  check_refused(outcome, 4, "--timeout");
  CHECK(contents(folder.path("x.png")).empty());
  CHECK(run_command(resumed, folder.path("")).exit_code == 0);
  CHECK(folder.entries() == std::vector<std::string>{"x.png"});
}

TEST_CASE("The option --max-pixels bounds what is drawn and what is read") {
  const ScratchFolder folder;
  const auto run = [&](std::vector<std::string> arguments, const char* most) {
    arguments.insert(arguments.end(), {"--max-pixels", most});
    return run_command(arguments, folder.path(""));
  };
  const std::vector<std::string> draw = {"render", "builtin:cornell", "--size", "40x30", "-q",
                                         "-o",     "x.png",           "-o",     "x.exr"};
  check_refused(run(draw, "1199"), 4, "a picture of 40x30 is over the limit (at most 1199 pixels, or a higher");
  CHECK(folder.entries().empty());
  REQUIRE(run(draw, "1200").exit_code == 0);
  for (const char* picture : {"x.png", "x.exr"}) {
    check_refused(run({"info", picture}, "1199"), 4, "--max-pixels");
    CHECK(run({"info", picture}, "1200").exit_code == 0);
  }
  check_refused(run({"compare", "x.png", "x.exr"}, "1199"), 4, "--max-pixels");
  check_refused(run({"compare", "x.exr", "x.png"}, "1199"), 4, "--max-pixels");
  CHECK(run({"compare", "x.png", "x.exr"}, "1200").exit_code == 0);
  folder.write("s.json",
               R"({"version": 1, "camera": {"eye": [0, 1, 5]}, "textures": [{"name": "t", "file": "x.png"}]})");
  check_refused(run({"info", "s.json"}, "1199"), 4, "--max-pixels");
  CHECK(run({"info", "s.json"}, "1200").exit_code == 0);
}

TEST_CASE("info and compare read the command's own pictures of over 16,384 pixels a side") {
  const ScratchFolder folder;
  const auto run = [&](const std::vector<std::string>& arguments) { return run_command(arguments, folder.path("")); };
  REQUIRE(run({"render", "builtin:cornell", "--size", "17000x70", "-q", "-o", "x.png", "-o", "x.exr"}).exit_code == 0);
  for (const char* picture : {"x.png", "x.exr"}) {
    const Outcome outcome = run({"info", picture});
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.out.find("17000x70") != std::string::npos);
  }
  const Outcome compared = run({"compare", "x.png", "x.exr"});
  INFO(compared.out << compared.err);
  CHECK(compared.exit_code == 0);
  check_refused(run({"compare", "x.png", "x.exr", "--max-memory", "20M"}), 4, "--max-memory");
  folder.write("s.json",
               R"({"version": 1, "camera": {"eye": [0, 1, 5]}, "textures": [{"name": "t", "file": "x.png"}]})");
  check_refused(run({"info", "s.json"}), 4, "it is over 16384 pixels a side or 4 GiB decoded");
}

}  // namespace trueshade
