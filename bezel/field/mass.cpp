#include <fmt/format.h>

#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/field/mass_kernel.hpp"

namespace bezel::field_detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;

constexpr double aim = 1e-15, accept = 1e-12;  // relative residuals
constexpr int max_steps = 5000;

[[noreturn]] void not_definite() {
  throw InputError(
      "the mass matrix is not positive definite, expected a mesh without inverted or flat "
      "elements");
}

VectorXd conjugate_gradients(const Matrix& mass, const VectorXd& rhs) {
  const VectorXd diagonal = mass.diagonal();
  if (!(diagonal.minCoeff() > 0.0)) not_definite();
  VectorXd x = rhs.cwiseQuotient(diagonal), r = rhs - mass * x;
  VectorXd z = r.cwiseQuotient(diagonal), p = z;
  const double size = rhs.norm();
  double rz = r.dot(z), best = r.norm();
  VectorXd best_x = x;
  int since_best = 0;  // the recursive residual stagnates near rounding
  for (int step = 0; step < max_steps && best > aim * size && since_best < 50; ++step) {
    const VectorXd q = mass * p;
    const double curvature = p.dot(q);
    if (!(curvature > 0.0)) not_definite();
    const double alpha = rz / curvature;
    x += alpha * p;
    r -= alpha * q;
    if (r.norm() < best) {
      best = r.norm();
      best_x = x;
      since_best = 0;
    } else {
      ++since_best;
    }
    z = r.cwiseQuotient(diagonal);
    const double next = r.dot(z);
    p = z + (next / rz) * p;
    rz = next;
  }
  const double residual = (rhs - mass * best_x).norm();
  if (!(residual <= accept * size))
    throw NumericsError(
        fmt::format("conjugate gradients on the mass matrix stopped at relative residual {:.1e}, "
                    "expected {:.0e}",
                    residual / size, accept));
  return best_x;
}

}  // namespace

MassSolver::MassSolver(const Matrix& mass, std::size_t largest_direct) : mass_(mass) {
  if (static_cast<std::size_t>(mass.rows()) > largest_direct) return;
  cholesky_ = std::make_unique<Eigen::SimplicialLLT<Matrix>>(mass);
  if (cholesky_->info() != Eigen::Success) not_definite();
}

MatrixXd MassSolver::solve(const MatrixXd& rhs) const {
  if (cholesky_) {
    MatrixXd x = cholesky_->solve(rhs);
    x += cholesky_->solve(rhs - mass_ * x);
    return x;
  }
  MatrixXd x = MatrixXd::Zero(rhs.rows(), rhs.cols());
  for (Eigen::Index k = 0; k < rhs.cols(); ++k)
    if (!rhs.col(k).isZero(0.0)) x.col(k) = conjugate_gradients(mass_, rhs.col(k));
  return x;
}

}  // namespace bezel::field_detail
