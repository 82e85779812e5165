#include "core/image_files/deflate.h"

#include <libdeflate.h>

#include "core/image_files/deflate_block.h"

namespace trueshade {
namespace {

/// Symbols of a block. Fewer would cost more codes, and more would share one code between bytes that differ in kind.
constexpr size_t kSymbolsOfBlock = 32768;

}  // namespace

void Deflater::append(std::span<const uint8_t> bytes, Part part, std::vector<uint8_t>& out) {
  const bool empty = bytes.empty();
  BitWriter writer(out);
  finder_.begin(bytes);
  while (!finder_.at_end()) {
    const size_t count = finder_.next(kSymbolsOfBlock, found_);
    write_block(bytes.first(count), found_, part == Part::last && finder_.at_end(), writer);
    bytes = bytes.subspan(count);
  }
  if (part == Part::inner || empty) write_block({}, {}, part == Part::last, writer);
  writer.finish();
}

std::array<uint8_t, 4> zlib_trailer(uint32_t checksum) {
  return {uint8_t(checksum >> 24), uint8_t(checksum >> 16), uint8_t(checksum >> 8), uint8_t(checksum)};
}

uint32_t adler_of(std::span<const uint8_t> bytes) {
  return libdeflate_adler32(kAdlerOfNothing, bytes.data(), bytes.size());
}

/// The lower half is 1 and the sum of all bytes, the upper half the sum of the lower halves after each byte.
uint32_t adler_of_both(uint32_t first, uint32_t second, uint64_t second_bytes) {
  constexpr uint64_t kModulus = 65521;
  const uint64_t before = (first & 0xffff) + kModulus - 1;  // the sum of the first bytes
  const uint64_t low = (before + (second & 0xffff)) % kModulus;
  const uint64_t high = ((first >> 16) + (second >> 16) + before % kModulus * (second_bytes % kModulus)) % kModulus;
  return uint32_t(high << 16 | low);
}

}  // namespace trueshade
