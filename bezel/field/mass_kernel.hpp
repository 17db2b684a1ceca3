#pragma once
// Solving with a sparse mass matrix; only for .cpp files and tests (heavy header).

#include <Eigen/SparseCore>
#include <cstddef>

namespace bezel::field_detail {

/// Sparse Cholesky up to this many degrees of freedom, conjugate gradients above.
inline constexpr std::size_t direct_limit = 300000;

/// Solves mass * x = rhs for a symmetric positive definite matrix; the bits do not depend on
/// threads.
///
/// Cholesky with one step of iterative refinement, or conjugate gradients with diagonal scaling
/// (mass matrices scaled so have a condition that does not depend on the mesh size) stopped at
/// relative residual 1e-15.
/// @throws InputError when the matrix is not positive definite (inverted or flat elements);
/// NumericsError when
///         conjugate gradients stop above relative residual 1e-12
Eigen::MatrixXd solve_mass(const Eigen::SparseMatrix<double>& mass, const Eigen::MatrixXd& rhs,
                           std::size_t largest_direct = direct_limit);

}  // namespace bezel::field_detail
