// Integrals of |f|: exact where coefficients tell the sign or f is linear, by quadrature elsewhere.

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/field/element_kernel.hpp"
#include "bezel/field/integrals.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::field_detail {
namespace {

using short_names::at;

constexpr std::size_t pieces = 16;  // of an element where |f| changes sign: two rounds of splitting
/// On the pieces where f changes sign the kink decides, and a higher degree does not help.
constexpr int piece_degree = 5;
/// Elements lie in their frames up to the rounding of barycentric coordinates.
constexpr double outside = -1e-12;

/// The rule on the pieces of the reference triangle.
TriangleRule on_pieces(const TriangleRule& rule) {
  std::vector<std::array<Lambda, 3>> triangles{{Lambda{1, 0, 0}, Lambda{0, 1, 0}, Lambda{0, 0, 1}}};
  while (triangles.size() < pieces) {
    std::vector<std::array<Lambda, 3>> next;
    for (const std::array<Lambda, 3>& t : triangles) {
      std::array<Lambda, 3> middle;  // of the sides 01, 12, 20
      for (std::size_t s = 0; s < 3; ++s)
        for (std::size_t k = 0; k < 3; ++k) middle[s][k] = 0.5 * (t[s][k] + t[(s + 1) % 3][k]);
      next.push_back({t[0], middle[0], middle[2]});
      next.push_back({middle[0], t[1], middle[1]});
      next.push_back({middle[2], middle[1], t[2]});
      next.push_back({middle[0], middle[1], middle[2]});
    }
    triangles = std::move(next);
  }
  TriangleRule all;
  for (const std::array<Lambda, 3>& t : triangles)
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const Lambda& l = rule.lambda[q];
      Lambda point;
      for (std::size_t k = 0; k < 3; ++k)
        point[k] = l[0] * t[0][k] + l[1] * t[1][k] + l[2] * t[2][k];
      all.lambda.push_back(point);
      all.weight.push_back(rule.weight[q] / static_cast<double>(pieces));
    }
  return all;
}

/// The integral of |f| from that of f, for f linear on a straight triangle with values of both
/// signs at its corners. With p the value of a sign of its own, q and r the others: f has p's sign
/// on the share p^2 / ((p - q) (p - r)) of the triangle, where its mean is p / 3.
double linear(double area, double integral, std::array<double, 3> value) {
  const auto positive = std::count_if(value.begin(), value.end(), [](double v) { return v > 0.0; });
  const auto apart = positive == 1 ? std::max_element(value.begin(), value.end())
                                   : std::min_element(value.begin(), value.end());
  std::iter_swap(value.begin(), apart);
  const double p = value[0];
  const double share = p / (p - value[1]) * (p / (p - value[2]));
  return std::abs(integral - 2.0 * (area * share * (p / 3.0)));
}

}  // namespace

AbsIntegral::AbsIntegral(std::shared_ptr<const Space> space, int threads)
    : space_(std::move(space)), pieces_(at(Space::max_degree) + 1) {
  const TriangleMesh& mesh = *space_->mesh();
  for (const int p : degrees_of(*space_)) {
    const int degree = std::min(integrand_degree(*space_, p) + 4, piece_degree);
    pieces_[at(p)] = MapRule(mesh.degree(), on_pieces(rule_of_degree(degree)));
  }
  plain_ = mesh.degree() == 1 ? Shape::straight : Shape::inside_frame;
  if (space_->basis() != Basis::physical) return;
  shape_.resize(mesh.element_count());
  for_chunks(mesh.element_count(), threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t e = from; e < to; ++e) {
      const ElementId id(e);
      const Frame& frame = space_->frame(id);
      if (space_->is_own_frame(id)) {
        shape_[e] = Shape::straight;
        continue;
      }
      double least = 1.0;
      for (const NodeId n : mesh.nodes(id)) {
        const Lambda l = frame.lambda(mesh.control(n));
        least = std::min({least, l[0], l[1], l[2]});
      }
      shape_[e] = least >= outside ? Shape::inside_frame : Shape::beyond_frame;
    }
  });
}

double AbsIntegral::of_both_signs(std::size_t e, const double* c, std::size_t stride,
                                  double integral, std::span<double> scratch) const {
  const TriangleMesh& mesh = *space_->mesh();
  const ElementId id(e);
  const int d = space_->degree(id);
  const MapRule& rule = pieces_[at(d)];
  const std::size_t points = rule.map.size(), size = at(bernstein::triangle_size(d));
  const auto x = scratch.subspan(0, points), y = scratch.subspan(points, points),
             w = scratch.subspan(2 * points, points), f = scratch.subspan(3 * points, points);
  std::span<const double> u = rule.u, v = rule.v;
  if (shape(e) == Shape::straight) {
    const std::array<Vec2, 3> corner = corners(mesh, id);
    const double det = triangle_cross(corner[0], corner[1], corner[2]);
    if (d == 1) return linear(0.5 * det, integral, {c[0], c[stride], c[2 * stride]});
    std::fill(w.begin(), w.end(), det);
  } else {
    const ElementMap element(mesh, id);
    const RoundControl round(element.control());
    rule.map(round.points(), x, y, w);
    const std::vector<double> jacobian =
        jacobian_if_bent(element.degree(), element.control(), round.points());
    if (!jacobian.empty())
      bernstein::evaluate(2 * (element.degree() - 1), jacobian, rule.u, rule.v, w);
    if (space_->basis() == Basis::physical) {
      to_frame(moved(round.map(), space_->frame(id)), x, y);
      u = x;
      v = y;
    }
  }
  std::array<double, static_cast<std::size_t>(largest_size)> own;
  for (std::size_t i = 0; i < size; ++i) own[i] = c[i * stride];
  bernstein::evaluate(d, std::span<const double>(own.data(), size), u, v, f);
  const auto [lo, hi] = std::minmax_element(f.begin(), f.end());
  if (*lo >= 0.0 || *hi <= 0.0) return std::abs(integral);
  double total = 0.0;
  for (std::size_t q = 0; q < points; ++q) total += rule.weight[q] * w[q] * std::abs(f[q]);
  return total;
}

std::size_t AbsIntegral::room() const {
  std::size_t most = 0;
  for (const MapRule& p : pieces_) most = std::max(most, 4 * p.map.size());
  return most;
}

}  // namespace bezel::field_detail
