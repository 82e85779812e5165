#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

struct libdeflate_compressor;

namespace trueshade {

/// Memory whose pages cost nothing until they are written.
struct Buffer {
  std::unique_ptr<uint8_t[]> bytes;
  size_t size = 0;

  explicit Buffer(size_t count) : bytes(std::make_unique_for_overwrite<uint8_t[]>(count)), size(count) {}
  std::span<uint8_t> first(size_t count) const { return {bytes.get(), count}; }
};

/// Makes zlib streams (RFC 1950) with libdeflate at its fastest level that looks for repetitions. Of the designs that
/// were measured (zlib in bands on all threads, zlib's run lengths alone, libdeflate) it makes the smallest files in
/// the least CPU time. Equal bytes give equal streams. One thread at a time.
class Deflater {
 public:
  Deflater();
  ~Deflater();
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  /// Bytes written to `out`, 0 where the stream has more than `out`.
  size_t compress(std::span<const uint8_t> in, std::span<uint8_t> out);

  /// The most bytes that a stream of so many bytes has.
  static size_t most(size_t bytes);

 private:
  libdeflate_compressor* compressor_;
};

}  // namespace trueshade
