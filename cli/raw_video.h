#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "cli/frame_text.h"
#include "cli/options.h"

namespace trueshade {

/// Error(usage) where standard output is a terminal, which shows a video's bytes as garbage.
void check_video_is_taken();

/// The codes that a PNG of the picture would hold: rows from the top down, pixel after pixel, R first, 16 bits the more
/// significant byte first, and nothing else.
std::vector<uint8_t> raw_video(const RenderOptions& options, const RenderedFrame& result);

/// What of the video ffmpeg has to be told, as its options. `picture`: any of the video's.
std::string raw_video_note(const RenderOptions& options, const RenderedFrame& picture);

}  // namespace trueshade
