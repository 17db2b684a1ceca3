#pragma once
// Any bytes as a file of any format: the readers return a dataset or throw InputError, nothing
// else.

#include <cstddef>
#include <string>

namespace bezel::io_fuzz {

/// Gives the bytes to the reader of a format (0: MSH, 1: VTU, 2: native, 3: PVD).
/// @return whether they were read; throws what is not an InputError
bool read_bytes(const std::string& bytes, int format);

}  // namespace bezel::io_fuzz
