target_link_libraries(${target} PRIVATE nlohmann_json::nlohmann_json)
target_compile_definitions(${target} PRIVATE BEZEL_CURVE_CASES="${PROJECT_SOURCE_DIR}/tests/reference/data/curves/curve_cases.json")
