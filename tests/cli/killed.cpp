// A command that is killed at any moment leaves each file as it was or as it would have become.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <random>
#include <thread>

#include "tests/catch.hpp"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kFiles[] = {"x.png", "x.exr", "x.html"};

/// Starts the command in a folder, silent; `preload` may be empty.
pid_t start_render(const ScratchFolder& folder, const std::string& scene, const char* preload) {
  const std::string place = folder.path("");
  const pid_t process = fork();
  if (process != 0) return process;
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
  if (*preload != '\0') setenv("LD_PRELOAD", preload, 1);
  if (chdir(place.c_str()) == 0)
    execl(TRUESHADE_COMMAND, TRUESHADE_COMMAND, "render", scene.c_str(), "--size", "200x150", "-o", kFiles[0], "-o",
          kFiles[1], "-o", kFiles[2], "--aov", "depth,position,normal,albedo", static_cast<char*>(nullptr));
  _exit(127);
}

int ended(pid_t process) {
  int status = 0;
  REQUIRE(waitpid(process, &status, 0) == process);
  return status;
}

/// A page has times, which differ from run to run: whole is one that begins and ends as pages do.
bool is_whole_page(const std::string& text) {
  return text.starts_with("<!doctype html>") && text.ends_with("</html>\n");
}

TEST_CASE("1,000 kills at random times tear no file, and temporaries are removed by the next run", "[long]") {
  const ScratchFolder folder;
  const std::string scenes[] = {"builtin:cornell", "builtin:city"};
  std::map<std::string, std::vector<std::string>> whole;
  Clock::duration longest{};
  for (const std::string& scene : scenes) {
    const auto begin = Clock::now();
    REQUIRE(ended(start_render(folder, scene, "")) == 0);
    longest = std::max(longest, Clock::now() - begin);
    for (const char* name : {kFiles[0], kFiles[1]}) whole[name].push_back(contents(folder.path(name)));
  }
  REQUIRE(whole["x.png"][0] != whole["x.png"][1]);
  REQUIRE(is_whole_page(contents(folder.path("x.html"))));
  std::mt19937 random(1);
  int killed = 0, changed = 0, with_temporaries = 0;
  size_t most_left = 0;
  for (int run = 0; killed < 1000 && run < 4000; ++run) {
    const std::string before = contents(folder.path("x.png"));
    // Every other run makes temporaries with names, as on file systems without nameless files.
    const pid_t process = start_render(folder, scenes[size_t(run / 2 % 2)], run % 2 == 0 ? "" : NO_TMPFILE);
    std::this_thread::sleep_for(longest * (random() % 1000) / 1000);
    kill(process, SIGKILL);
    killed += WIFSIGNALED(ended(process)) ? 1 : 0;
    for (const char* name : {kFiles[0], kFiles[1]}) {
      const std::string now = contents(folder.path(name));
      CHECK(std::count(whole[name].begin(), whole[name].end(), now) == 1);
    }
    CHECK(is_whole_page(contents(folder.path("x.html"))));
    changed += contents(folder.path("x.png")) != before ? 1 : 0;
    std::vector<std::string> left = folder.entries();
    std::erase_if(left, [](const std::string& name) { return std::find(kFiles, kFiles + 3, name) != kFiles + 3; });
    for (const std::string& name : left) CHECK((name.starts_with(".trueshade-") && name.ends_with(".tmp")));
    with_temporaries += left.empty() ? 0 : 1;
    most_left = std::max(most_left, left.size());
  }
  std::printf("%d killed, %d of them after the first file was replaced, %d left temporaries, at most %zu\n", killed,
              changed, with_temporaries, most_left);
  CHECK(killed == 1000);
  CHECK(changed > 20);
  CHECK(with_temporaries > 0);
  REQUIRE(ended(start_render(folder, scenes[0], "")) == 0);
  CHECK(folder.entries() == std::vector<std::string>{"x.exr", "x.html", "x.png"});
  CHECK(contents(folder.path("x.png")) == whole["x.png"][0]);
}

}  // namespace
}  // namespace trueshade
