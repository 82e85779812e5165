# Which SIMD targets kernels are compiled for. The baseline (one lane, or NEON on aarch64) is always among them. Adding a
# target to a build tree compiles that target's kernels and relinks; nothing else is compiled again.
set(TRUESHADE_SIMD "avx512;avx2;sse4" CACHE STRING "SIMD targets to compile kernels for, of: avx512 avx2 sse4")
set(highway_avx512 HWY_AVX3)
set(highway_avx2 HWY_AVX2)
set(highway_sse4 HWY_SSE4)

set(trueshade_disabled_targets HWY_SSSE3)  # its Round loses the sign of -0
set(trueshade_kernel_targets baseline)
set(highway_baseline HWY_STATIC_TARGET)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  foreach(target avx512 avx2 sse4)
    if(target IN_LIST TRUESHADE_SIMD)
      list(APPEND trueshade_kernel_targets ${target})
    else()
      string(APPEND trueshade_disabled_targets "|${highway_${target}}")
    endif()
  endforeach()
endif()

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
      set_property(SOURCE ${source} APPEND PROPERTY COMPILE_DEFINITIONS "HWY_DISABLED_TARGETS=(${trueshade_disabled_targets})")
    endif()
  endforeach()
endfunction()
