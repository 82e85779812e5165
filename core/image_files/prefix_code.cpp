#include "core/image_files/prefix_code.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

namespace trueshade {
namespace {

constexpr size_t kMostSymbols = 512;
constexpr int kLongestPrefixWord = 15;

/// The symbols that occur, rarest first: count and symbol in one number, so that they sort quickly.
struct Leaves {
  std::array<uint64_t, kMostSymbols> sorted;
  size_t size = 0;

  explicit Leaves(std::span<const uint32_t> counts) {
    for (size_t symbol = 0; symbol < counts.size(); ++symbol)
      if (counts[symbol] != 0) sorted[size++] = uint64_t(counts[symbol]) << 16 | symbol;
    std::sort(sorted.begin(), sorted.begin() + std::ptrdiff_t(size));
  }
  uint32_t count(size_t i) const { return uint32_t(sorted[i] >> 16); }
  size_t symbol(size_t i) const { return sorted[i] & 0xffff; }
};

/// How many words there are of each length in Huffman's code. Words over `most_bits` count as of that length.
///
/// Nodes that join two others come out in the order of their counts, so that the rarest node is the front one of the
/// leaves or the front one of the joined nodes (J. van Leeuwen, 1976).
void count_lengths(const Leaves& leaves, int most_bits, std::span<uint32_t> words_of) {
  std::array<uint32_t, 2 * kMostSymbols> weight;
  std::array<uint16_t, 2 * kMostSymbols> parent, depth;
  const size_t root = 2 * leaves.size - 2;
  for (size_t i = 0; i < leaves.size; ++i) weight[i] = leaves.count(i);
  size_t leaf = 0, joined = leaves.size;
  for (size_t next = leaves.size; next <= root; ++next) {
    weight[next] = 0;
    for (int child = 0; child < 2; ++child) {
      const bool is_leaf = leaf < leaves.size && (joined >= next || weight[leaf] <= weight[joined]);
      const size_t rarest = is_leaf ? leaf++ : joined++;
      weight[next] += weight[rarest];
      parent[rarest] = uint16_t(next);
    }
  }
  depth[root] = 0;
  for (size_t i = root; i-- > 0;) depth[i] = uint16_t(depth[parent[i]] + 1);
  for (size_t i = 0; i < leaves.size; ++i) ++words_of[std::min(size_t(depth[i]), size_t(most_bits))];
}

/// Shortening words has taken more code space than there is. Each step frees one unit: a shorter word grows by one bit,
/// and a word of the most bits becomes its sibling.
void fit_lengths(int most_bits, std::span<uint32_t> words_of) {
  uint64_t space = 0;
  for (int bits = 1; bits <= most_bits; ++bits) space += uint64_t(words_of[size_t(bits)]) << (most_bits - bits);
  for (; space > uint64_t(1) << most_bits; --space) {
    int bits = most_bits - 1;
    while (words_of[size_t(bits)] == 0) --bits;
    --words_of[size_t(bits)];
    words_of[size_t(bits) + 1] += 2;
    --words_of[size_t(most_bits)];
  }
}

}  // namespace

void code_lengths(std::span<const uint32_t> counts, int most_bits, std::span<uint8_t> lengths) {
  assert(counts.size() <= kMostSymbols && lengths.size() == counts.size() && most_bits <= kLongestPrefixWord);
  std::fill(lengths.begin(), lengths.end(), uint8_t(0));
  const Leaves leaves(counts);
  if (leaves.size == 1) lengths[leaves.symbol(0)] = 1;
  if (leaves.size < 2) return;
  std::array<uint32_t, kLongestPrefixWord + 1> words_of{};
  count_lengths(leaves, most_bits, words_of);
  fit_lengths(most_bits, words_of);
  size_t next = 0;
  for (int bits = most_bits; bits > 0; --bits)
    for (uint32_t i = 0; i < words_of[size_t(bits)]; ++i) lengths[leaves.symbol(next++)] = uint8_t(bits);
}

void code_words(std::span<const uint8_t> lengths, std::span<uint16_t> words) {
  std::array<uint32_t, kLongestPrefixWord + 2> words_of{}, next{};
  for (const uint8_t bits : lengths) ++words_of[bits];
  words_of[0] = 0;
  for (size_t bits = 0; bits <= kLongestPrefixWord; ++bits) next[bits + 1] = (next[bits] + words_of[bits]) << 1;
  for (size_t symbol = 0; symbol < lengths.size(); ++symbol) {
    uint32_t word = lengths[symbol] == 0 ? 0 : next[lengths[symbol]]++, reversed = 0;
    for (int bit = 0; bit < lengths[symbol]; ++bit, word >>= 1) reversed = reversed << 1 | (word & 1);
    words[symbol] = uint16_t(reversed);
  }
}

}  // namespace trueshade
