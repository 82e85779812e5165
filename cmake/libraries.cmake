# How many source files are compiled at a time; 1 compiles each alone, which shows a header that lacks an include.
set(TRUESHADE_BATCH 16 CACHE STRING "Source files of a library or a test program compiled as one")
function(trueshade_compile_in_batches target)
  if(TRUESHADE_BATCH GREATER 1)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${TRUESHADE_BATCH})
  endif()
endfunction()

# Of a tree whose preset adds checks (sanitizers): the libraries that it compiles without them, in half of the time.
set(TRUESHADE_UNCHECKED "" CACHE STRING "Libraries compiled without the sanitizers of the preset, such as judge;oracle")

# trueshade_library(NAME FOLDERS|SOURCES... LINKS... PRIVATE_LINKS...): a static library with exactly these links. It holds
# every .cpp file of the folders; a file named *_kernel.cpp is compiled once per SIMD target (cmake/kernels.cmake). The other
# files are compiled a batch at a time (TRUESHADE_BATCH), so that a header is read once for all of them. So names in
# unnamed namespaces must be unique within a library.
function(trueshade_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "FOLDERS;SOURCES;LINKS;PRIVATE_LINKS")
  foreach(folder IN LISTS arg_FOLDERS)
    file(GLOB found CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
    list(APPEND arg_SOURCES ${found})
  endforeach()
  set(kernels ${arg_SOURCES})
  list(FILTER kernels INCLUDE REGEX "_kernel\\.cpp$")
  list(FILTER arg_SOURCES EXCLUDE REGEX "_kernel\\.cpp$")
  add_library(trueshade_${name} STATIC ${arg_SOURCES})
  add_library(trueshade::${name} ALIAS trueshade_${name})
  set_target_properties(trueshade_${name} PROPERTIES EXPORT_NAME ${name})
  trueshade_compile_in_batches(trueshade_${name})
  if(name IN_LIST TRUESHADE_UNCHECKED)
    target_compile_options(trueshade_${name} PRIVATE -fno-sanitize=all)
  endif()
  target_include_directories(trueshade_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/trueshade>)
  target_link_libraries(
    trueshade_${name}
    PUBLIC trueshade_flags ${arg_LINKS}
    PRIVATE $<BUILD_INTERFACE:trueshade_private_flags> ${arg_PRIVATE_LINKS})
  target_include_directories(trueshade_${name} PRIVATE ${PROJECT_BINARY_DIR}/generated)
  target_compile_options(trueshade_${name} PRIVATE ${trueshade_scalar_options})
  if(kernels)
    trueshade_kernels(${name} "${kernels}" "${arg_LINKS}")
  endif()
endfunction()
