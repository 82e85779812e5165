// Where the system starts no more threads, the command does without, or says so before a library waits for one.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {

TEST_CASE("threads that the system does not start are done without, and a library that needs them is named") {
  if (geteuid() != 0 || std::system("setpriv --reuid 54321 --clear-groups bash -c 'exec \"" TRUESHADE_COMMAND
                                    "\" list' >/dev/null 2>&1") != 0) {
    WARN(
        "SKIPPED: holding another user to a number of processes needs root, setpriv, and a command that others may "
        "run");
    return;
  }
  const ScratchFolder folder;
  std::filesystem::permissions(folder.path(""), std::filesystem::perms::all);
  REQUIRE(run_command({"render", "builtin:cornell", "--size", "32x32", "-o", "x.exr"}, folder.path("")).exit_code == 0);
  const auto run = [&](const std::string& arguments, int processes) {
    const std::string line =
        "cd '" + folder.path("") + "' && setpriv --reuid 54321 --clear-groups bash -c 'ulimit -u " +
        std::to_string(processes) + "; exec \"" TRUESHADE_COMMAND "\" " + arguments + "' >out 2>err";
    return WEXITSTATUS(std::system(line.c_str()));
  };
  const std::string hash = run_command({"render", "builtin:cornell", "--size", "300x300", "--hash"}).out;
  std::string line;
  for (int processes = 1; processes <= 9; ++processes) {
    CAPTURE(processes);
    CHECK(run("render builtin:cornell --size 300x300 --hash --threads 8", processes) == 0);
    std::ifstream out(folder.path("out"));
    REQUIRE(std::getline(out, line));
    CHECK(hash == line + "\n");
  }
  folder.write("jobs.json", R"({"jobs": [{"name": "a", "run": ["info", "builtin:cornell"]}]})");
  const auto refused = [&](const std::string& arguments, int processes, const std::string& about) {
    CAPTURE(arguments, processes);
    CHECK(run(arguments, processes) == 6);
    std::ifstream err(folder.path("err"));
    REQUIRE(std::getline(err, line));
    CHECK(line.starts_with("trueshade: error: " + about));
    CHECK_FALSE(std::getline(err, line));
  };
  for (int processes = 1; processes <= 4; ++processes) {  // the libraries' initializers need more
    refused("info x.exr", processes, "threads: ");
    for (const char* driver : {"llvmpipe", "lavapipe"})
      refused(std::string("validate builtin:cornell --size 16x16 --driver ") + driver, processes, "threads: ");
  }
  refused("batch jobs.json", 1, "threads: ");
  refused("batch jobs.json", 2, "batch: cannot start a job: ");
}

TEST_CASE("a batch for which there is no memory to start a thread ends in order") {
  const ScratchFolder folder;
  folder.write("jobs.json", R"({"jobs": [{"name": "a", "run": ["info", "builtin:cornell"]}]})");
  int passed = 0, refused = 0;
  for (int mb = 64; mb <= 160; mb += 4) {
    const Outcome outcome =
        run_command({"batch", "jobs.json"}, folder.path(""), "ulimit -v " + std::to_string(mb * 1024));
    CAPTURE(mb, outcome.exit_code, outcome.err);
    if (outcome.exit_code == 127) continue;  // the system's loader had no memory for the libraries
    CHECK((outcome.exit_code == 0 || outcome.exit_code == 1 || outcome.exit_code == 6));  // 1: the job had too little
    passed += outcome.exit_code == 0, refused += outcome.exit_code == 6;
  }
  CHECK(passed > 0);
  CHECK(refused > 0);
}

}  // namespace trueshade
