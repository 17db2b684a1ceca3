#pragma once
// Kernels on the reference tetrahedron, templates on the value and the parameter's scalar, without
// any check of their arguments; see interval_kernel.hpp.

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/bernstein/tetrahedron_index.hpp"

namespace bezel::bernstein::tetrahedron {

/// Value and the three derivatives d/du, d/dv, d/dw where lambda = (1-u-v-w, u, v, w).
template <class Value>
struct ValueAndGradient {
  Value value, du, dv, dw;
};

namespace kernel {

using bernstein::kernel::at;
using bernstein::kernel::Binomial;
using bernstein::kernel::powers;

/// d! / (i! j! k! l!) with i = d - j - k - l; exact in double up to degree 20.
template <class Scalar>
Scalar multinomial(int d, int j, int k, int l) {
  return Scalar(Binomial<Scalar>::get(d, l) * bezel::kernel::trinomial<Scalar>(d - l, j, k));
}

/// The multinomials of degree d in index order.
template <class Scalar>
std::vector<Scalar> multinomials(int d) {
  std::vector<Scalar> m;
  m.reserve(at(tetrahedron_size(d)));
  for (int l = 0; l <= d; ++l)
    for (int k = 0; k <= d - l; ++k)
      for (int j = 0; j <= d - l - k; ++j) m.push_back(multinomial<Scalar>(d, j, k, l));
  return m;
}

/// Runs body on uninitialised work space for `size` values: on the stack when small.
template <class Value, class Body>
auto with_work(int size, const Body& body) {
  if (size <= 35) {
    std::array<Value, 35> w;
    return body(w.data());
  }
  std::vector<Value> w(at(size));
  return body(w.data());
}

/// l0 a + l1 b + l2 c + l3 e, as (l0 a + l1 b) + (l2 c + l3 e).
template <class Value, class Scalar>
Value combine(const std::array<Scalar, 4>& l, const Value& a, const Value& b, const Value& c,
              const Value& e) {
  return Value(Value(Value(l[0] * a) + Value(l[1] * b)) + Value(Value(l[2] * c) + Value(l[3] * e)));
}

/// One de Casteljau step: degree m, read from b, becomes m-1 in w; w may be b (reads run ahead of
/// writes).
template <class Value, class Scalar>
void step(const Value* b, Value* w, int m, const std::array<Scalar, 4>& lambda) {
  const Value* lower = b;  // row k of layer l; the one above it; the place in layer l+1
  const Value* above = b + triangle_size(m);
  for (int l = 0; l < m; ++l) {
    const int n = m - l;
    for (int k = 0; k < n; ++k) {
      const Value* upper = lower + (n - k + 1);
      for (int j = 0; j < n - k; ++j)
        *w++ = combine(lambda, lower[j], lower[j + 1], upper[j], *above++);
      lower = upper;
    }
    ++lower;  // the row of one entry at the top of the layer
  }
}

/// p(lambda), without checks: b holds tetrahedron_size(d) values, 0 <= d <= max_tetrahedron_degree.
template <class Value, class Scalar>
Value evaluate_unchecked(int d, const Value* b, const std::array<Scalar, 4>& lambda) {
  if (d == 0) return b[0];
  return with_work<Value>(tetrahedron_size(d - 1), [&](Value* w) -> Value {
    step(b, w, d, lambda);
    for (int m = d - 1; m > 0; --m) step(w, w, m, lambda);
    return w[0];
  });
}

/// p(lambda) and its derivatives from one de Casteljau sweep, without checks.
template <class Value, class Scalar>
ValueAndGradient<Value> evaluate_gradient_unchecked(int d, const Value* b,
                                                    const std::array<Scalar, 4>& lambda) {
  if (d == 0) {
    const Value zero(b[0] - b[0]);
    return {b[0], zero, zero, zero};
  }
  const auto finish = [&](const Value* w) -> ValueAndGradient<Value> {
    return {combine(lambda, w[0], w[1], w[2], w[3]), Value(Scalar(d) * Value(w[1] - w[0])),
            Value(Scalar(d) * Value(w[2] - w[0])), Value(Scalar(d) * Value(w[3] - w[0]))};
  };
  if (d == 1) return finish(b);
  return with_work<Value>(tetrahedron_size(d - 1), [&](Value* w) -> ValueAndGradient<Value> {
    step(b, w, d, lambda);
    for (int m = d - 1; m > 1; --m) step(w, w, m, lambda);
    return finish(w);
  });
}

/// Coefficients of d/du, d/dv and d/dw: tetrahedron_size(d-1) values each (d = 0: one zero).
template <class Value, class Scalar>
void differentiate(int d, const Value* b, Value* du, Value* dv, Value* dw) {
  if (d == 0) {
    du[0] = dv[0] = dw[0] = Value(b[0] - b[0]);
    return;
  }
  for (int l = 0, n = 0; l < d; ++l)
    for (int k = 0; k < d - l; ++k)
      for (int j = 0; j < d - l - k; ++j, ++n) {
        const Value& corner = b[tetrahedron_index(d, j, k, l)];
        du[n] = Value(Scalar(d) * Value(b[tetrahedron_index(d, j + 1, k, l)] - corner));
        dv[n] = Value(Scalar(d) * Value(b[tetrahedron_index(d, j, k + 1, l)] - corner));
        dw[n] = Value(Scalar(d) * Value(b[tetrahedron_index(d, j, k, l + 1)] - corner));
      }
}

/// out_ijkl = blossom of i times x[0], j times x[1], k times x[2], l times x[3]. The arguments are
/// applied in the order given by `order`; children of one subdivision use one order for their
/// shared points, so that their shared faces agree bit for bit.
template <class Value, class Scalar>
void specialize(int d, const Value* b, const std::array<std::array<Scalar, 4>, 4>& x,
                const std::array<int, 4>& order, Value* out) {
  std::vector<Value> first(b, b + tetrahedron_size(d)), second, third, fourth;
  std::array<int, 4> index{};
  for (int p = 0; p <= d; ++p) {  // p steps of x[order[0]] have been applied
    const int m = d - p;
    second.assign(first.begin(), first.begin() + tetrahedron_size(m));
    for (int q = 0; q <= m; ++q) {
      third.assign(second.begin(), second.begin() + tetrahedron_size(m - q));
      for (int r = 0; r <= m - q; ++r) {
        const int s = m - q - r;
        fourth.assign(third.begin(), third.begin() + tetrahedron_size(s));
        for (int n = s; n > 0; --n) step(fourth.data(), fourth.data(), n, x[at(order[3])]);
        index[at(order[0])] = p;
        index[at(order[1])] = q;
        index[at(order[2])] = r;
        index[at(order[3])] = s;
        out[tetrahedron_index(index)] = fourth[0];
        if (s > 0) step(third.data(), third.data(), s, x[at(order[2])]);
      }
      if (q < m) step(second.data(), second.data(), m - q, x[at(order[1])]);
    }
    if (p < d) step(first.data(), first.data(), m, x[at(order[0])]);
  }
}

/// The corners of the eight children of the midpoint split as pairs of the parent's corners: {a, a}
/// is corner a, {a, b} the midpoint of their edge.
inline constexpr std::array<std::array<std::array<int, 2>, 4>, 8> midpoint_children{{
    {{{0, 0}, {0, 1}, {0, 2}, {0, 3}}},
    {{{0, 1}, {1, 1}, {1, 2}, {1, 3}}},
    {{{0, 2}, {1, 2}, {2, 2}, {2, 3}}},
    {{{0, 3}, {1, 3}, {2, 3}, {3, 3}}},
    {{{0, 2}, {1, 3}, {0, 1}, {1, 2}}},
    {{{0, 2}, {1, 3}, {1, 2}, {2, 3}}},
    {{{0, 2}, {1, 3}, {2, 3}, {0, 3}}},
    {{{0, 2}, {1, 3}, {0, 3}, {0, 1}}},
}};

/// Eight children of the midpoint split, each tetrahedron_size(d) values.
template <class Value, class Scalar>
void subdivide(int d, const Value* b, const std::array<Value*, 8>& out) {
  const Scalar zero(0), half(0.5);
  for (std::size_t child = 0; child < 8; ++child) {
    const auto& corners = midpoint_children[child];
    std::array<std::array<Scalar, 4>, 4> x;
    std::array<int, 4> order{0, 1, 2, 3};
    for (std::size_t c = 0; c < 4; ++c) {
      x[c] = {zero, zero, zero, zero};
      for (const int end : corners[c]) x[c][at(end)] = Scalar(x[c][at(end)] + half);
    }
    // The corner first, then the midpoints in the order 01, 02, 03, 12, 13, 23, in every child.
    const auto rank = [&](int c) {
      const auto& pair = corners[at(c)];
      return (pair[0] == pair[1] ? 0 : 16) + 4 * pair[0] + pair[1];
    };
    std::sort(order.begin(), order.end(), [&](int a, int c) { return rank(a) < rank(c); });
    specialize<Value, Scalar>(d, b, x, order, out[child]);
  }
}

/// Halving along edges, cheap enough for searches: the tetrahedron with corners x0 x1 x2 x3 at
/// depth n is split at the middle z of x0 and xk, k = 3 - n mod 3, into x0 .. x(k-1) z x(k+1) ..
/// and x1 .. xk z x(k+1) .. [maubach1995]: three levels halve every edge of the reference
/// tetrahedron, and all pieces have one of a few shapes. Children may be negatively oriented.
///
/// A row of coefficients along the edge is a polynomial on an interval and is halved by itself: per
/// level at most d roundings of halves, d u max|b|.
class Bisection {
 public:
  explicit Bisection(int d) {
    for (int k = 1; k <= 3; ++k)
      for (int n = 0; n < tetrahedron_size(d); ++n) {
        const std::array<int, 4> x = tetrahedron_multi_index(d, n);
        if (x[at(k)] != 0) continue;  // rows by their first entry; x[0] is the row's degree
        const int length = x[0];
        std::vector<int>& place = place_[at(k - 1)];
        place.push_back(length);
        for (int r = 0; r <= length; ++r) {
          std::array<int, 4> own = x, second = x;
          own[0] = length - r;
          own[at(k)] = r;
          for (int p = 0; p + 1 < k; ++p) second[at(p)] = x[at(p + 1)];
          second[at(k - 1)] = length - r;
          second[at(k)] = r;
          place.push_back(tetrahedron_index(own));
          place.push_back(tetrahedron_index(second));
        }
      }
  }

  /// Children of the piece b at the given depth; tetrahedron_size(d) values each.
  template <class Value, class Scalar = double>
  void split(int depth, const Value* b, Value* first, Value* second) const {
    const Scalar half(0.5);
    const std::vector<int>& place = place_[at(2 - depth % 3)];
    std::array<Value, max_tetrahedron_degree + 1> row;
    for (std::size_t at_place = 0; at_place < place.size();) {
      const int length = place[at_place++];
      const int* p = &place[at_place];
      at_place += 2 * at(length + 1);
      for (int r = 0; r <= length; ++r) row[at(r)] = b[p[2 * r]];
      for (int r = 0; r <= length; ++r) {
        first[p[2 * r]] = row[0];
        second[p[2 * r + 1]] = row[at(length - r)];
        for (int j = 0; j + r < length; ++j)
          row[at(j)] = Value(Value(half * row[at(j)]) + Value(half * row[at(j + 1)]));
      }
    }
  }

  /// The corners of the children, in the parent's barycentrics.
  template <class Point>
  static void split_corners(int depth, const std::array<Point, 4>& corner,
                            std::array<Point, 4>& first, std::array<Point, 4>& second) {
    const std::size_t k = at(3 - depth % 3);
    Point middle{};
    for (std::size_t i = 0; i < 4; ++i) middle[i] = 0.5 * (corner[0][i] + corner[k][i]);
    first = second = corner;
    for (std::size_t p = 0; p < k; ++p) second[p] = corner[p + 1];
    first[k] = second[k] = middle;
  }

 private:
  std::array<std::vector<int>, 3> place_;  // per k: row length, then own and second child's places
};

/// Degree d to d+1: out_x = sum over corners c of x_c b_(x - e_c) / (d+1).
template <class Value, class Scalar>
void elevate(int d, const Value* b, Value* out) {
  const int n = d + 1;
  for (int m = 0; m < tetrahedron_size(n); ++m) {
    std::array<int, 4> x = tetrahedron_multi_index(n, m);
    Value& c = out[m];
    bool empty = true;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const int weight = x[corner];
      if (weight == 0) continue;
      --x[corner];
      const Value& source = b[tetrahedron_index(x)];
      ++x[corner];
      const Value term = weight == n ? source : Value(Scalar(weight) * source);
      c = empty ? term : Value(c + term);
      empty = false;
    }
    if (*std::max_element(x.begin(), x.end()) < n) c = Value(c * Scalar(Scalar(1) / Scalar(n)));
  }
}

/// out_x += product(a_y, b_z) for all y + z = x; the multinomial scaling is the caller's.
template <class A, class B, class Out, class Product>
void accumulate_products(int da, const A* a, int db, const B* b, Out* out, const Product& product) {
  const int d = da + db;
  for (int l = 0; l <= da; ++l)
    for (int k = 0; k <= da - l; ++k)
      for (int j = 0; j <= da - l - k; ++j, ++a) {
        const B* s = b;
        for (int n = 0; n <= db; ++n) {
          const int rest = d - l - n;  // layer l + n is a triangle of this degree
          Out* layer = out + (tetrahedron_size(d) - tetrahedron_size(rest));
          for (int q = 0; q <= db - n; ++q) {
            Out* row = layer + triangle_index(rest, j, k + q);
            for (int m = 0; m <= db - n - q; ++m) row[m] = Out(row[m] + product(*a, *s++));
          }
        }
      }
}

/// Product: c_x = sum over y + z = x of M(y) M(z) / M(x) a_y b_z, M the multinomial coefficient.
template <class Scalar>
void multiply(int da, const Scalar* x, int db, const Scalar* y, Scalar* out) {
  const int d = da + db;
  std::vector<Scalar> a = multinomials<Scalar>(da), b = multinomials<Scalar>(db);
  for (std::size_t n = 0; n < a.size(); ++n) a[n] = Scalar(a[n] * x[n]);
  for (std::size_t n = 0; n < b.size(); ++n) b[n] = Scalar(b[n] * y[n]);
  const std::vector<Scalar> divisor = multinomials<Scalar>(d);
  for (std::size_t n = 0; n < divisor.size(); ++n) out[n] = Scalar(0);
  accumulate_products(da, a.data(), db, b.data(), out,
                      [](const Scalar& p, const Scalar& q) { return Scalar(p * q); });
  for (const Scalar& m : divisor) {
    *out = Scalar(*out / m);
    ++out;
  }
}

/// Values at (i, j, k, l)/d: sum of M(a) i^a0 j^a1 k^a2 l^a3 b_a, divided by d^d at the end. The
/// sum over one index at a time: first along rows for every (i, j), then rows, then layers.
template <class Scalar>
void to_lagrange(int d, const Scalar* b, Scalar* values) {
  if (d == 0) {
    values[0] = b[0];
    return;
  }
  std::vector<std::vector<Scalar>> power;
  for (int i = 0; i <= d; ++i) power.push_back(powers(Scalar(i), d));
  std::vector<Scalar> scaled = multinomials<Scalar>(d);
  for (std::size_t n = 0; n < scaled.size(); ++n) scaled[n] = Scalar(scaled[n] * b[n]);
  // rows[(c, e)] = sum over a of i^(d-e-c-a) j^a scaled(a, c, e) depends on (i, j) only.
  std::vector<Scalar> rows(at(triangle_size(d)));
  for (int i = 0; i <= d; ++i)
    for (int j = 0; j <= d - i; ++j) {
      for (int e = 0, n = 0, row = 0; e <= d; ++e)
        for (int c = 0; c <= d - e; ++c, ++row) {
          Scalar sum(0);
          for (int a = 0; a <= d - e - c; ++a, ++n) {
            const Scalar w = Scalar(power[at(i)][at(d - e - c - a)] * power[at(j)][at(a)]);
            sum = Scalar(sum + Scalar(w * scaled[at(n)]));
          }
          rows[at(row)] = sum;
        }
      for (int k = 0; k <= d - i - j; ++k) {
        const int l = d - i - j - k;
        Scalar sum(0);
        for (int e = 0, row = 0; e <= d; ++e) {
          Scalar layer(0);
          for (int c = 0; c <= d - e; ++c, ++row)
            layer = Scalar(layer + Scalar(power[at(k)][at(c)] * rows[at(row)]));
          sum = Scalar(sum + Scalar(layer * power[at(l)][at(e)]));
        }
        values[tetrahedron_index(d, j, k, l)] = Scalar(sum / power[at(d)][at(d)]);
      }
    }
}

/// next (degree n) <- p (degree n-1) (d x_axis - s) / (s + 1), axis 1, 2, 3 of u, v, w; for n = 0
/// zero. The linear factor has the coefficient d - s at the corner of the axis, -s elsewhere; the
/// multi-indices have `axes` + 1 entries (2: triangle, 3: tetrahedron).
template <class Scalar>
void multiply_by_lattice_factor(int axes, int d, int n, int axis, int s, const Scalar* p,
                                Scalar* next) {
  const int size = axes == 2 ? triangle_size(n) : tetrahedron_size(n);
  for (int m = 0; m < size; ++m) {
    std::array<int, 4> x{};
    if (axes == 2) {
      const std::array<int, 3> y = triangle_multi_index(n, m);
      x = {y[0], y[1], y[2], 0};
    } else {
      x = tetrahedron_multi_index(n, m);
    }
    Scalar sum(0);
    for (int corner = 0; corner <= axes; ++corner) {
      if (x[at(corner)] == 0) continue;
      const Scalar weight((corner == axis ? d - s : -s) * x[at(corner)]);
      --x[at(corner)];
      const int from = axes == 2 ? triangle_index(n - 1, x[1], x[2]) : tetrahedron_index(x);
      ++x[at(corner)];
      sum = Scalar(sum + Scalar(weight * p[from]));
    }
    if (n > 0) sum = Scalar(sum / Scalar(n * (s + 1)));
    next[m] = sum;
  }
}

/// Coefficients from values at (i, j, k, l)/d: the Newton form on the lattice in x = d u, y = d v,
/// z = d w, sum D_abc C(x, a) C(y, b) C(z, c), nested in z over polynomials in (x, y), these in y
/// over polynomials in x; all multiplied out in Bernstein form.
template <class Scalar>
void from_lagrange(int d, const Scalar* values, Scalar* b) {
  std::vector<Scalar> difference(values, values + tetrahedron_size(d));
  const auto entry = [&](int j, int k, int l) -> Scalar& {
    return difference[at(tetrahedron_index(d, j, k, l))];
  };
  for (int p = 0; p <= d; ++p)
    for (int q = 0; q <= d - p; ++q) {
      const int n = d - p - q;
      for (int a = 1; a <= n; ++a)
        for (int j = n; j >= a; --j) entry(j, p, q) = Scalar(entry(j, p, q) - entry(j - 1, p, q));
    }
  for (int p = 0; p <= d; ++p)
    for (int q = 0; q <= d - p; ++q) {
      const int n = d - p - q;
      for (int a = 1; a <= n; ++a)
        for (int k = n; k >= a; --k) entry(p, k, q) = Scalar(entry(p, k, q) - entry(p, k - 1, q));
    }
  for (int p = 0; p <= d; ++p)
    for (int q = 0; q <= d - p; ++q) {
      const int n = d - p - q;
      for (int a = 1; a <= n; ++a)
        for (int l = n; l >= a; --l) entry(p, q, l) = Scalar(entry(p, q, l) - entry(p, q, l - 1));
    }

  std::vector<Scalar> solid(at(tetrahedron_size(d)), Scalar(0)), solid_next(solid.size());
  std::vector<Scalar> plane(at(triangle_size(d))), plane_next(plane.size());
  std::vector<Scalar> line(at(d + 1)), line_next(at(d + 1));
  for (int l = d; l >= 0; --l) {
    const int top = d - l;  // plane: sum over a, k of D_akl C(x, a) C(y, k), degree top
    plane[0] = Scalar(0);
    for (int k = top; k >= 0; --k) {
      const int n = top - k;  // line: sum over a of D_akl C(x, a), degree n
      line[0] = entry(n, k, l);
      for (int a = n - 1; a >= 0; --a) {
        const int m = n - 1 - a;
        for (int i = 0; i <= m + 1; ++i) {
          Scalar sum(0);
          if (i <= m) sum = Scalar(sum + Scalar(Scalar(-a * (m + 1 - i)) * line[at(i)]));
          if (i >= 1) sum = Scalar(sum + Scalar(Scalar((d - a) * i) * line[at(i - 1)]));
          line_next[at(i)] = Scalar(Scalar(sum / Scalar((m + 1) * (a + 1))) + entry(a, k, l));
        }
        line.swap(line_next);
      }
      multiply_by_lattice_factor(2, d, n, 2, k, plane.data(), plane_next.data());
      for (int q = 0, m = 0; q <= n; ++q)  // a polynomial in u alone has the coefficients line_j
        for (int j = 0; j <= n - q; ++j, ++m)
          plane_next[at(m)] = Scalar(plane_next[at(m)] + line[at(j)]);
      plane.swap(plane_next);
    }
    multiply_by_lattice_factor(3, d, top, 3, l, solid.data(), solid_next.data());
    for (int r = 0, m = 0; r <= top; ++r)  // one in (u, v) alone has plane_jk in every layer
      for (int q = 0; q <= top - r; ++q)
        for (int j = 0; j <= top - r - q; ++j, ++m)
          solid_next[at(m)] = Scalar(solid_next[at(m)] + plane[at(triangle_index(top, j, q))]);
    solid.swap(solid_next);
  }
  std::copy(solid.begin(), solid.end(), b);
}

/// M(x) l0^i l1^j l2^k l3^l, each from powers: small relative error in each value.
template <class Scalar>
void basis(int d, const std::array<Scalar, 4>& lambda, Scalar* out) {
  std::array<std::vector<Scalar>, 4> p;
  for (std::size_t c = 0; c < 4; ++c) p[c] = powers(lambda[c], d);
  for (int l = 0; l <= d; ++l)
    for (int k = 0; k <= d - l; ++k)
      for (int j = 0; j <= d - l - k; ++j) {
        Scalar product = Scalar(multinomial<Scalar>(d, j, k, l) * p[0][at(d - j - k - l)]);
        product = Scalar(product * p[1][at(j)]);
        product = Scalar(product * p[2][at(k)]);
        *out++ = Scalar(product * p[3][at(l)]);
      }
}

}  // namespace kernel
}  // namespace bezel::bernstein::tetrahedron
