#include "view/source_watch.h"

#include <filesystem>

#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

namespace trueshade::viewer {
namespace {

using Clock = SourceWatch::Clock;

TEST_CASE("Files that are written, replaced, removed or made have changed once they have been still for a moment") {
  const ScratchFolder folder;
  const std::string path = folder.write("scene.json", "one"), later = folder.path("later.ply");
  SourceWatch watch;
  const Clock::time_point now = Clock::now();
  watch.watch({path, later});
  CHECK_FALSE(watch.changed(now));
  CHECK_FALSE(watch.changed(now + std::chrono::seconds(5)));

  SECTION("written") { folder.write("scene.json", "one and more"); }
  SECTION("replaced by one of the same size") {
    folder.write("other", "two");
    std::filesystem::rename(folder.path("other"), path);
  }
  SECTION("removed") { std::filesystem::remove(path); }
  SECTION("made") { folder.write("later.ply", ""); }
  CHECK_FALSE(watch.changed(now + std::chrono::seconds(6)));
  CHECK_FALSE(watch.changed(now + std::chrono::seconds(6) + SourceWatch::kSettled / 2));
  CHECK(watch.changed(now + std::chrono::seconds(6) + SourceWatch::kSettled));
  watch.watch({path, later});
  CHECK_FALSE(watch.changed(now + std::chrono::seconds(9)));
}

TEST_CASE("A file that is being written is waited for") {
  const ScratchFolder folder;
  const std::string path = folder.write("scene.json", "");
  SourceWatch watch;
  watch.watch({path});
  Clock::time_point now = Clock::now();
  std::string content;
  for (int i = 0; i < 10; ++i) {
    folder.write("scene.json", content += "a line\n");
    now += SourceWatch::kSettled / 2;
    CHECK_FALSE(watch.changed(now));
  }
  CHECK(watch.changed(now + SourceWatch::kSettled));
}

}  // namespace
}  // namespace trueshade::viewer
