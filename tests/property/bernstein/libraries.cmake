target_link_libraries(${target} PRIVATE hwy::hwy gmpxx gmp)
