# trueshade_library(NAME SOURCES... LINKS...): the static library of one folder, with exactly these links.
function(trueshade_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LINKS;PRIVATE_LINKS")
  add_library(trueshade_${name} STATIC ${arg_SOURCES})
  add_library(trueshade::${name} ALIAS trueshade_${name})
  set_target_properties(trueshade_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(trueshade_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/trueshade>)
  target_link_libraries(
    trueshade_${name}
    PUBLIC trueshade_flags ${arg_LINKS}
    PRIVATE $<BUILD_INTERFACE:trueshade_private_flags> ${arg_PRIVATE_LINKS})
endfunction()
