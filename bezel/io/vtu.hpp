#pragma once
// Internal to io: VTK XML unstructured grids (.vtu).

#include <string>
#include <string_view>
#include <vector>

#include "bezel/io/io.hpp"

namespace bezel::files {

/// @throws InputError with file and line (of the XML element)
Dataset read_vtu(const std::string& path, std::string_view bytes);
std::string write_vtu(const Dataset& data, const WriteOptions& options,
                      std::vector<std::string>& lost);

}  // namespace bezel::files
