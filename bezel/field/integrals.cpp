#include "bezel/field/integrals.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/bernstein/fixed_size.hpp"
#include "bezel/bernstein/multinomial.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/numeric/eft.hpp"
#include "bezel/numeric/lanes.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel::field_detail {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
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
    out[n] = multinomial[n] * sum_of_lanes(sums[n]);
  }
}

/// out[e * stride + k] = sum over an element's coefficients of basis[i] c[i, k], for elements of
/// `fixed` coefficients (0: of `size`).
template <std::size_t fixed>
void add_products(std::size_t size, const double* basis, const double* c, std::size_t components,
                  std::size_t elements, std::size_t stride, double* out) {
  const std::size_t n = fixed > 0 ? fixed : size;
  for (std::size_t e = 0; e < elements; ++e) {
    for (std::size_t k = 0; k < components; ++k) {
      double total = 0.0;
      for (std::size_t i = 0; i < n; ++i) total += basis[i] * c[i * components + k];
      out[k] = total;
    }
    basis += n;
    c += n * components;
    out += stride;
  }
}

/// The same with the numbers that occur most known to the compiler.
void integrate_elements(std::size_t size, const double* basis, const double* c,
                        std::size_t components, std::size_t elements, std::size_t stride,
                        double* out) {
  if (components > 1) return add_products<0>(size, basis, c, components, elements, stride, out);
  bernstein::with_triangle_size(
      size, [&](auto fixed) { add_products<fixed()>(size, basis, c, 1, elements, stride, out); });
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
    : u(padded_to_lanes(rule.weight.size()), 1.0 / 3.0), v(u), weight(u.size(), 0.0) {
  std::vector<Lambda> lambda(u.size(), Lambda{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
  for (std::size_t q = 0; q < rule.weight.size(); ++q) {
    lambda[q] = rule.lambda[q];
    u[q] = lambda[q][1];
    v[q] = lambda[q][2];
    weight[q] = rule.weight[q];
  }
  map = MapTable(map_degree, lambda);
}

bool is_own_frame(const Frame& frame, const std::array<Vec2, 3>& corner) {
  double slope = 0.0;
  for (const Vec2& g : frame.gradient) slope = std::max({slope, std::abs(g.x()), std::abs(g.y())});
  const double reach = std::max(std::abs(frame.centre.x()), std::abs(frame.centre.y()));
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Lambda l = frame.lambda(corner[k]);
    for (std::size_t i = 0; i < 3; ++i)
      largest = std::max(largest, std::abs(l[i] - (i == k ? 1.0 : 0.0)));
  }
  return largest <= 0x1p-51 * (2.0 + reach * slope);
}

std::size_t component_count(std::span<const Field* const> fields) {
  std::size_t count = 0;
  for (const Field* f : fields) count += at(f->components());
  return count;
}

std::vector<double> basis_integrals(const Space& space, int threads) {
  const TriangleMesh& mesh = *space.mesh();
  const bool physical = space.basis() == Basis::physical;
  const bool straight = mesh.degree() == 1;
  std::vector<double> out(space.coefficient_count());
  std::vector<MapRule> rules(at(Space::max_degree) + 1);
  for (const int p : degrees_of(space))
    rules[at(p)] = MapRule(mesh.degree(), rule_of_degree(integrand_degree(space, p)));
  for_chunks(mesh.element_count(), threads, [&](std::size_t from, std::size_t to) {
    std::vector<double> x, y, w;
    for (std::size_t e = from; e < to; ++e) {
      const ElementId id(e);
      const int p = space.degree(id);
      if (straight) {
        // All functions of a triangle's own barycentrics have one integral.
        const std::array<Vec2, 3> c = corners(mesh, id);
        if (!physical || is_own_frame(space.frame(id), c)) {
          const auto n = at(bernstein::triangle_size(p));
          const double each = 0.5 * triangle_cross(c[0], c[1], c[2]) / static_cast<double>(n);
          std::fill_n(out.data() + space.offset(id), n, each);
          continue;
        }
      }
      const MapRule& rule = rules[at(p)];
      const std::size_t points = rule.map.size();
      x.resize(points);
      y.resize(points);
      w.resize(points);
      const ElementMap element(mesh, id);
      const RoundControl round(element.control());
      rule.map(round.points(), x, y, w);
      for (std::size_t q = 0; q < points; ++q) w[q] *= rule.weight[q];
      if (physical) to_frame(moved(round.map(), space.frame(id)), x, y);
      sum_basis(p, physical ? std::span<const double>(x) : rule.u,
                physical ? std::span<const double>(y) : rule.v, w, bernstein::multinomials(p),
                out.data() + space.offset(id));
    }
  });
  return out;
}

std::vector<double> element_integrals(std::span<const Field* const> fields,
                                      std::span<const double> basis_integrals, int threads) {
  const Space& space = fields.front()->space();
  const std::size_t elements = space.mesh()->element_count(), stride = component_count(fields);
  const int uniform = space.uniform_degree();
  std::vector<double> out(elements * stride);
  for_chunks(elements, threads, [&](std::size_t from, std::size_t to) {
    std::size_t first = 0;
    for (const Field* f : fields) {
      const std::size_t components = at(f->components());
      // All elements at once where their degree is one.
      const std::size_t step = uniform >= 0 ? to - from : 1;
      for (std::size_t e = from; e < to; e += step) {
        const ElementId id(e);
        const std::size_t begin = space.offset(id);
        integrate_elements(at(bernstein::triangle_size(space.degree(id))),
                           basis_integrals.data() + begin,
                           f->coefficients().data() + begin * components, components, step, stride,
                           out.data() + e * stride + first);
      }
      first += components;
    }
  });
  return out;
}

std::vector<double> integral(std::span<const double> element_integrals, std::size_t components) {
  if (components == 1) return {sum(element_integrals)};
  // As sum() for each component, all of them side by side.
  std::vector<double> total(components), error(components);
  for (std::size_t i = 0; i < element_integrals.size(); i += components) {
    for (std::size_t k = 0; k < components; ++k) {
      const WithError t = two_sum(total[k], element_integrals[i + k]);
      total[k] = t.value;
      error[k] += t.error;
    }
  }
  for (std::size_t k = 0; k < components; ++k) total[k] += error[k];
  return total;
}

}  // namespace bezel::field_detail
