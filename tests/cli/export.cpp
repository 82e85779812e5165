// What `trueshade export` writes, drawn by `trueshade render`.
#include <sys/stat.h>

#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/output_of.h"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

std::string hash_of(const std::string& scene, const Arguments& more, const ScratchFolder& folder) {
  Arguments arguments{"render", scene, "--size", "64x48", "--hash"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return output_of(arguments, folder);
}

TEST_CASE("an exported scene is drawn with the hash of the scene it is of, under each preset and at each time") {
  const ScratchFolder folder;
  for (const char* scene : {"builtin:cornell", "builtin:lecture", "builtin:city", "builtin:circle"}) {
    CAPTURE(scene);
    output_of({"export", scene, "-o", "a.glb"}, folder);
    for (const Arguments& more : {Arguments{}, {"--preset", "redsdk"}, {"--preset", "punctual"}, {"--time", "1.25"}})
      CHECK(hash_of("a.glb", more, folder) == hash_of(scene, more, folder));
  }
}

TEST_CASE("an exported scene of pictures, pipeline and a file's lights is drawn with its hash, and exported again") {
  const ScratchFolder folder;
  folder.write("m.obj",
               "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 3 0\nvt 3 3\nvt 0 3\nusemtl a\n"
               "f 1/1 2/2 3/3 4/4\n");
  folder.write("m.mtl", "newmtl a\nKd 1 1 1\nKs 1 1 1\nmap_Kd p.PNG\nd 0.9\n");
  output_of({"render", "builtin:cornell", "--size", "20x10", "-o", "p.PNG"}, folder);
  folder.write("s.json", R"({"version": 1, "camera": {"eye": [0.5, 0.6, 2]}, "objects": [{"geometry": "m.obj"}],
    "lights": [{"type": "point", "position": [1, 1, 1], "range": 5}, {"type": "ambient", "color": [0.1, 0.1, 0.1]}],
    "pipeline": {"target": "rgba16f", "transparency": {"mode": "after-lights"}}})");
  for (const char* scene : {"m.obj", "s.json"}) {
    CAPTURE(scene);
    const Outcome outcome = run_command({"export", scene, "-o", "A.GLB"}, folder.path(""));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(hash_of("A.GLB", {}, folder) == hash_of(scene, {"--samples", "1"}, folder));
    output_of({"export", "A.GLB", "-o", "b.glb"}, folder);
    CHECK((contents(folder.path("b.glb")) == contents(folder.path("A.GLB"))));
  }
}

TEST_CASE("export --time writes the scene as it stands then") {
  const ScratchFolder folder;
  output_of({"export", "builtin:circle", "--time", "2", "-o", "a.glb"}, folder);
  CHECK(hash_of("a.glb", {}, folder) == hash_of("builtin:circle", {"--time", "2"}, folder));
  CHECK(hash_of("a.glb", {"--time", "5"}, folder) == hash_of("a.glb", {}, folder));
}

TEST_CASE("export -o - writes the file's bytes to standard output, and -q says nothing") {
  const ScratchFolder folder;
  const std::string said = output_of({"export", "builtin:cornell", "-o", "a.glb"}, folder);
  CHECK(said.starts_with("wrote a.glb ("));
  const Outcome outcome = run_command({"export", "builtin:cornell", "-q", "-o", "-"}, folder.path(""));
  CHECK(outcome.exit_code == 0);
  CHECK((outcome.out == contents(folder.path("a.glb"))));  // no megabyte in a failure
  CHECK(outcome.err.empty());
  CHECK(output_of({"export", "builtin:cornell", "-q", "-o", "a.glb"}, folder).empty());
}

TEST_CASE("export writes its file whole or not at all") {
  const ScratchFolder folder;
  folder.write("a.glb", "old");
  check_refused(run_command({"export", "builtin:nothing", "-o", "a.glb"}, folder.path("")), 3, "builtin:nothing");
  const Outcome full = run_command({"export", "builtin:cornell", "-q", "-o", "a.glb"}, folder.path(""), "ulimit -f 1");
  check_refused(full, 5, "a.glb");
  CHECK(contents(folder.path("a.glb")) == "old");
  CHECK(folder.entries() == std::vector<std::string>{"a.glb"});
  check_refused(run_command({"export", "builtin:cornell", "-o", "/dev/full"}), 2, "end the name in .glb");
  check_refused(run_command({"export", "builtin:cornell", "-o", "a.gltf"}), 2, "end the name in .glb");
  check_refused(run_command({"export", "builtin:cornell"}), 2, "--output");
}

// --- Geometry alone ------------------------------------------------------------------------------------------------

/// A ball as a PLY file, of one colour.
std::string ball(const std::string& color) {
  constexpr int kRings = 24, kSides = 48;
  std::string vertices, faces;
  for (int ring = 0; ring <= kRings; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const double a = 3.14159265358979 * ring / kRings, b = 6.28318530717959 * side / kSides;
      vertices += std::to_string(std::sin(a) * std::cos(b)) + ' ' + std::to_string(std::cos(a)) + ' ' +
                  std::to_string(-std::sin(a) * std::sin(b)) + ' ' + color + '\n';
      if (ring == kRings) continue;
      const int next = (side + 1) % kSides;
      faces += "4";
      for (const int corner :
           {ring * kSides + side, (ring + 1) * kSides + side, (ring + 1) * kSides + next, ring * kSides + next})
        faces += ' ' + std::to_string(corner);
      faces += '\n';
    }
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string((kRings + 1) * kSides) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty "
         "uchar blue\nelement face " +
         std::to_string(kRings * kSides) + "\nproperty list uchar int vertex_index\nend_header\n" + vertices + faces;
}

TEST_CASE("a geometry file alone is neither dark nor burnt out, whatever its colour, and stands on a ground") {
  const ScratchFolder folder;
  for (const char* color : {"255 255 255", "178 178 178", "90 60 40", "30 30 30", "12 12 12"}) {
    CAPTURE(color);
    folder.write("ball.PLY", ball(color));
    output_of({"render", "ball.PLY", "--size", "120x120", "--aov", "id.object", "-o", "a.EXR"}, folder);
    Image picture, ids;
    for (NamedImage& plane : read_planes(folder.path("a.EXR"))) {
      if (plane.name == "color") picture = std::move(plane.image);
      if (plane.name == "id.object") ids = std::move(plane.image);
    }
    double sum = 0.0;
    int model = 0, ground = 0, burnt = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 120; ++x) {
        const double id = ids.value(x, y, 0);
        ground += id == 2.0;
        if (id != 1.0) continue;
        ++model;
        sum += (picture.value(x, y, 0) + picture.value(x, y, 1) + picture.value(x, y, 2)) / 3.0;
        burnt += picture.value(x, y, 1) >= 1.0;
      }
    CHECK(model > 3000);
    CHECK(ground > 2000);
    const double mean = sum / model;
    if (std::string(color) != "12 12 12") CHECK(mean > 0.2);
    CHECK(mean > 0.12);
    CHECK(mean < 0.65);
    CHECK(burnt < model / 10);
  }
}

}  // namespace
}  // namespace trueshade
