#pragma once
// Solving with a sparse mass matrix; only for .cpp files and tests (heavy header).

#include <Eigen/SparseCholesky>
#include <cstddef>
#include <memory>

namespace bezel::field_detail {

/// Sparse Cholesky up to this many degrees of freedom, conjugate gradients above.
inline constexpr std::size_t direct_limit = 300000;

/// Solves mass * x = rhs for a symmetric positive definite matrix; the bits do not depend on
/// threads.
///
/// Cholesky with one step of iterative refinement, or conjugate gradients with diagonal scaling
/// (mass matrices scaled so have a condition that does not depend on the mesh size) stopped at
/// relative residual 1e-15.
class MassSolver {
 public:
  /// @param mass  kept by reference; must outlive the solver
  /// @throws InputError when Cholesky finds the matrix not positive definite (inverted or flat
  /// elements)
  explicit MassSolver(const Eigen::SparseMatrix<double>& mass,
                      std::size_t largest_direct = direct_limit);
  /// @throws InputError as above for conjugate gradients; NumericsError when they stop above
  /// relative residual 1e-12
  Eigen::MatrixXd solve(const Eigen::MatrixXd& rhs) const;

 private:
  const Eigen::SparseMatrix<double>& mass_;
  std::unique_ptr<Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>> cholesky_;
};

}  // namespace bezel::field_detail
