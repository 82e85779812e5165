# Which SIMD targets kernels are compiled for: a list of avx512, avx2, sse4, scalar (NEON on aarch64) and `native`, which is the
# best one that this machine runs. Adding a target to a build tree compiles that target's kernels and relinks;
# little else is compiled again.
set(TRUESHADE_SIMD "avx512;avx2;sse4;scalar" CACHE STRING "SIMD targets of the kernels: avx512 avx2 sse4 scalar native")
set(highway_avx512 HWY_AVX3)
set(highway_avx2 HWY_AVX2)
set(highway_sse4 HWY_SSE4)
set(highway_scalar HWY_STATIC_TARGET)  # Highway's own baseline of the architecture

foreach(target IN LISTS TRUESHADE_SIMD)
  if(NOT target MATCHES "^(avx512|avx2|sse4|scalar|native)$")
    message(FATAL_ERROR "TRUESHADE_SIMD names ${target} (one or more of avx512;avx2;sse4;scalar;native)")
  endif()
endforeach()
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(trueshade_kernel_targets scalar)
  # Highway marks its NEON functions as +crypto, and g++ inlines those only where the whole file is compiled for it. No
  # kernel uses an instruction for cryptography, so CPUs without them run the kernels too.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
    list(APPEND trueshade_kernel_options -march=armv8-a+crypto)
  endif()
else()
  set(best "")
  if(native IN_LIST TRUESHADE_SIMD)
    set(flags "")
    if(EXISTS /proc/cpuinfo)
      file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
    endif()
    if(flags MATCHES " avx512f .* avx512bw " AND flags MATCHES " avx512dq " AND flags MATCHES " avx512vl ")
      set(best avx512)
    elseif(flags MATCHES " fma .* avx2 .* bmi2 ")
      set(best avx2)
    else()
      set(best sse4 scalar)
    endif()
  endif()
  set(trueshade_kernel_targets "")
  foreach(target avx512 avx2 sse4 scalar)  # best first
    if(target IN_LIST TRUESHADE_SIMD OR target IN_LIST best)
      list(APPEND trueshade_kernel_targets ${target})
    endif()
  endforeach()
endif()

# What core/simd/dispatch.h chooses from.
set(cases "")
foreach(target IN LISTS trueshade_kernel_targets)
  string(APPEND cases " X(${target})")
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/core/simd/built_targets.h CONTENT
"// Made by cmake/kernels.cmake: the SIMD targets of this build, best first.
#define TRUESHADE_BUILT_TARGETS(X)@cases@
" @ONLY)

# trueshade_kernels(NAME SOURCES LINKS): adds kernels to library NAME, each compiled once per SIMD target. Two macros tell
# core/simd/one_target.h which: Highway's word for the target, and ours.
function(trueshade_kernels name sources links)
  foreach(target IN LISTS trueshade_kernel_targets)
    set(objects trueshade_${name}_${target})
    add_library(${objects} OBJECT ${sources})
    target_include_directories(${objects} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
    target_link_libraries(${objects} PRIVATE trueshade_flags trueshade_private_flags ${links})
    target_compile_definitions(${objects} PRIVATE TRUESHADE_KERNEL_TARGET=${highway_${target}}
                               TRUESHADE_SIMD_TARGET=${target} HWY_DISABLED_TARGETS=HWY_SSSE3)
    target_compile_options(${objects} PRIVATE ${trueshade_kernel_options})
    target_sources(trueshade_${name} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()
