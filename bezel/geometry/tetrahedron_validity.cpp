// check_validity: the sign of the Jacobian determinant by subdivision of its Bernstein
// coefficients.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "bezel/geometry/tetrahedron.hpp"
#include "bezel/geometry/tetrahedron_check.hpp"
#include "bezel/geometry/tetrahedron_kernel.hpp"
#include "bezel/numeric/dyadic.hpp"

namespace bezel {
namespace {

using bernstein::tetrahedron::kernel::Bisection;
constexpr std::array<Lambda4, 4> whole_tetrahedron{Lambda4{1, 0, 0, 0}, Lambda4{0, 1, 0, 0},
                                                   Lambda4{0, 0, 1, 0}, Lambda4{0, 0, 0, 1}};
constexpr std::size_t max_exact = 32;

/// The determinant at lambda, whose entries are taken as exact and sum to 1.
Dyadic exact_determinant(int g, std::span<const Vec3> control, const Lambda4& lambda) {
  using bernstein::tetrahedron_index;
  const std::array<Dyadic, 4> x{lambda[0], lambda[1], lambda[2], lambda[3]};
  std::array<std::array<Dyadic, 3>, 3> column;
  for (std::size_t direction = 0; direction < 3; ++direction)
    for (int c = 0; c < 3; ++c) {
      std::vector<Dyadic> difference;
      for (int l = 0; l < g; ++l)
        for (int k = 0; k < g - l; ++k)
          for (int j = 0; j < g - l - k; ++j) {
            const int to = tetrahedron_index(g, j + (direction == 0), k + (direction == 1),
                                             l + (direction == 2));
            const int from = tetrahedron_index(g, j, k, l);
            difference.push_back(Dyadic(control[static_cast<std::size_t>(to)][c]) -
                                 Dyadic(control[static_cast<std::size_t>(from)][c]));
          }
      column[direction][static_cast<std::size_t>(c)] =
          Dyadic(g) *
          bernstein::tetrahedron::kernel::evaluate_unchecked(g - 1, difference.data(), x);
    }
  const auto& [a, b, c] = column;
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Exact values at places where rounding hides the sign; each place once, at most max_exact of
/// them.
class ExactSigns {
 public:
  ExactSigns(int g, std::span<const Vec3> control) : g_(g), control_(control) {}
  /// The value at lambda when it is not positive.
  std::optional<double> not_positive(const Lambda4& lambda) {
    if (seen_.size() >= max_exact || std::find(seen_.begin(), seen_.end(), lambda) != seen_.end())
      return std::nullopt;
    seen_.push_back(lambda);
    const Dyadic det = exact_determinant(g_, control_, lambda);
    if (det.sign() > 0) return std::nullopt;
    return det.to_double();
  }

 private:
  int g_;
  std::span<const Vec3> control_;
  std::vector<Lambda4> seen_;
};

double least(const std::vector<double>& c) {
  return *std::min_element(c.begin(), c.end());
}

}  // namespace

TetrahedronValidity check_validity(int g, std::span<const Vec3> control) {
  geometry_kernel::check_tetrahedron(g, control);
  const int d = 3 * (g - 1);
  const auto n = static_cast<std::size_t>(bernstein::tetrahedron_size(d));

  // Differences, scaled by 2^-exponent so that products of three neither overflow nor lose to
  // underflow more than u of the largest.
  auto hodograph = geometry_kernel::hodographs(g, control.data());
  int exponent = 0;
  const auto largest_difference = [&] {
    double w = 0;
    for (const auto& h : hodograph)
      for (const Vec3& e : h) w = std::max({w, std::fabs(e[0]), std::fabs(e[1]), std::fabs(e[2])});
    return w;
  };
  double widest = largest_difference();
  if (widest == 0.0) return {Validity::inverted, {0.25, 0.25, 0.25, 0.25}, 0.0};
  if (widest < 0x1p-250 || widest > 0x1p250) {
    if (!std::isfinite(widest)) {
      std::vector<Vec3> half(control.begin(), control.end());
      for (Vec3& p : half) p *= 0.5;
      hodograph = geometry_kernel::hodographs(g, half.data());
      exponent = 1;
    }
    const int shift = std::ilogb(largest_difference());
    exponent += shift;
    for (auto& h : hodograph)
      for (Vec3& e : h)
        for (int c = 0; c < 3; ++c) e[c] = std::scalbn(e[c], -shift);
    widest = largest_difference();
  }

  // Rounding: 2 size + 13 of the determinants, the rest for terms of second order, underflow and
  // the rounding of the bound itself; a bisection adds at most d u max|det|.
  std::vector<double> det(n);
  geometry_kernel::hodograph_determinant(g, std::move(hodograph), det.data());
  const double u = 0x1p-53;
  const double roundings = 2 * bernstein::tetrahedron_size(g - 1) + 20;
  const double base_error = u * roundings * 6.0 * g * g * g * widest * widest * widest;
  double largest = 0;
  for (const double c : det) largest = std::max(largest, std::fabs(c));

  ExactSigns exact(g, control);
  TetrahedronValidity result{
      Validity::valid, g == 1 ? Lambda4{0.25, 0.25, 0.25, 0.25} : whole_tetrahedron[0], det[0]};
  const auto finish = [&](Validity status) {
    result.status = status;
    result.det = std::scalbn(result.det, 3 * exponent);
    return result;
  };
  if (least(det) > base_error) {
    for (std::size_t c = 0; c < 4 && d > 0; ++c) {
      const double value =
          det[static_cast<std::size_t>(bernstein::tetrahedron_corner(d, static_cast<int>(c)))];
      if (value < result.det) result = {Validity::valid, whole_tetrahedron[c], value};
    }
    return finish(Validity::valid);
  }
  if (d == 0) {  // a constant: its sign exactly
    if (det[0] < -base_error) return finish(Validity::inverted);
    const Dyadic value = exact_determinant(g, control, result.where);
    return {value.sign() > 0 ? Validity::valid : Validity::inverted, result.where,
            value.to_double()};
  }

  const Bisection bisection(d);
  constexpr int max_depth = 60;  // bisections
  constexpr int max_pieces = 20000;
  struct Piece {
    std::vector<double> c;
    std::array<Lambda4, 4> corner;
    int depth;
  };
  std::vector<Piece> stack;
  stack.push_back({std::move(det), whole_tetrahedron, 0});
  Validity status = Validity::valid;
  int pieces = 0;
  while (!stack.empty()) {
    Piece piece = std::move(stack.back());
    stack.pop_back();
    const double error = base_error + u * d * piece.depth * largest * (1 + 0x1p-40);
    // The four corner coefficients are values of the determinant.
    for (std::size_t c = 0; c < 4; ++c) {
      const double value =
          piece.c[static_cast<std::size_t>(bernstein::tetrahedron_corner(d, static_cast<int>(c)))];
      if (value < result.det) {
        result.det = value;
        result.where = piece.corner[c];
      }
      if (value < -error) return finish(Validity::inverted);
      if (value <= error)
        if (const auto proven = exact.not_positive(piece.corner[c]))
          return {Validity::inverted, piece.corner[c], *proven};
    }
    if (least(piece.c) > error) continue;
    ++pieces;
    // The corner values so far are not negative beyond rounding.
    if (pieces > max_pieces) return finish(Validity::undecided);
    if (piece.depth >= max_depth) {
      status = Validity::undecided;  // keep looking only in what is stacked
      continue;
    }
    Piece first{std::vector<double>(n), {}, piece.depth + 1},
        second{std::vector<double>(n), {}, piece.depth + 1};
    bisection.split(piece.depth, piece.c.data(), first.c.data(), second.c.data());
    Bisection::split_corners(piece.depth, piece.corner, first.corner, second.corner);
    // Depth first into the child with the smaller coefficient: inverted elements end early.
    if (least(first.c) < least(second.c)) std::swap(first, second);
    stack.push_back(std::move(first));
    stack.push_back(std::move(second));
  }
  return finish(status);
}

}  // namespace bezel
