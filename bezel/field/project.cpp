// Nodal interpolation and L2 projection of formulas.

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/field.hpp"
#include "bezel/field/formula_kernel.hpp"
#include "bezel/field/integrals.hpp"
#include "bezel/field/mass_kernel.hpp"

namespace bezel {
namespace {

using Eigen::MatrixXd;
using field_detail::ElementMap;

std::size_t size_of(const Space& space, ElementId e) {
  return static_cast<std::size_t>(bernstein::triangle_size(space.degree(e)));
}

Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

InputPlace triangle(ElementId e) {
  return {{}, 0, "triangle", e.value};
}

/// The columns B_n(own lambda) at the given points, one point per column: shape (size, points).
MatrixXd basis_values(const Space& space, ElementId e, const ElementMap& map,
                      std::span<const Lambda> points) {
  const std::size_t size = size_of(space, e);
  MatrixXd values(index(size), index(points.size()));
  for (std::size_t q = 0; q < points.size(); ++q)
    bernstein::basis(space.degree(e), field_detail::own_lambda(space, e, map, points[q]),
                     {values.col(index(q)).data(), size});
  return values;
}

/// Coefficients (size, components) of the nodal interpolant on one element.
MatrixXd interpolate(const Space& space, ElementId e, std::span<const Formula> components) {
  const int d = space.degree(e);
  const std::size_t size = size_of(space, e);
  const ElementMap map(*space.mesh(), e);
  std::vector<Lambda> nodes(size);
  std::vector<Vec2> points(size);
  for (std::size_t i = 0; i < size; ++i) {
    nodes[i] = field_detail::lattice_point(d, static_cast<int>(i));
    points[i] = map(nodes[i]);
  }
  MatrixXd values(index(size), index(components.size()));
  for (std::size_t k = 0; k < components.size(); ++k)
    field_detail::evaluate_formula(components[k], points, {values.col(index(k)).data(), size}, e);
  if (space.basis() == Basis::physical) {
    const MatrixXd vandermonde = basis_values(space, e, map, nodes).transpose();
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(vandermonde);
    if (!qr.isInvertible())
      throw NumericsError(
          fmt::format("triangle {}: no unique polynomial of degree {} in x and y passes through "
                      "the images of the nodes; "
                      "project instead of sampling, or use the reference basis",
                      e.value, d));
    MatrixXd c = qr.solve(values);
    c += qr.solve(values - vandermonde * c);
    return c;
  }
  MatrixXd c(values.rows(), values.cols());
  for (Eigen::Index k = 0; k < values.cols(); ++k) {
    const std::vector<double> column =
        bernstein::from_lagrange<double>(d, std::span<const double>(values.col(k).data(), size));
    c.col(k) = Eigen::Map<const Eigen::VectorXd>(column.data(), index(size));
  }
  return c;
}

/// Dofs of a continuous space from element coefficients that agree where shared: the first
/// element's count.
std::vector<double> gather_dofs(const Space& space, const std::vector<double>& coefficients,
                                std::size_t n) {
  std::vector<double> dofs(space.dof_count() * n, 0.0);
  std::vector<char> seen(space.dof_count(), 0);
  for (std::size_t e = 0; e < space.mesh()->element_count(); ++e) {
    const std::span<const std::int32_t> of = space.dofs(ElementId(e));
    for (std::size_t i = 0; i < of.size(); ++i) {
      const auto dof = static_cast<std::size_t>(of[i]);
      if (seen[dof]) continue;
      seen[dof] = 1;
      for (std::size_t k = 0; k < n; ++k)
        dofs[dof * n + k] = coefficients[(space.offset(ElementId(e)) + i) * n + k];
    }
  }
  return dofs;
}

void store(const Space& space, ElementId e, const MatrixXd& c, std::vector<double>& out) {
  const auto n = static_cast<std::size_t>(c.cols());
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.rows()); ++i)
    for (std::size_t k = 0; k < n; ++k) out[(space.offset(e) + i) * n + k] = c(index(i), index(k));
}

/// An element's weighted least-squares problem: basis at the points, weights times Jacobian, values
/// of the formulas.
struct Samples {
  MatrixXd basis;          // (size, points)
  Eigen::VectorXd weight;  // (points)
  MatrixXd values;         // (points, components)
};

Samples take_samples(const Space& space, ElementId e, const TriangleRule& rule,
                     std::span<const Formula> components) {
  const ElementMap map(*space.mesh(), e);
  const std::size_t points = rule.weight.size();
  Samples s{basis_values(space, e, map, rule.lambda), Eigen::VectorXd(index(points)),
            MatrixXd(index(points), index(components.size()))};
  std::vector<Vec2> x(points);
  ElementMap round = map;
  round.make_round_for_det();
  for (std::size_t q = 0; q < points; ++q) {
    x[q] = map(rule.lambda[q]);
    s.weight(index(q)) = rule.weight[q] * round.det(rule.lambda[q]);
  }
  for (std::size_t k = 0; k < components.size(); ++k)
    field_detail::evaluate_formula(components[k], x, {s.values.col(index(k)).data(), points}, e);
  return s;
}

MatrixXd mass_matrix(const Samples& s) {
  return s.basis * s.weight.asDiagonal() * s.basis.transpose();
}
MatrixXd load(const Samples& s, const MatrixXd& values) {
  return s.basis * (s.weight.asDiagonal() * values);
}

// Corrections with the residual taken at the points ("corrected seminormal equations"): a
// polynomial of the space comes back to rounding although the condition of the mass matrix is the
// square of the basis's. One or two do.
constexpr int max_corrections = 4;

/// True while corrections of size `now` are worth another round.
bool still_shrinking(double now, double before, double solution) {
  return now > 0x1p-53 * solution && now < 0.25 * before;
}

[[noreturn]] void refuse(ElementId e) {
  throw InputError(triangle(e),
                   "its mass matrix is not positive definite, expected an element that is not "
                   "inverted or flat");
}

/// The projection on one element, by Cholesky and corrections.
MatrixXd project_element(const Space& space, ElementId e, const TriangleRule& rule,
                         std::span<const Formula> components) {
  const Samples s = take_samples(space, e, rule, components);
  const Eigen::LLT<MatrixXd> llt(mass_matrix(s));
  if (llt.info() != Eigen::Success) refuse(e);
  MatrixXd c = llt.solve(load(s, s.values));
  double before = c.norm();
  for (int round = 0; round < max_corrections; ++round) {
    const MatrixXd correction = llt.solve(load(s, s.values - s.basis.transpose() * c));
    c += correction;
    if (!still_shrinking(correction.norm(), before, c.norm())) break;
    before = correction.norm();
  }
  return c;
}

/// The same for straight elements in their own coordinates, many at once: one matrix for all of
/// them, their areas cancel.
class StraightProjection {
 public:
  StraightProjection(int degree, const TriangleRule& rule)
      : rule_(rule),
        basis_(index(static_cast<std::size_t>(bernstein::triangle_size(degree))),
               index(rule.weight.size())) {
    for (std::size_t q = 0; q < rule.weight.size(); ++q)
      bernstein::basis(degree, rule.lambda[q],
                       {basis_.col(index(q)).data(), static_cast<std::size_t>(basis_.rows())});
    const Eigen::Map<const Eigen::VectorXd> weight(rule.weight.data(), index(rule.weight.size()));
    const MatrixXd weighted = basis_ * weight.asDiagonal();
    projector_ = Eigen::LLT<MatrixXd>(weighted * basis_.transpose()).solve(weighted);
  }

  /// Elements [from, to) of one degree.
  void operator()(const Space& space, std::size_t from, std::size_t to,
                  std::span<const Formula> components, std::vector<double>& out) const {
    const std::size_t points = rule_.weight.size(), n = components.size();
    std::vector<Vec2> x;
    x.reserve((to - from) * points);
    for (std::size_t e = from; e < to; ++e) {
      const std::array<Vec2, 3> c = field_detail::corners(*space.mesh(), ElementId(e));
      if (!(cross(c[1] - c[0], c[2] - c[0]) > 0.0)) refuse(ElementId(e));
      for (const Lambda& l : rule_.lambda) x.push_back(l[0] * c[0] + l[1] * c[1] + l[2] * c[2]);
    }
    MatrixXd values(index(points), index(to - from));
    for (std::size_t k = 0; k < n; ++k) {
      field_detail::evaluate_formula(components[k], x, {values.data(), x.size()}, ElementId(from),
                                     points);
      MatrixXd c = projector_ * values;
      double before = c.norm();
      for (int round = 0; round < max_corrections; ++round) {
        const MatrixXd correction = projector_ * (values - basis_.transpose() * c);
        c += correction;
        if (!still_shrinking(correction.norm(), before, c.norm())) break;
        before = correction.norm();
      }
      double* to_coefficient = out.data() + space.offset(ElementId(from)) * n + k;
      for (Eigen::Index i = 0; i < c.size(); ++i)
        to_coefficient[static_cast<std::size_t>(i) * n] = c.data()[i];
    }
  }

 private:
  const TriangleRule& rule_;
  MatrixXd basis_, projector_;  // (size, points)
};

/// Whether elements [from, to) are straight and their polynomials in their own coordinates.
bool are_straight(const Space& space, std::size_t from, std::size_t to) {
  if (space.mesh()->degree() > 1 || space.uniform_degree() < 0) return false;
  if (space.basis() == Basis::reference) return true;
  for (std::size_t e = from; e < to; ++e) {
    const ElementId id(e);
    if (!space.is_own_frame(id)) return false;
  }
  return true;
}

std::vector<double> project_discontinuous(const Space& space, const field_detail::RuleTable& rules,
                                          std::span<const Formula> components, int threads) {
  std::vector<double> out(space.coefficient_count() * components.size());
  std::optional<StraightProjection> straight;
  if (are_straight(space, 0, 0))
    straight.emplace(space.uniform_degree(), rules(space.uniform_degree()));
  constexpr std::size_t chunk = 32;
  const std::size_t elements = space.mesh()->element_count();
  parallel_for((elements + chunk - 1) / chunk,
               [&](std::size_t task) {
                 const std::size_t from = task * chunk, to = std::min(elements, from + chunk);
                 if (straight && are_straight(space, from, to))
                   return (*straight)(space, from, to, components, out);
                 for (std::size_t e = from; e < to; ++e) {
                   const ElementId id(e);
                   store(space, id, project_element(space, id, rules(space.degree(id)), components),
                         out);
                 }
               },
               threads);
  return out;
}

/// Adds element contributions (size, components) to rows of the right-hand side, in element order.
MatrixXd assemble(const Space& space, const std::vector<MatrixXd>& parts, std::size_t n) {
  MatrixXd b = MatrixXd::Zero(index(space.dof_count()), index(n));
  for (std::size_t e = 0; e < parts.size(); ++e) {
    const std::span<const std::int32_t> dofs = space.dofs(ElementId(e));
    for (std::size_t i = 0; i < dofs.size(); ++i) b.row(dofs[i]) += parts[e].row(index(i));
  }
  return b;
}

std::vector<double> project_continuous(const Space& space, const field_detail::RuleTable& rules,
                                       std::span<const Formula> components, int threads) {
  const std::size_t elements = space.mesh()->element_count();
  const std::size_t n = components.size();
  std::vector<MatrixXd> mass(elements), part(elements);
  field_detail::for_elements(
      *space.mesh(),
      [&](ElementId e) {
        const Samples s = take_samples(space, e, rules(space.degree(e)), components);
        mass[e.index()] = mass_matrix(s);
        part[e.index()] = load(s, s.values);
      },
      threads);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t e = 0; e < elements; ++e) {
    const std::span<const std::int32_t> dofs = space.dofs(ElementId(e));
    for (std::size_t i = 0; i < dofs.size(); ++i)
      for (std::size_t j = 0; j < dofs.size(); ++j)
        entries.emplace_back(dofs[i], dofs[j], mass[e](index(i), index(j)));
    mass[e].resize(0, 0);
  }
  Eigen::SparseMatrix<double> matrix(index(space.dof_count()), index(space.dof_count()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  entries = {};
  const field_detail::MassSolver solver(matrix);
  MatrixXd x = solver.solve(assemble(space, part, n));
  double before = x.norm();
  for (int round = 0; round < max_corrections; ++round) {
    field_detail::for_elements(
        *space.mesh(),
        [&](ElementId e) {
          const Samples s = take_samples(space, e, rules(space.degree(e)), components);
          const std::span<const std::int32_t> dofs = space.dofs(e);
          MatrixXd c(index(dofs.size()), index(n));
          for (std::size_t i = 0; i < dofs.size(); ++i) c.row(index(i)) = x.row(dofs[i]);
          part[e.index()] = load(s, s.values - s.basis.transpose() * c);
        },
        threads);
    const MatrixXd correction = solver.solve(assemble(space, part, n));
    x += correction;
    if (!still_shrinking(correction.norm(), before, x.norm())) break;
    before = correction.norm();
  }
  std::vector<double> dofs(space.dof_count() * n);
  for (std::size_t i = 0; i < space.dof_count(); ++i)
    for (std::size_t k = 0; k < n; ++k) dofs[i * n + k] = x(index(i), index(k));
  return space.expand(dofs, static_cast<int>(n));
}

void check_arguments(const std::shared_ptr<const Space>& space,
                     std::span<const Formula> components) {
  if (!space) throw InputError("a field needs a space, found a null pointer");
  if (components.empty() || components.size() > static_cast<std::size_t>(Field::max_components))
    throw InputError(
        fmt::format("found {} formulas, expected 1..{}", components.size(), Field::max_components));
  for (const Formula& f : components) field_detail::check_formula(f);
}

}  // namespace

Field sample(std::string name, std::shared_ptr<const Space> space,
             std::span<const Formula> components, int threads) {
  check_arguments(space, components);
  const std::size_t n = components.size();
  std::vector<double> c(space->coefficient_count() * n);
  field_detail::for_elements(
      *space->mesh(), [&](ElementId e) { store(*space, e, interpolate(*space, e, components), c); },
      threads);
  if (space->continuity() == Continuity::continuous)
    c = space->expand(gather_dofs(*space, c, n), static_cast<int>(n));
  return Field(std::move(name), std::move(space), std::move(c), static_cast<int>(n));
}

Field project(std::string name, std::shared_ptr<const Space> space,
              std::span<const Formula> components, int extra, int threads) {
  check_arguments(space, components);
  if (extra < 0 || extra > 60)
    throw InputError(fmt::format("found extra degree {}, expected 0..60", extra));
  const field_detail::RuleTable rules(
      *space, [&](int p) { return field_detail::integrand_degree(*space, 2 * p + extra); });
  const std::size_t n = components.size();
  std::vector<double> c;
  if (space->continuity() == Continuity::continuous) {
    c = project_continuous(*space, rules, components, threads);
  } else {
    c = project_discontinuous(*space, rules, components, threads);
  }
  return Field(std::move(name), std::move(space), std::move(c), static_cast<int>(n));
}

}  // namespace bezel
