#include "bezel/geometry/quadrilateral.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/geometry/curve_shape.hpp"
#include "bezel/numeric/binomial_kernel.hpp"

namespace bezel {
namespace {

using bezel::kernel::Binomial;

void check_quad(int g, std::span<const Vec2> control) {
  if (g < 1 || g > max_quad_degree)
    throw InputError("found degree " + std::to_string(g) + " of a quadrilateral, expected 1 to " +
                     std::to_string(max_quad_degree));
  bernstein::checks::size(control.size(), static_cast<std::size_t>(quad_size(g)),
                          "control points of a quadrilateral");
  bernstein::checks::finite(control, "control point");
}

/// A polynomial of degree m in s and n in t: coefficient (i, j) at j (m+1) + i.
template <class Value>
struct Tensor {
  int m, n;
  std::vector<Value> c;
  Tensor(int degree_s, int degree_t)
      : m(degree_s), n(degree_t), c(static_cast<std::size_t>((degree_s + 1) * (degree_t + 1))) {}
  Value& operator()(int i, int j) { return c[static_cast<std::size_t>(j * (m + 1) + i)]; }
  const Value& operator()(int i, int j) const {
    return c[static_cast<std::size_t>(j * (m + 1) + i)];
  }
};

/// The derivative along s (or t), each coefficient times the binomials of its place: products of
/// such polynomials are plain convolutions.
Tensor<Vec2> scaled_derivative(int g, std::span<const Vec2> b, bool along_s) {
  Tensor<Vec2> out(along_s ? g - 1 : g, along_s ? g : g - 1);
  for (int j = 0; j <= out.n; ++j)
    for (int i = 0; i <= out.m; ++i) {
      const auto from = static_cast<std::size_t>(quad_index(g, i, j));
      const auto to = from + static_cast<std::size_t>(along_s ? 1 : g + 1);
      out(i, j) = (g * Binomial<double>::get(out.m, i) * Binomial<double>::get(out.n, j)) *
                  (b[to] - b[from]);
    }
  return out;
}

/// Halves along s (or, with the strides exchanged, t): rows of n+1 values, `step` apart.
void halve(int n, const double* c, double* low, double* high, std::size_t step, std::size_t row) {
  std::array<double, bernstein::max_interval_degree + 1> w;
  const auto size = static_cast<std::size_t>(n) + 1;
  for (std::size_t r = 0; r < size; ++r) {
    for (std::size_t i = 0; i < size; ++i) w[i] = c[r * row + i * step];
    for (std::size_t k = 0; k < size; ++k) {
      low[r * row + k * step] = w[0];
      high[r * row + (size - 1 - k) * step] = w[size - 1 - k];
      for (std::size_t i = 0; i + k + 1 < size; ++i) w[i] = 0.5 * (w[i] + w[i + 1]);
    }
  }
}

/// A part of the square with the determinant's coefficients there.
struct Piece {
  std::vector<double> c;
  Vec2 lo, size;
  int depth = 0;
};

}  // namespace

QuadValue evaluate_quad(int g, std::span<const Vec2> control, double s, double t) {
  check_quad(g, control);
  bernstein::checks::finite(s, "parameter s");
  bernstein::checks::finite(t, "parameter t");
  std::array<Vec2, max_quad_degree + 1> value, slope;
  for (int j = 0; j <= g; ++j) {
    const auto row = bernstein::kernel::evaluate_derivative_unchecked(
        g, control.data() + quad_index(g, 0, j), s);
    value[static_cast<std::size_t>(j)] = row.value;
    slope[static_cast<std::size_t>(j)] = row.derivative;
  }
  const auto column = bernstein::kernel::evaluate_derivative_unchecked(g, value.data(), t);
  return {column.value, bernstein::kernel::evaluate_unchecked(g, slope.data(), t),
          column.derivative};
}

std::vector<double> quad_jacobian_determinant(int g, std::span<const Vec2> control) {
  check_quad(g, control);
  const Tensor<Vec2> ds = scaled_derivative(g, control, true);
  const Tensor<Vec2> dt = scaled_derivative(g, control, false);
  const int d = 2 * g - 1;
  Tensor<double> det(d, d);
  for (int jb = 0; jb <= dt.n; ++jb)
    for (int ib = 0; ib <= dt.m; ++ib) {
      const Vec2 b = dt(ib, jb);
      for (int ja = 0; ja <= ds.n; ++ja)
        for (int ia = 0; ia <= ds.m; ++ia) det(ia + ib, ja + jb) += cross(ds(ia, ja), b);
    }
  for (int j = 0; j <= d; ++j)
    for (int i = 0; i <= d; ++i)
      det(i, j) /= Binomial<double>::get(d, i) * Binomial<double>::get(d, j);
  return std::move(det.c);
}

QuadValidity check_quad_validity(int g, std::span<const Vec2> control) {
  std::vector<double> det = quad_jacobian_determinant(g, control);
  const int d = 2 * g - 1;
  const auto n = static_cast<std::size_t>(d) + 1;
  // Rounding of a coefficient: a mean with positive weights of at most g (g+1) products of
  // differences, each difference within u of itself (relative), scaled and multiplied with 8
  // roundings more, summed with one for each. A halving takes means: d roundings per level.
  double widest = 0, largest = 0;
  for (int j = 0; j <= g; ++j)
    for (int i = 0; i <= g; ++i) {
      const Vec2& p = control[static_cast<std::size_t>(quad_index(g, i, j))];
      const auto include = [&](int other) {
        const Vec2 e = control[static_cast<std::size_t>(other)] - p;
        widest = std::max({widest, std::fabs(e.x()), std::fabs(e.y())});
      };
      if (i < g) include(quad_index(g, i + 1, j));
      if (j < g) include(quad_index(g, i, j + 1));
    }
  for (const double c : det) largest = std::max(largest, std::fabs(c));
  constexpr double u = 0x1p-53;
  const double base_error = 2 * u * g * g * (g * (g + 1.0) + 10) * widest * widest;
  constexpr int max_depth = 80;
  const auto max_pieces =
      static_cast<int>(std::clamp(5e8 / std::pow(static_cast<double>(n), 3), 500.0, 20000.0));

  QuadValidity result{Validity::valid, Vec2{0.0, 0.0}, det[0]};
  std::vector<Piece> stack;
  stack.push_back({std::move(det), Vec2{0.0, 0.0}, Vec2{1.0, 1.0}, 0});
  const auto least = [](const std::vector<double>& c) {
    return *std::min_element(c.begin(), c.end());
  };
  for (int pieces = 0; !stack.empty();) {
    const Piece piece = std::move(stack.back());
    stack.pop_back();
    const double error = base_error + u * d * piece.depth * largest;
    for (const std::size_t corner : {std::size_t{0}, n - 1, n * (n - 1), n * n - 1})
      if (piece.c[corner] < result.det) {
        result.det = piece.c[corner];
        result.where = piece.lo + Vec2{corner % n == 0 ? 0.0 : piece.size.x(),
                                       corner < n ? 0.0 : piece.size.y()};
      }
    if (result.det < -error) {
      result.status = Validity::inverted;
      return result;
    }
    if (least(piece.c) > error) continue;
    if (piece.depth >= max_depth || ++pieces > max_pieces) {
      result.status = Validity::undecided;
      if (pieces > max_pieces) return result;
      continue;
    }
    Piece low{std::vector<double>(n * n), piece.lo, piece.size, piece.depth + 1};
    Piece high = low;
    const bool along_s = piece.depth % 2 == 0;
    halve(d, piece.c.data(), low.c.data(), high.c.data(), along_s ? 1 : n, along_s ? n : 1);
    const int axis = along_s ? 0 : 1;
    low.size[axis] *= 0.5;
    high.size[axis] *= 0.5;
    high.lo[axis] += high.size[axis];
    // Depth first into the half with the smaller coefficient: inverted ones end early.
    if (least(low.c) < least(high.c)) std::swap(low, high);
    stack.push_back(std::move(low));
    stack.push_back(std::move(high));
  }
  return result;
}

std::vector<Vec2> quad_side(int g, std::span<const Vec2> control, int side) {
  check_quad(g, control);
  if (side < 0 || side > 3)
    throw InputError("side " + std::to_string(side) + " of a quadrilateral, expected 0 to 3");
  std::vector<Vec2> out;
  for (int m = 0; m <= g; ++m)
    out.push_back(control[static_cast<std::size_t>(quad_side_index(g, side, m))]);
  return out;
}

double quad_area(int g, std::span<const Vec2> control) {
  std::vector<Curve> chain;
  for (int side = 0; side < 4; ++side) chain.emplace_back(quad_side(g, control, side));
  return area_and_centroid(chain).area;
}

}  // namespace bezel
