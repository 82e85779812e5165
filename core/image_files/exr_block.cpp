#include "core/image_files/exr_block.h"

#include <algorithm>
#include <array>

namespace trueshade {
struct ExrBlockWriter::Work {
  /// Memory whose pages cost nothing until they are written.
  struct Buffer {
    std::unique_ptr<uint8_t[]> bytes;
    size_t size = 0;

    explicit Buffer(size_t count) : bytes(std::make_unique_for_overwrite<uint8_t[]>(count)), size(count) {}
    std::span<uint8_t> first(size_t count) const { return {bytes.get(), count}; }
  };

  /// ZIP's preparation: bytes at even places before those at odd ones, then each as its difference from the byte
  /// before. The two halves of a block grow at once.
  class Differences {
   public:
    explicit Differences(size_t bytes) : bytes_(bytes), half_(bytes / 2) {}  // a sample has an even number of bytes

    void add(std::span<const uint8_t> samples) {
      add_half(samples, 0, bytes_.bytes.get() + filled_, last_[0]);
      add_half(samples, 1, bytes_.bytes.get() + half_ + filled_, last_[1]);
      filled_ += samples.size() / 2;
    }
    /// All of the block, once it is added.
    std::span<const uint8_t> finish() {
      bytes_.bytes[half_] = uint8_t(bytes_.bytes[half_] - last_[0]);  // it stands behind the last even byte
      bytes_.bytes[0] = uint8_t(bytes_.bytes[0] - kBias);             // and the first of all behind none
      return bytes_.first(2 * half_);
    }
    void restart(size_t bytes) { half_ = bytes / 2, filled_ = 0, last_[0] = last_[1] = 0; }

   private:
    static constexpr uint8_t kBias = 128;

    static void add_half(std::span<const uint8_t> samples, size_t parity, uint8_t* out, uint8_t& last) {
      const uint8_t* const from = samples.data() + parity;
      const size_t count = samples.size() / 2;
      out[0] = uint8_t(from[0] - last + kBias);
      for (size_t i = 1; i < count; ++i) out[i] = uint8_t(from[2 * i] - from[2 * i - 2] + kBias);
      last = from[2 * count - 2];
    }

    Buffer bytes_;
    size_t half_, filled_ = 0;
    uint8_t last_[2] = {0, 0};
  };

  ExrRows rows;
  Buffer samples;  ///< of a channel in a row
  Differences differences;
  Deflater deflater;

  Work(std::span<const ExrChannel> channels, int most_rows)
      : rows(channels), samples(rows.row_bytes()), differences(rows.row_bytes() * size_t(most_rows)) {}

  /// The samples of rows, in the order in which a block has them.
  template <typename Take>
  void for_samples(int first, int end, Take take) {
    for (int y = first; y < end; ++y)
      for (const ExrChannel& channel : rows.channels()) {
        const std::span<uint8_t> row = samples.first(rows.channel_bytes(channel));
        rows.pack(channel, y, row.data());
        take(std::span<const uint8_t>(row));
      }
  }
};

ExrBlockWriter::ExrBlockWriter(std::span<const ExrChannel> channels, int most_rows)
    : work_(std::make_unique<Work>(channels, most_rows)) {}
ExrBlockWriter::~ExrBlockWriter() = default;

std::vector<uint8_t> ExrBlockWriter::block(std::span<const uint32_t> place, int first, int end) {
  Work& w = *work_;
  const size_t header = 4 * (place.size() + 1), bytes = w.rows.row_bytes() * size_t(end - first);
  w.differences.restart(bytes);
  w.for_samples(first, end, [&w](std::span<const uint8_t> samples) { w.differences.add(samples); });
  const std::span<const uint8_t> block = w.differences.finish();
  std::vector<uint8_t> piece(header + kZlibHeader.size());
  std::copy(kZlibHeader.begin(), kZlibHeader.end(), piece.begin() + std::ptrdiff_t(header));
  w.deflater.append(block, Deflater::Part::last, piece);
  const std::array<uint8_t, 4> trailer = zlib_trailer(adler_of(block));
  piece.insert(piece.end(), trailer.begin(), trailer.end());
  if (piece.size() - header >= bytes) {
    piece.resize(header);
    w.for_samples(first, end, [&piece](auto samples) { piece.insert(piece.end(), samples.begin(), samples.end()); });
  }
  uint8_t* out = piece.data();
  const auto put = [&out](uint32_t word) {
    for (const int shift : {0, 8, 16, 24}) *out++ = uint8_t(word >> shift);
  };
  for (const uint32_t word : place) put(word);
  put(uint32_t(piece.size() - header));
  return piece;
}

}  // namespace trueshade
