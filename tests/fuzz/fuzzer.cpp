// libFuzzer's entry (LLVM, "libFuzzer - a library for coverage-guided fuzz testing"). TRUESHADE_FUZZ_TARGET in the
// environment names the target.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/targets.h"

namespace {
const trueshade::fuzz::Target* target = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* const name = std::getenv("TRUESHADE_FUZZ_TARGET");
  target = trueshade::fuzz::target_named(name == nullptr ? "" : name);
  if (target != nullptr) return 0;
  std::fprintf(stderr, "TRUESHADE_FUZZ_TARGET names no target\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  target->run({bytes, size});
  return 0;
}
