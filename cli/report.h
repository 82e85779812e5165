#pragma once
#include <span>
#include <string>
#include <string_view>

#include "cli/frame_text.h"

namespace trueshade {

/// Planes that report_page() shows; they must be among the frame's.
std::span<const std::string_view> report_planes();

/// A page of HTML that needs no other file: the picture, the planes, lights per pixel, hash, counts, times, pipeline.
std::string report_page(const RenderedFrame& result);

}  // namespace trueshade
