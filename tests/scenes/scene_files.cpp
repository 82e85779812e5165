#include "scenes/files/content/scene_files.h"

#include <sys/stat.h>

#include "expect_error.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

std::string path_refusal(std::string_view uri) {
  return error_of(ErrorKind::bad_input, [&] { path_from_uri(uri, "s.json: /objects/0/geometry"); });
}

TEST_CASE("paths inside the scene's folder are decoded and taken") {
  CHECK(path_from_uri("a.ply", "w") == "a.ply");
  CHECK(path_from_uri("a/../b.ply", "w") == "a/../b.ply");
  CHECK(path_from_uri("./a%20b/%C3%A4.ply", "w") == "./a b/\xC3\xA4.ply");
  CHECK(path_from_uri("a/b:c.ply", "w") == "a/b:c.ply");
}

TEST_CASE("paths that leave the folder or the rules are refused") {
  for (const char* bad : {"",
                          "/etc/passwd",
                          "%2Fetc/passwd",
                          "..",
                          "../a.ply",
                          "%2e%2e/a.ply",
                          "a/../../b.ply",
                          "a/b/../../../c",
                          "a\\b.ply",
                          "a%5Cb.ply",
                          "a%00.ply",
                          "a%0ab.ply",
                          "a%",
                          "a%2",
                          "a%zz",
                          "file:///a.ply",
                          "http://x/a.ply",
                          "data:abc",
                          "C:/a.ply",
                          "//host/a.ply"})
    CHECK_STARTS_WITH(path_refusal(bad), "s.json: /objects/0/geometry: the path ");
  CHECK_STARTS_WITH(path_refusal(std::string_view("a\0b", 3)),
                    "s.json: /objects/0/geometry: the path has a control character");
  CHECK_STARTS_WITH(path_refusal(std::string(5000, 'a')), "s.json: /objects/0/geometry: the path is too long");
}

TEST_CASE("a scene's folder gives its own files and no others, with openat2 and without") {
  const ScratchFolder scratch;
  scratch.write("outside.ply", "outside");
  scratch.write("scene/in.ply", "inside");
  scratch.write("scene/sub/deep.ply", "deep");
  const std::string scene = scratch.write("scene/s.json", "{}");
  std::filesystem::create_symlink("sub/deep.ply", scratch.path("scene/link.ply"));
  std::filesystem::create_symlink("../outside.ply", scratch.path("scene/escape.ply"));
  std::filesystem::create_symlink("..", scratch.path("scene/up"));
  std::filesystem::create_symlink("loop.ply", scratch.path("scene/loop.ply"));
  REQUIRE(mkfifo(scratch.path("scene/pipe.ply").c_str(), 0600) == 0);
  const SceneFolder folder(scene);
  for (const bool portable : {false, true}) {
    const auto read = [&](const char* name, uint64_t limit = 100) {
      const Bytes bytes = folder.read(name, limit, "s.json", portable);
      return std::string(bytes.begin(), bytes.end());
    };
    CHECK(read("in.ply") == "inside");
    CHECK(read("sub/../in.ply") == "inside");
    CHECK(read("link.ply") == "deep");
    error_of(ErrorKind::bad_input, [&] { read("escape.ply"); });
    error_of(ErrorKind::bad_input, [&] { read("up/outside.ply"); });
    error_of(ErrorKind::bad_input, [&] { read("loop.ply"); });
    error_of(ErrorKind::bad_input, [&] { read("sub"); });
    CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { read("pipe.ply"); }),
                      "s.json: pipe.ply: this is no regular file");
    CHECK_STARTS_WITH(error_of(ErrorKind::io, [&] { read("absent.ply"); }), "s.json: absent.ply: No such file");
    CHECK_STARTS_WITH(error_of(ErrorKind::limit, [&] { read("in.ply", 5); }),
                      "s.json: in.ply: 6 bytes are over the limit");
  }
}

TEST_CASE("a file the user names may lie anywhere but must be a file") {
  const ScratchFolder scratch;
  CHECK(read_user_file(scratch.write("a", "x"), 1).size() == 1);
  error_of(ErrorKind::io, [&] { read_user_file(scratch.path("absent"), 1); });
  error_of(ErrorKind::bad_input, [&] { read_user_file("/dev/null", 1); });
  error_of(ErrorKind::bad_input, [&] { read_user_file("/", 1); });
}

}  // namespace
}  // namespace trueshade
