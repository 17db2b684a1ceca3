#pragma once
// Internal to io: Gmsh's MSH files, versions 2.2 and 4.1, text and binary.

#include <string>
#include <string_view>
#include <vector>

#include "bezel/io/io.hpp"

namespace bezel::files {

/// What an MSH element type stands for.
struct MshType {
  int type;
  int dim;     ///< 0, 1 or 2
  int degree;  ///< 1..10 (a point: 0)
  int nodes;
};
/// Points, lines and triangles of degree 1..10; null for every other type.
const MshType* msh_type(int type);
/// The type of the complete line or triangle of a degree 1..10.
int msh_line_type(int degree);
int msh_triangle_type(int degree);
/// "4-node quadrangle"; "unknown" for types that are in no manual.
std::string msh_type_name(int type);

/// The $InterpolationScheme of the equally spaced nodes of a triangle in file order: value =
/// sum_i v_i sum_j coefficients(i, j) u^exponents(j, 0) v^exponents(j, 1).
struct InterpolationScheme {
  std::size_t functions = 0, monomials = 0;
  std::vector<double> coefficients;  ///< (functions, monomials)
  std::vector<double> exponents;     ///< (monomials, 3)
};
/// Exact up to one rounding of each entry; 0 <= degree <= 10.
InterpolationScheme nodal_scheme(int degree);

/// @throws InputError carrying the file
Dataset read_msh(const std::string& path, std::string_view bytes);
/// The bytes of the file, and what was lost.
std::string write_msh(const Dataset& data, Format format, std::vector<std::string>& lost);

}  // namespace bezel::files
