// Integrals of basis functions over their elements.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "bezel/bernstein/multinomial.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/integrals.hpp"
#include "bezel/geometry/bent.hpp"
#include "bezel/geometry/jacobian_kernel.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/lanes.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::field_detail {
namespace {

using geometry_kernel::JacobianTable;
using short_names::at;

/// A Gauss rule on a side: values and derivatives of its basis functions, [point][function].
struct SideRule {
  SideRule(int map_degree, int points) {
    const IntervalRule rule = gauss_legendre(points);
    weight = rule.weight;
    for (const double s : rule.node) {
      std::vector<double> lower(at(map_degree) + 2, 0.0);  // from number -1 on
      for (int m = 0; m <= map_degree; ++m) {
        value.push_back(binomial(map_degree, m) * power(s, m) * power(1.0 - s, map_degree - m));
        if (m < map_degree) {
          lower[at(m) + 1] =
              binomial(map_degree - 1, m) * power(s, m) * power(1.0 - s, map_degree - 1 - m);
        }
      }
      for (int m = 0; m <= map_degree; ++m)
        slope.push_back(map_degree * (lower[at(m)] - lower[at(m) + 1]));
    }
  }
  static double power(double x, int n) {
    double product = 1.0;
    for (int i = 0; i < n; ++i) product *= x;
    return product;
  }
  std::vector<double> weight, value, slope;
};

/// A number of each of several elements, in pairs: every processor has vectors of two.
struct Block {
  using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;
  static constexpr std::size_t pairs = lanes / 2;
  Pair pair[pairs];

  double get(std::size_t l) const { return pair[l / 2][l % 2]; }
  void set(std::size_t l, double x) { pair[l / 2][l % 2] = x; }
  static Block all(double x) {
    Block b;
    for (Pair& p : b.pair) p = Pair{x, x};
    return b;
  }
  void add(double factor, const Block& b) {
    for (std::size_t i = 0; i < pairs; ++i) pair[i] += factor * b.pair[i];
  }
  void add(const Block& a, const Block& b, const Block& c) {
    for (std::size_t i = 0; i < pairs; ++i) pair[i] += a.pair[i] * b.pair[i] * c.pair[i];
  }
  friend Block operator*(const Block& a, const Block& b) {
    Block c;
    for (std::size_t i = 0; i < pairs; ++i) c.pair[i] = a.pair[i] * b.pair[i];
    return c;
  }
};

/// Polynomials in x and y on curved elements, by Green's formula in the frame's coordinates u and
/// v: with A_n such that dA_n / du = B_n, the integral of B_n du dv is that of A_n dv around the
/// element. Of degree d + 1 and without a negative coefficient,
/// A_ijk = (sum over m > j of B_(i+j+1-m, m, k)) / (d + 1).
class ByBoundary {
 public:
  ByBoundary(const Space& space, int d)
      : space_(space), d_(d), g_(space.mesh()->degree()), rule_(g_, ((d + 2) * g_ + 1) / 2) {
    for (int side = 0; side < 3; ++side)
      for (int m = 0; m <= g_; ++m)
        at_[at(side)].push_back(bernstein::triangle_side_index(g_, side, m));
    for (int k = 0; k <= d; ++k)
      for (int m = 0; m <= d + 1 - k; ++m)
        factor_.push_back(binomial(d + 1, k) * binomial(d + 1 - k, m) / (d + 1));
  }

  /// Elements from number `first` on.
  void operator()(std::size_t first, std::size_t count, double* out) const {
    constexpr std::size_t room =
        static_cast<std::size_t>(bernstein::triangle_size(Space::max_degree + 1));
    const TriangleMesh& mesh = *space_.mesh();
    std::array<Block, static_cast<std::size_t>(largest_size)> u, v;  // of control points
    std::array<double, lanes> scale;
    for (std::size_t l = 0; l < lanes; ++l) {
      const ElementId id(first + std::min(l, count - 1));
      ElementMap map(mesh, id);
      const AreaMap to_round = map.make_round();
      const Frame frame = to_round.identity ? space_.frame(id) : moved(to_round, space_.frame(id));
      scale[l] = 1.0 / cross(frame.gradient[1], frame.gradient[2]);
      for (const std::vector<int>& side : at_) {
        for (std::size_t m = 0; m + 1 < side.size(); ++m) {
          const std::size_t n = at(side[m]);
          const Vec2 r = map.control()[n] - frame.centre;
          u[n].set(l, 1.0 / 3.0 + dot(frame.gradient[1], r));
          v[n].set(l, 1.0 / 3.0 + dot(frame.gradient[2], r));
        }
      }
    }
    std::array<Block, room> sums;
    const std::size_t size = factor_.size();
    std::fill_n(sums.begin(), size, Block::all(0.0));
    for (const std::vector<int>& side : at_) add_side(side, u.data(), v.data(), sums.data());
    for (std::size_t l = 0; l < count; ++l) {
      std::size_t n = 0;
      for (int k = 0; k <= d_; ++k) {
        // From the last of the row on.
        double sum = 0.0;
        const std::size_t row = n;
        for (int j = d_ - k; j >= 0; --j, ++n) {
          const std::size_t from = row + at(k) + at(j) + 1;  // rows of sums are one longer
          sum += factor_[from] * sums[from].get(l);
          out[row + at(j)] = sum * scale[l];
        }
      }
      out += n;
    }
  }

 private:
  void add_side(const std::vector<int>& side, const Block* u, const Block* v, Block* sums) const {
    std::array<Block, static_cast<std::size_t>(Space::max_degree) + 2> p0, p1;
    const std::size_t functions = side.size();
    for (std::size_t q = 0; q < rule_.weight.size(); ++q) {
      const double* value = rule_.value.data() + q * functions;
      const double* slope = rule_.slope.data() + q * functions;
      Block x = Block::all(0.0), y = x, row = x;
      for (std::size_t m = 0; m < functions; ++m) {
        const Block &um = u[at(side[m])], &vm = v[at(side[m])];
        x.add(value[m], um);
        y.add(value[m], vm);
        row.add(slope[m] * rule_.weight[q], vm);
      }
      p0[0] = p1[0] = Block::all(1.0);
      p0[1] = Block::all(1.0);
      p0[1].add(-1.0, x);
      p0[1].add(-1.0, y);
      p1[1] = x;
      for (std::size_t i = 2; i <= at(d_) + 1; ++i) {
        p0[i] = p0[i - 1] * p0[1];
        p1[i] = p1[i - 1] * x;
      }
      std::size_t n = 0;
      for (int k = 0; k <= d_; ++k) {
        ++n;  // no antiderivative has a part of number 0 of a row
        for (int m = 1; m <= d_ + 1 - k; ++m, ++n)
          sums[n].add(p0[at(d_ + 1 - k - m)], p1[at(m)], row);
        row = row * y;
      }
    }
  }

  const Space& space_;
  int d_, g_;
  SideRule rule_;
  std::array<std::vector<int>, 3> at_;  // control points along the sides
  std::vector<double> factor_;          // multinomial coefficients of degree d + 1, over d + 1
};

/// Polynomials in reference coordinates: integrals of products with the coefficients of the
/// Jacobian.
class ByJacobian {
 public:
  ByJacobian(const Space& space, int d) : space_(space), g_(space.mesh()->degree()) {
    const int e = 2 * (g_ - 1), both = d + e;
    const auto multinomial = [](int n, int j, int k) {
      return binomial(n, k) * binomial(n - k, j);
    };
    for (int k = 0; k <= d; ++k)
      for (int j = 0; j + k <= d; ++j)
        for (int q = 0; q <= e; ++q)
          for (int p = 0; p + q <= e; ++p) {
            product_.push_back(multinomial(d, j, k) * multinomial(e, p, q) /
                               multinomial(both, j + p, k + q) / ((both + 1) * (both + 2)));
          }
  }
  void operator()(std::size_t e, double* out) const {
    ElementMap map(*space_.mesh(), ElementId(e));
    map.make_round();
    const JacobianTable& table = JacobianTable::of(g_);
    std::array<double, JacobianTable::max_room> room;
    std::array<double, JacobianTable::max_size> det;
    table(map.control().data(), room.data(), det.data());
    const std::size_t size = table.scale.size();
    const double twice_area =
        std::accumulate(det.begin(), det.begin() + static_cast<std::ptrdiff_t>(size), 0.0) /
        static_cast<double>(size);
    if (g_ > 1 && is_bent(map.control(), 0.5 * twice_area))
      std::ranges::copy(bent_jacobian(g_, ElementMap(*space_.mesh(), ElementId(e)).control()),
                        det.begin());
    for (const double* row = product_.data(); row != product_.data() + product_.size();
         row += size) {
      double sum = 0.0;
      for (std::size_t m = 0; m < size; ++m) sum += row[m] * det[m];
      *out++ = sum;
    }
  }

 private:
  const Space& space_;
  int g_;
  std::vector<double> product_;  // [function][coefficient]
};

/// Consecutive elements of one degree.
void integrate_run(const Space& space, std::size_t from, std::size_t to, const ByBoundary* boundary,
                   const ByJacobian* jacobian, double* out) {
  const TriangleMesh& mesh = *space.mesh();
  const auto size = at(bernstein::triangle_size(space.degree(ElementId(from))));
  for (std::size_t e = from; jacobian != nullptr && e < to; ++e) {
    (*jacobian)(e, out);
    out += size;
  }
  if (jacobian != nullptr) return;
  // All functions of a triangle's own barycentrics have one integral.
  const auto put_plain = [&](std::size_t e) {
    const std::array<Vec2, 3> c = corners(mesh, ElementId(e));
    const double each = 0.5 * triangle_cross(c[0], c[1], c[2]) / static_cast<double>(size);
    for (std::size_t n = 0; n < size; ++n) out[n] = each;
    out += size;
  };
  if (boundary == nullptr) {
    for (std::size_t e = from; e < to; ++e) put_plain(e);
    return;
  }
  const auto is_plain = [&](std::size_t e) { return space.is_own_frame(ElementId(e)); };
  for (std::size_t e = from; e < to;) {
    if (is_plain(e)) {
      put_plain(e++);
      continue;
    }
    std::size_t count = 1;
    while (count < lanes && e + count < to && !is_plain(e + count)) ++count;
    (*boundary)(e, count, out);
    out += count * size;
    e += count;
  }
}

}  // namespace

std::vector<double> basis_integrals(const Space& space, int threads) {
  const TriangleMesh& mesh = *space.mesh();
  const bool by_jacobian = space.basis() == Basis::reference && mesh.degree() > 1;
  const bool by_boundary = space.basis() == Basis::physical && !space.has_own_frames();
  std::vector<double> out(space.coefficient_count());
  std::vector<std::unique_ptr<ByBoundary>> boundary(at(Space::max_degree) + 1);
  std::vector<std::unique_ptr<ByJacobian>> jacobian(boundary.size());
  for (const int d : degrees_of(space)) {
    if (by_boundary) boundary[at(d)] = std::make_unique<ByBoundary>(space, d);
    if (by_jacobian) jacobian[at(d)] = std::make_unique<ByJacobian>(space, d);
  }
  for_chunks(mesh.element_count(), threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t e = from; e < to;) {
      const int d = space.degree(ElementId(e));
      std::size_t end = space.uniform_degree() >= 0 ? to : e + 1;
      while (end < to && space.degree(ElementId(end)) == d) ++end;
      integrate_run(space, e, end, boundary[at(d)].get(), jacobian[at(d)].get(),
                    out.data() + space.offset(ElementId(e)));
      e = end;
    }
  });
  return out;
}

}  // namespace bezel::field_detail
