#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/image_files/repetitions.h"

namespace trueshade {

static_assert(std::endian::native ==
              std::endian::little);  // words of bits are written, and words of bytes compared, as they are

/// Appends numbers of a few bits each to bytes, the first bit lowest.
class BitWriter {
 public:
  explicit BitWriter(std::vector<uint8_t>& out) : out_(&out), end_(out.data() + out.size()) {}

  /// Makes room for `bytes` more bytes. put() and flush() do not check that there is room.
  void make_room(size_t bytes) {
    const size_t written = size_t(end_ - out_->data());
    out_->resize(written + bytes + sizeof waiting_);
    end_ = out_->data() + written;
  }

  /// At most 56 bits between two calls of flush().
  void put(uint64_t value, int bits) {
    waiting_ |= value << count_;
    count_ += bits;
  }
  /// Writes the whole bytes that have come together; up to 7 bits wait for the next flush().
  void flush() {
    std::memcpy(end_, &waiting_, sizeof waiting_);
    end_ += count_ / 8;
    waiting_ >>= count_ / 8 * 8;
    count_ %= 8;
  }
  void fill_byte() {
    flush();
    count_ = count_ > 0 ? 8 : 0;
    flush();
  }
  /// Appends whole bytes; fill_byte() comes before.
  void copy(std::span<const uint8_t> bytes) { end_ = std::copy(bytes.begin(), bytes.end(), end_); }
  /// Ends the last byte and takes back the room that was not needed.
  void finish() {
    make_room(0);
    fill_byte();
    out_->resize(size_t(end_ - out_->data()));
  }

 private:
  std::vector<uint8_t>* out_;
  uint8_t* end_;  ///< the end of the bytes that are written
  uint64_t waiting_ = 0;
  int count_ = 0;
};

/// Writes one block (RFC 1951, section 3.2) of the bytes that `found` describes. The block has a prefix code made for
/// these bytes, or holds the bytes as they are, if that is shorter. No bytes give an empty block of the second kind.
void write_block(std::span<const uint8_t> bytes, std::span<const Repetition> found, bool last, BitWriter& out);

}  // namespace trueshade
