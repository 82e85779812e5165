#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace trueshade {

enum class SimdTarget : uint8_t;

/// SIMD targets that this build has and this machine runs, best first: of `avx512 avx2 sse4 scalar`.
std::vector<std::string_view> simd_targets();

/// SIMD targets that the kernels are compiled for, whether this machine runs them or not, best first.
std::vector<std::string_view> built_simd_targets();

/// For its lifetime kernels run on one SIMD target: `best`, or a name of simd_targets(). Error(usage) if the machine
/// does not run it. The choice is the process's: frames drawn at the same time share it (the image does not depend on
/// it).
class SimdScope {
 public:
  explicit SimdScope(std::string_view name);
  ~SimdScope();
  SimdScope(const SimdScope&) = delete;
  SimdScope& operator=(const SimdScope&) = delete;

 private:
  std::optional<SimdTarget> before_;  // set where the scope chose another target
};

}  // namespace trueshade
