#include "bezel/fit/rational_pieces.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bezel/base/error.hpp"

namespace bezel::fit {

template <int dim>
RationalPieces<dim>::RationalPieces(int degree, bool rational, std::vector<double> breaks,
                                    std::vector<Vec<dim + 1>> control)
    : data_(std::make_shared<const Data>(
          Data{degree, rational, std::move(breaks), std::move(control)})) {
  assume(degree >= 1 && degree <= max_degree && data_->breaks.size() >= 2, "bad pieces");
  assume(data_->control.size() == (data_->breaks.size() - 1) * static_cast<std::size_t>(degree + 1),
         "bad pieces");
}

template <int dim>
CurveJet<dim> RationalPieces<dim>::operator()(double u) const {
  const std::vector<double>& breaks = data_->breaks;
  const auto inside = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, u);
  return jet(static_cast<std::size_t>(inside - breaks.begin()) - 1, u);
}

template <int dim>
CurveJet<dim> RationalPieces<dim>::jet(std::size_t k, double u) const {
  return data_->degree <= 5 ? jet<6>(k, u) : jet<max_degree + 1>(k, u);
}

// De Casteljau's last three rows hold the point, the slope and the second derivative.
template <int dim>
template <int capacity>
CurveJet<dim> RationalPieces<dim>::jet(std::size_t k, double u) const {
  using Point = Vec<dim + 1>;
  const int d = data_->degree;
  const double lo = data_->breaks[k], hi = data_->breaks[k + 1], h = hi - lo;
  const double s = (u - lo) / h, r = (hi - u) / h;
  std::array<Point, static_cast<std::size_t>(capacity)> b;
  const Point* first = data_->control.data() + k * static_cast<std::size_t>(d + 1);
  std::copy(first, first + d + 1, b.begin());
  for (int n = d; n > 2; --n)
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) b[i] = r * b[i] + s * b[i + 1];
  Point second{};
  if (d >= 2) {
    second = (d * (d - 1) / (h * h)) * ((b[2] - b[1]) - (b[1] - b[0]));
    b[0] = r * b[0] + s * b[1];
    b[1] = r * b[1] + s * b[2];
  }
  const Point slope = (d / h) * (b[1] - b[0]), point = r * b[0] + s * b[1];
  CurveJet<dim> out;
  const double w = point[dim];
  for (int i = 0; i < dim; ++i) {
    out.x[i] = point[i];
    out.d1[i] = slope[i];
    out.d2[i] = second[i];
    if (!data_->rational) continue;
    out.x[i] /= w;
    out.d1[i] = (slope[i] - slope[dim] * out.x[i]) / w;
    out.d2[i] = (second[i] - 2.0 * slope[dim] * out.d1[i] - second[dim] * out.x[i]) / w;
  }
  return out;
}

template class RationalPieces<2>;
template class RationalPieces<3>;

}  // namespace bezel::fit
