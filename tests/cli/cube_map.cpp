// render --cube-map: faces as OpenGL samples them, and the cross of all six.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr const char* kFaces[] = {"px", "nx", "py", "ny", "pz", "nz"};
constexpr int kSide = 40;
const glm::dvec3 kEye(3.0, 4.0, -2.0);

struct TexturePlace {
  int face;
  double s, t;
};

/// Where OpenGL looks a direction up: section 8.13 and table 8.19 of OpenGL 4.6, by its own words.
TexturePlace looked_up(const glm::dvec3& r) {
  const glm::dvec3 a = glm::abs(r);
  const auto place = [](int face, double sc, double tc, double major) {
    return TexturePlace{face, (sc / major + 1.0) / 2.0, (tc / major + 1.0) / 2.0};
  };
  if (a.x >= a.y && a.x >= a.z) return r.x > 0 ? place(0, -r.z, -r.y, a.x) : place(1, r.z, -r.y, a.x);
  if (a.y >= a.z) return r.y > 0 ? place(2, r.x, r.z, a.y) : place(3, r.x, -r.z, a.y);
  return r.z > 0 ? place(4, r.x, -r.y, a.z) : place(5, -r.x, -r.y, a.z);
}

const Image& plane(const std::vector<NamedImage>& planes, const std::string& name) {
  return std::find_if(planes.begin(), planes.end(), [&](const NamedImage& p) { return p.name == name; })->image;
}

Outcome city_cube(const ScratchFolder& folder, std::vector<std::string> more) {
  more.insert(more.begin(), {"render", "builtin:city", "--cube-map", "3,4,-2", "--size", "40x40"});
  return run_command(more, folder.path(""));
}

}  // namespace

TEST_CASE("Every texel of every face of a cube map shows what lies in the direction by which OpenGL looks it up") {
  const ScratchFolder folder;
  REQUIRE(city_cube(folder, {"--aov", "position,depth", "-o", "sky.exr"}).exit_code == 0);
  int surfaces = 0;
  double worst = 0.0;
  for (int face = 0; face < 6; ++face) {
    const std::vector<NamedImage> planes = read_planes(folder.path("sky." + std::string(kFaces[face]) + ".exr"));
    const Image &position = plane(planes, "position"), &depth = plane(planes, "depth");
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        if (depth.value(x, y, 0) == 1.0) continue;
        const glm::dvec3 seen(position.value(x, y, 0), position.value(x, y, 1), position.value(x, y, 2));
        const TexturePlace place = looked_up(seen - kEye);
        ++surfaces;
        if (place.face != face) worst = kSide;
        worst = std::max({worst, std::abs(place.s * kSide - (x + 0.5)), std::abs(place.t * kSide - (y + 0.5))});
      }
  }
  CHECK(surfaces > 6 * kSide * kSide / 2);
  CHECK(worst < 0.01);  // texels: positions are interpolated between vertices on a grid of 1/256
}

TEST_CASE("A cross holds the six faces at their places, and nothing elsewhere") {
  const ScratchFolder folder;
  REQUIRE(city_cube(folder, {"-o", "sky.png"}).exit_code == 0);
  const Outcome cross_run = city_cube(folder, {"--cube-cross", "-o", "cross.png"});
  REQUIRE(cross_run.exit_code == 0);
  CHECK(cross_run.out.find("cross.png (160x120 rgba8") != std::string::npos);
  CHECK(cross_run.err.empty());
  const Image cross = plane(read_planes(folder.path("cross.png")), "color");
  constexpr int kPlaces[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};  // columns and rows of faces
  std::vector<char> is_face(12, 0);
  for (int face = 0; face < 6; ++face) {
    const Image alone = plane(read_planes(folder.path("sky." + std::string(kFaces[face]) + ".png")), "color");
    const auto [column, row] = kPlaces[face];
    is_face[size_t(4 * row + column)] = 1;
    for (int y = 0; y < kSide; ++y)
      CHECK(std::equal(alone.texel(0, y), alone.texel(0, y) + alone.row_bytes(),
                       cross.texel(column * kSide, row * kSide + y)));
  }
  int filled = 0;
  for (int y = 0; y < cross.height; ++y)
    for (int x = 0; x < cross.width; ++x)
      if (!is_face[size_t(4 * (y / kSide) + x / kSide)])
        for (int c = 0; c < 4; ++c) filled += cross.code(x, y, c) != 0;
  CHECK(filled == 0);
}

TEST_CASE("A cube map of the camera's place is that of its numbers, moves with the time, and says what it is") {
  const ScratchFolder folder;
  const auto hashes = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "builtin:circle", "--size", "32x32", "--hash", "--cube-map"});
    const Outcome outcome = run_command(more, folder.path(""));
    CHECK(outcome.exit_code == 0);
    return outcome.out;
  };
  const std::string at_eye = hashes({"eye", "-o", "red.exr"});
  CHECK(std::count(at_eye.begin(), at_eye.end(), '\n') == 6);
  const Outcome info = run_command({"info", "red.nz.exr"}, folder.path(""));
  const size_t told = info.out.find("trueshade:cubeMap");
  REQUIRE(told != std::string::npos);
  const size_t begin = info.out.find_first_not_of(' ', told + 17), end = info.out.find(" nz", begin);
  CHECK(hashes({info.out.substr(begin, end - begin)}) == at_eye);
  CHECK(hashes({"eye", "--time", "1"}) != at_eye);
  // A face carries its scene, and is not judged as if the scene's camera had drawn it.
  CHECK(run_command({"compare", "red.nz.exr", "red.nz.exr"}, folder.path("")).out.find("judge") == std::string::npos);
  CHECK(run_command({"compare", "red.nz.exr", "red.pz.exr"}, folder.path("")).exit_code == 1);
  const std::string frames = hashes({"eye", "--frames", "0-1", "-o", "f.png"});
  CHECK(frames.starts_with(at_eye));
  CHECK(run_command({"info", "f.0001.ny.png"}, folder.path("")).exit_code == 0);
}

TEST_CASE("Cube maps that make no sense are refused in a line") {
  const std::vector<std::string> draw = {"render", "builtin:circle"};
  const auto refused = [&](std::vector<std::string> more, const std::string& about) {
    more.insert(more.begin(), draw.begin(), draw.end());
    check_refused(run_command(more), 2, about);
  };
  for (const char* place :
       {"", "1", "1,2", "1,2,3,4", "1,2,x", "nan,0,0", "0,inf,0", "0,0,2e9", "1 2 3", "1,2,3 ", "Eye"})
    refused({"--hash", "--cube-map", place}, "--cube-map: '" + std::string(place) + "'");
  refused({"--hash", "--cube-map", "0,0,0", "--size", "8x9"}, "the faces of a cube are square, and 8x9 is not");
  refused({"--hash", "--cube-cross"}, "there is no cube map");
  refused({"--cube-map", "0,0,0", "-o", "a.html"}, "a report shows the camera's picture");
  refused({"--json", "--cube-map", "0,0,0", "--cube-cross"}, "statistics are those of one picture");
}

}  // namespace trueshade
