#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace trueshade {

/// Bytes as one stream in the format zlib (RFC 1950), in fewer bytes and more time than Deflater takes. Any number of
/// threads at a time.
std::vector<uint8_t> zlib_stream(std::span<const uint8_t> bytes);

}  // namespace trueshade
