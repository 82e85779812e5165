// P. Deutsch, "DEFLATE Compressed Data Format Specification version 1.3", RFC 1951, 1996.
#include "core/image_files/deflate_block.h"

#include <algorithm>
#include <array>

#include "core/image_files/prefix_code.h"

namespace trueshade {
namespace {

constexpr size_t kLiterals = 256, kEnd = 256, kFirstLength = 257, kSymbols = 286, kDistances = 30;
constexpr int kLongestWord = 14;  // four of them and 7 bits fit in 64
constexpr size_t kLengthSymbols = 19;
constexpr int kLongestLengthWord = 7;
constexpr size_t kMostStored = 65535;

/// How symbols stand for numbers: a symbol has a first number and bits that are added to it (section 3.2.5).
template <size_t kCount>
struct Ranges {
  std::array<uint16_t, kCount> first{};
  std::array<uint8_t, kCount> extra_bits{};
};

/// Ranges whose extra bits grow by one with every `of_a_size` symbols, after twice as many without any.
template <size_t kCount>
constexpr Ranges<kCount> growing_ranges(uint16_t first, size_t of_a_size) {
  Ranges<kCount> ranges;
  for (size_t i = 0; i < kCount; ++i) {
    const size_t bits = i < 2 * of_a_size ? 0 : i / of_a_size - 1;
    ranges.first[i] = first;
    ranges.extra_bits[i] = uint8_t(bits);
    first = uint16_t(first + (1u << bits));
  }
  return ranges;
}

constexpr Ranges<29> length_ranges() {
  Ranges<29> ranges = growing_ranges<29>(3, 4);
  ranges.first[28] = 258;  // the last symbol stands for the longest repetition alone
  ranges.extra_bits[28] = 0;
  return ranges;
}

constexpr Ranges<29> kLengthRanges = length_ranges();
constexpr Ranges<30> kDistanceRanges = growing_ranges<30>(1, 2);

constexpr std::array<uint8_t, 259> range_of_length() {
  std::array<uint8_t, 259> range{};
  for (size_t i = 0; i < 28; ++i)
    for (size_t k = 0; k < size_t(1) << kLengthRanges.extra_bits[i]; ++k)
      range[std::min<size_t>(kLengthRanges.first[i] + k, 257)] = uint8_t(i);
  range[258] = 28;
  return range;
}

/// Distances up to 256 one by one, then by 128: each range begins behind a multiple of 128 there.
constexpr std::array<uint8_t, 512> range_of_distance() {
  std::array<uint8_t, 512> range{};
  for (size_t k = 0, i = 0; k < range.size(); ++k) {
    const size_t distance = k < 256 ? k + 1 : (k - 256) * 128 + 1;
    if (distance == 1) i = 0;  // again
    while (i + 1 < kDistances && kDistanceRanges.first[i + 1] <= distance) ++i;
    range[k] = uint8_t(i);
  }
  return range;
}

constexpr std::array<uint8_t, 259> kRangeOfLength = range_of_length();
constexpr std::array<uint8_t, 512> kRangeOfDistance = range_of_distance();

size_t range_of(size_t distance) {
  return kRangeOfDistance[distance <= 256 ? distance - 1 : 256 + (distance - 1) / 128];
}

/// A prefix code with its words.
template <size_t kCount>
struct Code {
  std::array<uint32_t, kCount> counts{};
  std::array<uint8_t, kCount> lengths{};
  std::array<uint16_t, kCount> words{};

  void make(int most_bits) {
    code_lengths(counts, most_bits, lengths);
    code_words(lengths, words);
  }
  /// Symbols up to the last that occurs, and no fewer than `least`.
  size_t used(size_t least) const {
    size_t used = kCount;
    while (used > least && lengths[used - 1] == 0) --used;
    return used;
  }
  void put(size_t symbol, BitWriter& out) const { out.put(words.data()[symbol], lengths.data()[symbol]); }
  uint64_t bits() const {
    uint64_t sum = 0;
    for (size_t i = 0; i < kCount; ++i) sum += uint64_t(counts[i]) * lengths[i];
    return sum;
  }
};

using SymbolCode = Code<kSymbols>;
using DistanceCode = Code<kDistances>;

void count_symbols(const uint8_t* byte, std::span<const Repetition> found, SymbolCode& symbols,
                   DistanceCode& distances) {
  uint32_t literals[4][kLiterals] = {};  // four, so that equal bytes in turn need not wait
  for (const Repetition& r : found) {
    const uint8_t* const end = byte + r.literals;
    for (; byte + 4 <= end; byte += 4)
      for (size_t k = 0; k < 4; ++k) ++literals[k][byte[k]];
    for (; byte < end; ++byte) ++literals[0][*byte];
    if (r.length == 0) continue;
    byte += r.length;
    ++symbols.counts[kFirstLength + kRangeOfLength[r.length]];
    ++distances.counts[range_of(r.distance)];
  }
  for (size_t i = 0; i < kLiterals; ++i)
    symbols.counts[i] = literals[0][i] + literals[1][i] + literals[2][i] + literals[3][i];
  symbols.counts[kEnd] = 1;
}

/// Bits of numbers within their ranges.
uint64_t extra_bits(const SymbolCode& symbols, const DistanceCode& distances) {
  uint64_t bits = 0;
  for (size_t i = 0; i < kLengthRanges.first.size(); ++i)
    bits += uint64_t(symbols.counts[kFirstLength + i]) * kLengthRanges.extra_bits[i];
  for (size_t i = 0; i < kDistances; ++i) bits += uint64_t(distances.counts[i]) * kDistanceRanges.extra_bits[i];
  return bits;
}

/// The lengths of both codes as section 3.2.7 writes them: runs of equal lengths are symbols 16, 17 and 18, and a third
/// code stands for all of these.
class CodeHeader {
 public:
  CodeHeader(const SymbolCode& symbols, const DistanceCode& distances)
      : symbols_used_(symbols.used(kFirstLength)), distances_used_(distances.used(1)) {
    std::array<uint8_t, kSymbols + kDistances> lengths;
    std::copy_n(symbols.lengths.begin(), symbols_used_, lengths.begin());
    std::copy_n(distances.lengths.begin(), distances_used_, lengths.begin() + symbols_used_);
    const size_t all = symbols_used_ + distances_used_;
    for (size_t i = 0, end; i < all; i = end) {
      for (end = i + 1; end < all && lengths[end] == lengths[i];) ++end;
      add_run(lengths[i], end - i);
    }
    code_.make(kLongestLengthWord);
    orders_used_ = kLengthSymbols;
    while (orders_used_ > 4 && code_.lengths[kOrder[orders_used_ - 1]] == 0) --orders_used_;
  }

  uint64_t bits() const {
    return 14 + 3 * orders_used_ + code_.bits() + 2 * code_.counts[16] + 3 * code_.counts[17] + 7 * code_.counts[18];
  }

  void write(BitWriter& out) const {
    out.put(symbols_used_ - 257, 5);
    out.put(distances_used_ - 1, 5);
    out.put(orders_used_ - 4, 4);
    out.flush();
    for (size_t i = 0; i < orders_used_; ++i) {
      out.put(code_.lengths[kOrder[i]], 3);
      out.flush();
    }
    for (size_t i = 0; i < size_; ++i) {
      code_.put(items_[i].symbol, out);
      out.put(items_[i].extra, items_[i].symbol < 16 ? 0 : items_[i].symbol == 18 ? 7 : items_[i].symbol - 14);
      out.flush();
    }
  }

 private:
  static constexpr std::array<uint8_t, kLengthSymbols> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                                 11, 4,  12, 3, 13, 2, 14, 1, 15};
  struct Item {
    uint8_t symbol, extra;
  };

  void add(size_t symbol, size_t extra) {
    items_[size_++] = {uint8_t(symbol), uint8_t(extra)};
    ++code_.counts[symbol];
  }
  void add_run(uint8_t length, size_t count) {
    if (length != 0) add(length, 0), --count;
    const size_t least = 3, most = length != 0 ? 6 : 138;
    while (count >= least) {
      const size_t part = std::min(count, most);
      if (length != 0)
        add(16, part - 3);
      else if (part <= 10)
        add(17, part - 3);
      else
        add(18, part - 11);
      count -= part;
    }
    for (; count > 0; --count) add(length, 0);
  }

  size_t symbols_used_, distances_used_, orders_used_;
  Code<kLengthSymbols> code_;
  std::array<Item, kSymbols + kDistances> items_;
  size_t size_ = 0;
};

void write_symbols(const uint8_t* byte, std::span<const Repetition> found, const SymbolCode& symbols,
                   const DistanceCode& distances, BitWriter& writer) {
  BitWriter out = writer;  // a copy stays in registers: writes by uint8_t* may alias any object but a local one
  for (const Repetition& r : found) {
    const uint8_t* const end = byte + r.literals;
    for (; byte + 4 <= end; byte += 4) {
      for (size_t k = 0; k < 4; ++k) symbols.put(byte[k], out);
      out.flush();
    }
    for (; byte < end; ++byte) symbols.put(*byte, out);
    out.flush();
    if (r.length == 0) continue;
    byte += r.length;
    const size_t length = kRangeOfLength[r.length], distance = range_of(r.distance);
    symbols.put(kFirstLength + length, out);
    out.put(r.length - kLengthRanges.first[length], kLengthRanges.extra_bits[length]);
    distances.put(distance, out);
    out.put(r.distance - kDistanceRanges.first[distance], kDistanceRanges.extra_bits[distance]);
    out.flush();
  }
  symbols.put(kEnd, out);
  out.flush();
  writer = out;
}

void write_stored(std::span<const uint8_t> bytes, bool last, BitWriter& out) {
  out.make_room(bytes.size() + 5 * (bytes.size() / kMostStored + 2));
  do {
    const std::span<const uint8_t> part = bytes.first(std::min(bytes.size(), kMostStored));
    bytes = bytes.subspan(part.size());
    out.put(last && bytes.empty() ? 1 : 0, 3);
    out.fill_byte();
    out.put(part.size(), 16);
    out.put(~part.size() & 0xffff, 16);
    out.flush();
    out.copy(part);
  } while (!bytes.empty());
}

}  // namespace

void write_block(std::span<const uint8_t> bytes, std::span<const Repetition> found, bool last, BitWriter& out) {
  SymbolCode symbols;
  DistanceCode distances;
  count_symbols(bytes.data(), found, symbols, distances);
  symbols.make(kLongestWord);
  distances.make(kLongestWord);
  const CodeHeader header(symbols, distances);
  const uint64_t bits = 3 + header.bits() + symbols.bits() + distances.bits() + extra_bits(symbols, distances);
  if (bits / 8 >= bytes.size() + 5 * (bytes.size() / kMostStored)) return write_stored(bytes, last, out);
  out.make_room(bits / 8 + 2);
  out.put(last ? 1 : 0, 1);
  out.put(2, 2);
  header.write(out);
  write_symbols(bytes.data(), found, symbols, distances, out);
}

}  // namespace trueshade
