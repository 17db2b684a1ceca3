#pragma once
// Curves put to use: the boundary of a mesh around an aerofoil.

#include "cli/study_report.hpp"

namespace bezel::cli {

/// Adds the geometry error of meshes around NACA 0012 with edges of degree 1 to 4: nodes at equal
/// steps of the parameter, by arc length, and the best ones. @param quick  one level less
void add_aerofoil_meshes(StudyReport& report, bool quick);

}  // namespace bezel::cli
