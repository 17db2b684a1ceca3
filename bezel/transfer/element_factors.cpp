#include "bezel/transfer/element_factors.hpp"

#include <algorithm>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/geometry/area_map.hpp"
#include "bezel/geometry/bent.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/mass_rule.hpp"

namespace bezel::detail {
namespace {

constexpr std::size_t width = ElementFactors::width;

/// Where entry (i, j), j <= i, of a packed factor starts.
constexpr std::size_t packed(std::size_t i, std::size_t j) {
  return (i * (i + 1) / 2 + j) * width;
}
constexpr std::size_t packed_size(std::size_t n) {
  return n * (n + 1) / 2 * width;
}

/// v = L L^T v for the elements of a block; v has shape (n, width).
void multiply_factor(std::size_t n, const double* lower, double* v) {
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
void divide_factor(std::size_t n, const double* lower, const double* inverse, double* v) {
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

[[noreturn]] void fail_at(std::size_t element) {
  throw NumericsError("triangle " + std::to_string(element) +
                      ": its mass matrix is not positive definite in double precision");
}

/// Calls body(begin, end) for ranges of elements, whole blocks each.
template <class Body>
void for_block_ranges(std::size_t n, int threads, const Body& body) {
  constexpr std::size_t step = 32 * width;
  parallel_for((n + step - 1) / step,
               [&](std::size_t i) { body(i * step, std::min(n, (i + 1) * step)); }, threads);
}

}  // namespace

ElementFactors::ElementFactors(const Space& space, const Field* weight, int threads)
    : size_(static_cast<std::size_t>(bernstein::triangle_size(space.uniform_degree()))),
      elements_(space.mesh()->element_count()),
      blocks_((elements_ + width - 1) / width),
      straight_(space.mesh()->degree() == 1 && !weight) {
  diagonal_.assign(blocks_ * size_ * width, 0.0);
  integrals_.assign(elements_ * size_, 0.0);
  if (straight_) {
    factorise_straight(space);
  } else {
    factorise(space, weight, threads);
  }
}

/// One factor for all: that of the reference triangle.
void ElementFactors::factorise_straight(const Space& space) {
  const int p = space.uniform_degree();
  const TriangleMesh& mesh = *space.mesh();
  const std::size_t n = size_;
  const std::vector<double> exact = bernstein::mass_matrix(p);
  std::vector<double> reference = exact;
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
  for (std::size_t e = 0; e < elements_; ++e) {
    scale_[e] = 2.0 * area(1, mesh.gather(ElementId(e)));
    if (!(scale_[e] > 0.0)) fail_at(e);
    for (std::size_t i = 0; i < n; ++i) {
      diagonal_[(e / width * n + i) * width + e % width] = scale_[e] * exact[i * n + i];
      integrals_[e * n + i] = 0.5 * scale_[e] / static_cast<double>(n);
    }
  }
}

void ElementFactors::factorise(const Space& space, const Field* weight, int threads) {
  const int p = space.uniform_degree();
  const TriangleMesh& mesh = *space.mesh();
  const std::size_t n = size_;
  int degree = 2 * p + 2 * (mesh.degree() - 1);
  if (weight) {
    const Space& own = weight->space();
    degree += own.highest_degree() * (own.basis() == Basis::physical ? mesh.degree() : 1);
  }
  const MassRule rule = make_mass_rule(mesh.degree(), degree);
  const std::size_t points = rule.weight.size();
  std::vector<double> phi(points * n);
  std::vector<Lambda> lambda(points);
  for (std::size_t q = 0; q < points; ++q) {
    const auto& at = rule.place[q];
    basis_at(p, at[0], at[1], phi.data() + q * n);
    lambda[q] = {1.0 - at[0] - at[1], at[0], at[1]};
  }
  lower_.assign(blocks_ * packed_size(n), 0.0);
  inverse_.assign(blocks_ * n * width, 1.0);
  for_block_ranges(elements_, threads, [&](std::size_t from, std::size_t to) {
    std::vector<double> matrix(n * n);
    std::vector<double> factor(points, 1.0);
    std::vector<Vec2> control(static_cast<std::size_t>(mesh.nodes_per_element()));
    for (std::size_t e = from; e < to; ++e) {
      mesh.gather(ElementId(e), control);
      const RoundControl round(control);
      const std::vector<double> bent = jacobian_if_bent(mesh.degree(), control, round.points());
      const auto det = [&](std::size_t q) {
        return bent.empty() ? mass_point(rule, round.points(), q).det
                            : bernstein::evaluate<double>(2 * (mesh.degree() - 1), bent, lambda[q]);
      };
      if (weight) weight->evaluate(ElementId(e), lambda, factor);
      std::fill(matrix.begin(), matrix.end(), 0.0);
      double* integral = integrals_.data() + e * n;
      for (std::size_t q = 0; q < points; ++q) {
        const double w = rule.weight[q] * det(q) * factor[q];
        const double* at = phi.data() + q * n;
        for (std::size_t i = 0; i < n; ++i) {
          const double wi = w * at[i];
          integral[i] += wi;
          for (std::size_t j = 0; j <= i; ++j) matrix[i * n + j] += wi * at[j];
        }
      }
      const std::size_t lane = e % width;
      for (std::size_t i = 0; i < n; ++i)
        diagonal_[(e / width * n + i) * width + lane] = matrix[i * n + i];
      if (!cholesky(n, matrix)) fail_at(e);
      double* lower = lower_.data() + e / width * packed_size(n) + lane;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) lower[packed(i, j)] = matrix[i * n + j];
        inverse_[(e / width * n + i) * width + lane] = 1.0 / matrix[i * n + i];
      }
    }
  });
}

void ElementFactors::multiply(std::size_t block, double* v) const {
  multiply_factor(size_, lower_.data() + (straight_ ? 0 : block * packed_size(size_)), v);
  if (!straight_) return;
  const double* scale = scale_.data() + block * width;
  for (std::size_t i = 0; i < size_; ++i)
    for (std::size_t k = 0; k < width; ++k) v[i * width + k] *= scale[k];
}

void ElementFactors::divide(std::size_t block, double* v) const {
  divide_factor(size_, lower_.data() + (straight_ ? 0 : block * packed_size(size_)),
                inverse_.data() + (straight_ ? 0 : block * size_ * width), v);
  if (!straight_) return;
  const double* scale = scale_.data() + block * width;
  for (std::size_t i = 0; i < size_; ++i)
    for (std::size_t k = 0; k < width; ++k) v[i * width + k] /= scale[k];
}

void ElementFactors::matrix(std::size_t e, std::span<double> out) const {
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

}  // namespace bezel::detail
