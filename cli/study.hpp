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

/// The experiments of compensated evaluation [hermes2018, ch. 5]: figures 5.1, 5.2, 5.4, 5.6, 5.7,
/// table 5.1, operation counts and multipliers. Output as above.
int run_study_compensated(const std::string& out_dir, bool json);

/// Newton's method with compensated values [hermes2018, ch. 6]: figure 6.1, roots, tangent and
/// almost tangent intersections, the false start. Output as above.
int run_study_newton(const std::string& out_dir, bool json);

/// Interpolation of curves [bjontegaard2009, sec. 2.6]: figures 6 to 17, distances, iterations and
/// times. Output as above. @param quick  degrees up to 16 only
int run_study_curves(const std::string& out_dir, bool quick, bool json);

}  // namespace bezel::cli
