#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace trueshade {

/// SHA-256 (FIPS 180-4), fed in pieces.
class Sha256 {
 public:
  Sha256() = default;
  /// Without the processor's instructions for it; the same digits.
  enum class Blocks : uint8_t { best, plain };
  explicit Sha256(Blocks blocks) : plain_(blocks == Blocks::plain) {}

  void update(const void* data, size_t bytes);

  /// How far it has come, as hex digits, from which another process can go on.
  std::string progress() const;
  /// Goes on from progress(). Returns false, and changes nothing, for a text that is none.
  bool resume(std::string_view progress);

  std::string hex();  ///< 64 lower-case digits; call once, last

 private:
  void block(const uint8_t* data);
  std::array<uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<uint8_t, 64> pending_{};
  uint64_t bytes_ = 0;
  bool plain_ = false;
};

/// The digits of a text.
inline std::string sha256_of(std::string_view text) {
  Sha256 sum;
  sum.update(text.data(), text.size());
  return sum.hex();
}

}  // namespace trueshade
