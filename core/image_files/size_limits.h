#pragma once
#include <algorithm>
#include <cstdint>
#include <string>

#include "core/error.h"
#include "core/pixel_cap.h"

namespace trueshade {

/// Limits of images that are read, whatever their headers claim. The memory cap bounds their pixels, too.
inline constexpr int kMaxSide = 1 << 20;
inline constexpr uint64_t kMaxPixels = (uint64_t(1) << 31) - 1;
/// Of those that a scene has as textures.
inline constexpr int kMaxTexturePictureSide = 16384;
inline constexpr uint64_t kMaxDecodedBytes = uint64_t(4) << 30;

inline Error bad_image(const std::string& path, const std::string& reason,
                       const std::string& remedy = "write the file again") {
  return {ErrorKind::bad_input, path, reason, remedy};
}

/// Error(bad_input) for a side of 0, Error(limit) for an image over the limits.
inline void check_size(const std::string& path, int width, int height) {
  if (width < 1 || height < 1) throw bad_image(path, "a side of it is 0");
  if (width > kMaxSide || height > kMaxSide || uint64_t(width) * uint64_t(height) > kMaxPixels)
    throw Error(ErrorKind::limit, path, "it is over 1048576 pixels a side, or 2^31 in all", "give a part of it");
  require_pixels(width, height, path);
}

/// The same for a texture.
inline void check_texture_size(const std::string& path, int width, int height, uint64_t texel_bytes) {
  check_size(path, width, height);
  if (std::max(width, height) > kMaxTexturePictureSide ||
      uint64_t(width) * uint64_t(height) * texel_bytes > kMaxDecodedBytes)
    throw Error(ErrorKind::limit, path, "it is over 16384 pixels a side or 4 GiB decoded", "give a part of it");
}

}  // namespace trueshade
