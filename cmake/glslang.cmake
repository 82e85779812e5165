# TRUESHADE_GLSLANG: the libraries of glslang, which makes SPIR-V of GLSL, and of SPIRV-Tools, which checks it; empty where
# one of them or their headers are absent. They are linked statically, as Debian has glslang. glslang 14 took OGLCompiler into
# its other libraries; older ones need it.
# The first picture is built without it, as without every package of the whole command.
set(TRUESHADE_GLSLANG "")
if(TRUESHADE_PARTS STREQUAL "picture")
  return()
endif()
find_path(TRUESHADE_GLSLANG_HEADERS glslang/Include/glslang_c_interface.h)
foreach(part glslang SPIRV glslang-default-resource-limits MachineIndependent GenericCodeGen OSDependent OGLCompiler SPIRV-Tools-opt SPIRV-Tools)
  find_library(TRUESHADE_GLSLANG_${part} ${part})
  if(TRUESHADE_GLSLANG_${part} OR NOT part STREQUAL "OGLCompiler")
    list(APPEND TRUESHADE_GLSLANG ${TRUESHADE_GLSLANG_${part}})
  endif()
endforeach()
if(NOT TRUESHADE_GLSLANG_HEADERS OR TRUESHADE_GLSLANG MATCHES NOTFOUND)
  set(TRUESHADE_GLSLANG "")
endif()
