#pragma once
#include <cstdint>
#include <random>

namespace trueshade::programs {

/// Random words of 32 bits, the same on every machine.
class RandomWords {
 public:
  explicit RandomWords(uint32_t seed) : engine_(seed) {}
  uint32_t operator()() { return uint32_t(engine_()); }

 private:
  std::mt19937 engine_;
};

/// A float from `low` to `high`, by 24 random bits.
inline float float_between(RandomWords& random, float low, float high) {
  return low + (high - low) * (float(random() >> 8) * 0x1p-24f);
}

}  // namespace trueshade::programs
