add_executable(fuzz_intersect intersect_fuzz_test.cpp intersect_fuzz.cpp)
    target_include_directories(fuzz_intersect PRIVATE ${PROJECT_SOURCE_DIR}) target_link_libraries(
        fuzz_intersect PRIVATE bezel_warnings bezel::geometry GTest::gtest GTest::gtest_main)
        gtest_discover_tests(fuzz_intersect TEST_PREFIX fuzz.intersect.PROPERTIES LABELS fuzz
                                 DISCOVERY_TIMEOUT 120) if (BEZEL_LIBFUZZER)
            add_executable(libfuzzer_intersect intersect_libfuzzer.cpp intersect_fuzz.cpp)
                target_include_directories(libfuzzer_intersect PRIVATE ${PROJECT_SOURCE_DIR})
                    target_compile_options(libfuzzer_intersect PRIVATE - fsanitize = fuzzer)
                        target_link_options(libfuzzer_intersect PRIVATE - fsanitize = fuzzer)
                            target_link_libraries(
                                libfuzzer_intersect PRIVATE bezel_warnings bezel::geometry) endif()
