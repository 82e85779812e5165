#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace trueshade {

/// Some literal bytes, then `length` bytes that repeat the bytes `distance` places earlier. A length of 0 means that no
/// repetition follows.
struct Repetition {
  uint32_t literals;
  uint16_t length;    ///< 3 to 258, or 0
  uint16_t distance;  ///< 1 to 32767
};

/// Finds repetitions in a run of bytes, front to back, as LZ77 does (J. Ziv and A. Lempel, 1977).
///
/// A table remembers where each of some 8000 hashes of four bytes was seen last, and that place alone is tried. Where
/// nothing repeats, more and more bytes are passed over between two tries. A search is therefore bounded by the number
/// of bytes, and long repetitions cost next to nothing.
class RepetitionFinder {
 public:
  RepetitionFinder() : last_seen_(size_t(1) << kHashBits) {}

  /// Begins with other bytes, which have to stay as they are. Fewer than 2^32.
  void begin(std::span<const uint8_t> bytes);
  bool at_end() const { return at_ == bytes_.size(); }

  /// The next bytes as repetitions, about `most_symbols` literals and repetitions of them; how many bytes these are.
  size_t next(size_t most_symbols, std::vector<Repetition>& found);

 private:
  static constexpr int kHashBits = 13;

  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
  std::vector<uint32_t> last_seen_;

  size_t length_at(size_t at, size_t before) const;
};

}  // namespace trueshade
