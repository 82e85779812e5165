// Streams of ours, taken apart by zlib.
#include "core/image_files/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/image_files/prefix_code.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

using Bytes = std::vector<uint8_t>;

/// zlib checks the code, every distance and the checksum.
Bytes inflated_within(const Bytes& stream, size_t most) {
  Bytes out(most + 1);
  uLongf size = uLongf(out.size());
  REQUIRE(uncompress(out.data(), &size, stream.data(), uLong(stream.size())) == Z_OK);
  out.resize(size);
  return out;
}

/// A stream of the format zlib that is made in parts of so many bytes.
Bytes stream_of(const Bytes& bytes, size_t part_bytes) {
  Deflater deflater;
  Bytes stream(kZlibHeader.begin(), kZlibHeader.end());
  uint32_t checksum = kAdlerOfNothing;
  for (size_t at = 0; at == 0 || at < bytes.size(); at += part_bytes) {
    const std::span<const uint8_t> part = std::span(bytes).subspan(at, std::min(part_bytes, bytes.size() - at));
    const size_t before = stream.size();
    deflater.append(part, at + part.size() == bytes.size() ? Deflater::Part::last : Deflater::Part::inner, stream);
    REQUIRE(stream.size() - before <= part.size() + part.size() / 1000 + 32);
    checksum = adler_of_both(checksum, adler_of(part), part.size());
  }
  const auto trailer = zlib_trailer(checksum);
  stream.insert(stream.end(), trailer.begin(), trailer.end());
  return stream;
}

uint32_t next_random(uint32_t& state) { return state = state * 1664525u + 1013904223u, state >> 8; }

/// Bytes of many kinds: what repeats near and far, what is rare, and what never repeats.
std::vector<std::pair<std::string, std::function<uint8_t(size_t, uint32_t)>>> kinds() {
  return {{"zero", [](size_t, uint32_t) { return 0; }},
          {"noise", [](size_t, uint32_t random) { return uint8_t(random); }},
          {"three values", [](size_t, uint32_t random) { return uint8_t(random % 3); }},
          {"one value in a thousand", [](size_t, uint32_t random) { return uint8_t(random % 1000 == 0); }},
          {"geometric values", [](size_t, uint32_t random) { return uint8_t(__builtin_ctz(random | 1u << 20)); }},
          {"a period of two", [](size_t i, uint32_t) { return uint8_t(i % 2 == 0 ? 17 : 240); }},
          {"a period of 255 to 261", [](size_t i, uint32_t) { return uint8_t(i % (255 + i / 40000 % 7) * 7 / 5); }},
          {"a period of 32767 of noise", [](size_t i, uint32_t) { return uint8_t((i % 32767) * 2654435761u >> 13); }},
          {"a period of 32768 of noise", [](size_t i, uint32_t) { return uint8_t((i % 32768) * 2654435761u >> 13); }},
          {"noise and flat in turn",
           [](size_t i, uint32_t random) { return i / 5000 % 2 == 0 ? uint8_t(random) : uint8_t(9); }}};
}

TEST_CASE("Streams of bytes of every kind and length come back, in one part and in many") {
  uint32_t state = 5;
  for (const auto& [name, byte_of] : kinds())
    for (const size_t size :
         {0, 1, 2, 3, 4, 5, 7, 8, 257, 258, 259, 260, 261, 262, 516, 519, 4099, 65535, 65536, 300000}) {
      Bytes bytes(size);
      for (size_t i = 0; i < size; ++i) bytes[i] = byte_of(i, next_random(state));
      for (const size_t part : {size_t(1000000), size_t(40000), size / 2 + 1}) {
        INFO(name << ", " << size << " bytes, parts of " << part);
        REQUIRE(inflated_within(stream_of(bytes, part), size) == bytes);
      }
    }
}

TEST_CASE("Repetitions of every length from every short distance come back") {
  for (size_t distance = 1; distance < 300; distance += distance < 20 ? 1 : 37)
    for (size_t length = 3; length < 600; length += length < 270 ? 1 : 59) {
      Bytes bytes;
      for (size_t i = 0; i < distance + length; ++i)
        bytes.push_back(i < distance ? uint8_t(i * 2654435761u >> 11) : bytes[i - distance]);
      bytes.push_back(uint8_t(~bytes[bytes.size() - distance]));
      REQUIRE(inflated_within(stream_of(bytes, bytes.size()), bytes.size()) == bytes);
    }
}

TEST_CASE("A run of equal bytes is compressed to less than a hundredth, and to equal bytes every time") {
  const Bytes bytes(1000000, 3);
  const Bytes stream = stream_of(bytes, bytes.size());
  CHECK(stream.size() < bytes.size() / 100);
  CHECK(stream == stream_of(bytes, bytes.size()));
}

TEST_CASE("Code lengths fill the code space, keep their limit, and are Huffman's where he keeps it") {
  uint32_t state = 9;
  for (const int most_bits : {7, 14})
    for (int round = 0; round < 200; ++round) {
      std::vector<uint32_t> counts(size_t(2 + round % (most_bits == 7 ? 18 : 285)));
      for (size_t i = 0; i < counts.size(); ++i)  // growing by the golden ratio, which makes the longest words
        counts[i] =
            round % 2 == 0 ? next_random(state) % 100 : uint32_t(1 + std::min(2e6, 0.5 * std::pow(1.618, double(i))));
      counts[0] = counts[1] = 1;
      std::vector<uint8_t> lengths(counts.size());
      code_lengths(counts, most_bits, lengths);
      double space = 0;
      for (size_t i = 0; i < counts.size(); ++i) {
        REQUIRE((lengths[i] > 0) == (counts[i] > 0));
        REQUIRE(lengths[i] <= most_bits);
        if (lengths[i] > 0) space += std::pow(0.5, lengths[i]);
      }
      REQUIRE(space == 1.0);
    }
  std::vector<uint8_t> lengths(5);
  code_lengths(std::vector<uint32_t>{1, 1, 2, 4, 8}, 14, lengths);
  CHECK(lengths == std::vector<uint8_t>{4, 4, 3, 2, 1});
}

}  // namespace
}  // namespace trueshade
