# Rules of the sources and of what is built from them, as tests.
set(rules ${CMAKE_CURRENT_SOURCE_DIR})
add_test(NAME "rules: folders include only what the arrows allow" COMMAND ${rules}/include_arrows.sh ${PROJECT_SOURCE_DIR})
add_test(NAME "rules: every folder says in a README what it holds" COMMAND ${rules}/folder_readmes.sh ${PROJECT_SOURCE_DIR})
add_test(NAME "rules: what CI leaves out has run on a late commit, and passed" COMMAND ${rules}/night_rows.sh ${PROJECT_SOURCE_DIR})
add_test(NAME "rules: every test can be asked for by its name" COMMAND ${rules}/test_names.sh ${PROJECT_SOURCE_DIR})
add_test(NAME "rules: preset names occur in the presets, the command and tests" COMMAND ${rules}/preset_names.sh ${PROJECT_SOURCE_DIR})
add_test(NAME "rules: every source is compiled without contraction and fast math"
         COMMAND ${rules}/compile_flags.sh ${PROJECT_BINARY_DIR}/compile_commands.json)
find_program(TRUESHADE_OBJDUMP objdump REQUIRED)  # of binutils, whichever compiler is used: its spelling is what the script reads
set(programs_library "")
if(TARGET trueshade_programs)
  set(programs_library $<TARGET_FILE:trueshade_programs>)
endif()
add_test(NAME "rules: the kernels hold no fused or estimating instruction"
         COMMAND ${rules}/instructions.sh ${TRUESHADE_OBJDUMP} $<TARGET_FILE:trueshade_core> $<TARGET_FILE:trueshade_scene_values>
                 $<TARGET_FILE:trueshade_scenes>
                 $<TARGET_FILE:trueshade_raster> $<TARGET_FILE:trueshade_shading>
                 ${programs_library})
add_test(NAME "install: a program finds, links and runs the installed library"
         COMMAND ${rules}/consumer/run.sh ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR} ${CMAKE_CXX_COMPILER} "${CMAKE_CXX_FLAGS}")
add_test(NAME "rules: the picture is built without the packages of the whole command"
         COMMAND ${rules}/picture_parts.sh ${PROJECT_SOURCE_DIR} ${CMAKE_CXX_COMPILER})
add_test(NAME "rules: the golden frames are drawn without any fast path"
         COMMAND ${rules}/general_path/run.sh ${PROJECT_SOURCE_DIR} ${CMAKE_CXX_COMPILER} ${CMAKE_CXX_COMPILER_LAUNCHER})
set_tests_properties("rules: the golden frames are drawn without any fast path" PROPERTIES LABELS slow)
