// --samples, --background, --lights, --exposure and --tone-map, as users meet them, and what a model file gets by
// itself.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

using nlohmann::json;

/// A floor and an upright triangle of one material, and one directional light, whose node is turned by `rotation`.
std::string model_text(const std::string& rotation, double lux, const std::string& material) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
  "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": )" +
         std::to_string(lux) + R"(}]}},
  "nodes": [{"mesh": 0}, {"rotation": )" +
         rotation + R"(, "extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
  "materials": [{"doubleSided": true, "pbrMetallicRoughness": )" +
         material +
         R"(}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3",
                 "min": [-1, 0, 0], "max": [1, 1.5, 1]}],
  "bufferViews": [{"buffer": 0, "byteLength": 72}],
  "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,AACAvwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAA)"
         R"(wD8AAAAAAACAvwAAAAAAAAA/AAAAAAAAwD8AAAAAAAAAP83MTD4AAIA/"}]})";
}
constexpr const char* kFromTheFront = "[-0.2588190451, 0, 0, 0.9659258263]";
constexpr const char* kFromBehind = "[0.8191520443, 0, 0, 0.5735764364]";
constexpr const char* kClay = R"({"baseColorFactor": [0.7, 0.5, 0.4, 1], "metallicFactor": 0})";

/// Two upright triangles side by side under a light from the front: one of clay, one of metal that mirrors the light
/// past the eye.
constexpr const char* kMetalAndClay = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
  "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}},
  "nodes": [{"mesh": 0}, {"rotation": [-0.2588190451, 0, 0, 0.9659258263],
                          "extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0},
                             {"attributes": {"POSITION": 1}, "material": 1}]}],
  "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.5, 0.4, 1], "metallicFactor": 0}},
                {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.6, 1], "roughnessFactor": 0.2}}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                 "min": [-2, 0, 0], "max": [0, 2, 0]},
                {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC3",
                 "min": [0, 0, 0], "max": [2, 2, 0]}],
  "bufferViews": [{"buffer": 0, "byteLength": 72}],
  "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,AAAAwAAAAAAAAAAAAAAAAAAAAAAAAAAAAACAvwAAAEAAAAAA)"
                                      R"(AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAACAPwAAAEAAAAAA"}]})";

class Pictures {
 public:
  Pictures() {
    folder_.write("sun.gltf", model_text(kFromTheFront, 100000, kClay));
    folder_.write("lit.gltf", model_text(kFromTheFront, 3, kClay));
    folder_.write("behind.gltf", model_text(kFromBehind, 3, kClay));
    folder_.write("metal.gltf", kMetalAndClay);
    folder_.write("scene.json", R"({"version": 1, "camera": {"eye": [0, 2, 4], "target": [0, 0, 0]},
      "objects": [{"mesh": "sphere", "color": [0.8, 0.5, 0.3]}],
      "lights": [{"type": "directional", "direction": [-1, -1, -1], "color": [1.5, 1.5, 1.5]}]})");
  }

  Outcome run(const std::vector<std::string>& words) const { return run_command(words, folder_.path("")); }
  Outcome render(const std::string& scene, const std::vector<std::string>& more) const {
    std::vector<std::string> all{"render", scene, "--size", "60x45"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run(all);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return outcome;
  }
  Image picture(const std::string& scene, std::vector<std::string> more,
                const std::string& file = "picture.png") const {
    more.insert(more.end(), {"-q", "-o", file});
    render(scene, more);
    return read(file);
  }
  Image read(const std::string& file) const { return read_planes(folder_.path(file))[0].image; }
  std::string hash(const std::string& scene, const std::vector<std::string>& more) const {
    std::vector<std::string> all{"--hash", "-q"};
    all.insert(all.end(), more.begin(), more.end());
    return render(scene, all).out;
  }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  /// The same file, but that one channel of one covered pixel is a code more.
  void write_other(const std::string& name, const std::string& of) const {
    std::vector<NamedImage> planes = read_planes(folder_.path(of));
    Image color = planes[0].image;
    planes.erase(planes.begin());
    color.set_code(30, 25, 0, color.code(30, 25, 0) + 1);
    write_image(folder_.path(name), color, planes, {});
  }
  /// As another program would write it.
  void write_bare(const std::string& name, const Image& color) const { write_image(folder_.path(name), color, {}, {}); }
  std::string looks_of(const std::string& file) const {
    for (const auto& [key, value] : read_image_info(folder_.path(file)).metadata)
      if (key == "trueshade:looks") return value;
    return {};
  }

 private:
  ScratchFolder folder_;
};

/// Of all pixels whose background is another one.
int pixels_of_green(const Image& image, uint32_t least, uint32_t most) {
  int found = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const uint32_t green = image.code(x, y, 1);
      found += green >= least && green <= most ? 1 : 0;
    }
  return found;
}

std::vector<uint32_t> corner_of(const Image& image) {
  return {image.code(0, 0, 0), image.code(0, 0, 1), image.code(0, 0, 2), image.code(0, 0, 3)};
}
using Codes = std::vector<uint32_t>;

long double light_of_code(long double code) {
  return code <= 0.04045L ? code / 12.92L : std::pow((code + 0.055L) / 1.055L, 2.4L);
}

}  // namespace

TEST_CASE("The option --samples draws what post.samples of a pipeline draws, with an output that fits the target") {
  const Pictures pictures;
  pictures.write("codes.json", R"({"post": {"samples": 2, "output": "rgba8"}})");
  pictures.write("floats.json", R"({"target": "rgba16f", "post": {"samples": 3, "output": "rgba16f"}})");
  pictures.write("encoded.json", R"({"target": "srgb8_a8", "post": {"samples": 2, "encode": "srgb"}})");
  const auto same = [&](const std::vector<std::string>& options, const char* pipeline) {
    CHECK(pictures.hash("scene.json", options) == pictures.hash("scene.json", {"--pipeline", pipeline}));
  };
  same({"--samples", "4"}, "codes.json");
  same({"--samples", "9", "--target", "rgba16f"}, "floats.json");
  same({"--samples", "4", "--target", "srgb8_a8"}, "encoded.json");
  CHECK(pictures.hash("scene.json", {"--samples", "1"}) == pictures.hash("scene.json", {}));
  CHECK(pictures.hash("scene.json", {"--samples", "4"}) != pictures.hash("scene.json", {}));
  pictures.write("glow.json", R"({"post": {"bloom": {"strength": 0.5}, "output": "rgba32f"}})");
  CHECK(has(pictures.hash("scene.json", {"--samples", "4", "--pipeline", "glow.json"}), "rgba32f"));
}

TEST_CASE("A model's PNGs and pages have smooth edges, and what is to be judged has one sample a pixel") {
  const Pictures pictures;
  const auto hash = [&](const std::string& scene, std::vector<std::string> options, const std::string& file) {
    options.insert(options.end(), {"-o", file});
    return pictures.hash(scene, options);
  };
  for (const std::string file : {"a.png", "a.html"}) {
    CHECK(hash("lit.gltf", {}, file) == hash("lit.gltf", {"--samples", "4"}, file));
    CHECK(hash("lit.gltf", {}, file) != hash("lit.gltf", {"--samples", "1"}, file));
    CHECK(hash("scene.json", {}, file) == hash("scene.json", {"--samples", "1"}, file));
  }
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--preset", "gltf"}, {"--view", "normal"}}) {
    std::vector<std::string> one = options;
    one.insert(one.end(), {"--samples", "1"});
    INFO(options[0]);
    CHECK(hash("lit.gltf", options, "a.png") == hash("lit.gltf", one, "a.png"));
  }
  CHECK(hash("lit.gltf", {"--region", "8,8,20x20"}, "a.png") ==
        hash("lit.gltf", {"--region", "8,8,20x20", "--samples", "4"}, "a.png"));
  CHECK(hash("lit.gltf", {"--aov", "depth"}, "a.exr") == hash("lit.gltf", {"--samples", "1"}, "b.exr"));
  CHECK(pictures.hash("lit.gltf", {}) == hash("lit.gltf", {}, "a.png"));

  const auto big = [&](const std::string& memory) {
    std::vector<std::string> words{"render", "lit.gltf", "--size",       "2000x2000",
                                   "-o",     "big.png",  "--max-memory", memory};
    return pictures.run(words);
  };
  CHECK(big("4G").exit_code == 0);
  CHECK(has(pictures.run({"info", "big.png"}).out, R"("samples":2)"));
  const Outcome small = big("450M");  // 4 samples a pixel do not fit, and how many there are is not memory's to choose
  CHECK(small.exit_code == 4);
  CHECK(has(small.err, "name fewer --samples, or raise --max-memory"));

  pictures.picture("lit.gltf", {}, "smooth.png");
  pictures.write_other("other.png", "smooth.png");
  const Outcome outcome = pictures.run({"compare", "smooth.png", "other.png"});
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out + outcome.err, "--samples 1 draws one that has"));
}

TEST_CASE("OBJ files are lit on both faces, unless --faces keeps them as they are or their normals tell no front") {
  const Pictures pictures;
  const std::string corners = "v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\n", from_behind = "f 4//1 3//1 2//1 1//1\n";
  pictures.write("sheet.obj", corners + "vn 0 0 -1\n" + from_behind);
  pictures.write("otherwise.obj", corners + "vn 0 0 1\n" + from_behind);
  const auto seen = [](const char* eye, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--eye", eye, "--look-at", "0,1,0", "--samples", "1"});
    return more;
  };
  const char *const front = "0,1,-5", *const behind = "0,1,5";
  CHECK(pictures.hash("sheet.obj", seen(behind)) == pictures.hash("sheet.obj", seen(behind, {"--faces", "both"})));
  CHECK(pictures.hash("sheet.obj", seen(front)) == pictures.hash("sheet.obj", seen(front, {"--faces", "keep"})));
  CHECK(pictures.hash("otherwise.obj", seen(front)) ==
        pictures.hash("otherwise.obj", seen(front, {"--faces", "keep"})));
  const uint32_t lit = pictures.picture("sheet.obj", seen(behind), "both.png").code(30, 22, 1);
  CHECK(2 * lit > 3 * pictures.picture("sheet.obj", seen(behind, {"--faces", "keep"})).code(30, 22, 1));
  CHECK(has(pictures.looks_of("both.png"), "--faces both"));
  Image wrong = pictures.read("both.png");
  wrong.set_code(30, 22, 1, lit - 40);
  pictures.write_bare("other.png", wrong);
  const Outcome judged = pictures.run({"compare", "both.png", "other.png"});  // draws anew by the looks in the file
  CHECK(judged.exit_code == 1);
  CHECK(has(judged.out, "judged by the reference's scene: 1 pixel is in no legal set"));

  pictures.write("of_file.json", R"({"version": 1, "scene": "sheet.obj", "faces": "both"})");
  pictures.write("kept.json", R"({"version": 1, "scene": "sheet.obj", "faces": "keep"})");
  CHECK(pictures.hash("of_file.json", seen(behind)) == pictures.hash("kept.json", seen(behind, {"--faces", "both"})));
  CHECK(pictures.hash("of_file.json", seen(behind)) != pictures.hash("kept.json", seen(behind)));
  for (const char* scale : {"[1, 1, 1]", "[-1, 1, 1]"}) {  // one that mirrors without saying so has no known front
    INFO(scale);
    const auto scene = [&](const char* faces) {
      return R"({"version": 1, "camera": {"eye": [0, 1, -5], "target": [0, 1, 0]}, "faces": ")" + std::string(faces) +
             R"(", "objects": [{"geometry": "sheet.obj", "scale": )" + scale +
             R"(}], "lights": [{"type": "directional", "direction": [0, 0, 1]}]})";
    };
    pictures.write("both.json", scene("both"));
    pictures.write("keep.json", scene("keep"));
    CHECK(pictures.hash("both.json", {}) == pictures.hash("keep.json", {}));
  }
  CHECK(
      has(pictures.render("otherwise.obj", {"--faces", "both", "--hash"}).err, "do not tell which face is the front"));
  CHECK(pictures.hash("sheet.obj", seen(behind, {"--cache", "kept"})) == pictures.hash("sheet.obj", seen(behind)));
  CHECK(pictures.hash("sheet.obj", seen(behind, {"--cache", "kept"})) == pictures.hash("sheet.obj", seen(behind)));
}

TEST_CASE("A damaged cache file is noticed before faces or a camera are chosen by it") {
  const ScratchFolder folder;
  constexpr int kSide = 150;
  std::string text;
  for (int i = 0; i < kSide * kSide; ++i)
    text += "v " + std::to_string(i % kSide) + ' ' + std::to_string(i / kSide) + " 0." + std::to_string(i % 7) + '\n';
  for (int i = 1; i < kSide * (kSide - 1); ++i)
    if (i % kSide != 0)
      text += "f " + std::to_string(i) + ' ' + std::to_string(i + 1) + ' ' + std::to_string(i + kSide) + '\n';
  folder.write("grid.obj", text);
  std::filesystem::last_write_time(folder.path("grid.obj"),
                                   std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const Arguments faces_chosen = {"--faces", "both", "--eye", "75,75,200", "--look-at", "75,75,0"};
  const auto render = [&](const Arguments& seen) {
    return run_command(with({"render", "grid.obj", "--size", "32x24", "--hash", "--cache", "kept"}, seen),
                       folder.path(""));
  };
  const std::vector<Arguments> views = {faces_chosen, {}, {"--orbit", "30,20"}, {"--turntable", "3"}};
  std::vector<std::string> expected;
  for (const Arguments& view : views) {
    const Outcome whole = render(view);
    INFO(whole.err);
    REQUIRE(whole.exit_code == 0);
    expected.push_back(whole.out);
  }
  REQUIRE_FALSE(std::filesystem::is_empty(folder.path("kept")));
  const std::string file = std::filesystem::directory_iterator(folder.path("kept"))->path().string();
  const uint64_t size = std::filesystem::file_size(file);
  std::filesystem::copy_file(file, folder.path("whole"));
  std::vector<int> noticed(views.size());
  for (int part = 0; part < 12; ++part)
    for (size_t i = 0; i < views.size(); ++i) {
      std::filesystem::copy_file(folder.path("whole"), file, std::filesystem::copy_options::overwrite_existing);
      std::fstream(file, std::ios::binary | std::ios::in | std::ios::out)
          .seekp(int64_t(size * uint64_t(part) / 12))
          .write(std::string(size / 24, '\xff').data(), int64_t(size / 24));
      const Outcome drawn = render(views[i]);
      INFO(part << ", view " << i << ": " << drawn.err);
      if (drawn.exit_code == 0)
        CHECK(drawn.out == expected[i]);
      else
        CHECK(drawn.exit_code == 5);
      noticed[i] += int(drawn.exit_code == 5);
    }
  for (const int count : noticed) CHECK(count > 0);
}

TEST_CASE("A picture that explain is given is explained as it says that it looks, or as the file is") {
  const Pictures pictures;
  pictures.write("sheet.obj", "v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\nvn 0 0 -1\nf 4//1 3//1 2//1 1//1\n");
  const auto explained = [&](const char* picture) {
    const Outcome outcome = pictures.run({"explain", "sheet.obj", "--eye", "0,1,5", "--look-at", "0,1,0", "--size",
                                          "60x45", "--pixel", "30,22", "--against", picture});
    INFO(outcome.out << outcome.err);
    return has(outcome.out, "\"turned\"") || has(outcome.out, "turned ");
  };
  const std::vector<std::string> from_behind{"--eye", "0,1,5", "--look-at", "0,1,0", "--samples", "1"};
  pictures.picture("sheet.obj", from_behind, "ours.png");
  CHECK(explained("ours.png"));
  Image bare = pictures.read("ours.png");
  pictures.write_bare("engine.png", bare);
  CHECK_FALSE(explained("engine.png"));
}

TEST_CASE("A background is the colour that a PNG shows, whatever the target, the exposure and the curve") {
  const Pictures pictures;
  const Codes blue{0x33, 0x66, 0x99, 255};
  for (const char* target : {"rgba8", "srgb8_a8", "rgba16f", "rgba32f"}) {
    INFO(target);
    CHECK(corner_of(pictures.picture("scene.json", {"--background", "#336699", "--target", target})) == blue);
  }
  for (const char* stops : {"-7.25", "3", "auto"})
    for (const char* curve : {"clip", "filmic"}) {
      INFO(stops << ' ' << curve);
      const std::vector<std::string> options{"--background", "#336699", "--target",   "rgba16f",
                                             "--exposure",   stops,     "--tone-map", curve};
      CHECK(corner_of(pictures.picture("scene.json", options)) == blue);
      CHECK(corner_of(pictures.picture("sun.gltf", options)) == blue);
    }
  CHECK(corner_of(pictures.picture("scene.json", {"--background", "white"})) == Codes{255, 255, 255, 255});
  CHECK(corner_of(pictures.picture("scene.json", {"--background", "Teal"})) == Codes{0, 128, 128, 255});
  CHECK(corner_of(pictures.picture("scene.json", {"--background", "#36c"})) == Codes{0x33, 0x66, 0xcc, 255});
  CHECK(corner_of(pictures.picture("scene.json", {"--background", "none"})) == Codes{0, 0, 0, 0});
  const Image floats =
      pictures.picture("scene.json", {"--background", "0.5,2,0.25,0.75", "--target", "rgba32f"}, "x.exr");
  for (int c = 0; c < 4; ++c) CHECK(floats.value(0, 0, c) == std::array{0.5, 2.0, 0.25, 0.75}[size_t(c)]);
}

TEST_CASE("The option --exposure multiplies the light of a PNG, and leaves an EXR as it is") {
  const Pictures pictures;
  const std::vector<std::string> floats{"--target", "rgba32f", "--lights", "keep"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), floats.begin(), floats.end());
    return more;
  };
  const Image light = pictures.picture("scene.json", floats, "light.exr");
  CHECK(pictures.hash("scene.json", with({"--exposure", "-2"})) == pictures.hash("scene.json", floats));
  const Image exr = pictures.picture("scene.json", with({"--exposure", "-2"}), "exposed.exr");
  CHECK(exr.texels == light.texels);
  for (const char* stops : {"-2", "1"}) {
    const Image png = pictures.picture("scene.json", with({"--exposure", stops}));
    for (int y = 0; y < png.height; ++y)
      for (int x = 0; x < png.width; ++x) {
        const long double shown = std::min<long double>(light.value(x, y, 0) * std::exp2(std::stod(stops)), 1.0L);
        const long double code = png.code(x, y, 0);
        if (shown < light_of_code((code - 0.51L) / 255.0L) || shown > light_of_code((code + 0.51L) / 255.0L))
          FAIL("at " << x << ',' << y << " code " << code << " of " << double(shown));
      }
  }
  const Image codes = pictures.picture("scene.json", {}), half = pictures.picture("scene.json", {"--exposure", "-1"});
  for (int y = 0; y < codes.height; ++y)  // codes of a fixed-point target are light without a curve
    for (int x = 0; x < codes.width; ++x)
      if (std::abs(int(half.code(x, y, 0)) * 2 - int(codes.code(x, y, 0))) > 1) FAIL("at " << x << ',' << y);
}

TEST_CASE("A model under a sun in lux is not burnt, and says what was done and how to have it otherwise") {
  const Pictures pictures;
  const Outcome outcome = pictures.render("sun.gltf", {"-o", "sun.png"});
  CHECK(has(outcome.err, "of the light, under a filmic curve"));
  const Image burnt = pictures.picture("sun.gltf", {"--exposure", "0", "--background", "black"});
  const Image shown = pictures.picture("sun.gltf", {"--background", "black"});
  const int covered = pixels_of_green(burnt, 255, 255);
  CHECK(covered > 300);
  CHECK(pixels_of_green(shown, 60, 245) > covered * 9 / 10);
  CHECK(has(pictures.looks_of("sun.png"), "--exposure -"));
  CHECK(has(pictures.looks_of("sun.png"), "--tone-map filmic"));
  CHECK_FALSE(has(pictures.render("lit.gltf", {"-o", "lit.png"}).err, "filmic"));
  // The light of a sun is what --exposure auto is about, not the size of the picture.
  CHECK(pictures.run({"render", "sun.gltf", "-q", "-o", "large.png", "--size", "240x180"}).exit_code == 0);
  CHECK(pictures.looks_of("large.png") == pictures.looks_of("sun.png"));
}

TEST_CASE("A model's background is opaque, and none where a preset or a pipeline is named") {
  const Pictures pictures;
  CHECK(corner_of(pictures.picture("lit.gltf", {}))[3] == 255);
  CHECK(corner_of(pictures.picture("lit.gltf", {"--background", "none"}))[3] == 0);
  CHECK(corner_of(pictures.picture("lit.gltf", {"--preset", "gltf"}))[3] == 0);
  pictures.write("whole.json", R"({"version": 1, "scene": "lit.gltf"})");
  CHECK(corner_of(pictures.picture("whole.json", {}))[3] == 0);
}

TEST_CASE("Smooth edges of a model before no background have the model's own colour, and a share of its alpha") {
  const Pictures pictures;
  pictures.write("flat.gltf",
                 model_text(kFromTheFront, 3, kClay + std::string(R"(, "extensions": {"KHR_materials_unlit": {}})")));
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--exposure", "-1"}, {"--target", "rgba8"}, {"--samples", "16"}}) {
    std::vector<std::string> words{"--background", "none"};
    words.insert(words.end(), more.begin(), more.end());
    const Image image = pictures.picture("flat.gltf", words);
    std::vector<uint32_t> inner(3);
    int edges = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (image.code(x, y, 3) == 255)
          for (int c = 0; c < 3; ++c) inner[size_t(c)] = image.code(x, y, c);
    REQUIRE(inner[0] > 40);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        if (image.code(x, y, 3) == 0 || image.code(x, y, 3) == 255) continue;
        ++edges;
        for (int c = 0; c < 3; ++c) REQUIRE(std::abs(int(image.code(x, y, c)) - int(inner[size_t(c)])) <= 4);
      }
    CHECK(edges > 20);
  }
  // Its values are no target's, and so no judge takes them for one.
  pictures.picture("flat.gltf", {"--background", "none"}, "cut.png");
  pictures.write_other("other.png", "cut.png");
  CHECK(has(pictures.run({"compare", "cut.png", "other.png"}).out, "a transparent background has changed them"));
}

TEST_CASE("A model of PLY stands on a ground, and before a background that is asked for it does not") {
  const Pictures pictures;
  pictures.write("model.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const auto alpha_below = [&](const Image& image) { return image.code(30, image.height - 1, 3); };
  CHECK(alpha_below(pictures.picture("model.ply", {})) == 255);
  const Image cut_out = pictures.picture("model.ply", {"--background", "none"});
  CHECK(alpha_below(cut_out) == 0);
  CHECK(pixels_of_green(cut_out, 40, 255) > 100);
  CHECK(pictures.hash("model.ply", {"--lights", "three"}) == pictures.hash("model.ply", {}));
}

TEST_CASE("The option --lights keeps, adds, replaces and removes lights") {
  const Pictures pictures;
  const auto lights = [&](const std::string& scene, const std::string& choice) {
    return json::parse(pictures.render(scene, {"--json", "-q", "--lights", choice}).out)["scene"]["lights"].get<int>();
  };
  for (const char* scene : {"scene.json", "lit.gltf"}) {
    CHECK(lights(scene, "keep") == 1);
    CHECK(lights(scene, "soft") == 2);
    CHECK(lights(scene, "add") == 5);
    CHECK(lights(scene, "three") == 4);
    CHECK(lights(scene, "none") == 0);
  }
  CHECK(pictures.hash("scene.json", {"--lights", "keep"}) == pictures.hash("scene.json", {}));
  // Ours, which stand in for those that a model has none of, are as many times as bright as is asked for.
  pictures.write("slab.obj", "v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\nf 1 2 3 4\n");
  const std::string ours = pictures.hash("slab.obj", {});
  CHECK(pictures.hash("slab.obj", {"--lights", "add"}) == ours);
  CHECK(pictures.hash("slab.obj", {"--lights", "add:1"}) == ours);
  CHECK(pictures.hash("slab.obj", {"--lights", "add:2"}) != ours);
  CHECK(lights("slab.obj", "add:2") == 4);
  CHECK(pictures.hash("slab.obj", {"--lights", "soft:0"}) == ours);
  CHECK(pictures.hash("slab.obj", {"--lights", "soft:0.5"}) != ours);
  CHECK(pixels_of_green(pictures.picture("scene.json", {"--lights", "none", "--background", "black"}), 1, 255) == 0);
  CHECK(pixels_of_green(pictures.picture("scene.json", {"--lights", "three", "--background", "black"}), 40, 250) > 300);
}

TEST_CASE("A model whose lights leave it black gets light, and says so") {
  const Pictures pictures;
  const Outcome behind = pictures.render("behind.gltf", {"-o", "behind.png", "--background", "black"});
  CHECK(has(behind.err, "reach next to no surface that is seen, so lights of ours are added"));
  CHECK(pixels_of_green(pictures.read("behind.png"), 40, 255) > 300);
  CHECK(
      pixels_of_green(pictures.picture("behind.gltf", {"--background", "black", "--lights", "keep", "--exposure", "0"}),
                      1, 255) == 0);
  const Outcome metal = pictures.render("metal.gltf", {"-o", "metal.png", "--background", "black"});
  CHECK(has(metal.err, "so soft light from all sides is added"));
  CHECK(pixels_of_green(pictures.read("metal.png"), 20, 255) > 300);
  const Outcome lit = pictures.render("lit.gltf", {"-o", "lit.png"});
  CHECK_FALSE(has(lit.err, "added"));
  for (const char* scene : {"behind.gltf", "metal.gltf"})
    CHECK_FALSE(has(pictures.render(scene, {"--preset", "gltf", "-o", "x.png"}).err, "added"));
}

TEST_CASE("What a model lacks is measured through the camera that the picture is seen with") {
  const Pictures pictures;
  int added = 0;
  for (const char* side : {"0,10", "180,10"})
    added += has(pictures.render("behind.gltf", {"--orbit", side, "-o", "x.png"}).err, "are added") ? 1 : 0;
  CHECK(added == 1);  // the light shines on one of its sides
  const Outcome table =
      pictures.run({"render", "behind.gltf", "--size", "60x45", "--turntable", "2", "-o", "t_##.png"});
  CHECK(table.exit_code == 0);
  const auto lights_of = [&](const std::string& file) {
    const std::string looks = pictures.looks_of(file);
    return looks.substr(0, looks.find(" --exposure"));
  };
  CHECK(lights_of("t_00.png") == lights_of("t_01.png"));
}

TEST_CASE("Lights of ours fit a screen under an exposure that is found, and what is added has a factor") {
  const Pictures pictures;
  pictures.write(
      "dark.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n-1 0 0 9 9 9\n1 0 0 9 9 9\n0 2 0 9 9 9\n3 0 1 2\n");
  const Image plain = pictures.picture("dark.ply", {}), found = pictures.picture("dark.ply", {"--exposure", "auto"});
  CHECK(plain.texels == found.texels);
  CHECK(pictures.hash("lit.gltf", {"--lights", "add:1"}) != pictures.hash("lit.gltf", {"--lights", "add:2"}));
  CHECK(pictures.hash("lit.gltf", {"--lights", "add:0"}) == pictures.hash("lit.gltf", {"--lights", "keep"}));
}

TEST_CASE("A capture that was drawn with looks is judged by them") {
  const Pictures pictures;
  const std::string planes = "depth,position,normal,albedo,specular,emission,id.object,id.material";
  for (const char* scene : {"lit.gltf", "behind.gltf"}) {
    pictures.render(scene, {"-q", "-o", "capture.exr", "--aov", planes});
    const Outcome judged =
        pictures.run({"validate", scene, "--gbuffer", "capture.exr", "--subpixel-bits", "8", "--quick"});
    INFO(scene << judged.out << judged.err);
    CHECK(judged.exit_code == 0);
    CHECK(has(judged.out + judged.err, "as the capture says of itself, the scene is judged with --background "));
  }
}

TEST_CASE("What a picture looks like is in its file, and compare draws it again by it") {
  const Pictures pictures;
  const std::vector<std::vector<std::string>> all = {{"scene.json", "--lights", "three", "--background", "#102030"},
                                                     {"scene.json", "--lights", "add"},
                                                     {"behind.gltf"},
                                                     {"behind.gltf", "--orbit", "20,10"},
                                                     {"metal.gltf", "--lights", "soft:0.5"},
                                                     {"metal.gltf"},
                                                     {"sun.gltf"},
                                                     {"lit.gltf", "--lights", "none", "--background", "0.25,0.5,1"}};
  for (const std::vector<std::string>& words : all) {
    INFO(words[0]);
    std::vector<std::string> more(words.begin() + 1, words.end());
    more.insert(more.end(), {"-q", "--target", "rgba16f", "-o", "a.exr"});
    pictures.render(words[0], more);
    CHECK_FALSE(pictures.looks_of("a.exr").empty());
    pictures.write_other("b.exr", "a.exr");
    const Outcome judged = pictures.run({"compare", "a.exr", "b.exr"});
    INFO(judged.out << judged.err);
    CHECK(has(judged.out, "verdict     judged by the reference's scene: "));
    const bool is_black = words.size() > 2 && words[2] == "none";  // where one code more is none that OpenGL allows
    CHECK(judged.exit_code == (is_black ? 1 : 0));
    // explain ends where the picture does
    std::vector<std::string> ask(words);
    ask.insert(ask.begin(), "explain");
    ask.insert(ask.end(), {"--size", "60x45", "--target", "rgba16f", "--pixel", "30,25", "--against", "a.exr", "-q"});
    const Outcome explained = pictures.run(ask);
    CHECK(explained.exit_code == 0);
    CHECK(has(explained.out, "the same as here"));
  }
  CHECK(pictures.looks_of("a.exr") == "--background 0.25,0.5,1,1 --lights none");
  pictures.picture("scene.json", {}, "plain.png");
  CHECK(pictures.looks_of("plain.png").empty());
}

TEST_CASE("A PNG whose light was exposed is not taken for the target") {
  const Pictures pictures;
  pictures.picture("scene.json", {"--exposure", "-1"}, "half.png");
  pictures.write_other("other.png", "half.png");
  const Outcome outcome = pictures.run({"compare", "half.png", "other.png"});
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out + outcome.err, "not judged"));
  CHECK(has(outcome.out + outcome.err, "its values are not the target's"));
}

TEST_CASE("Pages show a picture as PNGs do, and frames share one exposure") {
  const Pictures pictures;
  CHECK(pictures.render("sun.gltf", {"-q", "-o", "page.html"}).exit_code == 0);
  pictures.render("sun.gltf", {"-q", "--frames", "0-1", "-o", "f.###.png"});
  CHECK(pictures.looks_of("f.000.png") == pictures.looks_of("f.001.png"));
}

TEST_CASE("Looks that mean nothing are refused before anything is drawn") {
  const Pictures pictures;
  const std::pair<std::vector<std::string>, const char*> refused[] = {
      {{"--samples", "3"}, "--samples: '3' is no number of samples that a square of them has (1, 4, 9,"},
      {{"--samples", "0"}, "--samples: '0'"},
      {{"--background", "bleu"}, "--background: 'bleu' is no colour (#rrggbb, #rgb, a basic name"},
      {{"--background", "#12345"}, "--background: '#12345'"},
      {{"--background", "#12345g"}, "--background: '#12345g'"},
      {{"--background", "1,2"}, "--background: '1,2'"},
      {{"--background", "1,2,3,4"}, "--background: '1,2,3,4'"},
      {{"--background", "1,2,3,1,1"}, "--background: '1,2,3,1,1'"},
      {{"--background", "1,-2,3"}, "--background: '1,-2,3'"},
      {{"--background", "1,2,nan"}, "--background: '1,2,nan'"},
      {{"--exposure", "bright"}, "--exposure: 'bright' is no number of stops from -40 to 40"},
      {{"--lights", "keep:2"}, "--lights: 'keep:2' is no choice with a factor"},
      {{"--lights", "add:much"}, "--lights: 'add:much' is no choice with a factor"},
      {{"--exposure", "41"}, "--exposure: '41'"},
      {{"--lights", "four"}, "--lights: there is no choice 'four'"},
      {{"--tone-map", "aces"}, "--tone-map: there is no curve 'aces'"},
      {{"--tone-map", "filmic"}, "--tone-map: the image's format rgba8 holds no light above 1"}};
  for (const auto& [options, message] : refused) {
    INFO(message);
    std::vector<std::string> words{"render", "scene.json", "-o", "x.png"};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = pictures.run(words);
    CHECK(outcome.exit_code == 2);
    CHECK(has(outcome.err, message));
  }
}

TEST_CASE("a model of the smallest or the largest units looks as it does in others, and a larger one is refused") {
  const Pictures pictures;
  const auto model = [](const std::string& size) {
    std::string text;
    for (int corner = 0; corner < 8; ++corner) {
      text += 'v';
      for (int k = 0; k < 3; ++k) text += " " + ((corner >> k & 1) != 0 ? size : "0");
      text += '\n';
    }
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  };
  pictures.write("one.obj", model("1"));
  const std::vector<std::string> on_black{"--background", "black"};  // and so on no ground
  const Image one = pictures.picture("one.obj", on_black);
  for (const char* size : {"1e-20", "1e-12", "1e16"}) {
    INFO(size);
    pictures.write("model.obj", model(size));
    const Image other = pictures.picture("model.obj", on_black);
    double difference = 0.0;
    for (int y = 0; y < one.height; ++y)
      for (int x = 0; x < one.width; ++x)
        for (int c = 0; c < 3; ++c) difference += std::fabs(double(one.code(x, y, c)) - double(other.code(x, y, c)));
    CHECK(difference / (3.0 * one.width * one.height) < 16.0);  // codes of 255: lamps shine from far away
  }
  pictures.write("model.obj", model("1e20"));
  const Outcome refused = pictures.run({"render", "model.obj", "--hash"});
  CHECK(refused.exit_code == 3);
  CHECK(has(refused.err, "line 2: x is '1e20' (a number from -1e18 to 1e18;"));
}

}  // namespace trueshade
