#include "bezel/transfer/mass_solve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/field/mass_kernel.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/mass_rule.hpp"

namespace bezel::detail {
namespace {

/// Elements worked on together, one to a lane of the loops below.
constexpr std::size_t width = 8;
constexpr std::size_t blocks_per_task = 32;
constexpr std::size_t dofs_per_task = 2048;

/// Relative residuals: what is aimed at (rounding), and the largest that is accepted.
constexpr double aim = 2e-16;
constexpr double accept = 1e-12;
constexpr int max_steps = 2000;
constexpr int max_rounds = 4;

constexpr std::size_t packed(std::size_t i, std::size_t j) {
  return (i * (i + 1) / 2 + j) * width;
}
constexpr std::size_t packed_size(std::size_t n) {
  return n * (n + 1) / 2 * width;
}

/// v = L L^T v for the elements of a block; v has shape (n, width).
void multiply(std::size_t n, const double* lower, double* v) {
  for (std::size_t j = 0; j < n; ++j) {
    double* vj = v + j * width;
    const double* diagonal = lower + packed(j, j);
    for (std::size_t k = 0; k < width; ++k) vj[k] *= diagonal[k];
    for (std::size_t i = j + 1; i < n; ++i) {
      const double* l = lower + packed(i, j);
      const double* vi = v + i * width;
      for (std::size_t k = 0; k < width; ++k) vj[k] += l[k] * vi[k];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    double* vi = v + i * width;
    const double* diagonal = lower + packed(i, i);
    for (std::size_t k = 0; k < width; ++k) vi[k] *= diagonal[k];
    for (std::size_t j = 0; j < i; ++j) {
      const double* l = lower + packed(i, j);
      const double* vj = v + j * width;
      for (std::size_t k = 0; k < width; ++k) vi[k] += l[k] * vj[k];
    }
  }
}

/// v = (L L^T)^-1 v.
void divide(std::size_t n, const double* lower, const double* inverse, double* v) {
  for (std::size_t i = 0; i < n; ++i) {
    double* vi = v + i * width;
    for (std::size_t j = 0; j < i; ++j) {
      const double* l = lower + packed(i, j);
      const double* vj = v + j * width;
      for (std::size_t k = 0; k < width; ++k) vi[k] -= l[k] * vj[k];
    }
    for (std::size_t k = 0; k < width; ++k) vi[k] *= inverse[i * width + k];
  }
  for (std::size_t j = n; j-- > 0;) {
    double* vj = v + j * width;
    for (std::size_t i = j + 1; i < n; ++i) {
      const double* l = lower + packed(i, j);
      const double* vi = v + i * width;
      for (std::size_t k = 0; k < width; ++k) vj[k] -= l[k] * vi[k];
    }
    for (std::size_t k = 0; k < width; ++k) vj[k] *= inverse[j * width + k];
  }
}

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
                               int threads, std::size_t largest_direct)
    : space_(std::move(space)),
      fixed_(std::move(fixed)),
      threads_(threads),
      size_(static_cast<std::size_t>(bernstein::triangle_size(space_->uniform_degree()))),
      elements_(space_->mesh()->element_count()),
      blocks_((elements_ + width - 1) / width),
      straight_(space_->mesh()->degree() == 1),
      direct_(space_->dof_count() <= largest_direct) {
  factorise();
  const std::size_t dofs = space_->dof_count();
  begin_.assign(dofs + 1, 0);
  const auto place = [&](std::size_t e, std::size_t i) {
    return (e / width * size_ + i) * width + e % width;
  };
  for (std::size_t e = 0; e < elements_; ++e)
    for (const std::int32_t d : space_->dofs(ElementId(e)))
      ++begin_[static_cast<std::size_t>(d) + 1];
  for (std::size_t d = 0; d < dofs; ++d) begin_[d + 1] += begin_[d];
  entry_.resize(begin_[dofs]);
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t e = 0; e < elements_; ++e) {
    const auto own = space_->dofs(ElementId(e));
    for (std::size_t i = 0; i < size_; ++i)
      entry_[next[static_cast<std::size_t>(own[i])]++] = static_cast<std::uint32_t>(place(e, i));
  }
  // The shares so far hold the diagonals of the element matrices.
  for_ranges(dofs, dofs_per_task, threads_, [&](std::size_t from, std::size_t to) {
    for (std::size_t d = from; d < to; ++d) {
      double sum = 0.0;
      for (std::size_t k = begin_[d]; k < begin_[d + 1]; ++k) sum += share_[entry_[k]];
      for (std::size_t k = begin_[d]; k < begin_[d + 1]; ++k) share_[entry_[k]] /= sum;
    }
  });
  local_.resize(blocks_ * size_ * width);
  if (direct_) assemble();
}

ContinuousMass::~ContinuousMass() = default;

void ContinuousMass::factorise() {
  const int p = space_->uniform_degree();
  const TriangleMesh& mesh = *space_->mesh();
  const std::size_t n = size_;
  share_.assign(blocks_ * n * width, 0.0);
  integrals_.resize(elements_ * n);
  std::vector<double> reference = bernstein::mass_matrix(p);
  if (straight_) {
    cholesky(n, reference);
    lower_.resize(packed_size(n));
    inverse_.resize(n * width);
    scale_.assign(blocks_ * width, 1.0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < width; ++k) {
        for (std::size_t j = 0; j <= i; ++j) lower_[packed(i, j) + k] = reference[i * n + j];
        inverse_[i * width + k] = 1.0 / reference[i * n + i];
      }
    }
    const std::vector<double> exact = bernstein::mass_matrix(p);
    for (std::size_t e = 0; e < elements_; ++e) {
      scale_[e] = 2.0 * area(1, mesh.gather(ElementId(e)));
      if (!(scale_[e] > 0.0)) {
        throw NumericsError(
            "triangle " + std::to_string(e) +
            ": its mass matrix is not positive definite (the area is not positive)");
      }
      for (std::size_t i = 0; i < n; ++i) {
        share_[(e / width * n + i) * width + e % width] = scale_[e] * exact[i * n + i];
        integrals_[e * n + i] = 0.5 * scale_[e] / static_cast<double>(n);
      }
    }
    return;
  }
  const MassRule rule = make_mass_rule(mesh.degree(), 2 * p + 2 * (mesh.degree() - 1));
  const std::size_t points = rule.weight.size();
  std::vector<double> phi(points * n);
  for (std::size_t q = 0; q < points; ++q)
    basis_at(p, rule.place[q][0], rule.place[q][1], phi.data() + q * n);
  lower_.assign(blocks_ * packed_size(n), 0.0);
  inverse_.assign(blocks_ * n * width, 1.0);
  for_ranges(elements_, blocks_per_task * width, threads_, [&](std::size_t from, std::size_t to) {
    std::vector<double> matrix(n * n);
    std::vector<Vec2> control(static_cast<std::size_t>(mesh.nodes_per_element()));
    for (std::size_t e = from; e < to; ++e) {
      mesh.gather(ElementId(e), control);
      std::fill(matrix.begin(), matrix.end(), 0.0);
      double* integral = integrals_.data() + e * n;
      for (std::size_t q = 0; q < points; ++q) {
        const double w = rule.weight[q] * mass_point(rule, control, q).det;
        const double* at = phi.data() + q * n;
        for (std::size_t i = 0; i < n; ++i) {
          const double wi = w * at[i];
          integral[i] += wi;
          for (std::size_t j = 0; j <= i; ++j) matrix[i * n + j] += wi * at[j];
        }
      }
      const std::size_t lane = e % width;
      for (std::size_t i = 0; i < n; ++i)
        share_[(e / width * n + i) * width + lane] = matrix[i * n + i];
      if (!cholesky(n, matrix)) {
        throw NumericsError("triangle " + std::to_string(e) +
                            ": its mass matrix is not positive definite in double precision");
      }
      double* lower = lower_.data() + e / width * packed_size(n) + lane;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) lower[packed(i, j)] = matrix[i * n + j];
        inverse_[(e / width * n + i) * width + lane] = 1.0 / matrix[i * n + i];
      }
    }
  });
}

void ContinuousMass::element_matrix(std::size_t e, std::span<double> out) const {
  const double* lower =
      lower_.data() + (straight_ ? 0 : e / width * packed_size(size_)) + e % width;
  const double scale = straight_ ? scale_[e] : 1.0;
  for (std::size_t i = 0; i < size_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k <= j; ++k) sum += lower[packed(i, k)] * lower[packed(j, k)];
      out[i * size_ + j] = out[j * size_ + i] = sum * scale;
    }
  }
}

/// y = sum over elements of A_e^T work(source of element e): source(e, i) gives coefficient i,
/// work(block, v) changes the coefficients of a block of elements.
template <class Source, class Work>
void ContinuousMass::by_elements(const Source& source, const Work& work, std::span<double> y) {
  for_ranges(blocks_, blocks_per_task, threads_, [&](std::size_t from, std::size_t to) {
    for (std::size_t b = from; b < to; ++b) {
      double* v = local_.data() + b * size_ * width;
      for (std::size_t lane = 0; lane < width && b * width + lane < elements_; ++lane) {
        for (std::size_t i = 0; i < size_; ++i) v[i * width + lane] = source(b * width + lane, i);
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

void ContinuousMass::multiply_block(std::size_t block, double* v) const {
  multiply(size_, lower_.data() + (straight_ ? 0 : block * packed_size(size_)), v);
  if (!straight_) return;
  const double* scale = scale_.data() + block * width;
  for (std::size_t i = 0; i < size_; ++i)
    for (std::size_t k = 0; k < width; ++k) v[i * width + k] *= scale[k];
}

void ContinuousMass::load(std::span<const double> c, std::span<double> y) {
  by_elements([&](std::size_t e, std::size_t i) { return c[e * size_ + i]; },
              [&](std::size_t b, double* v) { multiply_block(b, v); }, y);
}

void ContinuousMass::apply(std::span<const double> x, std::span<double> y) {
  const std::int32_t* dofs = space_->dofs(ElementId(0)).data();
  by_elements([&](std::size_t e,
                  std::size_t i) { return x[static_cast<std::size_t>(dofs[e * size_ + i])]; },
              [&](std::size_t b, double* v) { multiply_block(b, v); }, y);
}

void ContinuousMass::precondition(std::span<const double> r, std::span<double> z) {
  const std::int32_t* dofs = space_->dofs(ElementId(0)).data();
  by_elements([&](std::size_t e,
                  std::size_t i) { return r[static_cast<std::size_t>(dofs[e * size_ + i])]; },
              [&](std::size_t b, double* v) {
                const double* share = share_.data() + b * size_ * width;
                for (std::size_t i = 0; i < size_ * width; ++i) v[i] *= share[i];
                divide(size_, lower_.data() + (straight_ ? 0 : b * packed_size(size_)),
                       inverse_.data() + (straight_ ? 0 : b * size_ * width), v);
                if (straight_) {
                  for (std::size_t i = 0; i < size_; ++i)
                    for (std::size_t k = 0; k < width; ++k)
                      v[i * width + k] /= scale_[b * width + k];
                }
                for (std::size_t i = 0; i < size_ * width; ++i) v[i] *= share[i];
              },
              z);
}

void ContinuousMass::average(std::span<const double> c, std::span<double> x) {
  by_elements([&](std::size_t e, std::size_t i) { return c[e * size_ + i]; },
              [&](std::size_t b, double* v) {
                const double* share = share_.data() + b * size_ * width;
                for (std::size_t i = 0; i < size_ * width; ++i) v[i] *= share[i];
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

void ContinuousMass::assemble() {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(elements_ * size_ * size_);
  std::vector<double> matrix(size_ * size_);
  const auto is_fixed = [&](std::int32_t d) {
    return !fixed_.empty() && fixed_[static_cast<std::size_t>(d)];
  };
  for (std::size_t e = 0; e < elements_; ++e) {
    element_matrix(e, matrix);
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
    if (direct_) {
      const Eigen::MatrixXd d = solver_->solver->solve(
          Eigen::Map<const Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(n)));
      for (std::size_t i = 0; i < n; ++i) candidate[i] += d(static_cast<Eigen::Index>(i), 0);
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
