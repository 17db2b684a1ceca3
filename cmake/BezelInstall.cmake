# Installation: headers, static libraries, CMake package, pkg-config file, command line tool.
set(bezel_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/bezel)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/bezel DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(TARGETS bezel_flags ${BEZEL_MODULE_TARGETS} bezel_all
  EXPORT bezelTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT bezelTargets NAMESPACE bezel:: DESTINATION ${bezel_cmake_dir})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/bezelConfig.cmake.in
  ${PROJECT_BINARY_DIR}/bezelConfig.cmake INSTALL_DESTINATION ${bezel_cmake_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/bezelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/bezelConfig.cmake ${PROJECT_BINARY_DIR}/bezelConfigVersion.cmake
  DESTINATION ${bezel_cmake_dir})

# pkg-config: the libraries from top to bottom, because a static linker reads them in that order. They are static,
# so what they stand on is a plain requirement, and `pkg-config --libs bezel` is complete without --static.
set(BEZEL_PC_LIBS "")
foreach(target ${BEZEL_MODULE_TARGETS})
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    string(PREPEND BEZEL_PC_LIBS " -l${target}")
  endif()
endforeach()
set(BEZEL_PC_PETSC "")
if(BEZEL_WITH_PETSC)
  set(BEZEL_PC_PETSC " PETSc")
endif()
if(BEZEL_WITH_PETSC OR BEZEL_WITH_MPI)
  list(JOIN MPI_CXX_LIBRARIES " " mpi)
  string(APPEND BEZEL_PC_LIBS " ${mpi}")
endif()
# Relative to the file itself, so that an installed tree may be moved.
file(RELATIVE_PATH BEZEL_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" BEZEL_PC_PREFIX "${BEZEL_PC_PREFIX}")
configure_file(${PROJECT_SOURCE_DIR}/cmake/bezel.pc.in ${PROJECT_BINARY_DIR}/bezel.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/bezel.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

if(TARGET bezel_cli)
  install(TARGETS bezel_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
