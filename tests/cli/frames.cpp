// --time and --frames: the right time, one line and one file a frame, each whole.
#include <filesystem>

#include "cli/frame_name.h"
#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

TEST_CASE("a frame's number goes where the name says, or before the ending") {
  CHECK(frame_name("city.png", 7) == "city.0007.png");
  CHECK(frame_name("out.d/city.png", 12345) == "out.d/city.12345.png");
  CHECK(frame_name("a##b####.exr", 5) == "a05b####.exr");
  CHECK(frame_name("a####.exr", 5) == "a0005.exr");
  CHECK(frame_name("a%04d.exr", 5) == "a0005.exr");
  CHECK(frame_name("a%d.exr", 123) == "a123.exr");
  CHECK(frame_name("a%03d.exr", 1234) == "a1234.exr");
  CHECK(frame_name("50%.png", 1) == "50%.0001.png");    // no place of a number
  CHECK(frame_name("#1/a.png", 1) == "#1/a.0001.png");  // the folder keeps its name
}

std::string text_of(const Outcome& outcome) {
  INFO(outcome.err);
  CHECK(outcome.exit_code == 0);
  return outcome.out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1)
    lines.push_back(text.substr(begin, text.find('\n', begin) - begin));
  return lines;
}

constexpr std::string_view kTurningCube = R"({"version": 1, "fps": 8, "camera": {"eye": [0, 1, 5]},
  "objects": [{"mesh": "cube", "steps": [{"time": 0, "rotation_deg": [0, 0, 0]}, {"time": 1, "rotation_deg": [0, 80, 0]}]}],
  "lights": [{"type": "ring", "count": 6, "radius": 3, "height": 1, "range": 6, "turn_s": 4}]})";

TEST_CASE("each frame is the picture of its time, with a line and a file of its own") {
  const ScratchFolder folder;
  folder.write("s.json", kTurningCube);
  const std::vector<std::string> draw = {"render", "s.json", "--size", "40x30", "--hash"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), draw.begin(), draw.end());
    return text_of(run_command(more, folder.path("")));
  };
  const std::vector<std::string> lines = lines_of(with({"--frames", "2-4", "-o", "f_###.png", "-o", "f.exr"}));
  REQUIRE(lines.size() == 3);
  for (const char* name : {"f_002.png", "f_003.png", "f_004.png", "f.0002.exr", "f.0003.exr", "f.0004.exr"})
    CHECK(std::filesystem::file_size(folder.path(name)) > 0);
  CHECK(lines[0] != lines[1]);
  CHECK(with({"--time", "0.25"}) == lines[0] + "\n");  // frame 2 of 8 a second
  CHECK(with({"--time", "0.5"}) == lines[2] + "\n");
  CHECK(with({"--frames", "3"}) == lines[1] + "\n");
  CHECK(with({"--frames", "0-0"}) == with({}));
  const std::string info = text_of(run_command({"info", "f_003.png"}, folder.path("")));
  CHECK(info.find("trueshade:time        0.375") != std::string::npos);
  const std::string json =
      text_of(run_command({"render", "s.json", "--size", "8x8", "--frames", "0-1", "--json"}, folder.path("")));
  CHECK(json.starts_with("{\"frames\":[{\"version\""));
  CHECK(json.ends_with("}]}\n"));
}

TEST_CASE("a frame that cannot be made leaves those before it whole and no file of its own") {
  const ScratchFolder folder;
  folder.write(
      "s.json",
      R"({"version": 1, "fps": 1, "camera": {"steps": [{"time": 0, "eye": [0, 0, 2]}, {"time": 2, "eye": [0, 0, -2]}]}})");
  const Outcome outcome =
      run_command({"render", "s.json", "--size", "8x8", "--frames", "0-2", "-o", "f.png"}, folder.path(""));
  CHECK(outcome.exit_code == 3);
  CHECK(outcome.err.find("s.json: time 1: camera: eye, target and up") != std::string::npos);
  CHECK(std::filesystem::exists(folder.path("f.0000.png")));
  CHECK_FALSE(std::filesystem::exists(folder.path("f.0001.png")));
}

TEST_CASE("times and frames that make no sense are refused before anything is read") {
  const std::vector<std::vector<std::string>> cases = {{"--time", "nan"},
                                                       {"--time", "inf"},
                                                       {"--time", "1e7"},
                                                       {"--time", "1s"},
                                                       {"--time", ""},
                                                       {"--frames", "3-2"},
                                                       {"--frames", "-1-2"},
                                                       {"--frames", "1-"},
                                                       {"--frames", "a"},
                                                       {"--frames", "0-1000000"},
                                                       {"--frames", "0-1", "--time", "2"}};
  for (const std::vector<std::string>& arguments : cases) {
    std::vector<std::string> all = {"render", "absent.json", "--hash"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    INFO(arguments[1]);
    CHECK(run_command(all).exit_code == 2);
  }
}

}  // namespace
}  // namespace trueshade
