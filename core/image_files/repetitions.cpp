#include "core/image_files/repetitions.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace trueshade {
namespace {

constexpr size_t kTried = 4, kShortest = 3, kLongest = 258, kFarthest = 32767;
constexpr size_t kInside = 2;  // how far before a repetition's end the next table entry is made
constexpr int kPatience = 5;   // after every 2^kPatience failed tries the step grows by a byte

template <typename Word>
Word word_at(const uint8_t* bytes) {
  Word word;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

/// D. Knuth, The Art of Computer Programming, section 6.4: multiplication by the golden ratio.
size_t hash_of(uint32_t word, int bits) { return (word * 2654435761u) >> (32 - bits); }

/// A repetition of any length in parts of 3 to 258 bytes.
void add_parts(size_t literals, size_t length, size_t distance, std::vector<Repetition>& found) {
  while (length > 0) {
    size_t part = std::min(length, kLongest);
    if (length > part && length - part < kShortest) part = length - kShortest;
    found.push_back({uint32_t(literals), uint16_t(part), uint16_t(distance)});
    literals = 0;
    length -= part;
  }
}

}  // namespace

void RepetitionFinder::begin(std::span<const uint8_t> bytes) {
  bytes_ = bytes;
  at_ = 0;
  std::fill(last_seen_.begin(), last_seen_.end(), 0u);
}

/// How many bytes from `at` on repeat those from `before` on.
size_t RepetitionFinder::length_at(size_t at, size_t before) const {
  const uint8_t* const bytes = bytes_.data();
  const size_t end = bytes_.size();
  size_t i = at;
  for (; i + 8 <= end; i += 8)
    if (const uint64_t different = word_at<uint64_t>(bytes + i) ^ word_at<uint64_t>(bytes + before + (i - at)))
      return i - at + size_t(std::countr_zero(different) / 8);
  while (i < end && bytes[i] == bytes[before + (i - at)]) ++i;
  return i - at;
}

size_t RepetitionFinder::next(size_t most_symbols, std::vector<Repetition>& found) {
  found.clear();
  const uint8_t* const bytes = bytes_.data();
  uint32_t* const last_seen = last_seen_.data();
  const size_t first = at_, last_try = bytes_.size() - std::min(bytes_.size(), kTried);
  size_t literal = at_, literals = 0, misses = 0;
  while (at_ < last_try && literals + found.size() + (at_ - literal) < most_symbols) {
    const auto word = word_at<uint32_t>(bytes + at_);
    uint32_t& seen = last_seen[hash_of(word, kHashBits)];
    const size_t before = seen;
    seen = uint32_t(at_);
    if (word_at<uint32_t>(bytes + before) != word || before >= at_ || at_ - before > kFarthest) {
      at_ += 1 + (misses++ >> kPatience);
      continue;
    }
    const size_t length = length_at(at_, before);
    add_parts(at_ - literal, length, at_ - before, found);
    literals += at_ - literal;
    literal = at_ += length;
    misses = 0;
    if (at_ >= last_try) break;
    last_seen[hash_of(word_at<uint32_t>(bytes + at_ - kInside), kHashBits)] = uint32_t(at_ - kInside);
  }
  if (at_ >= last_try) at_ = bytes_.size();
  if (at_ > literal) found.push_back({uint32_t(at_ - literal), 0, 0});
  return at_ - first;
}

}  // namespace trueshade
