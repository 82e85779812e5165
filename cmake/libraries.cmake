# trueshade_library(NAME FOLDERS|SOURCES... LINKS... PRIVATE_LINKS...): a static library with exactly these links. It holds
# every .cpp file of the folders; a file named *_kernel.cpp is compiled once per SIMD target (cmake/kernels.cmake).
function(trueshade_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "FOLDERS;SOURCES;LINKS;PRIVATE_LINKS")
  foreach(folder IN LISTS arg_FOLDERS)
    file(GLOB found CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
    list(APPEND arg_SOURCES ${found})
  endforeach()
  set(kernels ${arg_SOURCES})
  list(FILTER kernels INCLUDE REGEX "_kernel\\.cpp$")
  list(FILTER arg_SOURCES EXCLUDE REGEX "_kernel\\.cpp$")
  trueshade_dispatch_sources(${arg_SOURCES})
  add_library(trueshade_${name} STATIC ${arg_SOURCES})
  add_library(trueshade::${name} ALIAS trueshade_${name})
  set_target_properties(trueshade_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(trueshade_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/trueshade>)
  target_link_libraries(
    trueshade_${name}
    PUBLIC trueshade_flags ${arg_LINKS}
    PRIVATE $<BUILD_INTERFACE:trueshade_private_flags> ${arg_PRIVATE_LINKS})
  if(kernels)
    trueshade_kernels(${name} "${kernels}" "${arg_LINKS}")
  endif()
endfunction()
