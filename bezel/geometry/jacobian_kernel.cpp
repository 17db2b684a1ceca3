#include "bezel/geometry/jacobian_kernel.hpp"

#include <algorithm>
#include <memory>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/binomial.hpp"

namespace bezel::geometry_kernel {
namespace {

double multinomial(int n, int j, int k) {
  return binomial(n, k) * binomial(n - k, j);
}

}  // namespace

JacobianTable::JacobianTable(int g) {
  using bernstein::triangle_index;
  const int e = g - 1, d = 2 * e;
  for (int k = 0; k <= e; ++k)
    for (int j = 0; j + k <= e; ++j)
      steps.push_back({triangle_index(g, j, k), triangle_index(g, j + 1, k),
                       triangle_index(g, j, k + 1), multinomial(e, j, k)});
  for (int k = 0; k <= e; ++k)
    for (int j = 0; j + k <= e; ++j)
      for (int q = 0; q <= e; ++q)
        for (int p = 0; p + q <= e; ++p) place.push_back(triangle_index(d, j + p, k + q));
  for (int k = 0; k <= d; ++k)
    for (int j = 0; j + k <= d; ++j)
      scale.push_back(static_cast<double>(g) * g / multinomial(d, j, k));
}

const JacobianTable& JacobianTable::of(int g) {
  static const auto tables = [] {
    std::vector<std::unique_ptr<const JacobianTable>> all;
    for (int d = 1; d <= max_kept; ++d) all.push_back(std::make_unique<const JacobianTable>(d));
    return all;
  }();
  return *tables[static_cast<std::size_t>(g - 1)];
}

void JacobianTable::operator()(const Vec2* control, double* room, double* det) const {
  const std::size_t size = steps.size();
  double *const ux = room, *const uy = ux + size, *const vx = uy + size, *const vy = vx + size;
  for (std::size_t n = 0; n < size; ++n) {
    const Step& step = steps[n];
    const Vec2 base = control[step.base];
    const Vec2 du = step.weight * (control[step.along_u] - base),
               dv = step.weight * (control[step.along_v] - base);
    ux[n] = du.x();
    uy[n] = du.y();
    vx[n] = dv.x();
    vy[n] = dv.y();
  }
  std::fill_n(det, scale.size(), 0.0);
  const std::int32_t* to = place.data();
  for (std::size_t m = 0; m < size; ++m)
    for (std::size_t n = 0; n < size; ++n) det[*to++] += ux[m] * vy[n] - uy[m] * vx[n];
  for (std::size_t n = 0; n < scale.size(); ++n) det[n] *= scale[n];
}

}  // namespace bezel::geometry_kernel
