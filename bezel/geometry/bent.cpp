#include "bezel/geometry/bent.hpp"

#include <cstddef>

#include "bezel/bernstein/index.hpp"
#include "bezel/geometry/jacobian_kernel.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/eft.hpp"

namespace bezel {
namespace {

/// Diameter over width from which the roundings of a plane are too many.
constexpr double most_bent = 256.0;

DoubleDouble exact_difference(double a, double b) {
  const WithError d = two_sum(a, -b);
  return {d.value, d.error};
}

}  // namespace

ExactVec2 exact_step(const Vec2& a, const Vec2& b) {
  return {{exact_difference(b.x(), a.x()), exact_difference(b.y(), a.y())}};
}

bool is_bent(std::span<const Vec2> round, double area) {
  Box2 box;
  for (const Vec2& p : round) box.include(p);
  const Vec2 size = box.hi - box.lo;
  return dot(size, size) > most_bent * 2.0 * area;
}

// The integral of B_i of degree d times B_j of degree d - 1 is C(d,i) C(d-1,j) / (2d C(2d-1,i+j)).
DoubleDouble twice_swept_area(std::span<const ExactVec2> control) {
  const int d = static_cast<int>(control.size()) - 1;
  if (d == 1) return cross(control[0], control[1]);
  DoubleDouble twice;
  for (int k = 0; k < 2 * d; ++k) {
    DoubleDouble sum;  // of the products with i + j = k
    for (int i = 0; i <= d; ++i) {
      const int j = k - i;
      if (j < 0 || j >= d) continue;
      const auto at = static_cast<std::size_t>(j);
      sum += DoubleDouble(binomial(d, i) * binomial(d - 1, j)) *
             cross(control[static_cast<std::size_t>(i)], control[at + 1] - control[at]);
    }
    twice += sum / DoubleDouble(2.0 * binomial(2 * d - 1, k));
  }
  return twice;
}

double bent_area(int g, std::span<const Vec2> control) {
  std::vector<ExactVec2> side(static_cast<std::size_t>(g) + 1);
  DoubleDouble twice;
  for (int k = 0; k < 3; ++k) {
    for (int m = 0; m <= g; ++m) {
      const auto at = static_cast<std::size_t>(bernstein::triangle_side_index(g, k, m));
      side[static_cast<std::size_t>(m)] = exact_step(control[0], control[at]);
    }
    twice += twice_swept_area(side);
  }
  return 0.5 * static_cast<double>(twice);
}

std::vector<double> bent_jacobian(int g, std::span<const Vec2> control) {
  using geometry_kernel::JacobianTable;
  const auto by_table = [&](const JacobianTable& table) {
    std::vector<ExactVec2> du, dv;
    for (const JacobianTable::Step& step : table.steps) {
      const Vec2& base = control[static_cast<std::size_t>(step.base)];
      const DoubleDouble weight(step.weight);
      du.push_back(weight * exact_step(base, control[static_cast<std::size_t>(step.along_u)]));
      dv.push_back(weight * exact_step(base, control[static_cast<std::size_t>(step.along_v)]));
    }
    std::vector<DoubleDouble> det(table.scale.size());
    const std::int32_t* to = table.place.data();
    for (const ExactVec2& u : du)
      for (const ExactVec2& v : dv) det[static_cast<std::size_t>(*to++)] += cross(u, v);
    std::vector<double> out;
    for (std::size_t n = 0; n < det.size(); ++n)
      out.push_back(static_cast<double>(det[n]) * table.scale[n]);
    return out;
  };
  return g <= JacobianTable::max_kept ? by_table(JacobianTable::of(g)) : by_table(JacobianTable(g));
}

std::vector<double> jacobian_if_bent(int g, std::span<const Vec2> control,
                                     std::span<const Vec2> round) {
  if (g == 1 || !is_bent(round, area(g, round))) return {};
  return bent_jacobian(g, control);
}

}  // namespace bezel
