#pragma once
#include <string>

#include "cli/frame_text.h"
#include "cli/options.h"

namespace trueshade {

/// Error(usage) where standard output is a terminal, which shows a video's bytes as garbage.
void check_video_is_taken();

/// Writes the codes that a PNG of the picture would hold to standard output: rows from the top down, pixel after pixel,
/// R first, 16 bits the more significant byte first, and nothing else.
void write_raw_video(const RenderOptions& options, const RenderedFrame& result);

/// What of the video ffmpeg has to be told, as its options. `picture`: any of the video's.
std::string raw_video_note(const RenderOptions& options, const RenderedFrame& picture);

}  // namespace trueshade
