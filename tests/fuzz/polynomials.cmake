if(TARGET bezel_cli)
  add_executable(fuzz_polynomials polynomial_mutations_test.cpp ${PROJECT_SOURCE_DIR}/cli/polynomials.cpp
    ${PROJECT_SOURCE_DIR}/cli/json_text.cpp)
  target_include_directories(fuzz_polynomials PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(fuzz_polynomials PRIVATE bezel_warnings bezel::io fmt::fmt
    nlohmann_json::nlohmann_json GTest::gtest GTest::gtest_main)
  gtest_discover_tests(fuzz_polynomials TEST_PREFIX fuzz.polynomials. PROPERTIES LABELS fuzz DISCOVERY_TIMEOUT 120)
endif()
