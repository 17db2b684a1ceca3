// libFuzzer entry of evaluate_fuzz.

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/evaluate_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bezel::evaluate_fuzz::evaluate_bytes({data, size});
  return 0;
}
