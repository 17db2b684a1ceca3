#include "bezel/transfer/mass_solve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/base/parallel.hpp"
#include "bezel/field/mass_kernel.hpp"
#include "bezel/transfer/petsc_system.hpp"

namespace bezel {

bool is_available(MassMethod method) {
  return method != MassMethod::petsc || detail::PetscRows::available();
}

}  // namespace bezel

namespace bezel::detail {
namespace {

constexpr std::size_t block_width = ElementFactors::width;
constexpr std::size_t blocks_per_task = 32;
constexpr std::size_t dofs_per_task = 2048;

/// Relative residuals: what is aimed at (rounding), and the largest that is accepted.
constexpr double aim = 2e-16;
constexpr double accept = 1e-12;
constexpr int max_steps = 2000;
constexpr int max_rounds = 4;

/// Calls body(begin, end) for ranges of `step` indices below n.
template <class Body>
void for_ranges(std::size_t n, std::size_t step, int threads, const Body& body) {
  parallel_for((n + step - 1) / step,
               [&](std::size_t i) { body(i * step, std::min(n, (i + 1) * step)); }, threads);
}

}  // namespace

struct ContinuousMass::Direct {
  Eigen::SparseMatrix<double> matrix;
  std::unique_ptr<field_detail::MassSolver> solver;
};

ContinuousMass::ContinuousMass(std::shared_ptr<const Space> space, std::vector<char> fixed,
                               int threads, MassMethod method, const Field* weight,
                               const MassSystemMaker& make_system)
    : space_(std::move(space)),
      fixed_(std::move(fixed)),
      threads_(threads),
      factors_(*space_, weight, threads),
      size_(factors_.size()),
      elements_(factors_.element_count()),
      method_(method) {
  if (method_ == MassMethod::automatic) {
    method_ = space_->dof_count() <= direct_limit ? MassMethod::cholesky
                                                  : MassMethod::conjugate_gradients;
  }
  const std::size_t dofs = space_->dof_count();
  begin_.assign(dofs + 1, 0);
  for (std::size_t e = 0; e < elements_; ++e)
    for (const std::int32_t d : space_->dofs(ElementId(e)))
      ++begin_[static_cast<std::size_t>(d) + 1];
  for (std::size_t d = 0; d < dofs; ++d) begin_[d + 1] += begin_[d];
  entry_.resize(begin_[dofs]);
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t e = 0; e < elements_; ++e) {
    const auto own = space_->dofs(ElementId(e));
    for (std::size_t i = 0; i < size_; ++i)
      entry_[next[static_cast<std::size_t>(own[i])]++] =
          static_cast<std::uint32_t>(factors_.place(e, i));
  }
  share_ = factors_.diagonal();
  for_ranges(dofs, dofs_per_task, threads_, [&](std::size_t from, std::size_t to) {
    for (std::size_t d = from; d < to; ++d) {
      double sum = 0.0;
      for (std::size_t k = begin_[d]; k < begin_[d + 1]; ++k) sum += share_[entry_[k]];
      for (std::size_t k = begin_[d]; k < begin_[d + 1]; ++k) share_[entry_[k]] /= sum;
    }
  });
  local_.resize(share_.size());
  if (method_ == MassMethod::cholesky) assemble_cholesky();
  if (method_ == MassMethod::petsc) assemble_elsewhere(make_system);
}

ContinuousMass::~ContinuousMass() = default;

/// y = sum over elements of A_e^T work(source of element e): source(e, i) gives coefficient i,
/// work(block, v) changes the coefficients of a block of elements.
template <class Source, class Work>
void ContinuousMass::by_elements(const Source& source, const Work& work, std::span<double> y) {
  for_ranges(factors_.block_count(), blocks_per_task, threads_,
             [&](std::size_t from, std::size_t to) {
               for (std::size_t b = from; b < to; ++b) {
                 double* v = local_.data() + b * size_ * block_width;
                 for (std::size_t lane = 0;
                      lane < block_width && b * block_width + lane < elements_; ++lane) {
                   for (std::size_t i = 0; i < size_; ++i)
                     v[i * block_width + lane] = source(b * block_width + lane, i);
                 }
                 work(b, v);
               }
             });
  for_ranges(space_->dof_count(), dofs_per_task, threads_, [&](std::size_t from, std::size_t to) {
    for (std::size_t d = from; d < to; ++d) {
      double sum = 0.0;
      for (std::size_t k = begin_[d]; k < begin_[d + 1]; ++k) sum += local_[entry_[k]];
      y[d] = sum;
    }
  });
}

void ContinuousMass::load(std::span<const double> c, std::span<double> y) {
  by_elements([&](std::size_t e, std::size_t i) { return c[e * size_ + i]; },
              [&](std::size_t b, double* v) { factors_.multiply(b, v); }, y);
}

void ContinuousMass::apply(std::span<const double> x, std::span<double> y) {
  const std::int32_t* dofs = space_->dofs(ElementId(0)).data();
  by_elements([&](std::size_t e,
                  std::size_t i) { return x[static_cast<std::size_t>(dofs[e * size_ + i])]; },
              [&](std::size_t b, double* v) { factors_.multiply(b, v); }, y);
}

void ContinuousMass::precondition(std::span<const double> r, std::span<double> z) {
  const std::int32_t* dofs = space_->dofs(ElementId(0)).data();
  by_elements([&](std::size_t e,
                  std::size_t i) { return r[static_cast<std::size_t>(dofs[e * size_ + i])]; },
              [&](std::size_t b, double* v) {
                const double* share = share_.data() + b * size_ * block_width;
                for (std::size_t i = 0; i < size_ * block_width; ++i) v[i] *= share[i];
                factors_.divide(b, v);
                for (std::size_t i = 0; i < size_ * block_width; ++i) v[i] *= share[i];
              },
              z);
}

void ContinuousMass::average(std::span<const double> c, std::span<double> x) {
  by_elements([&](std::size_t e, std::size_t i) { return c[e * size_ + i]; },
              [&](std::size_t b, double* v) {
                const double* share = share_.data() + b * size_ * block_width;
                for (std::size_t i = 0; i < size_ * block_width; ++i) v[i] *= share[i];
              },
              x);
}

double ContinuousMass::dot(std::span<const double> a, std::span<const double> b) {
  partial_.assign((a.size() + dofs_per_task - 1) / dofs_per_task, 0.0);
  for_ranges(a.size(), dofs_per_task, threads_, [&](std::size_t from, std::size_t to) {
    double sum = 0.0;
    for (std::size_t i = from; i < to; ++i) sum += a[i] * b[i];
    partial_[from / dofs_per_task] = sum;
  });
  double sum = 0.0;
  for (const double part : partial_) sum += part;
  return sum;
}

void ContinuousMass::mask(std::vector<double>& v) const {
  for (std::size_t d = 0; d < fixed_.size(); ++d)
    if (fixed_[d]) v[d] = 0.0;
}

/// A^T M (c - A x), 0 for the fixed dofs.
std::vector<double> ContinuousMass::residual(std::span<const double> c, std::span<const double> x) {
  const std::int32_t* dofs = space_->dofs(ElementId(0)).data();
  std::vector<double> difference(c.size());
  for_ranges(c.size(), dofs_per_task, threads_, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      difference[i] = c[i] - x[static_cast<std::size_t>(dofs[i])];
  });
  std::vector<double> r(x.size());
  load(difference, r);
  mask(r);
  return r;
}

void ContinuousMass::assemble_cholesky() {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(elements_ * size_ * size_);
  std::vector<double> matrix(size_ * size_);
  const auto is_fixed = [&](std::int32_t d) {
    return !fixed_.empty() && fixed_[static_cast<std::size_t>(d)];
  };
  for (std::size_t e = 0; e < elements_; ++e) {
    factors_.matrix(e, matrix);
    const auto own = space_->dofs(ElementId(e));
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j) {
        if ((is_fixed(own[i]) || is_fixed(own[j])) && own[i] != own[j]) continue;
        entries.emplace_back(own[i], own[j], matrix[i * size_ + j]);
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(space_->dof_count());
  solver_ = std::make_unique<Direct>();
  solver_->matrix.resize(n, n);
  solver_->matrix.setFromTriplets(entries.begin(), entries.end());
  solver_->solver = std::make_unique<field_detail::MassSolver>(solver_->matrix);
}

void ContinuousMass::assemble_elsewhere(const MassSystemMaker& make_system) {
  const auto is_fixed = [&](std::size_t d) { return !fixed_.empty() && fixed_[d]; };
  elsewhere_ = make_system ? make_system(*space_) : std::make_unique<PetscSystem>(*space_);
  std::vector<double> matrix(size_ * size_);
  std::vector<std::int32_t> rows(size_);
  for (std::size_t e = 0; e < elements_; ++e) {
    factors_.matrix(e, matrix);
    const auto own = space_->dofs(ElementId(e));
    for (std::size_t i = 0; i < size_; ++i)
      rows[i] = is_fixed(static_cast<std::size_t>(own[i])) ? -1 : own[i];
    elsewhere_->add(rows, matrix);
  }
  // The fixed dofs, whose right-hand side is 0, get a row of their own.
  constexpr std::array<double, 1> unit{1.0};
  for (std::size_t d = 0; d < space_->dof_count(); ++d)
    if (is_fixed(d)) elsewhere_->add(std::array{static_cast<std::int32_t>(d)}, unit);
  elsewhere_->finish();
}

/// Adds to x the solution for the residual r, to the recursive residual `smallest`.
int ContinuousMass::conjugate_gradients(std::vector<double> r, double smallest,
                                        std::span<double> x) {
  const std::size_t n = r.size();
  std::vector<double> z(n);
  std::vector<double> q(n);
  precondition(r, z);
  mask(z);
  std::vector<double> direction = z;
  double rz = dot(r, z);
  int step = 0;
  while (step < max_steps && rz > 0.0) {
    ++step;
    apply(direction, q);
    mask(q);
    const double curvature = dot(direction, q);
    if (!(curvature > 0.0)) break;
    const double alpha = rz / curvature;
    for_ranges(n, dofs_per_task, threads_, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        x[i] += alpha * direction[i];
        r[i] -= alpha * q[i];
      }
    });
    if (std::sqrt(dot(r, r)) <= smallest) break;
    precondition(r, z);
    mask(z);
    const double next = dot(r, z);
    const double beta = next / rz;
    rz = next;
    for_ranges(n, dofs_per_task, threads_, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) direction[i] = z[i] + beta * direction[i];
    });
  }
  return step;
}

MassSolution ContinuousMass::solve(std::span<const double> c, std::span<const double> given) {
  const std::size_t n = space_->dof_count();
  MassSolution solution;
  std::vector<double>& x = solution.dofs;
  x.resize(n);
  std::vector<double> right(n);
  load(c, right);
  const double size = std::sqrt(dot(right, right));
  average(c, x);
  for (std::size_t d = 0; d < fixed_.size(); ++d)
    if (fixed_[d]) x[d] = given[d];

  // Corrections of the element-wise residual: what the elements agree on already is never touched.
  std::vector<double> r = residual(c, x);
  double now = std::sqrt(dot(r, r));
  std::vector<double> candidate;
  for (int round = 0; round < max_rounds && now > aim * size; ++round) {
    candidate = x;
    if (method_ == MassMethod::cholesky) {
      const Eigen::MatrixXd d = solver_->solver->solve(
          Eigen::Map<const Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(n)));
      for (std::size_t i = 0; i < n; ++i) candidate[i] += d(static_cast<Eigen::Index>(i), 0);
    } else if (method_ == MassMethod::petsc) {
      solution.iterations += elsewhere_->solve(r, aim * size, candidate);
    } else {
      solution.iterations += conjugate_gradients(r, aim * size, candidate);
    }
    std::vector<double> better = residual(c, candidate);
    const double after = std::sqrt(dot(better, better));
    if (!(after < now)) break;
    const bool done = after > 0.5 * now;
    x = candidate;
    r = std::move(better);
    now = after;
    if (done) break;
  }
  solution.relative_residual = size > 0.0 ? now / size : now;
  if (!(solution.relative_residual <= accept)) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "the mass matrix of the continuous target: relative residual %.1e after %d "
                  "iterations, expected %.0e",
                  solution.relative_residual, solution.iterations, accept);
    throw NumericsError(text);
  }
  return solution;
}

}  // namespace bezel::detail
