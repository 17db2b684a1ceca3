#pragma once
// Internal to io: Bezel's own text form (.bzl), exact by hex floats. Grammar: docs/formats.md.

#include <string>
#include <string_view>

#include "bezel/io/io.hpp"

namespace bezel::files {

/// @throws InputError with file and line for anything write_native() does not write
Dataset read_native(const std::string& path, std::string_view bytes);
std::string write_native(const Dataset& data);

}  // namespace bezel::files
