// X.cpp includes this file to call a function that X_kernel.cpp implements once per SIMD target; the target is chosen
// at run time:
//
//   light_pass.cpp         void light_tile(...) { kernel<light_tile>()(...); }
//   light_pass_kernel.cpp  TRUESHADE_KERNEL(light_tile, HWY_NAMESPACE::light_tile_simd);
#pragma once
#include <cstdint>

#include "core/simd/built_targets.h"  // TRUESHADE_BUILT_TARGETS, made by cmake/kernels.cmake

namespace trueshade {

enum class SimdTarget : uint8_t { avx512, avx2, sse4, scalar };  ///< best first

/// The target that kernels run on: the best one of this machine, or SimdScope's. Error(no_gl_driver) if the build has
/// none.
SimdTarget simd_target();

/// What TRUESHADE_KERNEL defines in X_kernel.cpp for one target. `kFunction` only names the kernel. X.cpp does not
/// declare these specialisations, which the language asks for without diagnosis: g++ and clang refer to their symbols,
/// and a kernel that a target lacks does not link.
template <auto kFunction, SimdTarget kTarget>
struct Kernel {
  static decltype(kFunction) function();
};

template <auto kFunction>
decltype(kFunction) kernel() {
  switch (simd_target()) {
#define TRUESHADE_CASE(target) \
  case SimdTarget::target:     \
    return Kernel<kFunction, SimdTarget::target>::function();
    TRUESHADE_BUILT_TARGETS(TRUESHADE_CASE)
#undef TRUESHADE_CASE
    default:
      return nullptr;  // simd_target() names built targets alone
  }
}

}  // namespace trueshade
