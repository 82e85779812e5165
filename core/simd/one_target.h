// Included first by a kernel file (*_kernel.cpp), which the build compiles once per SIMD target: it makes that target
// the one that <hwy/highway.h> works for. cmake/kernels.cmake defines TRUESHADE_KERNEL_TARGET and
// TRUESHADE_SIMD_TARGET.
#pragma once
#include <hwy/detect_targets.h>

#include "core/simd/dispatch.h"

#undef HWY_TARGET
#define HWY_TARGET TRUESHADE_KERNEL_TARGET

/// In namespace trueshade, at a kernel file's end: kernel<name>() returns `kernel` while this file's target is
/// in use.
#define TRUESHADE_KERNEL(name, kernel)                                           \
  template <>                                                                    \
  decltype(&name) Kernel<&name, SimdTarget::TRUESHADE_SIMD_TARGET>::function() { \
    return kernel;                                                               \
  }                                                                              \
  static_assert(true)
