# Debian packages by CPack (docs/packages.md): `scripts/packages.sh` makes them. Each component of cmake/install.cmake is a
# package; those of the Python module and the viewer are there where these are built.
find_program(TRUESHADE_GZIP gzip)
set(documentation ${PROJECT_BINARY_DIR}/package_docs)

# Manual pages and completions, which the command itself has made (cli/CMakeLists.txt).
install(DIRECTORY ${documentation}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT command FILES_MATCHING PATTERN "*.1")
if(TRUESHADE_GZIP)  # as Debian has manual pages; man reads both
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\")
    file(GLOB pages \"\${folder}/trueshade*.1\")
    if(pages)
      execute_process(COMMAND ${TRUESHADE_GZIP} -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)
    endif()" COMPONENT command)
endif()
install(FILES ${documentation}/trueshade.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME trueshade COMPONENT command)
install(FILES ${documentation}/_trueshade DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT command)
install(FILES ${documentation}/trueshade.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
        COMPONENT command)

if(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux")
  return()
endif()
set(components command image_io dev)
set(package_command trueshade)
set(package_image_io trueshade-image-io)
set(package_dev libtrueshade-dev)
set(package_python python3-trueshade)
set(package_viewer trueshade-view)
set(package_mpi trueshade-mpi)
if(TARGET trueshade_python)
  list(APPEND components python)
endif()
if(TARGET trueshade_view_program)
  list(APPEND components viewer)
endif()
if(TARGET trueshade_mpi_module)
  list(APPEND components mpi)
endif()

# What every package has in share/doc: the copyright, and a changelog whose date is that of the sources.
if(DEFINED ENV{SOURCE_DATE_EPOCH})
  set(epoch $ENV{SOURCE_DATE_EPOCH})
else()
  execute_process(COMMAND git log -1 --format=%ct WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                  OUTPUT_VARIABLE epoch OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
execute_process(COMMAND git rev-parse --short=12 HEAD WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                OUTPUT_VARIABLE TRUESHADE_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT epoch)
  set(epoch 0)
endif()
execute_process(COMMAND date -u -R -d @${epoch} OUTPUT_VARIABLE TRUESHADE_DATE OUTPUT_STRIP_TRAILING_WHITESPACE)
set(maintainer "Trueshade's developers <trueshade@example.org>")
foreach(component IN LISTS components)
  set(TRUESHADE_PACKAGE ${package_${component}})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/debian/changelog.in ${documentation}/${TRUESHADE_PACKAGE}/changelog @ONLY)
  set(doc ${CMAKE_INSTALL_DATADIR}/doc/${TRUESHADE_PACKAGE})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian/copyright DESTINATION ${doc} COMPONENT ${component} EXCLUDE_FROM_ALL)
  if(TRUESHADE_GZIP)
    execute_process(COMMAND ${TRUESHADE_GZIP} -9nkf ${documentation}/${TRUESHADE_PACKAGE}/changelog)
    install(FILES ${documentation}/${TRUESHADE_PACKAGE}/changelog.gz DESTINATION ${doc} COMPONENT ${component}
            EXCLUDE_FROM_ALL)
  endif()
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_NAME trueshade)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "${maintainer}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
    WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/same_dates.cmake)

# trueshade_package(COMPONENT SECTION SUMMARY TEXT [FIELD VALUE]...): a row of the packages.
function(trueshade_package component section summary text)
  string(TOUPPER ${component} upper)
  set(values NAME ${package_${component}} SECTION ${section} ${ARGN})
  while(values)
    list(POP_FRONT values field value)
    if(field MATCHES "^(NAME|SECTION)$")
      set(field PACKAGE_${field})
    endif()
    set(CPACK_DEBIAN_${upper}_${field} "${value}" PARENT_SCOPE)
  endwhile()
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
endfunction()
set(same "(= ${PROJECT_VERSION})")
trueshade_package(command graphics "deferred renderer whose image is the same on every CPU"
"Trueshade draws 3D scenes with many lights on the CPU. Its image has the
same hash on every machine, so it can be the reference that a GPU's image is
judged by. This package has the command trueshade."
  PACKAGE_RECOMMENDS "libegl1, libopengl0, libgl1-mesa-dri" PACKAGE_SUGGESTS "trueshade-image-io, trueshade-view, trueshade-mpi, mesa-vulkan-drivers, libvulkan1")
trueshade_package(image_io graphics "reader of EXR and JPEG pictures for Trueshade"
"Trueshade writes EXR and PNG and reads PNG by itself. With this package,
which brings OpenImageIO, it reads EXR files and JPEG textures too."
  PACKAGE_DEPENDS "trueshade ${same}")
trueshade_package(dev libdevel "deferred renderer whose image is the same on every CPU: library"
"Headers, static libraries and the CMake package of Trueshade:
find_package(trueshade), trueshade::shading."
  PACKAGE_DEPENDS "glslang-dev, spirv-tools, libglm-dev, libhwy-dev, libmeshoptimizer-dev, libtbb-dev, nlohmann-json3-dev, zlib1g-dev, libdeflate-dev"
  PACKAGE_SUGGESTS "libopenimageio-dev")
trueshade_package(python python "deferred renderer whose image is the same on every CPU: Python module"
"The module trueshade: scenes from NumPy arrays, frames whose planes are
arrays without a copy, and a pytest fixture for golden images."
  PACKAGE_DEPENDS "python3 (>= ${TRUESHADE_PYTHON_VERSION}), python3 (<< ${TRUESHADE_PYTHON_AFTER}), python3-numpy"
  PACKAGE_SUGGESTS "python3-pytest, trueshade ${same}")
trueshade_package(viewer graphics "deferred renderer whose image is the same on every CPU: window"
"The command trueshade view: a window to fly through a scene, to change its
pipeline, and to click on pixels."
  PACKAGE_DEPENDS "trueshade ${same}")
trueshade_package(mpi graphics "deferred renderer whose image is the same on every CPU: frames shared by MPI"
"With this package frames of a sequence are shared by the processes that
mpirun or Slurm starts, on one machine or many."
  PACKAGE_DEPENDS "trueshade ${same}" PACKAGE_RECOMMENDS "openmpi-bin")
# Python's byte code, which nobody else would take away again.
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/python/postinst
    ${PROJECT_SOURCE_DIR}/cmake/debian/python/prerm)
include(CPack)
