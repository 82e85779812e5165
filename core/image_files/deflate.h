#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image_files/repetitions.h"

namespace trueshade {

/// Makes parts of a compressed stream (RFC 1951). Parts in turn are one stream, and each can be made by itself: none
/// refers to bytes of another. Equal bytes give equal parts on every machine. One thread at a time.
///
/// For planes of city, libdeflate's fastest level took about twice the time and made 3 % fewer bytes: it tries every
/// byte of noise, and takes long repetitions byte by byte.
class Deflater {
 public:
  enum class Part : uint8_t {
    inner,  ///< others follow; it ends at a whole byte
    last,   ///< ends the stream
  };

  /// Appends a part to `out`. `bytes` are fewer than 2^32; the part is at most 0.1 % and 32 bytes longer.
  void append(std::span<const uint8_t> bytes, Part part, std::vector<uint8_t>& out);

 private:
  RepetitionFinder finder_;
  std::vector<Repetition> found_;
};

/// What stands before the stream and behind it in the format zlib (RFC 1950).
inline constexpr std::array<uint8_t, 2> kZlibHeader = {0x78, 0x01};
std::array<uint8_t, 4> zlib_trailer(uint32_t checksum);

/// Adler-32 of bytes, and that of two runs of bytes in turn from those of each.
inline constexpr uint32_t kAdlerOfNothing = 1;
uint32_t adler_of(std::span<const uint8_t> bytes);
uint32_t adler_of_both(uint32_t first, uint32_t second, uint64_t second_bytes);

}  // namespace trueshade
