// Memory: what would take too much is refused before it is taken, in one line that names the option; what is drawn
// stays below the cap; and where the system gives none, the command ends in order.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/limit_options.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "core/memory_cap.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/gzipped.h"
#include "tests/programs/macro_bombs.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

/// How a run ended, and the most memory it had.
struct Run {
  Outcome outcome;
  double mib = 0;
};

Run measured(const Arguments& arguments, const ScratchFolder& folder, const std::string& input = "true") {
  std::string line = "cd '" + folder.path("") + "' && " + input + " | '" PEAK_MEMORY "' '" TRUESHADE_COMMAND "'";
  for (const std::string& argument : arguments) line += " '" + argument + "'";
  const int status = std::system((line + " >'" + folder.path("out") + "' 2>'" + folder.path("err") + "'").c_str());
  const auto content = [&](const char* name) {
    std::ifstream file(folder.path(name));
    std::stringstream text;
    text << file.rdbuf();
    std::filesystem::remove(folder.path(name));
    return text.str();
  };
  Run run{{WEXITSTATUS(status), content("out"), content("err")}, 0};
  const size_t peak = run.outcome.out.rfind("peak ");
  REQUIRE(peak != std::string::npos);
  run.mib = std::stod(run.outcome.out.substr(peak + 5)) / 1024;
  run.outcome.out.resize(peak);
  return run;
}

double mib_of_start() {
  const ScratchFolder folder;
  return measured({"list"}, folder).mib;
}

/// Refused in one line, with less than 256 MiB more than a command that does nothing.
void check_refused_early(const Arguments& arguments, const ScratchFolder& folder, int exit_code,
                         const std::string& about) {
  const Run run = measured(arguments, folder);
  check_refused(run.outcome, exit_code, about);
  CAPTURE(run.mib);
  CHECK(run.mib < mib_of_start() + 256);
}

std::string word(uint32_t value) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) text += char(value >> shift);
  return text;
}

std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string content = type + data;
  return word(uint32_t(data.size())) + content +
         word(uint32_t(crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size()))));
}

/// A black PNG of RGB, a thousandth as long as its texels.
std::string black_png(uint32_t side) {
  const std::string rows(size_t(side) * (3 * side + 1), '\0');
  uLongf size = compressBound(uLong(rows.size()));
  std::string packed(size, '\0');
  REQUIRE(compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                    uLong(rows.size()), 1) == Z_OK);
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", word(side) + word(side) + std::string("\x08\x02\0\0\0", 5)) +
         png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

TEST_CASE("small files that would take gigabytes are refused early, by the name of a limit") {
  const ScratchFolder folder;
  std::string patterns;
  for (int i = 0; i < 12; ++i)
    patterns += std::string(i == 0 ? "" : ",") + R"({"name": "t)" + std::to_string(i) +
                R"(", "pattern": {"type": "checker", "format": "rgba32f", "size": [16384, 16384]}})";
  folder.write("patterns.json", R"({"version": 1, "textures": [)" + patterns + "]}");
  check_refused_early({"render", "patterns.json", "--hash", "--max-texture-memory", "3G"}, folder, 4,
                      "patterns.json: /textures/0/pattern: with its 4294967296 bytes the textures are over the limit "
                      "(at most 3221225472 bytes in all, or a higher --max-texture-memory)");
  folder.write("p.json", R"({"width": 4096, "height": 4096, "post": {"samples": 8, "bloom": {"strength": 1}}})");
  check_refused_early({"render", "builtin:cornell", "--pipeline", "p.json", "--hash", "--max-memory", "8G"}, folder, 4,
                      "raise --max-memory");
  folder.write("grid.json", R"({"version": 1, "objects": [{"mesh": "cube", "grid": {"count": [256, 256, 200], )"
                            R"("spacing": 1}}]})");
  check_refused_early({"render", "grid.json", "--hash", "--max-memory", "1G"}, folder, 4, "/objects/0/grid");
  folder.write("m.ply.gz", gzipped("ply\nformat binary_little_endian 1.0\nelement vertex 16000000\nproperty float x\n"
                                   "property float y\nproperty float z\nelement face 0\nproperty list uchar int "
                                   "vertex_indices\nend_header\n" +
                                   std::string(size_t(192) << 20, '\0')));
  check_refused_early({"info", "m.ply.gz"}, folder, 4, "--max-expansion");
  folder.write("black.png", black_png(8192));
  check_refused_early({"info", "black.png"}, folder, 4, "--max-expansion");
}

TEST_CASE("standard input takes its own size and a chunk's, and is refused where that is over a limit") {
  const ScratchFolder folder;
  constexpr double kChunk = 64, kRest = 16;  // MiB
  const auto sent = [&](int mib, const Arguments& limits) {
    Arguments arguments{"render", "-", "--hash"};
    arguments.insert(arguments.end(), limits.begin(), limits.end());
    const Run run = measured(arguments, folder, "head -c " + std::to_string(mib) + "M /dev/zero");
    CAPTURE(run.mib, run.outcome.err);
    return run;
  };
  const Run whole = sent(300, {});
  check_refused(whole.outcome, 3, "its first bytes are neither of JSON nor of glTF, GLB or PLY");
  CHECK(whole.mib > 300);
  CHECK(whole.mib < mib_of_start() + 300 + kChunk + kRest);
  const Run over_file = sent(600, {"--max-file", "300M"});
  check_refused(over_file.outcome, 4, "more bytes come than the limit");
  CHECK(over_file.mib < mib_of_start() + 300 + kChunk + kRest);
  const Run over_memory = sent(600, {"--max-memory", "300M"});
  check_refused(over_memory.outcome, 4, "raise --max-memory");
  CHECK(over_memory.mib < 300 + kRest);
}

/// Refused in one line, within a second of CPU time.
void check_refused_without_work(const Arguments& arguments, const ScratchFolder& folder, const std::string& about) {
  check_refused(run_command(arguments, folder.path(""), "ulimit -t 1"), 4, about);
}

TEST_CASE("what a short file asks for is added up before the first of it is made") {
  const ScratchFolder folder;
  const auto pattern = [](const std::string& name) {
    return R"({"name": ")" + name + R"(", "pattern": {"type": "noise", "format": "rgba32f", "size": [16384, 8192]}})";
  };
  const std::string eye = R"({"version": 1, "camera": {"eye": [0, 1, 5]}, )";
  folder.write("patterns.json",
               eye + R"("textures": [)" + pattern("a") + "," + pattern("b") + "," + pattern("c") + "]}");
  check_refused_without_work({"render", "patterns.json", "--hash", "--max-memory", "32G"}, folder,
                             "patterns.json: /textures/2/pattern: with its 2147483648 bytes the textures are over");
  check_refused_without_work({"render", "patterns.json", "--hash", "--max-memory", "3G"}, folder,
                             "patterns.json: /textures/1/pattern: the texture needs 4096 MiB");
  folder.write("levels.json",
               eye + R"("textures": [)" + pattern("a") + "," + pattern("b").replace(0, 0, "") +
                   R"(], "materials": [{"name": "m", "color": [1, 1, 1], "color_map": {"texture": "a"}}]})");
  check_refused_without_work({"render", "levels.json", "--hash", "--max-memory", "32G"}, folder,
                             "levels.json: /materials:");
  const std::string grid = R"({"mesh": "cube", "grid": {"count": [4096, 4096, 1], "spacing": 1})",
                    steps = R"(, "steps": [{"time": 0, "position": [0, 0, 0]}, {"time": 1, "position": [1, 0, 0]}])";
  folder.write("grids.json", R"({"version": 1, "objects": [)" + grid + "}," + grid + "}]}");
  check_refused_without_work({"info", "grids.json"}, folder,
                             "grids.json: /objects/1/grid: the objects are over the limit");
  folder.write("moving.json", R"({"version": 1, "objects": [)" + grid + steps + "}]}");
  check_refused_without_work({"info", "moving.json", "--max-memory", "6G"}, folder, "moving.json: /objects/0/grid:");
}

/// A glTF file of a triangle that is drawn as `rest` says.
std::string triangle_gltf(const std::string& accessors, const std::string& rest) {
  return R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
         R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}], "bufferViews": [{"buffer": 0, "byteLength": 36}], )"
         R"("accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"})" +
         accessors + "], " + rest + "}";
}

/// `count` elements with commas between, made by `element(i)`.
template <typename Element>
std::string list_of(int count, const Element& element) {
  std::string list;
  for (int i = 0; i < count; ++i) list += (i > 0 ? "," : "") + element(i);
  return list;
}

TEST_CASE("glTF files that name much are refused before geometry is read and pictures are decoded") {
  const ScratchFolder folder;
  const std::string primitive = R"({"attributes": {"POSITION": 0}})", node = R"({"mesh": 0})";
  const auto of_each = [](const std::string& text) { return [&text](int) { return text; }; };
  folder.write("nodes.gltf", triangle_gltf("", R"("meshes": [{"primitives": [)" + list_of(300, of_each(primitive)) +
                                                   R"(]}], "nodes": [)" + list_of(20000, of_each(node)) + "]"));
  check_refused_early({"info", "nodes.gltf", "--max-memory", "200M"}, folder, 4, "--max-memory");
  const std::string many_zeros = R"(, {"componentType": 5126, "count": 100000000, "type": "VEC3"})";
  folder.write("zeros.gltf",
               triangle_gltf(many_zeros, R"("meshes": [{"primitives": [{"attributes": {"POSITION": 1}}]}],)"
                                         R"("nodes": [{"mesh": 0}])"));
  check_refused_early({"info", "zeros.gltf"}, folder, 4, "/accessors/1");
  folder.write("copies.gltf",
               triangle_gltf(R"(, {"componentType": 5126, "count": 1700000, "type": "VEC3"})",
                             R"("meshes": [{"primitives": [)" + list_of(5, of_each(primitive)) +
                                 R"(]}], "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": )"
                                 R"({"attributes": {"TRANSLATION": 1}}}}], "images": [{"uri": "none.png"}])"));
  check_refused_early({"info", "copies.gltf"}, folder, 5, "none.png");
  constexpr int kPictures = 17;
  const std::string picture = black_png(4096);
  for (int i = 0; i < kPictures; ++i)
    folder.write(std::to_string(i) + ".png", i + 1 < kPictures ? picture : picture.substr(0, picture.size() / 2));
  const auto numbered = [](const std::string& before, const std::string& after) {
    return [before, after](int i) { return before + std::to_string(i) + after; };
  };
  const std::string material = R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": )";
  folder.write(
      "pictures.gltf",
      triangle_gltf(
          R"(, {"componentType": 5126, "count": 3, "type": "VEC2"})",
          R"("nodes": [{"mesh": 0}], "meshes": [{"primitives": [)" +
              list_of(kPictures, numbered(R"({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": )", "}")) +
              R"(]}], "materials": [)" + list_of(kPictures, numbered(material, "}}}")) + R"(], "textures": [)" +
              list_of(kPictures, numbered(R"({"source": )", "}")) + R"(], "images": [)" +
              list_of(kPictures, numbered(R"({"uri": ")", R"(.png"})")) + "]"));
  check_refused_early({"info", "pictures.gltf"}, folder, 3, "/images/16: byte 33: a PNG chunk is longer than the file");
}

TEST_CASE("an EXR whose lengths are beyond its bytes is refused before OpenEXR sees it") {
  const ScratchFolder folder;
  const auto little = [](uint32_t value) {
    std::string text;
    for (int shift = 0; shift < 32; shift += 8) text += char(value >> shift);
    return text;
  };
  const auto attribute = [&](const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + little(uint32_t(value.size())) + value;
  };
  const std::string start = "\x76\x2f\x31\x01" + little(2),
                    channels = attribute("channels", "chlist",
                                         std::string("R\0", 2) + little(2) + little(0) + little(1) + little(1) + '\0'),
                    compression = attribute("compression", "compression", std::string(1, '\0'));
  const auto window = [&](uint32_t side) { return little(0) + little(0) + little(side - 1) + little(side - 1); };
  const auto refused = [&](const std::string& file, int code, const std::string& about) {
    folder.write("x.exr", file);
    check_refused_early({"info", "x.exr"}, folder, code, about);
  };
  refused(start + "note" + '\0' + "string" + '\0' + little(0x7fffffff) + "short", 3, "longer than the file");
  refused(start + attribute("preview", "preview", little(0x4000) + little(0x8000)), 3, "preview");
  refused(start + attribute("ids", "idmanifest", little(0x7fffffff) + "x"), 3, "manifest");
  refused(start + channels + compression + attribute("dataWindow", "box2i", window(0x7fffffff)) + '\0', 4, "1048576");
  refused(start + channels + compression + attribute("dataWindow", "box2i", window(60000)) + '\0', 3,
          "the EXR ends before its pixels do");
  refused(start + channels + '\0', 3, "no channels, window or compression");
  refused("\x76\x2f\x31\x01" + little(2 | 0x1000) + std::string(100, '\0'), 3, "several parts");
  refused("\x76\x2f\x31\x01" + little(2 | 0x800) + std::string(100, '\0'), 3, "deep");
}

TEST_CASE("frames take what is predicted, within a fifth, and are refused where that is over the cap") {
  const ScratchFolder folder;
  folder.write("post.json", R"({"post": {"samples": 2, "bloom": {"strength": 1}}})");
  folder.write("grid.json",
               R"({"version": 1, "camera": {"eye": [0, 0, 90], "target": [0, 0, 0]}, "objects": [{"mesh": )"
               R"("cube", "grid": {"count": [100, 100, 60], "spacing": 1}}]})");
  const std::vector<Arguments> frames = {
      {"render", "builtin:cornell", "--size", "6000x6000", "--hash"},
      {"render", "builtin:cornell", "--size", "3000x3000", "--target", "rgba32f", "--hash"},
      {"render", "builtin:cornell", "--size", "2000x2000", "--pipeline", "post.json", "--hash"},
      {"render", "builtin:cornell", "--size", "4000x4000", "--view", "normal", "--hash"},
      {"render", "grid.json", "--size", "64x64", "--hash"}};
  for (Arguments arguments : frames) {
    const double peak = measured(arguments, folder).mib;
    CAPTURE(arguments[1], arguments[3], peak);
    const auto with_cap = [&](double mib) {
      Arguments capped = arguments;
      capped.insert(capped.end(), {"--max-memory", std::to_string(int(mib)) + 'M'});
      return measured(capped, folder);
    };
    const Run below = with_cap(peak / 1.2);
    CHECK(below.outcome.exit_code == 4);
    CHECK(below.outcome.err.find("--max-memory") != std::string::npos);
    const Run above = with_cap(peak * 1.2);
    CAPTURE(above.outcome.err);
    CHECK(above.outcome.exit_code == 0);
    CHECK(above.mib <= peak * 1.2 + 64);
  }
}

/// What a run is predicted to have in all, MiB: the error over a cap that nothing stays below says so.
double predicted_mib(Arguments arguments, const ScratchFolder& folder) {
  arguments.insert(arguments.end(), {"--max-memory", "1M"});
  const Outcome outcome = run_command(arguments, folder.path(""));
  check_refused(outcome, 4, "drawing it needs ");
  double more = 0, used = 0;
  const size_t at = outcome.err.find("drawing it needs ");
  REQUIRE(at != std::string::npos);
  REQUIRE(std::sscanf(outcome.err.c_str() + at, "drawing it needs %lf MiB besides the %lf MiB", &more, &used) == 2);
  return more + used;
}

/// The prediction over what was measured; 1 where both are within 8 MiB, which is what small frames take by chance.
double predicted_share(const Arguments& arguments, const ScratchFolder& folder) {
  const double predicted = predicted_mib(arguments, folder);
  const Run run = measured(arguments, folder);
  CAPTURE(run.outcome.err);
  REQUIRE(run.outcome.exit_code == 0);
  std::string line;
  for (const std::string& argument : arguments) line += argument + ' ';
  const double share = predicted / run.mib;
  std::printf("%s: %.0f MiB predicted, %.0f MiB measured, %.2f\n", line.c_str(), predicted, run.mib, share);
  return std::fabs(predicted - run.mib) < 8 ? 1 : share;
}

TEST_CASE("30 frames and their files take what is predicted, within a quarter, and no more than a cap above it",
          "[long]") {
  const ScratchFolder folder;
  folder.write("post.json", R"({"post": {"samples": 2, "bloom": {"strength": 1}}})");
  std::vector<Arguments> runs;
  const auto add = [&](const char* scene, const char* size, const Arguments& more) {
    runs.push_back({"render", scene, "--size", size});
    runs.back().insert(runs.back().end(), more.begin(), more.end());
  };
  const Arguments planes{"-o", "x.exr", "--aov", "depth,position,normal,albedo"};
  for (const char* scene : {"builtin:cornell", "builtin:city", "builtin:lecture"}) {
    for (const char* size : {"1500x1500", "3000x2000", "5000x4000"}) {
      add(scene, size, {"--hash"});
      add(scene, size, {"-o", "x.png"});
    }
    add(scene, "3000x2000", {"-o", "x.exr"});
    add(scene, "2500x2000", planes);
    add(scene, "2000x2000", {"-o", "x.html"});
  }
  add("builtin:city", "3000x2000", {"--target", "rgba16f", "-o", "x.exr"});
  add("builtin:cornell", "2000x2000", {"--pipeline", "post.json", "-o", "x.png"});
  add("builtin:city", "3000x3000", {"-o", "x.html", "-o", "x.exr", "-o", "x.png"});
  REQUIRE(runs.size() == 30);
  for (Arguments arguments : runs) {
    CAPTURE(arguments);
    const double share = predicted_share(arguments, folder);
    CHECK(share > 0.8);
    CHECK(share < 1.25);
    const double cap = std::ceil(predicted_mib(arguments, folder)) + 2;
    arguments.insert(arguments.end(), {"--max-memory", std::to_string(int(cap)) + 'M'});
    const Run run = measured(arguments, folder);
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.mib <= cap + 64);
  }
}

TEST_CASE("validate takes what is predicted, within a third", "[long]") {
  const ScratchFolder folder;
  if (run_command({"validate", "builtin:cornell", "--size", "32x32", "--quick"}).exit_code == 7) {
    WARN("SKIPPED: there is no OpenGL driver");
    return;
  }
  for (const char* scene : {"builtin:cornell", "builtin:sphere", "builtin:city", "builtin:circle"})
    for (const char* size : {"320x240", "640x480", "960x720"}) {
      const Arguments arguments{"validate", scene, "--size", size, "--quick"};
      CAPTURE(arguments);
      const double share = predicted_share(arguments, folder);
      CHECK(share > 0.75);
      CHECK(share < 1.34);
    }
}

TEST_CASE("a file that compresses worse than predicted is refused while it is made, and is not there", "[slow]") {
  const ScratchFolder folder;
  Image noise(3200, 3200, Format::rgba16);  // 78 MiB
  uint32_t random = 1;
  for (uint8_t& code : noise.texels) code = uint8_t((random = random * 1664525u + 1013904223u) >> 24);
  for (const char* name : {"x.png", "x.exr"}) {
    const std::string path = folder.path(name);
    set_memory_cap(resident_memory() + (uint64_t(40) << 20));
    try {
      write_image(path, noise, {}, {});
      FAIL("78 MiB of noise fit into 40");
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::limit);
      CHECK_THAT(error.what(), Catch::StartsWith(path + ": the file needs "));
    }
    CHECK(resident_memory() < memory_cap() + (uint64_t(64) << 20));
    set_memory_cap(0);
    CHECK(folder.entries().empty());
  }
}

TEST_CASE("light programs whose macros grow beyond all bounds are refused early") {
  const ScratchFolder folder;
  for (const auto& [name, text] : macro_bombs()) {
    INFO(name);
    folder.write("bomb.glsl", text);
    check_refused_early({"render", "builtin:cornell", "--size", "8x8", "--hash", "--light-shader", "bomb.glsl"}, folder,
                        4, "bomb.glsl: has macros that grow beyond all bounds");
  }
}

TEST_CASE("limits of light programs have options that their errors name, and that let them pass") {
  const ScratchFolder folder;
  folder.write("loop.glsl",
               "vec3 light(Surface s, Light l, View v) {\n  float a = s.albedo.r;\n"
               "  for (int i = 0; i < 3000; ++i) a = a * a + 0.5;\n  return vec3(a);\n}\n");
  const auto with = [&](const Arguments& more) {
    Arguments all{"render", "builtin:cornell", "--size", "8x8", "--hash", "--light-shader", "loop.glsl"};
    all.insert(all.end(), more.begin(), more.end());
    return run_command(all, folder.path(""));
  };
  check_refused(with({}), 4, "--max-loop-trips");
  check_refused(with({"--max-loop-trips", "2999"}), 4, "--max-loop-trips");
  CHECK(with({"--max-loop-trips", "3000"}).exit_code == 0);
  check_refused(with({"--max-loop-trips", "3000", "--max-program-nodes", "5000"}), 4, "--max-program-nodes");
  for (const char* const command : {"view", "explain", "shade", "glsl"})
    CHECK_THAT(run_command({command, "--help-limits"}).out, Catch::Contains("--max-loop-trips"));
}

TEST_CASE("every limit has an option, which is checked, and which its error names") {
  const ScratchFolder folder;
  for (const LimitOption& limit : limit_options()) {
    for (const char* bad : {"0", "-1", "many", "", "1.5", "99999999999999999999", "4X"})
      check_refused(run_command({"info", "builtin:cornell", limit.name, bad}), 2, limit.name);
    const bool bytes = limit.unit == LimitOption::Unit::bytes;
    CHECK(limit_from_text(limit, "7") == 7);
    if (bytes) CHECK(limit_from_text(limit, "3G") == uint64_t(3) << 30);
    for (const char* command : {"render", "info", "validate", "bench"})
      CHECK(run_command({command, "--help-limits"}).out.find(limit.name) != std::string::npos);
  }
  const auto refused = [&](const std::string& scene, const std::string& option, const std::string& value) {
    check_refused(run_command({"info", scene, option, value}, folder.path("")), 4, option);
  };
  folder.write("s.json",
               R"({"version": 1, "objects": [{"mesh": "cube", "grid": {"count": [2, 2, 1], "spacing": 1}}]})");
  folder.write("g.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{"children": [1]}, {"children": [2]}, {}], )"
                         R"("scenes": [{"nodes": [0]}], "buffers": [{"byteLength": 3, "uri": "data:application/)"
                         R"(octet-stream;base64,AAAA"}]})");
  refused("builtin:city,lights=9", "--max-lights", "8");
  refused("s.json", "--max-instances", "3");
  refused("s.json", "--max-json", "20");
  refused("g.gltf", "--max-file", "20");
  refused("g.gltf", "--max-nodes", "2");
  refused("g.gltf", "--max-node-depth", "2");
  refused("g.gltf", "--max-buffer-memory", "2");
}

TEST_CASE("wherever memory ends, the command ends in order") {
  const ScratchFolder folder;
  folder.write("s.json",
               R"({"version": 1, "objects": [{"mesh": "rabbit", "grid": {"count": [20, 20, 2], "spacing": 1}}]})");
  int drawn = 0, out_of_memory = 0;
  // The program has 17 MB; where the system cannot map these, it ends the process by a signal.
  for (int mb = 24; mb <= 400; mb += mb < 120 ? 8 : 40) {
    const Outcome outcome = run_command({"render", "s.json", "--size", "200x200", "--hash", "--threads", "4"},
                                        folder.path(""), "ulimit -v " + std::to_string(mb * 1024));
    CAPTURE(mb, outcome.exit_code, outcome.err);
    if (outcome.exit_code == 127) continue;  // the system's loader had no memory for the libraries
    drawn += outcome.exit_code == 0, out_of_memory += outcome.exit_code == 6;
    CHECK((outcome.exit_code == 0 || outcome.exit_code == 6));
    if (outcome.exit_code == 6) check_refused(outcome, 6, "memory");
  }
  CHECK(drawn > 0);
  CHECK(out_of_memory > 0);
}

TEST_CASE("whichever allocation is the last, and none succeeds after it, the command says so in one line") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  WARN("SKIPPED: sanitizers bring an allocator of their own");
#else
  const ScratchFolder folder;
  int drawn = 0, refused = 0;
  for (int last = 0; last < 16000; last += last < 8 ? 1 : last < 1000 ? 97 : 331) {
    const Outcome outcome =
        run_command({"render", "builtin:cornell", "--size", "64x64", "--threads", "2", "-o", "x.png"}, folder.path(""),
                    "export LD_PRELOAD='" FAIL_ALLOCATIONS "' TRUESHADE_ALLOCATIONS=" + std::to_string(last));
    CAPTURE(last, outcome.exit_code, outcome.err);
    if (outcome.exit_code == 125) continue;  // timeout, which starts the command, had not enough
    // Where glibc has no memory to register a destructor of a thread, glibc ends the process, and we are not asked.
    if (outcome.err.starts_with("Fatal glibc error")) continue;
    CHECK((outcome.exit_code == 0 || outcome.exit_code == 6));
    drawn += outcome.exit_code == 0, refused += outcome.exit_code == 6;
    if (outcome.exit_code != 6) continue;
    CHECK(outcome.err.starts_with("trueshade: error: memory: "));
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    const std::vector<std::string> left =
        folder.entries();  // the picture may be whole already, and nothing else is there
    CHECK((left.empty() || left == std::vector<std::string>{"x.png"}));
  }
  CHECK(drawn > 0);
  CHECK(refused > 10);
#endif
}

}  // namespace
}  // namespace trueshade
