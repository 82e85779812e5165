# One compile line for every target. -ffp-contract=off is what makes one hash possible: g++ 12 and clang 14 both fuse
# multiply-add in code compiled for AVX2 and up unless told not to.
add_library(trueshade_flags INTERFACE)
target_compile_features(trueshade_flags INTERFACE cxx_std_20)
target_compile_options(
  trueshade_flags
  INTERFACE -ffp-contract=off -fno-fast-math -fno-math-errno -fno-strict-aliasing)
target_compile_definitions(
  trueshade_flags
  INTERFACE GLM_FORCE_EXPLICIT_CTOR GLM_FORCE_PURE)
# Ours only, not a consumer's: warnings, which the presets make errors, and the usual hardening.
add_library(trueshade_private_flags INTERFACE)
target_compile_options(
  trueshade_private_flags
  INTERFACE -Wall -Wextra -Wconversion -Wfloat-conversion -fstack-protector-strong -fstack-clash-protection)
target_compile_definitions(trueshade_private_flags INTERFACE _GLIBCXX_ASSERTIONS)
if(CMAKE_BUILD_TYPE MATCHES "Release|RelWithDebInfo")
  target_compile_definitions(trueshade_private_flags INTERFACE _FORTIFY_SOURCE=2)
endif()
# g++ 12 joins scalar code to vectors in which a double that is rounded to float and widened again keeps its bits as they
# were (tests/core/roundings.cpp), so it may not where code is not written in vectors; g++ 14 is right.
set(trueshade_scalar_options
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,14>>:-fno-tree-slp-vectorize>)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
add_link_options(-Wl,-z,relro,-z,now)
# Kernels are compiled by -O3, as are the other files of their libraries, because the linker keeps one copy of an inline
# function that several files compile: loops over three components are unrolled, so that vectors stay in registers.
set(trueshade_kernel_options $<$<CONFIG:Release>:-O3>)
