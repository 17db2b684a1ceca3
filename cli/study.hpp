#pragma once
// The experiments behind `bezel study`.

#include <string>

namespace bezel::cli {

/// The convergence study of transfers from a square to a disc. Prints a Markdown table (or, with
/// json, one object
/// {"schema": "bezel/study/1", "tables": […]}) and writes CSV files and an SVG plot to out_dir,
/// which it creates.
/// @return the exit code
int run_study_transfer(const std::string& out_dir, bool quick, bool json);

}  // namespace bezel::cli
