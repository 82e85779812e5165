# An install tree for find_package(trueshade) and pkg-config. Image files are a component of their own (COMPONENTS image_io), because they
# bring OpenImageIO. The headers named here are the interface; the others are ours to change.
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/trueshade)
set_target_properties(trueshade_flags PROPERTIES EXPORT_NAME flags)

install(TARGETS trueshade_flags trueshade_core trueshade_scene_values trueshade_scenes trueshade_raster trueshade_programs trueshade_shading EXPORT trueshade
        COMPONENT dev)
install(TARGETS trueshade_image_files trueshade_image_io EXPORT trueshade_image_io COMPONENT dev)
install(TARGETS trueshade COMPONENT command)
install(TARGETS trueshade_image_io_module LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/trueshade COMPONENT image_io)
if(TARGET trueshade_mpi_module)
  install(TARGETS trueshade_mpi_module LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/trueshade COMPONENT mpi)
endif()
foreach(header
  core/array.h core/blend_state.h core/error.h core/expansion.h core/format.h core/memory_cap.h core/threads/parallel_for.h core/half.h core/image.h core/image_files/image_io.h core/numeric_profile.h core/sha256.h
  scenes/builtin/builtin.h scenes/camera.h scenes/pipeline/image_view.h scenes/light.h scenes/pipeline/light_model.h scenes/pipeline/light_program.h scenes/mesh.h scenes/pipeline/pipeline.h
  scenes/placement.h scenes/pipeline/post_chain.h scenes/pipeline/presets.h scenes/texture.h scenes/timeline.h scenes/pipeline/transparency.h
  scenes/scene.h scenes/scene_limits.h scenes/scene_parts.h core/simd/simd_target.h shading/frame.h shading/output/extent.h)
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/trueshade/${folder} COMPONENT dev)
endforeach()

install(FILES ${PROJECT_SOURCE_DIR}/scenes/schemas/scene.schema.json ${PROJECT_SOURCE_DIR}/scenes/schemas/pipeline.schema.json
              ${PROJECT_SOURCE_DIR}/cli/batch/jobs.schema.json
        DESTINATION ${CMAKE_INSTALL_DATADIR}/trueshade COMPONENT command)

install(FILES ${PROJECT_SOURCE_DIR}/programs/light_interface.glsl DESTINATION ${CMAKE_INSTALL_DATADIR}/trueshade COMPONENT command)
install(DIRECTORY ${PROJECT_BINARY_DIR}/generated/light_models/ DESTINATION ${CMAKE_INSTALL_DATADIR}/trueshade/light_models COMPONENT command)

install(EXPORT trueshade NAMESPACE trueshade:: FILE trueshadeTargets.cmake DESTINATION ${config_dir} COMPONENT dev)
install(EXPORT trueshade_image_io NAMESPACE trueshade:: FILE trueshadeImageIoTargets.cmake DESTINATION ${config_dir} COMPONENT dev)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/trueshadeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/trueshadeConfig.cmake ${PROJECT_BINARY_DIR}/trueshadeConfigVersion.cmake
        DESTINATION ${config_dir} COMPONENT dev)

# The same for pkg-config: `trueshade`, and `trueshade-image-io` for image files. The flags are those of trueshade_flags.
get_target_property(options trueshade_flags INTERFACE_COMPILE_OPTIONS)
get_target_property(definitions trueshade_flags INTERFACE_COMPILE_DEFINITIONS)
list(TRANSFORM definitions PREPEND -D)
list(JOIN options " " options)
list(JOIN TRUESHADE_GLSLANG " " glslang)
list(JOIN definitions " " definitions)
set(flags "${options} ${definitions}")
file(RELATIVE_PATH to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
foreach(name trueshade trueshade-image-io)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endforeach()
include(cmake/packages.cmake)
