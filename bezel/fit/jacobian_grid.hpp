#pragma once
// The grid on which maps are looked at, made once for all maps of one degree.

#include <algorithm>
#include <span>
#include <vector>

#include "bezel/fit/gordon_hall.hpp"
#include "bezel/fit/tensor_grid.hpp"

namespace bezel::fit_detail {

/// jacobian_range for many maps of one basis.
class JacobianGrid {
 public:
  explicit JacobianGrid(const LobattoBasis& basis)
      : xi_(lobatto_rule(std::min(3 * basis.degree(), 180)).node), at_(sample(basis, xi_)) {}

  JacobianRange range(std::span<const Vec2> nodes) const {
    const std::vector<Vec2> d_xi = apply(at_, at_.derivative, at_.value, nodes);
    const std::vector<Vec2> d_eta = apply(at_, at_.value, at_.derivative, nodes);
    JacobianRange range;
    std::size_t least = 0;
    for (std::size_t q = 0; q < d_xi.size(); ++q) {
      const double det = cross(d_xi[q], d_eta[q]);
      if (q == 0 || det < range.min) {
        range.min = det;
        least = q;
      }
      if (q == 0 || det > range.max) range.max = det;
    }
    const std::size_t m = at_.points, n = at_.nodes, p = least % m, q = least / m;
    range.xi = xi_[p];
    range.eta = xi_[q];
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i)
        range.point += (at_.value[p * n + i] * at_.value[q * n + j]) * nodes[j * n + i];
    return range;
  }

 private:
  std::vector<double> xi_;
  LobattoSample at_;
};

}  // namespace bezel::fit_detail
