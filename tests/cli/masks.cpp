// --mask, --ignore, --window, --channels and --rows, run as people run them; and masks that are none.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/cli/engine_capture.h"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr int kMaskedWidth = 64, kMaskedHeight = 48;

EnginePlane even(int channels, double value, int width = kMaskedWidth, int height = kMaskedHeight) {
  return {width, height, channels, std::vector<double>(size_t(width * height * channels), value)};
}

/// `value` in the rectangle.
EnginePlane with_icon(EnginePlane plane, double value, int x0 = 8, int y0 = 8, int x1 = 24, int y1 = 20) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      for (int c = 0; c < plane.channels; ++c) plane.at(x, y, c) = value;
  return plane;
}

/// ref.npy, and test.npy that has an icon of 16x12 pixels, 6.25 % of them all; mask.npy leaves it out.
void write_pair(const ScratchFolder& folder) {
  write_npy(folder.path("ref.npy"), even(3, 100), "|u1");
  write_npy(folder.path("test.npy"), with_icon(even(3, 100), 200), "|u1");
  write_npy(folder.path("mask.npy"), with_icon(even(1, 1), 0), "|b1");
}

Outcome compare_pair(const ScratchFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"compare", "ref.npy", "test.npy"});
  return run_command(arguments, folder.path(""));
}

nlohmann::json json_of(const Outcome& outcome) {
  INFO(outcome.err);
  return nlohmann::json::parse(outcome.out);
}

bool text_says(const std::string& text, const std::string& part) {
  INFO(text);
  CHECK(text.find(part) != std::string::npos);
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("A number to ignore that no picture has is said, and options of FLIP that do nothing are refused") {
  const ScratchFolder folder;
  write_pair(folder);
  folder.write("s.json", R"({"version": 1, "camera": {"eye": [0, 0, 3], "target": [0, 0, 0]},
    "objects": [{"mesh": "sphere"}], "lights": [{"type": "ambient", "color": [1, 1, 1]}]})");
  const auto draw = [&](const char* file) {
    REQUIRE(run_command({"render", "s.json", "--size", "32x24", "-o", file, "--aov",
                         "depth,position,normal,albedo,id.object", "-q"},
                        folder.path(""))
                .exit_code == 0);
  };
  draw("a.exr"), draw("b.exr");
  const auto ignore = [&](const char* number) {
    return run_command({"compare", "a.exr", "b.exr", "--ignore", number, "--allow-mask"}, folder.path("")).out;
  };
  text_says(ignore("id.object=7"), "--ignore id.object=7 leaves nothing out");
  CHECK(ignore("id.object=1").find("leaves nothing out") == std::string::npos);
  const Outcome judged =
      run_command({"validate", "s.json", "--gbuffer", "a.exr", "--ignore", "id.object=7", "--quick"}, folder.path(""));
  text_says(judged.out, "id.object=7 leaves nothing out");

  const auto refused = [&](std::vector<std::string> options, const char* reason) {
    const Outcome outcome = compare_pair(folder, std::move(options));
    CHECK(outcome.exit_code == 2);
    text_says(outcome.err, reason);
  };
  refused({"--ppd", "40"}, "nothing here measures FLIP");
  refused({"--hdr", "-o", "page.html"}, "nothing here measures FLIP");
  refused({"--ldr", "--flip", "0.1", "--tone-mapper", "hable"}, "with --ldr nothing is exposed");
  CHECK(compare_pair(folder, {"--ppd", "40", "--flip", "1"}).exit_code == 0);
  text_says(compare_pair(folder, {"--tone-mapper", "hable", "--flip", "1"}).out, "--tone-mapper does nothing");
  CHECK(compare_pair(folder, {"--ppd", "40", "-o", "map.png"}).exit_code == 1);
}

TEST_CASE("what a mask leaves out is no difference, and is counted in text, JSON and page") {
  const ScratchFolder folder;
  write_pair(folder);
  CHECK(compare_pair(folder, {}).exit_code == 1);
  const Outcome text = compare_pair(folder, {"--mask", "mask.npy", "-o", "page.html"});
  CHECK(text.exit_code == 0);
  text_says(text.out, "every stored value equal; 192 are left out");
  text_says(text.out, "mask        mask.npy: 192 of 3072 pixels left out, 6.25 %");
  const std::string html = contents(folder.path("page.html"));
  text_says(html, "pixels left out");
  text_says(html, "\"left out\"");
  CHECK(compare_pair(folder, {"--mask", "mask.npy", "--junit", "j.xml"}).exit_code == 0);
  text_says(contents(folder.path("j.xml")), "192 are left out</system-out>");
  const auto json = json_of(compare_pair(folder, {"--mask", "mask.npy", "--json", "--flip", "0", "--psnr", "200"}));
  CHECK(json["left_out_pixels"] == 192);
  CHECK(json["left_out_by"] == "mask.npy");
  CHECK(json["pixels"] == 3072 - 192);
  CHECK(json["passes"] == true);
}

TEST_CASE("masks that are none are refused in one line") {
  const ScratchFolder folder;
  write_pair(folder);
  write_npy(folder.path("grey.npy"), with_icon(even(1, 255), 128), "|u1");
  write_npy(folder.path("low.npy"), even(1, 1, kMaskedWidth, kMaskedHeight - 1), "|u1");
  write_npy(folder.path("none.npy"), even(1, 0), "|u1");
  write_npy(folder.path("much.npy"), with_icon(even(1, 1), 0, 0, 0, kMaskedWidth, 5), "|u1");
  write_npy(folder.path("nan.npy"), with_icon(even(1, 1), std::nan("")), "<f4");
  write_npy(folder.path("minus.npy"), with_icon(even(1, 1), -1), "<f4");
  EnginePlane colors = even(3, 1);
  colors.at(3, 4, 1) = 0;
  write_npy(folder.path("colors.npy"), colors, "|u1");
  folder.write("text.png", "this is no picture");
  folder.write("torn.npy", std::string("\x93NUMPY\x01\x00\x40\x00{'descr': '|b1'", 25));
  folder.write("huge.npy", std::string("\x93NUMPY\x01\x00\x4b\x00", 10) +
                               "{'descr': '|b1', 'fortran_order': False, 'shape': (999999999, 999999999), }\n");
  const struct {
    const char *mask, *about;
    int exit_code;
  } rows[] = {{"grey.npy", "channel R of the mask is 128 (0.501961) at 8,8", 3},
              {"low.npy", "the mask is 64x47, and what it masks is 64x48", 3},
              {"none.npy", "all 3072 pixels are left out", 3},
              {"much.npy", "320 of 3072 pixels are left out, 10.4 %, and at most 10 % may be", 3},
              {"nan.npy", "of the mask is nan at 8,8", 3},
              {"minus.npy", "of the mask is -1 at 8,8", 3},
              {"colors.npy", "channels contradict each other at 3,4", 3},
              {"text.png", "it is no picture of a kind that is read", 3},
              {"torn.npy", "ends inside its header", 3},
              {"huge.npy", "", 4},
              {"absent.png", "cannot open it", 5},
              {"", "the name is empty", 2}};
  for (const auto& row : rows) {
    CAPTURE(row.mask);
    check_refused(compare_pair(folder, {"--mask", row.mask}), row.exit_code, row.about);
  }
  CHECK(compare_pair(folder, {"--mask", "much.npy", "--allow-mask"}).exit_code == 1);
  check_refused(compare_pair(folder, {"--mask", "none.npy", "--allow-mask"}), 3, "all 3072 pixels are left out");
  check_refused(compare_pair(folder, {"--allow-mask"}), 2, "nothing is left out");
  folder.write("m.png", "");
  check_refused(compare_pair(folder, {"--mask", "m.png", "-o", "m.png"}), 2, "or their mask");
}

TEST_CASE("lists of identifiers and windows that are none are refused, and so are channels that are not there") {
  const ScratchFolder folder;
  write_pair(folder);
  for (const char* list : {"", "3", "id.object", "id.object=", "id.object=a", "id.object=3,", "id.object=9-3",
                           "id.object=-1", "id.object=99999999999", "id.object=1.5", "object=3", "depth=0"}) {
    CAPTURE(list);
    check_refused(compare_pair(folder, {"--ignore", list}), 2, "--ignore");
  }
  check_refused(compare_pair(folder, {"--ignore", "id.object=3"}), 3, "neither picture has a channel id.object");
  for (const char* window : {"", "16", "16:", ":0.1", "16:2", "16:-1", "16:x", "12:0.1", "4:0.1", "256:0.1", "16:nan",
                             "1e9:0.1", "16:0.1:2"}) {
    CAPTURE(window);
    check_refused(compare_pair(folder, {"--window", window}), 2, "--window");
  }
  check_refused(compare_pair(folder, {"--delta", "0.1"}), 2, "--delta");
  check_refused(compare_pair(folder, {"--channels", "RGBA"}), 3, "it has no channel A");
  for (const char* channels : {"", ",", "R,", "RR", "R,R"}) {
    CAPTURE(channels);
    check_refused(compare_pair(folder, {"--channels", channels}), 2, "--channels");
  }
  check_refused(compare_pair(folder, {"--rows", "sideways"}), 2, "--rows");
  check_refused(compare_pair(folder, {"--rows", "bottom_up", "--accept"}), 2, "--accept");
}

TEST_CASE("of folders one mask goes for all pictures, and what is wrong with it accepts none") {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path("ref"));
  std::filesystem::create_directories(folder.path("test"));
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"compare", "ref", "test"});
    return run_command(more, folder.path(""));
  };
  for (const char* name : {"a.npy", "b.npy"}) {
    write_npy(folder.path(std::string("ref/") + name), even(3, 100), "|u1");
    write_npy(folder.path(std::string("test/") + name), with_icon(even(3, 100), 200), "|u1");
  }
  write_npy(folder.path("mask.npy"), with_icon(even(1, 1), 0), "|b1");
  write_npy(folder.path("small.npy"), even(1, 1, 8, 8), "|b1");
  write_npy(folder.path("much.npy"), with_icon(even(1, 1), 0, 0, 0, kMaskedWidth, 30), "|b1");
  CHECK(run({}).exit_code == 1);
  const auto json = json_of(run({"--mask", "mask.npy", "--json", "--junit", "j.xml"}));
  text_says(contents(folder.path("j.xml")), "192 are left out</system-out>");
  CHECK(json["passes"] == true);
  CHECK(json["pictures"][1]["left_out_pixels"] == 192);
  for (const char* wrong : {"small.npy", "much.npy"}) {
    const Outcome outcome = run({"--mask", wrong, "--accept"});
    CHECK(outcome.exit_code == 3);
    text_says(outcome.out, "2 of 2 pictures do not pass");
  }
  check_refused(run({"--mask", "absent.npy", "--accept"}), 5, "absent.npy: cannot open it");
  CHECK(run({"--mask", "mask.npy", "--accept"}).exit_code == 0);
  CHECK(run({}).exit_code == 1);  // none was accepted
}

TEST_CASE("the worst windows are told, and one fails the comparison") {
  const ScratchFolder folder;
  write_pair(folder);
  const Outcome text = compare_pair(folder, {"--window", "16:0.5", "--delta", "2/255"});
  CHECK(text.exit_code == 1);
  // 16 of its 16 columns and 12 of its rows are the icon's: of 8, 12, 16, ... the first window that has all of it.
  text_says(text.out,
            "window      16x16 at 8,4: 192 of 256 pixels differ by more than 2/255, mean error 0.2941, "
            "largest 0.3922");
  text_says(text.out, "in a window of 16x16: 0.75 (at most 0.5): DOES NOT HOLD");
  CHECK(compare_pair(folder, {"--window", "16:0.75", "--window", "64:1"}).exit_code == 0);
  CHECK(compare_pair(folder, {"--window", "16:0", "--delta", "100/255"}).exit_code == 0);
  const auto json = json_of(compare_pair(folder, {"--window", "32:0.5", "--json"}));
  REQUIRE(json["windows"].size() == 3);
  CHECK(json["windows"][1]["side"] == 32);
  CHECK(json["windows"][1]["pixels_beyond"] == 192);
  CHECK(json["windows"][1]["share"] == 192.0 / 1024);
  CHECK(json["criteria"][0]["measure"] == "window_share");
}

TEST_CASE("rows from the bottom up are turned, and channels that are not named are not compared") {
  const ScratchFolder folder;
  EnginePlane plane = even(3, 7);
  for (int y = 0; y < kMaskedHeight; ++y)
    for (int x = 0; x < kMaskedWidth; ++x) plane.at(x, y, 0) = y;
  write_npy(folder.path("ref.npy"), plane, "|u1");
  EnginePlane other = bottom_up(plane);
  for (int i = 0; i < kMaskedWidth; ++i) other.at(i, 5, 2) = 99;
  write_npy(folder.path("test.npy"), other, "|u1");
  CHECK(compare_pair(folder, {}).exit_code == 1);
  const auto turned = json_of(compare_pair(folder, {"--rows", "bottom_up", "--json"}));
  CHECK(turned["unequal_pixels"] == kMaskedWidth);
  CHECK(turned["first"]["y"] == kMaskedHeight - 1 - 5);
  CHECK(compare_pair(folder, {"--rows", "bottom_up", "--channels", "RG"}).exit_code == 0);
  CHECK(compare_pair(folder, {"--rows", "bottom_up", "--channels", "R,B"}).exit_code == 1);
  CHECK(compare_pair(folder, {"--channels", "G"}).exit_code == 0);
}

TEST_CASE("an error names the file that holds the value, of several") {
  const ScratchFolder folder;
  const auto run = [&](std::vector<std::string> arguments) { return run_command(arguments, folder.path("")); };
  write_npy(folder.path("position.npy"), even(3, 1), "<f4");
  write_npy(folder.path("normal.npy"), even(3, 1), "<f4");
  write_npy(folder.path("depth.npy"), even(1, 0.5), "<f4");
  write_npy(folder.path("albedo.npy"), even(3, 51), "|u1");
  write_npy(folder.path("lit.npy"), with_icon(even(3, 0.2), 0.3003), "<f4");
  const auto judged = [&](const std::string& map) {
    return run({"validate", "builtin:cornell", "--subpixel-bits", "8", "--map", map});
  };
  const std::string planes = "position=position.npy,normal=normal.npy,depth=depth.npy,albedo=albedo.npy";
  check_refused(judged(planes + ",color=lit.npy"), 3, "error: lit.npy: color at 8,8 is 0.300300002, which rgba8 does");
  check_refused(
      run({"validate", "builtin:cornell", "--subpixel-bits", "8", "--gbuffer", "position.npy", "--map",
           "position=position.npy,depth=depth.npy,normal=normal.npy,albedo=albedo.npy", "--image", "lit.npy"}),
      3, "error: lit.npy: color at 8,8");
  write_npy(folder.path("albedo.npy"), with_icon(even(3, 0.2), 0.7), "<f4");
  check_refused(judged(planes), 3, "error: albedo.npy: albedo at 8,8 is 0.699999988, which rgba8 does not hold");
  write_npy(folder.path("id.npy"), with_icon(even(1, 1), 1.5), "<f4");
  write_npy(folder.path("albedo.npy"), even(3, 51), "|u1");
  check_refused(judged(planes + ",id.object=id.npy"), 3, "error: id.npy: id.object at 8,8 is 1.5");
  write_npy(folder.path("depth.npy"), even(1, 0.5, kMaskedWidth, kMaskedHeight - 8), "<f4");
  check_refused(judged(planes), 3, "depth.npy");
}

TEST_CASE("validate judges nothing of what a mask, or an object, leaves out") {
  const ScratchFolder folder;
  const auto run = [&](std::vector<std::string> arguments) { return run_command(arguments, folder.path("")); };
  const std::vector<std::string> size = {"--size", "64x48"};
  REQUIRE(run({"render", "builtin:cornell", "--size", "64x48", "-o", "good.exr", "--aov",
               "depth,position,normal,albedo,id.object,id.material"})
              .exit_code == 0);
  REQUIRE(run({"render", "builtin:cornell,lights=1", "--size", "64x48", "-o", "lit.png"}).exit_code == 0);
  write_npy(folder.path("mask.npy"), with_icon(even(1, 1), 0), "|u1");
  const auto judged = [&](std::vector<std::string> more, const char* image) {
    std::vector<std::string> all = {"validate", "builtin:cornell", "--gbuffer", "good.exr", "--subpixel-bits",
                                    "8",        "--quick"};
    if (*image != '\0') all.insert(all.end(), {"--map", "depth,position,normal,albedo,id.object", "--image", image});
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  };
  const Outcome text = judged({"--mask", "mask.npy", "-o", "page.html"}, "");
  CHECK(text.exit_code == 0);
  text_says(text.out, "mask        mask.npy: 192 of 3072 pixels left out, 6.25 %");
  text_says(text.out, "lighting: 2880 pixels, ");
  text_says(text.out, "every pixel is explained; 192 are left out");
  const std::string html = contents(folder.path("page.html"));
  text_says(html, "LEFT OUT");
  text_says(html, "mask.npy: 192 of 3072 pixels left out, 6.25 %");
  const auto json = json_of(judged({"--mask", "mask.npy", "--json"}, ""));
  CHECK(json["left_out_pixels"] == 192);
  CHECK(json["verdict"]["stages"][0]["left_out"] == 192);
  // What is judged is the rest: a picture under other lights is in no legal set there.
  const auto before = json_of(judged({"--json"}, "lit.png")),
             after = json_of(judged({"--mask", "mask.npy", "--json"}, "lit.png"));
  const auto violations = [](const nlohmann::json& v) { return int(v["verdict"]["stages"][1]["counts"]["VIOLATION"]); };
  CHECK(violations(before) > violations(after));
  CHECK(violations(after) > 0);
  REQUIRE(after["verdict"]["stages"][1]["windows"].size() == 2);
  CHECK(after["verdict"]["stages"][1]["windows"][0]["violations"] > 0);
  check_refused(judged({"--ignore", "id.object=1-99"}, ""), 3, "pixels are left out");
  check_refused(judged({"--ignore", "id.object=1-99", "--allow-mask"}, ""), 3, "pixels with a surface are left out");
  const Outcome without = judged({"--ignore", "id.object=1", "--allow-mask"}, "");
  CHECK(without.exit_code == 0);
  text_says(without.out, "id.object=1: ");
  write_npy(folder.path("small.npy"), even(1, 1, 3, 3), "|u1");
  check_refused(judged({"--mask", "small.npy"}, ""), 3, "the mask is 3x3, and what it masks is 64x48");
  check_refused(judged({"--mask", "good.exr"}, ""), 3, "of the mask is");
  check_refused(
      run({"validate", "builtin:cornell", "--driver", "llvmpipe", "--mask", "good.exr", "--save", "./good.exr"}), 2,
      "is the mask");
}

}  // namespace trueshade
