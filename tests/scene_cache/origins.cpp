// A cache file is used for what it was made of, and for nothing else.
#include <fcntl.h>
#include <sys/stat.h>

#include <fstream>

#include "core/error.h"
#include "tests/catch.hpp"
#include "tests/scene_cache/cached.h"

namespace trueshade {
namespace {

std::string triangle(const char* x) {
  return std::string(
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n") +
         x + " 0 0\n0 1 0\n3 0 1 2\n";
}

const char* const kWithTriangle = R"({"version": 1, "objects": [{"geometry": "t.ply", "color": [1, 1, 1]}],
  "lights": [{"type": "ambient", "color": [1, 1, 1]}]})";

TEST_CASE("a file of the scene that changes is seen, also with its size and time kept") {
  const ScratchFolder folder, cache;
  const std::string spec = folder.write("scene.json", kWithTriangle), part = folder.write("t.ply", triangle("1"));
  let_files_settle();
  int loads = 0;
  const std::string before = cached_hash(cache.path(""), spec, loads);
  CHECK(before == plain_hash(spec));
  CHECK(cached_hash(cache.path(""), spec, loads) == before);
  CHECK(loads == 1);

  struct stat status {};
  REQUIRE(stat(part.c_str(), &status) == 0);
  folder.write("t.ply", triangle("2"));
  const timespec times[2] = {status.st_atim, status.st_mtim};
  REQUIRE(utimensat(AT_FDCWD, part.c_str(), times, 0) == 0);
  let_files_settle();
  const std::string after = cached_hash(cache.path(""), spec, loads);
  CHECK(after == plain_hash(spec));
  CHECK(after != before);
  CHECK(loads == 2);
  CHECK(cached_hash(cache.path(""), spec, loads) == after);
  CHECK(loads == 2);

  std::filesystem::remove(part);
  CHECK_THROWS_AS(cached_hash(cache.path(""), spec, loads), Error);
}

TEST_CASE("a scene whose files were written a moment ago is not kept") {
  const ScratchFolder folder, cache;
  const std::string spec = folder.write("scene.json", kWithTriangle);
  folder.write("t.ply", triangle("1"));
  int loads = 0;
  CHECK(cached_hash(cache.path(""), spec, loads) == plain_hash(spec));
  CHECK(cache.entries().empty());
}

TEST_CASE("scenes of one name in two folders, and one scene by two names, have files of their own") {
  const ScratchFolder one, other, cache;
  const std::string a = one.write("t.ply", triangle("1")), b = other.write("t.ply", triangle("2"));
  let_files_settle();
  int loads = 0;
  const std::string hash_a = cached_hash(cache.path(""), a, loads), hash_b = cached_hash(cache.path(""), b, loads);
  CHECK(hash_a == plain_hash(a));
  CHECK(hash_b == plain_hash(b));
  CHECK(cached_hash(cache.path(""), "builtin:city", loads) !=
        cached_hash(cache.path(""), "builtin:city,seed=2", loads));
  CHECK(cache.entries().size() == 4);
  CHECK(loads == 4);
}

TEST_CASE("a limit below those that a cache file was made under holds") {
  const ScratchFolder cache;
  int loads = 0;
  SceneLimits limits;
  cached_hash(cache.path(""), "builtin:city", loads, 0.0, {}, limits);
  limits.instances = 3;
  CHECK_THROWS_AS(cached_hash(cache.path(""), "builtin:city", loads, 0.0, {}, limits), Error);
  limits.instances = SceneLimits().instances + 1;
  cached_hash(cache.path(""), "builtin:city", loads, 0.0, {}, limits);
  CHECK(loads == 2);
}

TEST_CASE("a folder that others can write to is refused, and so is a file in its place") {
  const ScratchFolder scratch;
  int loads = 0;
  const std::string folder = scratch.path("open"), file = scratch.write("file", "");
  std::filesystem::create_directory(folder);
  for (const mode_t mode : {0775, 0757, 0777}) {
    REQUIRE(chmod(folder.c_str(), mode) == 0);
    CHECK_THROWS_AS(cached_hash(folder, "builtin:city", loads), Error);
  }
  CHECK_THROWS_AS(cached_hash(file, "builtin:city", loads), Error);
  CHECK(loads == 0);
  REQUIRE(chmod(folder.c_str(), 0755) == 0);
  cached_hash(folder, "builtin:city", loads);
  const std::string cached = folder + '/' + std::filesystem::directory_iterator(folder)->path().filename().string();
  REQUIRE(chmod(cached.c_str(), 0666) == 0);  // as others might have left it
  cached_hash(folder, "builtin:city", loads);
  CHECK(loads == 2);
}

}  // namespace
}  // namespace trueshade
