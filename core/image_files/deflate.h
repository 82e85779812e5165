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

/// Makes zlib streams (RFC 1950) with libdeflate at its fastest level that looks for repetitions. On a
/// picture of city at 3840x2160 it took 0.13 s of CPU for 4.3 MB, zlib's level 1 took 0.24 s for 5.1 MB and zlib's run
/// lengths with the filter Paeth 0.22 s for 4.2 MB. Equal bytes give equal streams. One thread at a time.
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
