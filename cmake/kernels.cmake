# Which SIMD targets kernels are compiled for: a list of avx512, avx2, sse4 and scalar (NEON on aarch64), or `native`, the best
# one that this machine runs and no other. Adding a target to a build tree compiles that target's kernels and relinks;
# little else is compiled again.
set(TRUESHADE_SIMD "avx512;avx2;sse4;scalar" CACHE STRING "SIMD targets of the kernels: avx512 avx2 sse4 scalar, or native")
set(highway_avx512 HWY_AVX3)
set(highway_avx2 HWY_AVX2)
set(highway_sse4 HWY_SSE4)
set(highway_scalar HWY_STATIC_TARGET)  # Highway's own baseline of the architecture

set(trueshade_kernel_targets ${TRUESHADE_SIMD})
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(trueshade_kernel_targets scalar)
elseif(TRUESHADE_SIMD STREQUAL "native")
  set(flags "")
  if(EXISTS /proc/cpuinfo)
    file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
  endif()
  if(flags MATCHES " avx512f .* avx512bw " AND flags MATCHES " avx512dq " AND flags MATCHES " avx512vl ")
    set(trueshade_kernel_targets avx512)
  elseif(flags MATCHES " fma .* avx2 .* bmi2 ")
    set(trueshade_kernel_targets avx2)
  else()
    set(trueshade_kernel_targets sse4 scalar)
  endif()
endif()

# What Highway is told where functions of several targets are chosen from: which targets exist, and which of them is the one
# that every machine of this build runs.
set(disabled HWY_SSSE3)  # its Round loses the sign of -0
foreach(target avx512 avx2 sse4)
  if(NOT target IN_LIST trueshade_kernel_targets)
    string(APPEND disabled "|${highway_${target}}")
  endif()
endforeach()
if(NOT "scalar" IN_LIST trueshade_kernel_targets)
  string(APPEND disabled "|HWY_SCALAR|HWY_EMU128")
  list(GET trueshade_kernel_targets -1 lowest)
  set(trueshade_target_macros "HWY_BASELINE_TARGETS=${highway_${lowest}}")
endif()
list(APPEND trueshade_target_macros "HWY_DISABLED_TARGETS=(${disabled})")

# trueshade_kernels(NAME SOURCES LINKS): adds kernels to library NAME, each compiled once per SIMD target. The macro
# TRUESHADE_KERNEL_TARGET tells core/simd/one_target.h which.
function(trueshade_kernels name sources links)
  foreach(target IN LISTS trueshade_kernel_targets)
    set(objects trueshade_${name}_${target})
    add_library(${objects} OBJECT ${sources})
    target_include_directories(${objects} PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${objects} PRIVATE trueshade_flags trueshade_private_flags ${links})
    target_compile_definitions(${objects} PRIVATE TRUESHADE_KERNEL_TARGET=${highway_${target}} HWY_DISABLED_TARGETS=HWY_SSSE3)
    target_compile_options(${objects} PRIVATE ${trueshade_kernel_options})
    target_sources(trueshade_${name} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()

# trueshade_dispatch_sources(SOURCES...): tells those that include Highway which targets exist. The macro is set on these
# files alone, so that a change of TRUESHADE_SIMD compiles few files again.
function(trueshade_dispatch_sources)
  foreach(source IN LISTS ARGN)
    get_filename_component(path ${source} ABSOLUTE)
    file(STRINGS ${path} highway REGEX "include <hwy/" LIMIT_COUNT 1)
    if(highway)
      set_property(SOURCE ${source} APPEND PROPERTY COMPILE_DEFINITIONS "${trueshade_target_macros}")
    endif()
  endforeach()
endfunction()
