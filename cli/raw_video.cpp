#include "cli/raw_video.h"

#include <unistd.h>

#include <array>

#include "cli/json_text.h"
#include "cli/option_values.h"
#include "cli/picture_encoding.h"
#include "core/image_files/png_codes.h"

namespace trueshade {
namespace {

/// ffmpeg's names, by bits (8, 16) and channels (1 to 4).
constexpr std::array<std::array<const char*, 4>, 2> kPixelFormats = {
    {{"gray", "ya8", "rgb24", "rgba"}, {"gray16be", "ya16be", "rgb48be", "rgba64be"}}};

}  // namespace

void check_video_is_taken() {
  if (isatty(STDOUT_FILENO) != 0)
    throw usage("--raw-video", "standard output is a terminal", "add > FILE, or | and a program that reads the video");
}

std::vector<uint8_t> raw_video(const RenderOptions& options, const RenderedFrame& result) {
  const Image& color = result.frame.color;
  const PngCodes codes(color, file_options(options, result.pipeline, result.scene));
  std::vector<uint8_t> bytes(codes.row_bytes() * size_t(color.height));
  for (int y = 0; y < color.height; ++y) codes.row(y, bytes.data() + size_t(y) * codes.row_bytes());
  return bytes;
}

std::string raw_video_note(const RenderOptions& options, const RenderedFrame& picture) {
  const Image& color = picture.frame.color;
  const PngCodes codes(color, file_options(options, picture.pipeline, picture.scene));
  return std::string("raw video: ffmpeg -f rawvideo -pixel_format ") +
         kPixelFormats[size_t(codes.bits() / 8 - 1)][size_t(codes.channels() - 1)] + " -video_size " +
         std::to_string(color.width) + 'x' + std::to_string(color.height) + " -framerate " +
         json_number(picture.scene.timeline.fps) + " -i - FILE.mp4";
}

}  // namespace trueshade
