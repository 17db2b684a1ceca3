target_link_libraries(${target} PRIVATE nlohmann_json::nlohmann_json gmpxx gmp)
target_compile_definitions(${target} PRIVATE
  BEZEL_REFERENCE_DATA="${PROJECT_SOURCE_DIR}/tests/reference/data/bezier")
