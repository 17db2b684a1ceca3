// libFuzzer entry: the first byte picks the format, the rest is the file.

#include <cstdint>

#include "tests/fuzz/io_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  bezel::io_fuzz::read_bytes(std::string(reinterpret_cast<const char*>(data) + 1, size - 1),
                             data[0] % 4);
  return 0;
}
