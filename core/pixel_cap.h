#pragma once
#include <cstdint>
#include <string_view>

// A limit on the pixels of a picture that the process draws or reads. The process has one, as it has one memory cap.
namespace trueshade {

/// There is none until this is called.
void set_pixel_cap(uint64_t pixels);

/// Is called before a picture is drawn or decoded. Throws Error(limit) that names --max-pixels if it has more pixels.
void require_pixels(int width, int height, std::string_view where);

}  // namespace trueshade
