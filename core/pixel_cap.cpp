#include "core/pixel_cap.h"

#include <atomic>
#include <string>

#include "core/error.h"

namespace trueshade {
namespace {

std::atomic<uint64_t> most_pixels{UINT64_MAX};

}  // namespace

void set_pixel_cap(uint64_t pixels) { most_pixels = pixels; }

void require_pixels(int width, int height, std::string_view where) {
  const uint64_t most = most_pixels;
  if (uint64_t(width) * uint64_t(height) <= most) return;
  throw Error(ErrorKind::limit, where,
              "a picture of " + std::to_string(width) + 'x' + std::to_string(height) + " is over the limit",
              "at most " + std::to_string(most) + " pixels, or a higher --max-pixels");
}

}  // namespace trueshade
