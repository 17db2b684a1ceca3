target_link_libraries(${target} PRIVATE gmpxx gmp)
