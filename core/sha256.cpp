#include "core/sha256.h"

#ifdef __x86_64__
#include <cpuid.h>
#include <immintrin.h>
#endif

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

namespace trueshade {
namespace {

// FIPS 180-4, section 4.2.2: the first 32 bits of the fractions of the cube roots of the first 64 primes.
constexpr std::array<uint32_t, 64> kRound = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

uint32_t big_endian(const uint8_t* bytes) {
  return uint32_t(bytes[0]) << 24 | uint32_t(bytes[1]) << 16 | uint32_t(bytes[2]) << 8 | uint32_t(bytes[3]);
}

#ifdef __x86_64__
bool has_instructions() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  constexpr unsigned kSsse3 = 1u << 9, kSse41 = 1u << 19, kSha = 1u << 29;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & kSsse3) == 0 || (c & kSse41) == 0) return false;
  return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (b & kSha) != 0;
}

/// A block by the processor's own rounds, four at a time. They want the state as (a, b, e, f) and (c, d, g, h).
__attribute__((target("sha,sse4.1,ssse3"))) void block_by_instructions(const uint8_t* data, uint32_t* state) {
  const __m128i swapped = _mm_set_epi64x(0x0c0d0e0f08090a0b, 0x0405060700010203);
  const __m128i abcd = _mm_shuffle_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(state)), 0xB1),
                efgh = _mm_shuffle_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(state + 4)), 0x1B);
  const __m128i first_abef = _mm_alignr_epi8(abcd, efgh, 8), first_cdgh = _mm_blend_epi16(efgh, abcd, 0xF0);
  __m128i abef = first_abef, cdgh = first_cdgh, w[4];
  for (size_t g = 0; g < 16; ++g) {
    __m128i& words = w[g % 4];
    if (g < 4) {
      words = _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(data + 16 * g)), swapped);
    } else {
      const __m128i two = w[(g + 2) % 4], three = w[(g + 3) % 4];
      const __m128i sum = _mm_add_epi32(_mm_sha256msg1_epu32(words, w[(g + 1) % 4]), _mm_alignr_epi8(three, two, 4));
      words = _mm_sha256msg2_epu32(sum, three);
    }
    const __m128i round =
        _mm_add_epi32(words, _mm_loadu_si128(reinterpret_cast<const __m128i*>(kRound.data() + 4 * g)));
    cdgh = _mm_sha256rnds2_epu32(cdgh, abef, round);
    abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(round, 0x0E));
  }
  const __m128i feba = _mm_shuffle_epi32(_mm_add_epi32(abef, first_abef), 0x1B),
                dchg = _mm_shuffle_epi32(_mm_add_epi32(cdgh, first_cdgh), 0xB1);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(state), _mm_blend_epi16(feba, dchg, 0xF0));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(state + 4), _mm_alignr_epi8(dchg, feba, 8));
}
#endif

}  // namespace

void Sha256::block(const uint8_t* data) {
#ifdef __x86_64__
  static const bool by_instructions = has_instructions();
  if (by_instructions && !plain_) return block_by_instructions(data, state_.data());
#endif
  std::array<uint32_t, 64> w;
  for (size_t t = 0; t < 16; ++t) w[t] = big_endian(data + 4 * t);
  for (size_t t = 16; t < 64; ++t) {
    const uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3);
    const uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10);
    w[t] = w[t - 16] + s0 + w[t - 7] + s1;
  }
  auto [a, b, c, d, e, f, g, h] = state_;
  for (size_t t = 0; t < 64; ++t) {
    const uint32_t sum1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
    const uint32_t t1 = h + sum1 + ((e & f) ^ (~e & g)) + kRound[t] + w[t];
    const uint32_t sum0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
    const uint32_t t2 = sum0 + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + t1;
    d = c;
    c = b;
    b = a;
    a = t1 + t2;
  }
  const std::array<uint32_t, 8> step = {a, b, c, d, e, f, g, h};
  for (size_t i = 0; i < 8; ++i) state_[i] += step[i];
}

void Sha256::update(const void* data, size_t bytes) {
  if (bytes == 0) return;  // of an empty list the address may be null, which memcpy takes for no length
  const auto* next = static_cast<const uint8_t*>(data);
  size_t filled = size_t(bytes_ % 64);
  bytes_ += bytes;
  if (filled != 0) {
    const size_t taken = std::min(bytes, 64 - filled);
    std::memcpy(pending_.data() + filled, next, taken);
    filled += taken;
    next += taken;
    bytes -= taken;
    if (filled < 64) return;
    block(pending_.data());
  }
  for (; bytes >= 64; next += 64, bytes -= 64) block(next);
  if (bytes != 0) std::memcpy(pending_.data(), next, bytes);
}

namespace {

constexpr char kDigits[] = "0123456789abcdef";

void append_hex(uint64_t value, int digits, std::string& text) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) text += kDigits[(value >> shift) & 15u];
}

/// The value of so many digits, which are taken from the front of the text; false where they are none.
template <typename Word>
bool take_hex(std::string_view& text, Word& value) {
  const size_t digits = 2 * sizeof(Word);
  if (text.size() < digits) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, value, 16);
  const bool whole = error == std::errc() && end == text.data() + digits;
  text.remove_prefix(digits);
  return whole;
}

}  // namespace

std::string Sha256::progress() const {
  std::string text;
  append_hex(bytes_, 16, text);
  for (const uint32_t word : state_) append_hex(word, 8, text);
  for (size_t i = 0; i < size_t(bytes_ % 64); ++i) append_hex(pending_[i], 2, text);
  return text;
}

bool Sha256::resume(std::string_view progress) {
  Sha256 read;
  read.plain_ = plain_;
  bool good = take_hex(progress, read.bytes_);
  for (uint32_t& word : read.state_) good = good && take_hex(progress, word);
  for (size_t i = 0; good && i < size_t(read.bytes_ % 64); ++i) good = take_hex(progress, read.pending_[i]);
  if (!good || !progress.empty()) return false;
  *this = read;
  return true;
}

std::string Sha256::hex() {
  const uint64_t bits = bytes_ * 8;
  std::array<uint8_t, 72> padding{0x80};
  const size_t zeros = (119 - size_t(bytes_ % 64)) % 64 + 1;  // the one and zeros, up to 8 bytes short of a block
  for (size_t i = 0; i < 8; ++i) padding[zeros + i] = uint8_t(bits >> (56 - 8 * i));
  update(padding.data(), zeros + 8);

  std::string text;
  for (const uint32_t word : state_) append_hex(word, 8, text);
  return text;
}

}  // namespace trueshade
