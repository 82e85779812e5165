// Whatever happens to a cache file, the picture is the right one, or there is one error that names the file.
#include <fstream>
#include <functional>
#include <iterator>

#include "core/error.h"
#include "scene_cache/checked_file.h"
#include "tests/catch.hpp"
#include "tests/scene_cache/cached.h"

namespace trueshade {
namespace {

constexpr const char* kScene = "builtin:atrium";

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What came of drawing from a file that was changed.
struct Tally {
  int refused = 0, read_anew = 0, unseen = 0;
};

class Damage {
 public:
  Damage() {
    cached_hash(cache_.path(""), kScene, loads_);
    path_ = only_file(cache_);
    whole_ = content_of(path_);
    expected_ = plain_hash(kScene);
  }

  const std::string& whole() const { return whole_; }

  void draw(const std::string& content) {
    cache_.write(cache_.entries().at(0), content);
    const int loads_before = loads_;
    try {
      const std::string hash = cached_hash(cache_.path(""), kScene, loads_);
      REQUIRE(hash == expected_);
      ++(loads_ > loads_before ? tally.read_anew : tally.unseen);
    } catch (const Error& error) {
      REQUIRE(error.kind() == ErrorKind::io);
      REQUIRE(std::string(error.what()).starts_with(path_ + ": the bytes from "));
      ++tally.refused;
    }
  }

  Tally tally;

 private:
  ScratchFolder cache_;
  std::string path_, whole_, expected_;
  int loads_ = 0;
};

TEST_CASE("a byte that is wrong anywhere in a cache file changes no picture", "[slow]") {
  Damage damage;
  const size_t size = damage.whole().size(), segments = size / kSegmentBytes;
  REQUIRE(segments > 40);
  const auto flip = [&](size_t at) {
    std::string content = damage.whole();
    content[at] = char(content[at] ^ (1 << at % 8));
    damage.draw(content);
  };
  for (size_t segment = 0; segment < segments; ++segment)
    flip(segment * kSegmentBytes + segment * 1237 % kSegmentBytes);
  CHECK(damage.tally.refused > 10);
  damage.tally = {};
  const size_t checksums_and_footer = 4 * (segments + 1) + 56;
  for (size_t from_end = 1; from_end < checksums_and_footer; from_end += from_end < 60 ? 1 : 13) flip(size - from_end);
  CHECK(damage.tally.refused + damage.tally.unseen == 0);
  damage.tally = {};
  for (size_t from_end = checksums_and_footer + 1; from_end < 4000; from_end += 97) flip(size - from_end);
  CHECK(damage.tally.read_anew > 20);
}

TEST_CASE("a cache file that is cut off, longer, empty or something else is made anew") {
  Damage damage;
  const std::string& whole = damage.whole();
  int files = 0;
  for (size_t size = 0; size < whole.size(); size += whole.size() / 23 + 1, ++files) damage.draw(whole.substr(0, size));
  for (size_t less = 1; less < 70; less += 3, ++files) damage.draw(whole.substr(0, whole.size() - less));
  damage.draw(whole + "x"), ++files;
  damage.draw(whole + whole), ++files;
  damage.draw(std::string(whole.size(), '\0')), ++files;
  CHECK(damage.tally.read_anew == files);
}

TEST_CASE("a cache file with right checksums that names a mesh, a material or a texture beyond its own is bad input") {
  const auto kind_of = [](const std::function<void(Scene&)>& forge) {
    const ScratchFolder cache;
    const auto load = [&forge] {
      Scene scene = load_scene("builtin:atrium");
      forge(scene);
      return scene;
    };
    try {
      cached_scene(cache.path(""), "builtin:atrium", {}, {}, load);
    } catch (const Error& error) {
      return int(error.kind());
    }
    return 0;
  };
  CHECK(kind_of([](Scene&) {}) == 0);
  const int bad_input = int(ErrorKind::bad_input);
  CHECK(kind_of([](Scene& scene) { scene.instances[0].mesh = uint32_t(scene.meshes.size()); }) == bad_input);
  CHECK(kind_of([](Scene& scene) { scene.instances[0].material = uint32_t(scene.materials.size()); }) == bad_input);
  CHECK(kind_of([](Scene& scene) { maps_of(scene.materials[0])[0]->texture = int32_t(scene.textures.size()); }) ==
        bad_input);
}

}  // namespace
}  // namespace trueshade
