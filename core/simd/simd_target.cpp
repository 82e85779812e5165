#include "core/simd/simd_target.h"

#include <hwy/targets.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/simd/dispatch.h"

namespace trueshade {
namespace {

struct Target {
  std::string_view name;
  SimdTarget is;
  int64_t bits;  // Highway's; 0: every machine runs it
};

// g++ compiles Highway's one-lane target as `scalar`, clang its 128-bit emulation: the same operations either way.
constexpr Target kTargets[] = {{"avx512", SimdTarget::avx512, HWY_AVX3},
                               {"avx2", SimdTarget::avx2, HWY_AVX2},
                               {"sse4", SimdTarget::sse4, HWY_SSE4},
                               {"scalar", SimdTarget::scalar, 0}};

bool built(SimdTarget target) {
#define TRUESHADE_IS(name) || target == SimdTarget::name
  return false TRUESHADE_BUILT_TARGETS(TRUESHADE_IS);
#undef TRUESHADE_IS
}

// Targets that this build has and this machine runs, best first; asked of the CPU once: CPUID leaves a virtual machine.
const std::vector<Target>& runnable() {
  static const std::vector<Target> targets = [] {
    const int64_t supported = hwy::SupportedTargets();
    std::vector<Target> found;
    for (const Target& target : kTargets)
      if (built(target.is) && (supported & target.bits) == target.bits) found.push_back(target);
    if (found.empty())
      throw Error(ErrorKind::no_gl_driver, "simd", "this build has no kernels for this machine's CPU",
                  "build with TRUESHADE_SIMD=native");
    return found;
  }();
  return targets;
}

std::atomic<SimdTarget>& target_in_use() {
  static std::atomic<SimdTarget> target = runnable().front().is;
  return target;
}

// Highway's own choice follows, for tests that call functions of several targets by HWY_DYNAMIC_DISPATCH.
void choose(SimdTarget chosen) {
  target_in_use() = chosen;
  const auto of_machine = [chosen](const Target& target) { return target.is == chosen; };
  const Target& target = *std::find_if(runnable().begin(), runnable().end(), of_machine);
  const bool best = target.is == runnable().front().is;
  hwy::SetSupportedTargetsForTest(best ? 0 : target.bits == 0 ? HWY_SCALAR | HWY_EMU128 : target.bits);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

SimdTarget simd_target() { return target_in_use(); }

std::vector<std::string_view> built_simd_targets() {
  std::vector<std::string_view> names;
  for (const Target& target : kTargets)
    if (built(target.is)) names.push_back(target.name);
  return names;
}

std::vector<std::string_view> simd_targets() {
  std::vector<std::string_view> names;
  for (const Target& target : runnable()) names.push_back(target.name);
  return names;
}

SimdScope::SimdScope(std::string_view name) {
  if (name == "best") return;
  const auto found =
      std::find_if(runnable().begin(), runnable().end(), [&](const Target& target) { return target.name == name; });
  if (found == runnable().end()) {
    std::string known;
    for (const Target& target : runnable()) known += ", " + std::string(target.name);
    throw Error(ErrorKind::usage, "simd", "this build on this machine does not run " + std::string(name),
                "one of best" + known);
  }
  before_ = simd_target();
  choose(found->is);
}

SimdScope::~SimdScope() {
  if (before_) choose(*before_);
}

}  // namespace trueshade
