#pragma once
// Numbers as text, and aligned columns of them.

#include <string>
#include <vector>

namespace bezel::cli {

/// The shortest decimal that reads back as the same double, or a hex float.
std::string exact_text(double value, bool hex = false);

/// Rows of cells under a header, each column as wide as its widest cell, two spaces apart.
std::string aligned(const std::vector<std::string>& header,
                    const std::vector<std::vector<std::string>>& rows);

}  // namespace bezel::cli
