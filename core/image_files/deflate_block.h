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

  /// To be called before so many bytes are written: put() and flush() do not look whether there is room.
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
  /// Writes whole bytes, and keeps up to 7 bits.
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
  /// Whole bytes, after fill_byte().
  void copy(std::span<const uint8_t> bytes) { end_ = std::copy(bytes.begin(), bytes.end(), end_); }
  /// Ends the last byte and takes back the room that was not needed.
  void finish() {
    make_room(0);
    fill_byte();
    out_->resize(size_t(end_ - out_->data()));
  }

 private:
  std::vector<uint8_t>* out_;
  uint8_t* end_;  ///< of what is written
  uint64_t waiting_ = 0;
  int count_ = 0;
};

/// Writes one block (RFC 1951, section 3.2) of bytes that `found` describes: with a code of its own, or stored where
/// that is shorter. No bytes give an empty stored block.
void write_block(std::span<const uint8_t> bytes, std::span<const Repetition> found, bool last, BitWriter& out);

}  // namespace trueshade
