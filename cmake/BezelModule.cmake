# One static library per module folder: bezel/<name>/*.cpp -> target bezel_<name>, alias bezel::<name>.
add_library(bezel_flags INTERFACE)
add_library(bezel::flags ALIAS bezel_flags)
set_target_properties(bezel_flags PROPERTIES EXPORT_NAME flags)
target_compile_features(bezel_flags INTERFACE cxx_std_20)
# Same bits everywhere: products and sums are never fused unless the code asks for it (docs/determinism.md).
target_compile_options(bezel_flags INTERFACE -ffp-contract=off)

add_library(bezel_warnings INTERFACE)
# Of sources compiled together, one's constants are not shadowed by the next one's local names, and unnamed namespaces of an
# included file are meant: builds without BEZEL_UNITY tell what is wrong within a file.
set(together $<BOOL:$<TARGET_PROPERTY:BEZEL_TOGETHER>>)
target_compile_options(bezel_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion $<$<NOT:${together}>:-Wshadow>
  $<$<AND:${together},$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>)
if(BEZEL_WERROR)
  target_compile_options(bezel_warnings INTERFACE -Werror)
endif()
if(BEZEL_SANITIZE)
  # Among the sanitizers' own code g++ loses track of values; the other builds follow them.
  target_compile_options(bezel_warnings INTERFACE
    "$<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized;-Wno-error=array-bounds;-Wno-error=stringop-overflow>")
  # Left out is what AddressSanitizer finds when the pointer is used: it takes a third of the time to compile.
  target_compile_options(bezel_flags INTERFACE -fsanitize=address,undefined -fno-sanitize=null,object-size,pointer-overflow
    -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(bezel_flags INTERFACE -fsanitize=address,undefined)
endif()

# Much of the time of most sources goes into headers: several at a time share it. Those that Highway includes once per target
# stay alone.
set(BEZEL_UNITY_BATCH 8 CACHE STRING "Sources of a module compiled together, with BEZEL_UNITY; 0: all of them")
mark_as_advanced(BEZEL_UNITY_BATCH)
function(bezel_together target sources)
  if(BEZEL_UNITY)
    set_target_properties(${target} PROPERTIES BEZEL_TOGETHER ON UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${BEZEL_UNITY_BATCH})
  endif()
  foreach(source ${sources})
    file(STRINGS ${source} per_target REGEX "^#include \"hwy/foreach_target.h\"" LIMIT_COUNT 1)
    if(per_target)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      file(STRINGS ${source} fewer_targets REGEX "^#define HWY_DISABLED_TARGETS" LIMIT_COUNT 1)
      if(BEZEL_SANITIZE AND NOT fewer_targets)  # what is left shows all that these show
        set_property(SOURCE ${source} APPEND PROPERTY COMPILE_DEFINITIONS HWY_DISABLED_TARGETS=HWY_SSSE3|HWY_SSE4|HWY_AVX3_DL)
      endif()
    endif()
  endforeach()
endfunction()

set(BEZEL_MODULE_TARGETS "")
function(bezel_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bezel/${name}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bezel/${name}/*.hpp)
  set(target bezel_${name})
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:bezel_warnings>)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    bezel_together(${target} "${sources}")
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(bezel::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} ${scope} bezel_flags ${ARG_DEPENDS})
  if(sources)
    target_link_libraries(${target} PRIVATE ${ARG_PRIVATE_DEPENDS})
  endif()
  set_property(GLOBAL APPEND PROPERTY BEZEL_HEADERS ${headers})
  set(BEZEL_MODULE_TARGETS ${BEZEL_MODULE_TARGETS} ${target} PARENT_SCOPE)
endfunction()
