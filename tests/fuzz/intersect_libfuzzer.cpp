// libFuzzer entry of intersect_fuzz.

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/intersect_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bezel::intersect_fuzz::intersect_bytes({data, size});
  return 0;
}
