#include "core/simd/simd_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"

namespace trueshade {
namespace {

struct Target {
  std::string_view name;
  int64_t bits;
};

// g++ compiles Highway's one-lane target as `scalar`, clang its 128-bit emulation: the same operations either way.
constexpr Target kTargets[] = {
    {"avx512", HWY_AVX3}, {"avx2", HWY_AVX2}, {"sse4", HWY_SSE4}, {"scalar", HWY_SCALAR | HWY_EMU128}};

int64_t runnable() {
  static const int64_t targets = [] {  // before any SimdScope narrows what Highway reports
    int64_t bits = 0;
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) bits |= target;
    if (bits == 0)
      throw Error(ErrorKind::usage, "simd", "this build has no kernels for this machine's CPU", "build with TRUESHADE_SIMD=native");
    return bits;
  }();
  return targets;
}

}  // namespace

std::vector<std::string_view> simd_targets() {
  std::vector<std::string_view> names;
  for (const Target& target : kTargets)
    if (runnable() & target.bits) names.push_back(target.name);
  return names;
}

SimdScope::SimdScope(std::string_view name) : chosen_(name != "best") {
  if (!chosen_) return;
  const auto names = simd_targets();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    std::string known;
    for (const auto& n : names) known += (known.empty() ? "" : ", ") + std::string(n);
    throw Error(ErrorKind::usage, "simd", "this machine does not run " + std::string(name), "one of best, " + known);
  }
  for (const Target& target : kTargets)
    if (target.name == name) hwy::SetSupportedTargetsForTest(target.bits);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

SimdScope::~SimdScope() {
  if (!chosen_) return;
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(runnable());  // not asked of the CPU again: CPUID leaves a virtual machine
}

}  // namespace trueshade
