// render --raw-video -o -: what a program that reads the pipe gets.
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

const std::vector<std::string> kDraw = {"render", "builtin:circle", "--size", "31x17"};  // rows that no alignment fits

Outcome draw(std::vector<std::string> more, const ScratchFolder& folder) {
  more.insert(more.begin(), kDraw.begin(), kDraw.end());
  return run_command(more, folder.path(""));
}

/// The first `channels` codes of each texel of a PNG, those of 16 bits with the more significant byte first.
std::string codes_of_png(const std::string& path, int channels) {
  const std::vector<NamedImage> planes = read_planes(path);
  const Image& image = planes[0].image;
  std::string bytes;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < channels; ++c) {
        const uint32_t code = image.code(x, y, c);
        if (image.format == Format::rgba16) bytes += char(code >> 8);
        bytes += char(code & 255);
      }
  return bytes;
}

}  // namespace

TEST_CASE("Raw video is the codes of the frames' PNGs, one frame after the other, in the format that its note names") {
  struct Row {
    const char *target, *pixel_format;
    int channels;
  };
  for (const Row& row : {Row{"rgba8", "rgba", 4}, Row{"srgb8_a8", "rgba", 4}, Row{"rgba16", "rgba64be", 4},
                         Row{"rgba16f", "rgba", 4}, Row{"r11g11b10f", "rgb24", 3}, Row{"rgb10_a2", "rgba64be", 4}}) {
    INFO(row.target);
    const ScratchFolder folder;
    const Outcome video = draw({"--target", row.target, "--frames", "3-5", "--raw-video", "-o", "-"}, folder);
    CHECK(video.exit_code == 0);
    const std::string told = std::string("raw video: ffmpeg -f rawvideo -pixel_format ") + row.pixel_format +
                             " -video_size 31x17 -framerate 24 -i - FILE.mp4\n";
    CHECK(video.err.find(told) != std::string::npos);
    CHECK(video.err.find(told) == video.err.rfind("raw video:"));  // once, not for every frame
    REQUIRE(draw({"--target", row.target, "--frames", "3-5", "-o", "f.png"}, folder).exit_code == 0);
    std::string expected;
    for (const char* name : {"f.0003.png", "f.0004.png", "f.0005.png"})
      expected += codes_of_png(folder.path(name), row.channels);
    CHECK(video.out.size() == expected.size());
    CHECK(video.out == expected);
  }
}

TEST_CASE("Raw video of a cube map's cross is one picture a frame, and --quiet says nothing beside it") {
  const ScratchFolder folder;
  const Outcome video = run_command({"render", "builtin:circle", "--size", "8x8", "--cube-map", "eye", "--cube-cross",
                                     "--frames", "0-1", "--raw-video", "-o", "-", "--quiet"},
                                    folder.path(""));
  CHECK(video.exit_code == 0);
  CHECK(video.err.empty());
  CHECK(video.out.size() == 2u * 32 * 24 * 4);
}

TEST_CASE("Raw video has standard output for itself, and a reader that goes ends it in a line") {
  const ScratchFolder folder;
  check_refused(draw({"--raw-video"}, folder), 2, "give -o - and no other -o");
  check_refused(draw({"--raw-video", "-o", "a.png"}, folder), 2, "give -o - and no other -o");
  check_refused(draw({"--raw-video", "-o", "-", "-o", "a.png"}, folder), 2, "give -o - and no other -o");
  check_refused(draw({"--raw-video", "-o", "-", "--hash"}, folder), 2, "standard output is the video");
  check_refused(draw({"--raw-video", "-o", "-", "--aov", "depth"}, folder), 2, "planes go into an EXR only");
  check_refused(run_command({"render", "builtin:circle", "--cube-map", "eye", "--raw-video", "-o", "-"}), 2,
                "there are six");
  const std::string gone = "cd '" + folder.path("") +
                           "' && { " TRUESHADE_COMMAND
                           " render builtin:circle --size 640x480 --frames 0-40 --raw-video -o - --quiet 2>err; "
                           "echo $? >code; } | head -c 1000 >/dev/null";
  CHECK(std::system(gone.c_str()) == 0);
  std::ifstream code(folder.path("code"));
  const std::string said = contents(folder.path("err"));
  int exit_code = -1;
  code >> exit_code;
  CHECK(exit_code == 5);
  CHECK(said.starts_with("trueshade: error: standard output: cannot write: Broken pipe"));
  CHECK(said.find('\n') == said.size() - 1);
}

}  // namespace trueshade
