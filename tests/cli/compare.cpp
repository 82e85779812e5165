// `trueshade compare`, run as people run it.
#include <OpenImageIO/imageio.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/image_files/image_io.h"
#include "scenes/scene.h"
#include "tests/catch.hpp"
#include "tests/cli/engine_capture.h"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

EnginePlane even_plane(int width, int height, int channels, double value) {
  return {width, height, channels, std::vector<double>(size_t(width * height * channels), value)};
}

/// Pictures of floats as another program writes them; NaN and infinities as they are.
void write_floats(const std::string& path, const EnginePlane& plane, std::vector<std::string> names,
                  OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT) {
  OIIO::ImageSpec spec(plane.width, plane.height, plane.channels, type);
  spec.channelnames = std::move(names);
  const std::vector<float> values(plane.values.begin(), plane.values.end());
  const auto output = OIIO::ImageOutput::create(path);
  REQUIRE(output);
  REQUIRE(output->open(path, spec));
  REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  REQUIRE(output->close());
}
const std::vector<std::string> kRgb = {"R", "G", "B"};

bool says(const Outcome& outcome, const std::string& text) {
  INFO(outcome.out << outcome.err);
  const bool found = outcome.out.find(text) != std::string::npos;
  CHECK(found);
  return found;
}

Outcome run_compare(const ScratchFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "compare");
  return run_command(arguments, folder.path(""));
}

/// Two floats pictures of 60x40 that differ as `change` makes the second.
template <typename Change>
ScratchFolder& with_pair(ScratchFolder& folder, Change change) {
  EnginePlane plane = even_plane(60, 40, 3, 0.25);
  write_floats(folder.path("ref.exr"), plane, kRgb);
  change(plane);
  write_floats(folder.path("test.exr"), plane, kRgb);
  return folder;
}

}  // namespace

TEST_CASE("pictures that fool idiff and FLIP's tool are refused: NaN for 0, Inf for 0, a run of 50 NaN") {
  const auto put = [](double value, int from, int count) {
    return [=](EnginePlane& plane) {
      for (int x = from; x < from + count; ++x)
        for (int c = 0; c < 3; ++c) plane.at(x, 7, c) = value;
    };
  };
  const std::vector<std::vector<std::string>> criteria = {{},
                                                          {"--max-difference", "1e30"},
                                                          {"--pixels", "1000000", "--delta", "1"},
                                                          {"--flip", "1"},
                                                          {"--allow-nonfinite"}};
  for (const auto& [value, count] :
       {std::pair(kNan, 1), std::pair(kInf, 1), std::pair(-kInf, 1), std::pair(kNan, 50)}) {
    ScratchFolder folder;
    with_pair(folder, put(value, 3, count));
    for (std::vector<std::string> arguments : criteria) {
      arguments.insert(arguments.begin(), {"ref.exr", "test.exr"});
      const Outcome outcome = run_compare(folder, arguments);
      CHECK(outcome.exit_code == 1);
      says(outcome, count == 1 ? "1 pixel has an infinity or NaN that is another value"
                               : "50 pixels have an infinity or NaN that is another value");
      says(outcome, "at 3,7, from the top left");
      says(outcome, std::isnan(value) ? "nan" : "inf");
    }
  }
}

TEST_CASE("NaN and infinities that both pictures have fail as well, unless --allow-nonfinite lets them pass") {
  ScratchFolder folder;
  with_pair(folder, [](EnginePlane& plane) { plane.at(5, 6, 1) = kNan; });
  std::filesystem::copy(folder.path("test.exr"), folder.path("same.exr"));
  const Outcome outcome = run_compare(folder, {"test.exr", "same.exr"});
  CHECK(outcome.exit_code == 1);
  says(outcome, "1 pixel has an infinity or NaN, the same in both pictures");
  says(outcome, "first pixel that is not finite at 5,6");
  CHECK(run_compare(folder, {"test.exr", "same.exr", "--allow-nonfinite"}).exit_code == 0);
}

TEST_CASE("sizes, parts, channels and a missing alpha fail by default, each with a line that says what") {
  const ScratchFolder folder;
  const EnginePlane small = even_plane(8, 8, 3, 0.5), wide = even_plane(9, 8, 3, 0.5), rgba = even_plane(8, 8, 4, 0.5),
                    grey = even_plane(8, 8, 1, 0.5), other = even_plane(8, 8, 1, 0.75);
  write_floats(folder.path("small.exr"), small, kRgb);
  write_floats(folder.path("wide.exr"), wide, kRgb);
  write_floats(folder.path("rgba.exr"), rgba, {"R", "G", "B", "A"});
  write_floats(folder.path("named.exr"), small, {"R", "G", "Z"});
  write_exr_parts(folder.path("two.exr"), {{"a", {"R"}, "float", &grey}, {"b", {"R"}, "float", &grey}});
  write_exr_parts(folder.path("second.exr"), {{"a", {"R"}, "float", &grey}, {"b", {"R"}, "float", &other}});
  write_exr_parts(folder.path("one.exr"), {{"a", {"R"}, "float", &grey}});
  const std::vector<std::array<std::string, 3>> rows = {
      {"small.exr", "wide.exr", "the size is 8x8 in the reference and 9x8 in the test"},
      {"rgba.exr", "small.exr", "the test has no alpha (channel A)"},
      {"small.exr", "rgba.exr", "the reference has no alpha (channel A)"},
      {"small.exr", "named.exr", "the test has no channel B"},
      {"two.exr", "one.exr", "the test has no part 'b'"},
      {"one.exr", "two.exr", "the reference has no part 'b'"},
      {"two.exr", "second.exr", "at 0,0 of part b, from the top left"}};
  for (const auto& [reference, test, line] : rows) {
    const Outcome outcome = run_compare(folder, {reference, test});
    CHECK(outcome.exit_code == 1);
    says(outcome, line);
  }
  CHECK(run_compare(folder, {"small.exr", "wide.exr", "--max-difference", "1"}).exit_code == 1);
}

TEST_CASE("the first and the worst pixel are shown with both values, from the top left") {
  ScratchFolder folder;
  with_pair(folder, [](EnginePlane& plane) { plane.at(59, 0, 0) = 0.375, plane.at(0, 39, 2) = -0.5; });
  const Outcome outcome = run_compare(folder, {"ref.exr", "test.exr"});
  CHECK(outcome.exit_code == 1);
  says(outcome, "verdict     the pictures differ: 2 of 2400 pixels differ, by 0.75 at most");
  says(outcome, "first pixel at 59,0, from the top left");
  says(outcome, "worst pixel at 0,39, from the top left");
  says(outcome, "0.375");
  says(outcome, "-0.5");
  const auto json = nlohmann::json::parse(run_compare(folder, {"ref.exr", "test.exr", "--json"}).out);
  CHECK(json.at("outcome") == "different");
  CHECK(json.at("passes") == false);
  CHECK(json.at("unequal_pixels") == 2);
  CHECK(json.at("first").at("x") == 59);
  CHECK(json.at("worst").at("y") == 39);
  CHECK(json.at("worst").at("values").at(2).at("test") == "-0.5");
  CHECK(json.at("channels").at(2).at("largest") == 0.75);
}

TEST_CASE("one picture is the same in every format that holds its values") {
  const ScratchFolder folder;
  EnginePlane plane = even_plane(24, 10, 3, 0.0);
  for (size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = double(i % 9) / 8.0;  // halves
  write_floats(folder.path("float.exr"), plane, kRgb);
  write_floats(folder.path("half.exr"), plane, kRgb, OIIO::TypeDesc::HALF);
  write_exr_parts(folder.path("tiled.exr"), {{"", kRgb, "float", &plane}}, 16);
  write_npy(folder.path("floats.npy"), plane, "<f4");
  write_npy(folder.path("big.npy"), plane, ">f8", true);
  write_tiff(folder.path("float.tif"), plane, "float", "zip");
  for (const char* test : {"half.exr", "tiled.exr", "floats.npy", "big.npy", "float.tif"}) {
    const Outcome outcome = run_compare(folder, {"float.exr", test});
    INFO(test << outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
  }
}

TEST_CASE("a PNG and an EXR of one target are the same, a float target's PNG is decoded, and that is said") {
  const ScratchFolder folder;
  REQUIRE(run_command({"render", "builtin:cornell", "--size", "48x32", "-o", "codes.png", "-o", "codes.exr"},
                      folder.path(""))
              .exit_code == 0);
  REQUIRE(run_command({"render", "builtin:cornell", "--size", "48x32", "--target", "rgba16f", "-o", "light.png", "-o",
                       "light.exr"},
                      folder.path(""))
              .exit_code == 0);
  CHECK(run_compare(folder, {"codes.exr", "codes.png"}).exit_code == 0);
  const Outcome decoded = run_compare(folder, {"light.exr", "light.png", "--no-judge"});
  says(decoded, "the test is sRGB and was decoded, as the other is linear light");
}

TEST_CASE("where the reference carries its scene, pictures are judged by it, and a fault is named") {
  const ScratchFolder folder;
  folder.write("scene.json", R"({"version": 1, "camera": {"eye": [0, 3, 4], "target": [0, 0, 0]},
    "objects": [{"mesh": "plane", "color": [0.8, 0.7, 0.6], "scale": 10}],
    "lights": [{"type": "point", "position": [0, 2, 0], "color": [1, 1, 1], "intensity": 0.8, "range": 6}]})");
  std::string dim = contents(folder.path("scene.json"));
  dim.replace(dim.find("0.8, \"range\""), 3, "0.4");
  folder.write("dim.json", dim);
  const auto render = [&](const std::string& scene, const std::string& output) {
    REQUIRE(run_command({"render", scene, "--size", "64x48", "-o", output, "-q"}, folder.path("")).exit_code == 0);
  };
  render("scene.json", "ref.png");
  render("dim.json", "test.png");
  const Outcome wrong = run_compare(folder, {"ref.png", "test.png"});
  CHECK(wrong.exit_code == 1);
  says(wrong, "verdict     judged by the reference's scene: ");
  says(wrong, "are in no legal set (lighting ");
  says(wrong, "looks like  light");
  CHECK(nlohmann::json::parse(run_compare(folder, {"ref.png", "test.png", "--json"}).out).contains("judged"));

  const Outcome plain = run_compare(folder, {"ref.png", "test.png", "--no-judge"});
  CHECK(plain.exit_code == 1);
  CHECK(plain.out.find("judged") == std::string::npos);
  CHECK(run_compare(folder, {"ref.png", "test.png", "--max-difference", "254/255"}).exit_code ==
        0);  // a criterion: no judge

  folder.write("scene.json", dim);  // the reference's scene is another one now
  const Outcome changed = run_compare(folder, {"ref.png", "test.png"});
  CHECK(changed.exit_code == 1);
  says(changed, "not judged  the reference's scene: scene.json is another scene today");
  std::filesystem::remove(folder.path("scene.json"));
  says(run_compare(folder, {"ref.png", "test.png"}), "not judged  ");
}

TEST_CASE(
    "a picture's metadata opens no file out of its folder and the working one, and quotes none that is no scene") {
  const ScratchFolder folder;
  const std::string secret = R"({"the_secret_key": 1})", scene = R"({"version": 1, "objects": [{"mesh": "cube"}]})";
  folder.write("secret.json", secret);
  folder.write("outside.json", scene);
  folder.write("work/secret.json", secret);
  folder.write("pictures/beside.json", scene);
  std::filesystem::create_symlink(folder.path("outside.json"), folder.path("work/link.json"));
  const auto said_of = [&](const Metadata& named) {
    Metadata metadata = {{"trueshade:scene", "builtin:cornell"},
                         {"trueshade:sceneHash", "sha256:0"},
                         {"trueshade:pipeline", R"({"width": 8, "height": 8})"}};
    for (const auto& other : named)
      std::erase_if(metadata, [&other](const auto& entry) { return entry.first == other.first; });
    metadata.insert(metadata.end(), named.begin(), named.end());
    Image image(8, 8, Format::rgba8);
    write_image(folder.path("pictures/ref.png"), image, {}, metadata);
    image.texels[0] = 9;
    write_image(folder.path("pictures/test.png"), image, {}, {});
    const Outcome outcome =
        run_command({"compare", "../pictures/ref.png", "../pictures/test.png", "-o", "page.html"}, folder.path("work"));
    CHECK(outcome.exit_code == 1);
    CHECK((outcome.out + outcome.err + contents(folder.path("work/page.html"))).find("the_secret_key") ==
          std::string::npos);
    return outcome;
  };
  for (const std::string& name : {folder.path("outside.json"), std::string("../outside.json"), std::string("link.json"),
                                  std::string("/dev/stdin"), std::string(".."), std::string()})
    says(said_of({{"trueshade:scene", name}}), "not judged  the reference's scene: there is no " + name);
  for (const std::string& name : {std::string("secret.json"), folder.path("work/secret.json")})
    says(said_of({{"trueshade:scene", name}}), "secret.json is no scene that can be drawn");
  for (const std::string& name : {std::string("beside.json"), folder.path("pictures/beside.json")})
    says(said_of({{"trueshade:scene", name}}), "beside.json is another scene today");
  const std::string cornell = "sha256:" + scene_hash(load_scene("builtin:cornell"));
  const auto gbuffer = [&](const std::string& files, const std::string& map) {
    return said_of({{"trueshade:sceneHash", cornell},
                    {"trueshade:gbuffer", files},
                    {"trueshade:gbufferHash", "x"},
                    {"trueshade:gbufferMap", map}});
  };
  says(gbuffer("../outside.json", ""), "it is neither here nor beside it");
  says(gbuffer("secret.json", "@../outside.json"), "it is neither here nor beside it");
  says(gbuffer("secret.json", "@secret.json"), "what it names is no G-buffer");
}

TEST_CASE("values that are stored otherwise pass by the judge where OpenGL lets them, though equality would fail") {
  const ScratchFolder folder;
  const auto render = [&](const std::string& half_round, const std::string& output) {
    folder.write("pipeline.json",
                 "{\"version\": 1, \"target\": \"rgba16f\", \"gbuffer\": {\"half_round\": \"" + half_round + "\"}}");
    REQUIRE(run_command({"render", "builtin:cornell", "--size", "64x64", "--pipeline", "pipeline.json", "-o", output,
                         "--aov", "depth,position,normal,albedo,uv,id.object,id.material", "-q"},
                        folder.path(""))
                .exit_code == 0);
  };
  render("toward_zero", "ref.exr");
  render("nearest", "test.exr");
  CHECK(run_compare(folder, {"ref.exr", "test.exr", "--no-judge"}).exit_code == 1);
  const Outcome judged = run_compare(folder, {"ref.exr", "test.exr"});
  CHECK(judged.exit_code == 0);
  says(judged, "verdict     judged by the reference's scene: every pixel is explained; ");
}

TEST_CASE("maps of differences: FLIP's as PNG, the absolute difference of each channel as EXR") {
  ScratchFolder folder;
  with_pair(folder, [](EnginePlane& plane) { plane.at(30, 20, 1) = 0.75; });
  const Outcome outcome = run_compare(folder, {"ref.exr", "test.exr", "-o", "map.png", "-o", "difference.exr"});
  CHECK(outcome.exit_code == 1);
  says(outcome, "wrote map.png (differences, PNG");
  says(outcome, "FLIP        mean ");
  const Image map = read_planes(folder.path("map.png"))[0].image;
  CHECK((map.width == 60 && map.height == 40));
  CHECK(map.code(0, 0, 0) == 0);  // no error is black
  CHECK(map.code(30, 20, 0) > 0);
  const Image difference = read_planes(folder.path("difference.exr"))[0].image;
  CHECK(difference.value(30, 20, 1) == 0.5);
  CHECK(difference.value(30, 20, 0) == 0.0);
  CHECK(difference.value(0, 0, 1) == 0.0);
}

TEST_CASE("sizes that differ are a verdict although a map was asked for, and the map's absence is said") {
  ScratchFolder folder;
  write_floats(folder.path("ref.exr"), even_plane(60, 40, 3, 0.25), kRgb);
  write_floats(folder.path("test.exr"), even_plane(30, 40, 3, 0.25), kRgb);
  for (const char* map : {"map.png", "map.exr"}) {
    const Outcome outcome = run_compare(folder, {"ref.exr", "test.exr", "-o", map, "--junit", "j.xml"});
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.err.find("is not written: ") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder.path(map)));
    CHECK(contents(folder.path("j.xml")).find("<failure") != std::string::npos);
  }
}

TEST_CASE("folders behind links are compared too, links that lead back end, and maps need a folder") {
  ScratchFolder folder;
  namespace fs = std::filesystem;
  for (const char* name : {"ref", "test", "far/ref", "far/test"}) fs::create_directories(folder.path(name));
  write_floats(folder.path("far/ref/a.exr"), even_plane(8, 8, 3, 0.25), kRgb);
  write_floats(folder.path("far/test/a.exr"), even_plane(8, 8, 3, 0.5), kRgb);
  for (const char* side : {"ref", "test"}) {
    fs::create_directory_symlink(folder.path(std::string("far/") + side), folder.path(std::string(side) + "/link"));
    fs::create_directory_symlink(folder.path(side), folder.path(std::string(side) + "/round"));
  }
  const Outcome outcome = run_compare(folder, {"ref", "test", "--no-judge", "--junit", "j.xml"});
  CHECK(outcome.exit_code == 1);
  says(outcome, "link/a.exr");
  says(outcome, "worst at 0,0: R 0.25 against 0.5, G 0.25 against 0.5");
  // The report shows what a reader needs: the pixel and both values.
  CHECK(contents(folder.path("j.xml")).find("first pixel at 0,0") != std::string::npos);
  check_refused(run_compare(folder, {"ref", "test", "-o", "map.png"}), 2, "is named like a file");
  CHECK_FALSE(fs::exists(folder.path("map.png")));
}

TEST_CASE("a gallery of two folders shows each picture, the worst first, and leads to a page of each that differs") {
  ScratchFolder folder;
  namespace fs = std::filesystem;
  for (const char* name : {"ref/in", "test/in"}) fs::create_directories(folder.path(name));
  const std::string odd = "in/a <b> & 50%#\".exr";
  const auto write = [&](const std::string& name, int width, double value) {
    write_floats(folder.path(name), even_plane(width, 8, 3, value), kRgb);
  };
  write("ref/same.exr", 8, 0.25), write("test/same.exr", 8, 0.25);
  write("ref/" + odd, 8, 0.25), write("test/" + odd, 8, 0.5);
  write("ref/wide.exr", 8, 0.25), write("test/wide.exr", 9, 0.25);
  write("ref/gone.exr", 8, 0.25), write("test/new.exr", 8, 0.25);
  write("ref/torn.exr", 8, 0.25), folder.write("test/torn.exr", "no picture\n");
  const Outcome outcome = run_compare(folder, {"ref", "test", "--no-judge", "-o", "report/all.html", "-o", "maps"});
  CHECK(outcome.exit_code == 3);  // of the file that cannot be read
  says(outcome, "wrote report/all.html (HTML report");
  const std::string html = contents(folder.path("report/all.html"));
  CHECK(html.find("5 of 6 pictures do not pass") != std::string::npos);
  size_t before = 0;
  for (const char* state : {"unreadable", "extra", "missing", "mismatched", "different", "same"}) {
    CAPTURE(state);
    const size_t at = html.find("<article class=\"pair " + std::string(state == std::string("same") ? "good" : "bad") +
                                "\" data-state=" + state + " ");
    REQUIRE(at != std::string::npos);
    CHECK(at > before);
    before = at;
    CHECK(count_of(html, "data-state=" + std::string(state) + ">" + state + " 1</button>") == 1);
  }
  // Three pictures of what differs, two of what does not fit, one of each other.
  CHECK(count_of(html, "<figure data-side=\"Difference\">") == 1);
  CHECK(count_of(html, "<figure data-side=") == 3 + 2 + 1 + 1 + 1 + 1);
  CHECK(html.find("in/a &lt;b&gt; &amp; 50%#&quot;.exr") != std::string::npos);
  CHECK(html.find("<b> &") == std::string::npos);
  CHECK(html.find("href=\"../maps/in/a%20%3Cb%3E%20%26%2050%25%23%22.exr.html\"") != std::string::npos);
  const std::string page = contents(folder.path("maps/" + odd + ".html"));
  CHECK(page.find("64 of 64 pixels differ, by 0.25 at most") != std::string::npos);
  CHECK_FALSE(fs::exists(folder.path("maps/same.exr.html")));
  // Without a gallery there are maps alone, and a gallery alone writes nothing else.
  const std::vector<std::string> entries = folder.entries();
  CHECK(run_compare(folder, {"ref", "test", "--no-judge", "-o", "report/all.html"}).exit_code == 3);
  CHECK(folder.entries() == entries);
  check_refused(run_compare(folder, {"ref", "test", "-o", "ref/same.exr/p.html"}), 5, "p.html");
}

TEST_CASE("a gallery of pictures that are noise has the bytes that it may have") {
  ScratchFolder folder;
  namespace fs = std::filesystem;
  for (const char* name : {"ref", "test"}) fs::create_directories(folder.path(name));
  uint32_t seed = 1;
  Image noise(640, 640, Format::rgba8);
  for (const char* side : {"ref", "test"}) {
    for (uint8_t& texel : noise.texels) texel = uint8_t((seed = seed * 1664525u + 1013904223u) >> 24);
    write_image(folder.path(std::string(side) + "/0.png"), noise, {}, {});
    for (int i = 1; i < 12; ++i)
      fs::copy(folder.path(std::string(side) + "/0.png"), folder.path(side + ('/' + std::to_string(i)) + ".png"));
  }
  CHECK(run_compare(folder, {"ref", "test", "--no-judge", "-o", "all.html"}).exit_code == 1);
  const auto size = fs::file_size(folder.path("all.html"));
  CHECK(size < 20'000'000);  // 36 pictures of 1.2 MB each would be 58 MB
  CHECK(size > 8'000'000);   // and they are as large as that lets them be
}

TEST_CASE("bad input to compare is one line, and leaves nothing behind") {
  ScratchFolder folder;
  with_pair(folder, [](EnginePlane&) {});
  const std::string exr = contents(folder.path("ref.exr"));
  folder.write("torn.exr", exr.substr(0, exr.size() / 2));
  folder.write("empty.png", "");
  folder.write("text.png", "no picture\n");
  folder.write("folder/inside.txt", "no picture\n");
  folder.write("other/inside.txt", "no picture\n");
  folder.write("bomb.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16000 +X 16000\n\2\2");
  const std::vector<std::string> before = folder.entries();
  struct Row {
    std::vector<std::string> arguments;
    int exit_code;
    std::string about;
  };
  const std::vector<Row> rows = {
      {{"ref.exr", "torn.exr"}, 3, "torn.exr"},
      {{"torn.exr", "ref.exr"}, 3, "torn.exr"},
      {{"ref.exr", "empty.png"}, 3, "the file is empty"},
      {{"ref.exr", "text.png"}, 3, "no picture of a kind that is read"},
      {{"ref.exr", "bomb.hdr"}, 4, "--max-expansion"},
      {{"ref.exr", "test.exr", "--max-memory", "1K"}, 4, "--max-memory"},
      {{"ref.exr", "nothing.exr"}, 5, "cannot open it"},
      {{"ref.exr", "folder"}, 3, "it is a file, and the test a folder"},
      {{"folder", "ref.exr"}, 3, "it is a file, and the reference a folder"},
      {{"folder", "other"}, 3, "there is no picture in it"},
      {{"ref.exr", "ref.exr"}, 2, "it is the same as the reference"},
      {{"ref.exr", "./ref.exr"}, 2, "it is the same as the reference"},
      {{"ref.exr", "test.exr", "-o", "ref.exr"}, 2, "is one of the pictures that are compared"},
      {{"ref.exr", "test.exr", "-o", "map.jpg"}, 2, "no format has the ending"},
      {{"ref.exr", "test.exr", "-o", "text.png/map.png"}, 5, "text.png/map.png"},
      {{"ref.exr", "test.exr", "--junit", "junit.txt"}, 2, "end the name in .xml"},
      {{"ref.exr", "test.exr", "--max-difference", "-1"}, 2, "--max-difference"},
      {{"ref.exr", "test.exr", "--max-difference", "2/0"}, 2, "--max-difference"},
      {{"ref.exr", "test.exr", "--max-difference", "nan"}, 2, "--max-difference"},
      {{"ref.exr", "test.exr", "--max-ulp", "1.5"}, 2, "--max-ulp"},
      {{"ref.exr", "test.exr", "--delta", "0.1"}, 2, "add --pixels COUNT"},
      {{"ref.exr", "test.exr", "--ppd", "0"}, 2, "--ppd"},
      {{"ref.exr", "test.exr", "--ldr", "--hdr"}, 2, "exclude each other"},
      {{"ref.exr", "test.exr", "--tone-mapper", "none"}, 2, "one of: aces hable reinhard"},
      {{"ref.exr", "test.exr", "--exposures", "3,1"}, 2, "--exposures"},
      {{"ref.exr", "test.exr", "--color-space", "adobe"}, 2, "one of: srgb linear"},
      {{"ref.exr", "test.exr", "--treshold", "1"}, 2, "there is no such option"}};
  for (const Row& row : rows) {
    INFO(row.arguments[0] << ' ' << row.arguments[1]);
    check_refused(run_compare(folder, row.arguments), row.exit_code, row.about);
    CHECK(folder.entries() == before);
  }
}

namespace {

/// Folders ref and test with pictures in folders within: one that is the same, one that differs, one missing, one
/// extra.
void write_folders(const ScratchFolder& folder) {
  for (const char* name : {"ref/a/same.exr", "test/a/same.exr", "ref/b/differs.exr", "ref/missing.exr",
                           "test/extra.exr", "test/b/differs.exr", "test/notes.txt"})
    folder.write(name, "");
  const EnginePlane dark = even_plane(8, 6, 3, 0.25), light = even_plane(8, 6, 3, 0.5);
  for (const char* name :
       {"ref/a/same.exr", "test/a/same.exr", "ref/b/differs.exr", "ref/missing.exr", "test/extra.exr"})
    write_floats(folder.path(name), dark, kRgb);
  write_floats(folder.path("test/b/differs.exr"), light, kRgb);
}

}  // namespace

TEST_CASE("folders are compared by relative names: one table, the worst first, missing and extra pictures fail") {
  const ScratchFolder folder;
  write_folders(folder);
  const Outcome outcome = run_compare(folder, {"ref", "test"});
  CHECK(outcome.exit_code == 1);
  says(outcome, "verdict     3 of 4 pictures do not pass");
  says(outcome, "names do not end as a picture's were passed over: 1, test/notes.txt\n");
  const size_t extra = outcome.out.find("extra.exr"), missing = outcome.out.find("missing.exr"),
               differs = outcome.out.find("b/differs.exr"), same = outcome.out.find("same        1 picture");
  CHECK(extra < missing);
  CHECK(missing < differs);
  CHECK(differs < same);
  CHECK(same != std::string::npos);
  CHECK(run_compare(folder, {"ref/a", "test/a"}).exit_code == 0);

  folder.write("test/b/differs.exr", "no picture");
  const Outcome damaged = run_compare(folder, {"ref", "test"});
  CHECK(damaged.exit_code == 3);  // that of the picture that cannot be read
  says(damaged, "unreadable");
  const auto json = nlohmann::json::parse(run_compare(folder, {"ref", "test", "--json"}).out);
  CHECK(json.at("failures") == 3);
  CHECK(json.at("passed_over_files") == nlohmann::json::array({"test/notes.txt"}));
  CHECK(json.at("pictures").at(0).at("name") == "b/differs.exr");

  // A link to the golden picture holds whatever that holds.
  std::filesystem::create_directories(folder.path("same"));
  std::filesystem::create_symlink(folder.path("ref/a/same.exr"), folder.path("same/same.exr"));
  CHECK(run_compare(folder, {"ref/a", "same"}).exit_code == 2);
  CHECK(run_compare(folder, {"ref", "test", "-o", ""}).exit_code == 2);

  // Of a picture that does not pass, all that is said of two pictures.
  write_folders(folder);
  const auto rows = nlohmann::json::parse(run_compare(folder, {"ref", "test", "--json"}).out).at("pictures");
  for (const auto& row : rows) {
    CAPTURE(row.dump());
    const bool is_compared = row.at("outcome") == "different" || row.at("outcome") == "mismatched";
    REQUIRE(row.contains("comparison") == is_compared);
    if (!is_compared) continue;
    const std::string name = row.at("name");
    auto alone = nlohmann::json::parse(run_compare(folder, {"ref/" + name, "test/" + name, "--json"}).out);
    CHECK(row.at("comparison").at("worst") == alone.at("worst"));
    for (const auto& value : alone.at("worst").at("values")) {  // as numbers too
      CHECK(value.at("reference_value") == 0.25);
      CHECK(value.at("test_value") == 0.5);
    }
    CHECK(row.at("comparison").at("channels") == alone.at("channels"));
  }
}

TEST_CASE(
    "compare --accept makes test pictures references, byte by byte, and then the folders pass but for what is "
    "missing") {
  const ScratchFolder folder;
  write_folders(folder);
  const Outcome outcome = run_compare(folder, {"ref", "test", "--accept"});
  CHECK(outcome.exit_code == 1);  // a reference that has no test picture is not deleted
  says(outcome, "2 accepted");
  says(outcome, "delete the reference by hand if it is to go");
  CHECK(contents(folder.path("ref/b/differs.exr")) == contents(folder.path("test/b/differs.exr")));
  CHECK(contents(folder.path("ref/extra.exr")) == contents(folder.path("test/extra.exr")));
  std::filesystem::remove(folder.path("ref/missing.exr"));
  CHECK(run_compare(folder, {"ref", "test"}).exit_code == 0);
}

TEST_CASE("compare --accept makes the folder of references that is not there yet") {
  const ScratchFolder folder;
  write_folders(folder);
  const Outcome outcome = run_compare(folder, {"new/golden", "test", "--accept"});
  CHECK(has(outcome.err, "new/golden is not there, so it is made"));
  CHECK(outcome.exit_code == 0);
  says(outcome, "3 accepted");
  CHECK(contents(folder.path("new/golden/extra.exr")) == contents(folder.path("test/extra.exr")));
  CHECK(run_compare(folder, {"new/golden", "test"}).exit_code == 0);
  CHECK(run_compare(folder, {"absent", "test"}).exit_code == 5);
  std::filesystem::create_directories(folder.path("empty"));
  CHECK(run_compare(folder, {"absent", "empty", "--accept"}).exit_code == 3);
  CHECK_FALSE(std::filesystem::exists(folder.path("absent")));
}

TEST_CASE("pictures that do not fit together meet no criterion") {
  const ScratchFolder folder;
  write_floats(folder.path("ref.exr"), even_plane(8, 6, 3, 0.25), kRgb);
  write_floats(folder.path("test.exr"), even_plane(8, 7, 3, 0.25), kRgb);
  const Outcome outcome = run_compare(folder, {"ref.exr", "test.exr", "--max-difference", "1"});
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out.find("holds") == std::string::npos);
}

TEST_CASE("compare --accept writes through no link, neither of a picture nor of a folder") {
  const ScratchFolder folder;
  write_folders(folder);
  const std::string test = contents(folder.path("test/b/differs.exr"));
  folder.write("elsewhere/differs.exr", "mine");
  folder.write("elsewhere/kept.exr", "mine");
  std::filesystem::remove_all(folder.path("ref/b"));
  std::filesystem::create_directory_symlink("../elsewhere", folder.path("ref/b"));
  std::filesystem::create_symlink("elsewhere/kept.exr", folder.path("link.exr"));
  const Outcome folders = run_compare(folder, {"ref", "test", "--accept"});
  CHECK(folders.exit_code == 3);
  says(folders, "no picture is accepted through a link");
  CHECK(contents(folder.path("elsewhere/differs.exr")) == "mine");
  CHECK(contents(folder.path("ref/extra.exr")) == contents(folder.path("test/extra.exr")));
  std::filesystem::remove(folder.path("elsewhere/kept.exr"));
  for (const char* made : {"link.exr", "ref/link.exr"}) {
    std::filesystem::remove(folder.path(made));
    std::filesystem::create_symlink(folder.path("elsewhere/kept.exr"), folder.path(made));
    check_refused(run_compare(folder, {made, "test/extra.exr", "--accept"}), 3,
                  "no picture is accepted through a link");
    CHECK_FALSE(std::filesystem::exists(folder.path("elsewhere/kept.exr")));
  }
}

TEST_CASE(
    "compare --accept takes no picture that is not finite or damaged, replaces a damaged reference, and makes a first "
    "one") {
  ScratchFolder folder;
  with_pair(folder, [](EnginePlane& plane) { plane.at(2, 3, 1) = kNan; });
  const std::string before = contents(folder.path("ref.exr"));
  check_refused(run_compare(folder, {"ref.exr", "test.exr", "--accept"}), 3, "channel G is not finite at 2,3");
  CHECK(contents(folder.path("ref.exr")) == before);
  check_refused(run_compare(folder, {"new.exr", "test.exr", "--accept"}), 3, "channel G is not finite at 2,3");
  CHECK_FALSE(std::filesystem::exists(folder.path("new.exr")));
  const Outcome first = run_compare(folder, {"made/new.exr", "ref.exr", "--accept"});
  CHECK(first.exit_code == 0);
  CHECK(contents(folder.path("made/new.exr")) == before);

  folder.write("r/x.exr", before.substr(0, 200));
  folder.write("t/x.exr", before);
  folder.write("r/y.exr", before);
  folder.write("t/y.exr", before.substr(0, 200));
  CHECK(run_compare(folder, {"r", "t", "--accept"}).exit_code == 3);
  CHECK(contents(folder.path("r/x.exr")) == before);
  CHECK(contents(folder.path("r/y.exr")) == before);
}

TEST_CASE("compare --junit writes a testcase a picture, and names that XML has to escape are escaped") {
  const ScratchFolder folder;
  write_folders(folder);
  std::filesystem::rename(folder.path("test/extra.exr"), folder.path("test/<a> & \"b\".exr"));
  folder.write("ref/torn.exr", "no picture");
  folder.write("test/torn.exr", "no picture");
  CHECK(run_compare(folder, {"ref", "test", "--junit", "junit.xml"}).exit_code == 3);
  const std::string xml = contents(folder.path("junit.xml"));
  CHECK(xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites "));
  CHECK(xml.find("tests=\"5\" failures=\"3\" errors=\"1\"") != std::string::npos);
  CHECK(xml.find("name=\"&lt;a&gt; &amp; &quot;b&quot;.exr\"") != std::string::npos);
  CHECK(xml.find("<failure type=\"missing\"") != std::string::npos);
  CHECK(xml.find("<error type=\"unreadable\"") != std::string::npos);
}

TEST_CASE("Bounds are told as they were given, and what was measured beside a fraction as one") {
  const ScratchFolder folder;
  Image plain(8, 8, Format::rgba8);
  std::fill(plain.texels.begin(), plain.texels.end(), uint8_t(255));
  Image other = plain;
  other.set_code(3, 2, 0, 253);
  write_file(folder.path("ref.png"), encode_png(plain, {}));
  write_file(folder.path("test.png"), encode_png(other, {}));
  const auto told = [&](Arguments criteria) {
    criteria.insert(criteria.begin(), {"ref.png", "test.png", "--no-judge"});
    return run_compare(folder, criteria).out;
  };
  CHECK(has(told({"--max-difference", "1/255"}), "largest difference 2/255 (at most 1/255): DOES NOT HOLD"));
  CHECK(has(told({"--max-difference", "0.0100"}), "largest difference 0.00784314 (at most 0.0100): holds"));
  CHECK(has(told({"--max-difference", "1/100"}), "largest difference 0.00784314 (at most 1/100): holds"));
  const std::string pixels = told({"--pixels", "0", "--delta", "1/255"});
  CHECK(has(pixels, "pixels that differ by more than 1/255: 1 (at most 0): DOES NOT HOLD"));
  CHECK(has(pixels, "1 of 64 pixels differs by more than 1/255, mean error"));
}

TEST_CASE("An error that ends compare is in its JUnit, in place of what an earlier run wrote there") {
  const ScratchFolder folder;
  write_folders(folder);
  REQUIRE(run_compare(folder, {"ref", "ref/../test", "--no-judge", "--junit", "j.xml"}).exit_code == 1);
  const Outcome gone = run_compare(folder, {"ref", "gone", "--junit", "j.xml"});
  CHECK(gone.exit_code == 5);
  const std::string xml = contents(folder.path("j.xml"));
  CHECK(xml.find("tests=\"1\" failures=\"0\" errors=\"1\"") != std::string::npos);
  CHECK(xml.find("message=\"gone: ") != std::string::npos);
  CHECK(run_compare(folder, {"ref", "test", "-o", "one", "-o", "two", "--junit", "j.xml"}).exit_code == 2);
  CHECK(has(contents(folder.path("j.xml")), "one folder takes all maps"));
  // So it is on a page, but on none that is not ours, and on none where none was.
  REQUIRE(run_compare(folder, {"ref", "ref/../test", "--no-judge", "-o", "p.html"}).exit_code == 1);
  folder.write("mine.html", "<!doctype html>\n<title>mine</title>\n");
  const Outcome late = run_compare(folder, {"ref", "gone", "-o", "p.html", "-o", "mine.html", "-o", "new.html"});
  CHECK(late.exit_code == 5);
  CHECK(has(late.err, "note: p.html was of an earlier run, and now says that this one ended with an error"));
  CHECK(has(contents(folder.path("p.html")), "The command ended with an error: gone: "));
  CHECK(has(contents(folder.path("mine.html")), "mine"));
  CHECK_FALSE(std::filesystem::exists(folder.path("new.html")));
  // It is never one of what is compared.
  folder.write("j.xml", "mine");
  CHECK(run_compare(folder, {"j.xml", "test/extra.exr", "--junit", "j.xml"}).exit_code == 2);
  CHECK(contents(folder.path("j.xml")) == "mine");
}

TEST_CASE("of folders -o takes maps of the pictures that do not pass") {
  const ScratchFolder folder;
  write_folders(folder);
  CHECK(run_compare(folder, {"ref", "test", "-o", "maps"}).exit_code == 1);
  CHECK(std::filesystem::exists(folder.path("maps/b/differs.exr.flip.png")));
  CHECK_FALSE(std::filesystem::exists(folder.path("maps/a/same.exr.flip.png")));
  for (const char* within : {"test/maps", "ref/a/maps", "./test/../test/maps"}) {
    const Outcome refused = run_compare(folder, {"ref", "test", "-o", within});
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.find("whose pictures are compared: maps would be some") != std::string::npos);
  }
  CHECK(run_compare(folder, {"ref", "test", "-o", "report.htm"}).err.find("end its name in .html") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path("report.htm")));
}

TEST_CASE("a picture that passes by now leaves no map and no page of an earlier run, and other files stay") {
  const ScratchFolder folder;
  write_folders(folder);
  const auto run = [&folder] {
    return run_compare(folder, {"ref", "test", "-o", "maps", "-o", "page.html"}).exit_code;
  };
  CHECK(run() == 1);
  const std::string map = folder.path("maps/b/differs.exr.flip.png"), page = folder.path("maps/b/differs.exr.html");
  REQUIRE(std::filesystem::exists(map));
  REQUIRE(std::filesystem::exists(page));
  folder.write("maps/b/mine.png", "mine");
  std::filesystem::copy_file(folder.path("ref/b/differs.exr"), folder.path("test/b/differs.exr"),
                             std::filesystem::copy_options::overwrite_existing);
  CHECK(run() == 1);  // one is missing, and one more
  CHECK_FALSE(std::filesystem::exists(map));
  CHECK_FALSE(std::filesystem::exists(page));
  CHECK(contents(folder.path("maps/b/mine.png")) == "mine");

  // What others have under such names stays, and so does what a link leads to.
  folder.write("maps/b/differs.exr.flip.png", "mine");
  folder.write("maps/b/differs.exr.html", "mine");
  folder.write("elsewhere/same.exr.html", "mine");
  std::filesystem::remove_all(folder.path("maps/a"));
  std::filesystem::create_directory_symlink("../elsewhere", folder.path("maps/a"));
  CHECK(run() == 1);
  CHECK(contents(map) == "mine");
  CHECK(contents(page) == "mine");
  CHECK(contents(folder.path("elsewhere/same.exr.html")) == "mine");
  std::filesystem::remove(folder.path("maps/a"));

  // The map of a picture whose test is gone is removed too.
  std::filesystem::remove(map), std::filesystem::remove(page);
  write_floats(folder.path("test/b/differs.exr"), even_plane(8, 6, 3, 0.5), kRgb);
  CHECK(run() == 1);
  REQUIRE(std::filesystem::exists(map));
  std::filesystem::remove(folder.path("test/b/differs.exr"));
  CHECK(run() == 1);
  CHECK_FALSE(std::filesystem::exists(map));
}

TEST_CASE("compare --criteria: the first pattern that fits a name has a picture's criteria") {
  const ScratchFolder folder;
  const EnginePlane dark = even_plane(8, 6, 3, 0.25), light = even_plane(8, 6, 3, 0.5);
  for (const char* name : {"noise/a b.exr", "noise/c.exr", "flat.exr"}) {
    folder.write(std::string("ref/") + name, ""), folder.write(std::string("test/") + name, "");
    write_floats(folder.path(std::string("ref/") + name), dark, kRgb);
    write_floats(folder.path(std::string("test/") + name), light, kRgb);
  }
  const auto outcomes = [&folder](const char* criteria) {
    folder.write("criteria.txt", criteria);
    const Outcome outcome =
        run_compare(folder, {"ref", "test", "--criteria", "criteria.txt", "--max-difference", "0.1", "--json"});
    INFO(outcome.err);
    REQUIRE(outcome.exit_code < 2);
    return nlohmann::json::parse(outcome.out);
  };
  const auto passing = [](const nlohmann::json& json) {
    std::vector<std::string> names;
    for (const auto& row : json.at("pictures"))
      if (row.at("passes").get<bool>()) names.push_back(row.at("name"));
    std::sort(names.begin(), names.end());
    return names;
  };
  using Names = std::vector<std::string>;
  CHECK(passing(outcomes("")).empty());
  CHECK(passing(outcomes("# noise\n\nnoise/*  --max-difference 0.3\r\n")) == Names{"noise/a b.exr", "noise/c.exr"});
  CHECK(passing(outcomes("\"noise/a b.exr\" --pixels 48 --delta 1/8")) == Names{"noise/a b.exr"});
  CHECK(passing(outcomes("\xef\xbb\xbfnoise/* --max-difference 0.3\n")) == Names{"noise/a b.exr", "noise/c.exr"});
  const auto first = outcomes("noise/c.exr --max-difference 0.2\n*.exr --max-difference 1/4\nabsent* --psnr 30\n");
  CHECK(passing(first) == Names{"flat.exr", "noise/a b.exr"});
  CHECK(first.at("unused_criteria") == nlohmann::json::array({"absent*"}));

  EnginePlane right_half = even_plane(8, 6, 1, 1.0);
  for (size_t i = 0; i < right_half.values.size(); ++i) right_half.values[i] = i % 8 < 4 ? 0.0 : 1.0;
  write_floats(folder.path("mask.exr"), right_half, {"Y"});
  const auto masked = outcomes("flat.exr --pixels 24 --mask mask.exr --allow-mask\nnoise/c.exr --pixels 24\n");
  CHECK(passing(masked) == Names{"flat.exr"});
  write_floats(folder.path("test/flat.exr"), dark, kRgb);
  folder.write("criteria.txt", "flat.exr --mask mask.exr --allow-mask\n");
  CHECK(has(run_compare(folder, {"ref", "test", "--criteria", "criteria.txt"}).out,
            "same        1 picture (1 with pixels left out)\n"));

  const auto refused = [&folder](const char* criteria, const char* about) {
    folder.write("criteria.txt", criteria);
    check_refused(run_compare(folder, {"ref", "test", "--criteria", "criteria.txt"}), 3, about);
  };
  refused("\na --max-difference\n", "criteria.txt: line 2: --max-difference: its value is missing");
  refused("a --max-diffrence 1\n", "criteria.txt: line 1: --max-diffrence: there is no such option");
  refused("a b\n", "line 1: command line: 'b' is one argument too many");
  refused("a --delta 1\n", "line 1: --delta: it is what --pixels and --window let pass");
  refused("a -o b\n", "line 1: -o: there is no such option");
  refused("\"a --psnr 3\n", "line 1: quote: it is not closed");
  check_refused(run_compare(folder, {"ref", "test", "--criteria", "absent.txt"}), 5, "absent.txt");
  check_refused(run_compare(folder, {"ref/flat.exr", "test/flat.exr", "--criteria", "criteria.txt"}), 2, "--criteria");
}

TEST_CASE("a bound that no difference of codes is beyond is refused, and of floats it is one") {
  ScratchFolder folder;
  for (const char* preset : {"many-lights", "redsdk"})
    REQUIRE(run_command({"render", "builtin:cornell", "--size", "32x24", "--preset", preset, "-q", "-o",
                         std::string(preset) + ".png"},
                        folder.path(""))
                .exit_code == 0);
  for (const std::vector<std::string>& bound : {std::vector<std::string>{"--max-difference", "1"},
                                                {"--max-difference", "2"},
                                                {"--pixels", "0", "--delta", "2"}}) {
    std::vector<std::string> words{"many-lights.png", "redsdk.png"};
    words.insert(words.end(), bound.begin(), bound.end());
    const Outcome refused = run_compare(folder, words);
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.find("so it lets every difference pass (give a fraction, like 2/255)") != std::string::npos);
  }
  CHECK(run_compare(folder, {"many-lights.png", "redsdk.png", "--max-ulp", "254"}).exit_code < 2);
  check_refused(run_compare(folder, {"many-lights.png", "redsdk.png", "--max-ulp", "255"}), 2,
                "the pictures hold codes of 8 bits, so it lets every difference pass");
  with_pair(folder, [](EnginePlane& plane) { plane.values[0] += 1.5f; });
  CHECK(run_compare(folder, {"ref.exr", "test.exr", "--max-difference", "2"}).exit_code == 0);
  CHECK(run_compare(folder, {"ref.exr", "test.exr", "--max-difference", "1"}).exit_code == 1);
}

}  // namespace trueshade
