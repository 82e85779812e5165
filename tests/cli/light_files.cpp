// Buffers of lights from a picture, through the command: sample i of an EXR is light i.
#include <cstring>
#include <fstream>

#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr int kWide = 3, kHigh = 2;
constexpr float kPosition[kWide * kHigh][3] = {{-2, 1, 0},    {0, 1.5f, 1}, {2, 1, 0},
                                               {-1, 0.5f, 2}, {1, 0.5f, 2}, {0, 3, -1}};
constexpr float kColor[kWide * kHigh][3] = {{1, 0, 0},         {0, 0.5f, 0},      {0, 0, 1},
                                            {0.25f, 0.25f, 0}, {0, 0.25f, 0.25f}, {0.5f, 0.5f, 0.5f}};

/// The samples as a picture, texel after texel from the top row on.
void write_buffer(const std::string& path, const float (&samples)[kWide * kHigh][3]) {
  Image image(kWide, kHigh, Format::rgba32f);
  for (int i = 0; i < kWide * kHigh; ++i) {
    const float texel[4] = {samples[i][0], samples[i][1], samples[i][2], 1.0f};
    std::memcpy(image.texel(i % kWide, i / kWide), texel, sizeof texel);
  }
  write_image(path, image, {}, {});
}

std::string numbers(const float (&samples)[kWide * kHigh][3]) {
  std::string text;
  for (const auto& s : samples)
    text += (text.empty() ? "[[" : ",[") + std::to_string(s[0]) + "," + std::to_string(s[1]) + "," +
            std::to_string(s[2]) + "]";
  return text + "]";
}

TEST_CASE("lights from an EXR draw the picture that the same lights in numbers draw") {
  const ScratchFolder folder;
  write_buffer(folder.path("p.exr"), kPosition);
  write_buffer(folder.path("c.exr"), kColor);
  const auto hash = [&](const std::string& position, const std::string& color) {
    std::ofstream(folder.path("s.json"))
        << R"({"version": 1, "camera": {"eye": [0, 2, 6]}, "objects": [{"mesh": "plane", "scale": 6}, {"mesh": "cube"}], "lights": [{"type": "buffers", "range": 4, "position": )"
        << position << R"(, "color": )" << color << "}]}";
    const Outcome outcome = run_command({"render", "s.json", "--size", "48x32", "--hash"}, folder.path(""));
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    return outcome.out;
  };
  const std::string expected = hash(numbers(kPosition), numbers(kColor));
  CHECK(hash("\"p.exr\"", "\"c.exr\"") == expected);
  CHECK(hash("\"p.exr\"", numbers(kColor)) == expected);
}

}  // namespace
}  // namespace trueshade
