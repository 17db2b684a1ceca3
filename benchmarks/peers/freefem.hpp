#pragma once
// FreeFEM behind plain functions: it runs as a program of its own.

#include <array>

#include "bezel/mesh/mesh.hpp"

namespace peers {

/// What a transfer took, and how good it was.
struct Transferred {
  double seconds;      ///< processor time
  double l2_relative;  ///< error against the function
  double mass_defect;  ///< |mass after - mass before| / integral of |f|
};

/// The field exp(x^2) + 2 y of degree 1, 2 or 3, discontinuous, from one straight mesh to another:
/// by its values at the target's nodes, and by L2 projection with quadrature on the target's
/// triangles. The least times of `rounds`.
/// @throws std::runtime_error when FreeFEM fails
std::array<Transferred, 2> freefem_transfer(const bezel::TriangleMesh& donor,
                                            const bezel::TriangleMesh& target, int degree,
                                            int rounds);

}  // namespace peers
