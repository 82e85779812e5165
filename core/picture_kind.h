#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace trueshade {

/// What a picture's first bytes say it is, whatever its name ends in: "PNG", "JPEG", "OpenEXR", or the name of a format
/// that is refused; empty where they say nothing that is known here.
inline std::string_view picture_kind(std::span<const uint8_t> content) {
  struct Magic {
    std::string_view name, bytes;
  };
  constexpr Magic kMagics[] = {{"PNG", "\x89PNG\r\n\x1a\n"},
                               {"JPEG", "\xff\xd8\xff"},
                               {"OpenEXR", "\x76\x2f\x31\x01"},
                               {"KTX2", "\xabKTX 20"},
                               {"KTX", "\xabKTX 11"},
                               {"WebP", "RIFF"},
                               {"DDS", "DDS "},
                               {"GIF", "GIF8"},
                               {"BMP", "BM"},
                               {"TIFF", std::string_view("II*\0", 4)},
                               {"TIFF", std::string_view("MM\0*", 4)},
                               {"JPEG 2000", std::string_view("\0\0\0\x0cjP  ", 8)},
                               {"JPEG XL", "\xff\x0a"},
                               {"PNM", "P6"},
                               {"Radiance HDR", "#?"}};
  const std::string_view start(reinterpret_cast<const char*>(content.data()),
                               content.size() < 16 ? content.size() : 16);
  for (const Magic& magic : kMagics)
    if (start.starts_with(magic.bytes)) return magic.name;
  return {};
}

}  // namespace trueshade
