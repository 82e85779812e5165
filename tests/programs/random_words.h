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

}  // namespace trueshade::programs
