// Included first by a kernel file (*_kernel.cpp), which the build compiles once per SIMD target: it makes that target the
// one that <hwy/highway.h> works for. cmake/kernels.cmake defines TRUESHADE_KERNEL_TARGET.
#pragma once
#include <hwy/detect_targets.h>

#undef HWY_TARGET
#define HWY_TARGET TRUESHADE_KERNEL_TARGET
