#pragma once
#include <cstdint>
#include <span>

namespace trueshade {

/// Lengths, in bits, of a prefix code for symbols that occur `counts` times (D. Huffman, 1952), none over `most_bits`. A
/// symbol that does not occur has length 0. A lone symbol has length 1.
/// At most 512 symbols, whose counts have a sum below 2^32.
void code_lengths(std::span<const uint32_t> counts, int most_bits, std::span<uint8_t> lengths);

/// The code words that RFC 1951 (section 3.2.2) gives to lengths of at most 15 bits. The first bit of a word is its lowest.
void code_words(std::span<const uint8_t> lengths, std::span<uint16_t> words);

}  // namespace trueshade
