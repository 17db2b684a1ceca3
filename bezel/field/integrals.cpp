#include "bezel/field/integrals.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/field/element_kernel.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel::field_detail {
namespace {

constexpr std::size_t lanes = 8;    // points worked on together: the compiler makes vectors of them
constexpr std::size_t pieces = 16;  // of an element where |f| changes sign: two rounds of splitting
/// On the pieces where f changes sign the kink decides, and a higher degree does not help.
constexpr int piece_degree = 5;
/// Elements lie in their frames up to the rounding of barycentric coordinates.
constexpr double outside = -1e-12;

constexpr double own_frame = 0x1p-50;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

std::size_t padded(std::size_t points) {
  return (points + lanes - 1) / lanes * lanes;
}

/// out[n] = sum over the points of weight B_n(u, v), the number of points a multiple of lanes.
void sum_basis(int d, std::span<const double> u, std::span<const double> v,
               std::span<const double> weight, std::span<const double> multinomial, double* out) {
  constexpr std::size_t room = static_cast<std::size_t>(Space::max_degree) + 1;
  double sums[static_cast<std::size_t>(largest_size)][lanes] = {};
  double p0[room][lanes], p1[room][lanes], p2[lanes], first[lanes];
  for (std::size_t start = 0; start < u.size(); start += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) {
      first[l] = 1.0 - u[start + l] - v[start + l];
      p0[0][l] = p1[0][l] = 1.0;
      p2[l] = weight[start + l];
    }
    for (std::size_t i = 1; i <= at(d); ++i) {
      for (std::size_t l = 0; l < lanes; ++l) {
        p0[i][l] = p0[i - 1][l] * first[l];
        p1[i][l] = p1[i - 1][l] * u[start + l];
      }
    }
    std::size_t n = 0;
    for (int k = 0; k <= d; ++k) {
      for (int j = 0; j <= d - k; ++j, ++n)
        for (std::size_t l = 0; l < lanes; ++l)
          sums[n][l] += p0[at(d - k - j)][l] * p1[at(j)][l] * p2[l];
      for (std::size_t l = 0; l < lanes; ++l) p2[l] *= v[start + l];
    }
  }
  for (std::size_t n = 0; n < multinomial.size(); ++n) {
    const double* s = sums[n];
    out[n] = multinomial[n] * (((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7])));
  }
}

std::vector<double> multinomials(int d) {
  std::vector<double> all;
  for (int k = 0; k <= d; ++k)
    for (int j = 0; j <= d - k; ++j) all.push_back(binomial(d, k) * binomial(d - k, j));
  return all;
}

/// Barycentrics 1 and 2 of points of the plane, in place.
void to_frame(const Frame& frame, std::span<double> x, std::span<double> y) {
  for (std::size_t q = 0; q < x.size(); ++q) {
    const double rx = x[q] - frame.centre.x(), ry = y[q] - frame.centre.y();
    x[q] = 1.0 / 3.0 + (frame.gradient[1].x() * rx + frame.gradient[1].y() * ry);
    y[q] = 1.0 / 3.0 + (frame.gradient[2].x() * rx + frame.gradient[2].y() * ry);
  }
}

/// The straight triangle's own barycentrics, to the last bits.
bool is_own_frame(const Frame& frame, std::span<const Vec2> corner) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Lambda l = frame.lambda(corner[k]);
    for (std::size_t i = 0; i < 3; ++i)
      if (!(std::abs(l[i] - (i == k ? 1.0 : 0.0)) <= own_frame)) return false;
  }
  return true;
}

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

/// Elements work in chunks; small enough that every thread gets some.
void for_chunks(std::size_t n, int threads,
                const std::function<void(std::size_t, std::size_t)>& body) {
  constexpr std::size_t chunk = 512;
  parallel_for((n + chunk - 1) / chunk,
               [&](std::size_t c) { body(c * chunk, std::min(n, (c + 1) * chunk)); }, threads);
}

/// Which degrees occur.
std::vector<int> degrees_of(const Space& space) {
  if (space.uniform_degree() >= 0) return {space.uniform_degree()};
  std::array<bool, static_cast<std::size_t>(Space::max_degree) + 1> used{};
  for (std::size_t e = 0; e < space.mesh()->element_count(); ++e)
    used[at(space.degree(ElementId(e)))] = true;
  std::vector<int> degrees;
  for (int p = 0; p <= Space::max_degree; ++p)
    if (used[at(p)]) degrees.push_back(p);
  return degrees;
}

}  // namespace

MapTable::MapTable(int degree, std::span<const Lambda> points) : points_(points.size()) {
  const auto nodes = at(bernstein::triangle_size(degree));
  value_.resize(nodes * points_);
  du_.resize(nodes * points_);
  dv_.resize(nodes * points_);
  std::vector<double> basis(nodes), lower(nodes);
  const auto lower_size = at(bernstein::triangle_size(degree - 1));
  for (std::size_t q = 0; q < points_; ++q) {
    bernstein::basis(degree, points[q], basis);
    for (std::size_t n = 0; n < nodes; ++n) value_[n * points_ + q] = basis[n];
    bernstein::basis(degree - 1, points[q], std::span(lower).first(lower_size));
    std::size_t i = 0;
    for (int k = 0; k < degree; ++k) {
      for (int j = 0; j + k < degree; ++j, ++i) {
        const std::size_t here = at(bernstein::triangle_index(degree, j, k)) * points_ + q;
        const std::size_t above = at(bernstein::triangle_index(degree, j, k + 1)) * points_ + q;
        const double b = degree * lower[i];
        du_[here] -= b;
        dv_[here] -= b;
        du_[here + points_] += b;
        dv_[above] += b;
      }
    }
  }
}

void MapTable::operator()(std::span<const Vec2> control, std::span<double> x, std::span<double> y,
                          std::span<double> det) const {
  // Derivatives from control points relative to the first one, which takes away the place in the
  // plane.
  constexpr std::size_t block = 2 * lanes;
  const Vec2 origin = control[0];
  double xu[block], yu[block], xv[block], yv[block], px[block], py[block];
  for (std::size_t start = 0; start < points_; start += block) {
    const std::size_t m = std::min(block, points_ - start);
    for (std::size_t l = 0; l < block; ++l) xu[l] = yu[l] = xv[l] = yv[l] = px[l] = py[l] = 0.0;
    for (std::size_t n = 1; n < control.size(); ++n) {
      const double cx = control[n].x() - origin.x(), cy = control[n].y() - origin.y();
      const double* b = value_.data() + n * points_ + start;
      const double* bu = du_.data() + n * points_ + start;
      const double* bv = dv_.data() + n * points_ + start;
      for (std::size_t l = 0; l < m; ++l) {
        px[l] += b[l] * cx;
        py[l] += b[l] * cy;
        xu[l] += bu[l] * cx;
        yu[l] += bu[l] * cy;
        xv[l] += bv[l] * cx;
        yv[l] += bv[l] * cy;
      }
    }
    for (std::size_t l = 0; l < m; ++l) {
      x[start + l] = origin.x() + px[l];
      y[start + l] = origin.y() + py[l];
      det[start + l] = xu[l] * yv[l] - yu[l] * xv[l];
    }
  }
}

MapRule::MapRule(int map_degree, const TriangleRule& rule)
    : u(padded(rule.weight.size()), 1.0 / 3.0), v(u), weight(u.size(), 0.0) {
  std::vector<Lambda> lambda(u.size(), Lambda{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
  for (std::size_t q = 0; q < rule.weight.size(); ++q) {
    lambda[q] = rule.lambda[q];
    u[q] = lambda[q][1];
    v[q] = lambda[q][2];
    weight[q] = rule.weight[q];
  }
  map = MapTable(map_degree, lambda);
}

std::vector<double> basis_integrals(const Space& space, int threads) {
  const TriangleMesh& mesh = *space.mesh();
  const bool physical = space.basis() == Basis::physical;
  const bool straight = mesh.degree() == 1;
  std::vector<double> out(space.coefficient_count());
  std::vector<MapRule> rules(at(Space::max_degree) + 1);
  std::vector<std::vector<double>> factors(rules.size());
  for (const int p : degrees_of(space)) {
    rules[at(p)] = MapRule(mesh.degree(), rule_of_degree(integrand_degree(space, p)));
    factors[at(p)] = multinomials(p);
  }
  for_chunks(mesh.element_count(), threads, [&](std::size_t from, std::size_t to) {
    std::vector<double> x, y, w;
    for (std::size_t e = from; e < to; ++e) {
      const ElementId id(e);
      const int p = space.degree(id);
      if (straight) {
        // All functions of a triangle's own barycentrics have one integral.
        const ElementMap map(mesh, id);
        const std::span<const Vec2> c = map.control();
        if (!physical || is_own_frame(space.frame(id), c)) {
          const auto n = at(bernstein::triangle_size(p));
          const double each = 0.5 * cross(c[1] - c[0], c[2] - c[0]) / static_cast<double>(n);
          std::fill_n(out.data() + space.offset(id), n, each);
          continue;
        }
      }
      const MapRule& rule = rules[at(p)];
      const std::size_t points = rule.map.size();
      x.resize(points);
      y.resize(points);
      w.resize(points);
      rule.map(ElementMap(mesh, id).control(), x, y, w);
      for (std::size_t q = 0; q < points; ++q) w[q] *= rule.weight[q];
      if (physical) to_frame(space.frame(id), x, y);
      sum_basis(p, physical ? std::span<const double>(x) : rule.u,
                physical ? std::span<const double>(y) : rule.v, w, factors[at(p)],
                out.data() + space.offset(id));
    }
  });
  return out;
}

std::vector<double> element_integrals(const Field& field, std::span<const double> basis_integrals,
                                      int threads) {
  const std::size_t n = at(field.components());
  std::vector<double> out(field.mesh().element_count() * n, 0.0);
  const std::span<const double> all = field.coefficients();
  for_chunks(field.mesh().element_count(), threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t e = from; e < to; ++e) {
      const std::size_t begin = field.space().offset(ElementId(e));
      const auto size = at(bernstein::triangle_size(field.space().degree(ElementId(e))));
      for (std::size_t i = begin; i < begin + size; ++i)
        for (std::size_t k = 0; k < n; ++k) out[e * n + k] += basis_integrals[i] * all[i * n + k];
    }
  });
  return out;
}

std::vector<double> integral(const Field& field, std::span<const double> element_integrals) {
  const std::size_t n = at(field.components());
  std::vector<double> total(n), column(element_integrals.size() / n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t e = 0; e < column.size(); ++e) column[e] = element_integrals[e * n + k];
    total[k] = sum(column);
  }
  return total;
}

AbsIntegral::AbsIntegral(std::shared_ptr<const Space> space)
    : space_(std::move(space)), pieces_(at(Space::max_degree) + 1) {
  const TriangleMesh& mesh = *space_->mesh();
  for (const int p : degrees_of(*space_)) {
    const int degree = std::min(integrand_degree(*space_, p) + 4, piece_degree);
    pieces_[at(p)] = MapRule(mesh.degree(), on_pieces(rule_of_degree(degree)));
  }
  if (space_->basis() != Basis::physical) return;
  fits_.resize(mesh.element_count());
  for_chunks(mesh.element_count(), 0, [&](std::size_t from, std::size_t to) {
    for (std::size_t e = from; e < to; ++e) {
      const Frame& frame = space_->frame(ElementId(e));
      double least = 1.0;
      for (const NodeId n : mesh.nodes(ElementId(e))) {
        const Lambda l = frame.lambda(mesh.control(n));
        least = std::min({least, l[0], l[1], l[2]});
      }
      fits_[e] = least >= outside ? 1 : 0;
    }
  });
}

double AbsIntegral::on_element(const Field& field, ElementId e, std::size_t component,
                               double integral, std::span<double> scratch) const {
  const int d = space_->degree(e);
  const MapRule& rule = pieces_[at(d)];
  const std::size_t points = rule.map.size(), n = at(field.components());
  const auto x = scratch.subspan(0, points), y = scratch.subspan(points, points),
             w = scratch.subspan(2 * points, points), f = scratch.subspan(3 * points, points);
  rule.map(ElementMap(field.mesh(), e).control(), x, y, w);
  const bool physical = space_->basis() == Basis::physical;
  if (physical) to_frame(space_->frame(e), x, y);
  std::array<double, static_cast<std::size_t>(largest_size)> c;
  const std::span<const double> all = field.coefficients(e);
  const std::size_t size = all.size() / n;
  for (std::size_t i = 0; i < size; ++i) c[i] = all[i * n + component];
  bernstein::evaluate(d, std::span<const double>(c.data(), size),
                      physical ? std::span<const double>(x) : rule.u,
                      physical ? std::span<const double>(y) : rule.v, f);
  const auto [lo, hi] = std::minmax_element(f.begin(), f.end());
  if (*lo >= 0.0 || *hi <= 0.0) return integral;
  double total = 0.0;
  for (std::size_t q = 0; q < points; ++q) total += rule.weight[q] * w[q] * std::abs(f[q]);
  return total;
}

std::vector<double> AbsIntegral::operator()(const Field& field,
                                            std::span<const double> element_integrals,
                                            int threads) const {
  const std::size_t n = at(field.components());
  std::vector<double> out(element_integrals.begin(), element_integrals.end());
  std::size_t room = 0;
  for (const MapRule& p : pieces_) room = std::max(room, 4 * p.map.size());
  for_chunks(field.mesh().element_count(), threads, [&](std::size_t from, std::size_t to) {
    std::vector<double> scratch(room);
    for (std::size_t e = from; e < to; ++e) {
      const std::span<const double> c = field.coefficients(ElementId(e));
      for (std::size_t k = 0; k < n; ++k) {
        double& result = out[e * n + k];
        result = std::abs(result);
        double least = c[k], most = c[k];
        for (std::size_t i = k; i < c.size(); i += n) {
          least = std::min(least, c[i]);
          most = std::max(most, c[i]);
        }
        // Coefficients of one sign say that of f inside the reference triangle or the frame. An
        // element that reaches out of a frame given by the caller is left to its values.
        if ((least >= 0.0 || most <= 0.0) && (fits_.empty() || fits_[e] != 0)) continue;
        result = on_element(field, ElementId(e), k, result, scratch);
      }
    }
  });
  return integral(field, out);
}

}  // namespace bezel::field_detail
