# The JSON that commands read.
if(TARGET bezel_cli)
  foreach(what polynomial shape)
    add_executable(fuzz_${what}s ${what}_mutations_test.cpp ${PROJECT_SOURCE_DIR}/cli/polynomials.cpp
      ${PROJECT_SOURCE_DIR}/cli/shapes.cpp ${PROJECT_SOURCE_DIR}/cli/json_text.cpp)
    target_include_directories(fuzz_${what}s PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(fuzz_${what}s PRIVATE bezel_warnings bezel::io fmt::fmt
      nlohmann_json::nlohmann_json GTest::gtest GTest::gtest_main)
    gtest_discover_tests(fuzz_${what}s TEST_PREFIX fuzz.${what}s. PROPERTIES LABELS fuzz DISCOVERY_TIMEOUT 120)
  endforeach()
endif()
