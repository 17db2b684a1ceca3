# Adds to bench_geometry and bench_straight what is installed.

# lib2geom: Debian's lib2geom-dev, whose headers need libboost-dev.
find_library(BEZEL_LIB2GEOM_LIBRARY 2geom)
find_path(BEZEL_LIB2GEOM_INCLUDE 2geom/basic-intersection.h PATH_SUFFIXES 2geom-1.2.2 2geom-1.2.0 2geom-1.2)
find_path(BEZEL_BOOST_INCLUDE boost/operators.hpp)
if(BEZEL_LIB2GEOM_LIBRARY AND BEZEL_LIB2GEOM_INCLUDE AND BEZEL_BOOST_INCLUDE)
  message(STATUS "Benchmarks beside lib2geom: ${BEZEL_LIB2GEOM_LIBRARY}")
  target_sources(bench_geometry PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/peers/lib2geom.cpp)
  target_include_directories(bench_geometry SYSTEM PRIVATE ${BEZEL_LIB2GEOM_INCLUDE} ${BEZEL_BOOST_INCLUDE})
  target_compile_definitions(bench_geometry PRIVATE BEZEL_BENCH_LIB2GEOM)
  target_link_libraries(bench_geometry PRIVATE ${BEZEL_LIB2GEOM_LIBRARY})
endif()

# lyon_geom: Debian's librust-lyon-geom-dev, compiled by cargo without a network. Built from a copy: cargo writes
# beside its sources.
find_program(BEZEL_CARGO cargo)
find_path(BEZEL_LYON_CRATE lyon_geom-0.15.0/Cargo.toml PATHS /usr/share/cargo/registry NO_DEFAULT_PATH)
if(BEZEL_CARGO AND BEZEL_LYON_CRATE)
  message(STATUS "Benchmarks beside lyon_geom: ${BEZEL_LYON_CRATE}")
  set(crate ${CMAKE_CURRENT_BINARY_DIR}/lyon)
  set(archive ${crate}/target/release/libpeer_lyon.a)
  set(sources ${CMAKE_CURRENT_SOURCE_DIR}/peers/lyon)
  add_custom_command(OUTPUT ${archive}
    COMMAND ${CMAKE_COMMAND} -E copy_directory ${sources} ${crate}
    COMMAND ${CMAKE_COMMAND} -E chdir ${crate} ${BEZEL_CARGO} build --release --offline --quiet
    WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}
    DEPENDS ${sources}/Cargo.toml ${sources}/src/lib.rs ${sources}/.cargo/config.toml
    COMMENT "Building lyon_geom with cargo"
    VERBATIM)
  add_custom_target(peer_lyon DEPENDS ${archive})
  add_dependencies(bench_geometry peer_lyon)
  target_compile_definitions(bench_geometry PRIVATE BEZEL_BENCH_LYON)
  target_link_libraries(bench_geometry PRIVATE ${archive} pthread dl)
endif()

# FreeFEM: Debian's freefem++, and libfreefem++ for its plugins (P3dc).
find_program(BEZEL_FREEFEM FreeFem++-nw)
find_path(BEZEL_FREEFEM_PLUGINS Element_P3dc.so PATHS /usr/lib/freefem++ /usr/lib/ff++/lib NO_DEFAULT_PATH)
if(BEZEL_FREEFEM AND BEZEL_FREEFEM_PLUGINS)
  message(STATUS "Benchmarks beside FreeFEM: ${BEZEL_FREEFEM}")
  target_sources(bench_straight PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/peers/freefem.cpp)
  target_include_directories(bench_straight PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_compile_definitions(bench_straight PRIVATE
    BEZEL_FREEFEM="${BEZEL_FREEFEM}" BEZEL_FREEFEM_PLUGINS="${BEZEL_FREEFEM_PLUGINS}"
    BEZEL_FREEFEM_SCRIPT="${CMAKE_CURRENT_SOURCE_DIR}/peers/freefem.edp")
endif()
