#include "bezel/geometry/exact_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bezel/bernstein/exact.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::geometry_kernel {
namespace {

using short_names::at;

/// c becomes the coefficients about `centre`.
void shift(Polynomial& c, const Dyadic& centre) {
  const std::size_t n = c.size() - 1;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = n; k-- > i;) c[k] += centre * c[k + 1];
}

void trim(Polynomial& c) {
  while (!c.empty() && c.back().sign() == 0) c.pop_back();
}

Dyadic value(const Polynomial& c, const Dyadic& x) {
  Dyadic h;
  for (std::size_t k = c.size(); k-- > 0;) h = h * x + c[k];
  return h;
}

}  // namespace

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial out(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].sign() == 0) continue;
    for (std::size_t k = 0; k < b.size(); ++k)
      if (b[k].sign() != 0) out[i + k] += a[i] * b[k];
  }
  return out;
}

Polynomial compose(const Polynomial& f, const Polynomial& g) {
  Polynomial out{f.back()};
  for (std::size_t k = f.size() - 1; k-- > 0;) {
    out = product(out, g);
    out[0] += f[k];
  }
  return out;
}

ExactCurve::ExactCurve(std::span<const Vec2> control, std::int64_t exponent) {
  for (int axis = 0; axis < 2; ++axis) {
    Polynomial b;
    for (const Vec2& p : control) b.push_back(Dyadic(p[axis]).scaled(-exponent));
    const bernstein::ExactPolynomial polynomial{std::span<const Dyadic>(b)};
    c_[at(axis)].assign(polynomial.monomial().begin(), polynomial.monomial().end());
  }
  while (c_[0].size() > 1 && c_[0].back().sign() == 0 && c_[1].back().sign() == 0) {
    c_[0].pop_back();
    c_[1].pop_back();
  }
  const std::size_t n = c_[0].size() - 1;
  bool straight = n > 0;
  for (std::size_t k = 1; k < n && straight; ++k)
    straight = c_[0][k] * c_[1][n] == c_[1][k] * c_[0][n];
  if (straight) direction_ = ExactPoint{c_[0][n], c_[1][n]};
}

ExactPoint ExactCurve::operator()(const Dyadic& s) const {
  return {value(c_[0], s), value(c_[1], s)};
}

ExactTaylor ExactCurve::taylor(const Dyadic& centre) const {
  ExactTaylor out = c_;
  if (centre.sign() != 0)
    for (auto& c : out) shift(c, centre);
  return out;
}

ExactTaylor ExactCurve::taylor(const Ratio& centre) const {
  if (centre.den == Dyadic(1.0)) return taylor(centre.num);
  // With s = (num + x) / den: den^n c(s) = sum c_k den^(n-k) (num + x)^k, then x = den h.
  ExactTaylor out = c_;
  for (auto& c : out) {
    Dyadic power = 1.0;
    for (std::size_t k = c.size() - 1; k-- > 0;) {
      power *= centre.den;
      c[k] *= power;
    }
    shift(c, centre.num);
    power = 1.0;
    for (std::size_t k = 1; k < c.size(); ++k) {
      power *= centre.den;
      c[k] *= power;
    }
  }
  return out;
}

std::optional<ExactContact> verify_contact(const ExactCurve& a, const ExactCurve& b, const Ratio& s,
                                           const Ratio& t) {
  ExactContact out{s, t, a.taylor(s), b.taylor(t)};
  const auto multiply = [](ExactTaylor& taylor, const Dyadic& by, int times) {
    if (by == Dyadic(1.0)) return;
    Dyadic factor = 1.0;
    for (int i = 0; i < times; ++i) factor *= by;
    for (auto& c : taylor)
      for (Dyadic& x : c) x *= factor;
  };
  multiply(out.a, t.den, b.degree());
  multiply(out.b, s.den, a.degree());
  if (!(out.a[0][0] == out.b[0][0]) || !(out.a[1][0] == out.b[1][0])) return std::nullopt;
  return out;
}

std::optional<AffineChange> coincide(const ExactContact& contact) {
  const ExactTaylor &a = contact.a, &b = contact.b;
  if (a[0].size() != b[0].size() || a[0].size() < 2) return std::nullopt;
  const std::size_t axis = a[0][1].sign() != 0 && b[0][1].sign() != 0 ? 0 : 1;
  const Dyadic &p = a[axis][1], &q = b[axis][1];
  if (p.sign() == 0 || q.sign() == 0) return std::nullopt;
  if (!(a[0][1] * b[1][1] == a[1][1] * b[0][1])) return std::nullopt;
  Dyadic power_p = 1.0, power_q = 1.0;
  for (std::size_t k = 1; k < a[0].size(); ++k) {
    power_p *= p;
    power_q *= q;
    for (const std::size_t x : {0U, 1U})
      if (!(a[x][k] * power_q == b[x][k] * power_p)) return std::nullopt;
  }
  return AffineChange{p, q};
}

ContactOrder contact_order(const ExactContact& contact, int axis, int limit, double start) {
  const std::size_t x = at(axis), y = 1 - x;
  const ExactTaylor &a = contact.a, &b = contact.b;
  const Dyadic& beta = b[x][1];
  const auto coefficient = [](const Polynomial& c, std::size_t k) {
    return k < c.size() ? c[k] : Dyadic();
  };
  // With h = beta^2 mu and b's parameter beta theta(mu), b[x] = a[x] reads
  //   theta + sum_{k>=2} b_k beta^(k-2) theta^k = sum a_k beta^(2k-2) mu^k:
  // theta has exact coefficients. delta = a[y] - b[y] in powers of mu follows.
  const std::size_t n = b[x].size() - 1;
  Polynomial scaled_x{Dyadic(), Dyadic(1.0)}, scaled_y{Dyadic(), b[y][1] * beta};
  Dyadic power = 1.0;
  for (std::size_t k = 2; k <= n; ++k) {
    scaled_x.push_back(b[x][k] * power);
    power *= beta;
    scaled_y.push_back(b[y][k] * power * beta);
  }
  std::vector<Polynomial> theta(n + 1);    // theta[k]: coefficients of theta^k
  for (auto& t : theta) t.emplace_back();  // all without a constant term
  Dyadic power_a = 1.0, delta;             // beta^(2j-2)
  const Dyadic beta_squared = beta * beta;
  int order = 0;
  for (int j = 1; j <= limit; ++j) {
    const std::size_t i = at(j);
    // theta^k at order j needs theta to order j - k + 1 only.
    for (std::size_t k = 2; k <= n; ++k) {
      Dyadic sum;
      for (std::size_t l = 1; l < i; ++l)
        if (theta[1].size() > l && theta[k - 1].size() > i - l)
          sum += theta[1][l] * theta[k - 1][i - l];
      theta[k].push_back(sum);
    }
    Dyadic next = coefficient(a[x], i) * power_a;
    for (std::size_t k = 2; k <= n; ++k) next -= scaled_x[k] * theta[k][i];
    theta[1].push_back(next);
    power_a *= beta_squared;
    delta = coefficient(a[y], i) * power_a;
    for (std::size_t k = 1; k <= n; ++k) delta -= scaled_y[k] * theta[k][i];
    if (delta.sign() != 0) {
      order = j;
      break;
    }
  }
  if (order == 0) return {0, 0.0, 0};
  // a[y] - b[y] = delta mu^order: with x to the right, a rises above b, which goes to the right
  // when beta > 0.
  const int sign = order % 2 == 0 ? 0 : delta.sign() * beta.sign() * (axis == 0 ? -1 : 1);

  // In doubles, in units of h and relative to |beta|: what stays of a - b beyond the order, with
  // all cancellation done exactly.
  constexpr double up = 1.0 + 0x1p-40;
  const auto r = at(order);
  std::vector<double> tau(r + 1, 0.0);  // |coefficients| of b's parameter
  Dyadic divisor = beta;                // beta^(2j-1)
  for (std::size_t j = 1; j <= r; ++j) {
    tau[j] = std::fabs(quotient(theta[1][j], divisor)) * up;
    divisor *= beta_squared;
  }
  std::array<std::vector<double>, 2> size_b;
  for (const std::size_t w : {x, y})
    for (const Dyadic& v : b[w]) size_b[w].push_back(std::fabs(quotient(v, beta)) * up);
  Dyadic beta_power = beta;  // delta / beta^(2 order) / beta
  for (int j = 0; j < order; ++j) beta_power *= beta_squared;
  const double leading = std::fabs(quotient(delta, beta_power)) / up;
  const Polynomial path(theta[1].begin(), theta[1].begin() + static_cast<std::ptrdiff_t>(r + 1));
  std::array<std::vector<double>, 2> rest;
  for (const std::size_t w : {x, y}) {
    Polynomial c = compose(w == x ? scaled_x : scaled_y, path);
    if (c.size() < a[w].size()) c.resize(a[w].size());
    // In mu; that of x is divided by beta^2.
    Dyadic factor = w == x ? Dyadic(1.0) : beta_squared;
    divisor = w == x ? beta : beta * beta_squared;  // beta^(2j+1), less 2 for x
    rest[w].assign(c.size(), 0.0);
    for (std::size_t j = 1; j < c.size(); ++j) {
      if (j > r) {
        Dyadic v = -c[j];
        if (j < a[w].size()) v += a[w][j] * factor;
        rest[w][j] = std::fabs(quotient(v, divisor)) * up;
      }
      factor *= beta_squared;
      divisor *= beta_squared;
    }
  }
  const auto sum = [](const std::vector<double>& c, double h, std::size_t from) {
    double s = 0.0;
    for (std::size_t j = c.size(); j-- > from;) s = s * h + c[j];
    return s * up;
  };
  double h = start;
  for (int i = 0; i < 200; ++i, h *= 0.5) {
    const double off = sum(rest[x], h, r + 1);
    const double off_power = off * std::pow(h, static_cast<double>(r + 1));
    const double t = 2.0 * (sum(tau, h, 0) + 4.0 * off_power);  // b's parameter stays within
    double speed = 1.0, along_y = 0.0;
    for (std::size_t k = n; k >= 2; --k)
      speed -= static_cast<double>(k) * size_b[x][k] * std::pow(t, static_cast<double>(k - 1)) * up;
    for (std::size_t k = 1; k <= n; ++k)
      along_y += static_cast<double>(k) * size_b[y][k] * std::pow(t, static_cast<double>(k - 1));
    if (!(speed > 0.25)) continue;
    // |a[x] - b[x]| <= off h^(r+1), so b's parameter is off by w <= off h^(r+1) / speed.
    const double w = off_power / speed * up;
    if (!(sum(tau, h, 0) + w <= t)) continue;
    if (leading > h * (sum(rest[y], h, r + 1) + along_y * up * off / speed) * up)
      return {order, h, sign};
  }
  return {order, 0.0, sign};
}

std::optional<bool> common_root(Polynomial f, Polynomial g, const Dyadic& lo, const Dyadic& hi) {
  trim(f);
  trim(g);
  if (f.size() > 13 || g.size() > 13) return std::nullopt;
  while (!g.empty()) {
    if (f.size() < g.size()) std::swap(f, g);
    if (g.empty()) break;
    // Pseudo-remainder, made small by a power of two.
    while (f.size() >= g.size() && !f.empty()) {
      const Dyadic lead = f.back();
      const std::size_t offset = f.size() - g.size();
      for (Dyadic& c : f) c *= g.back();
      for (std::size_t k = 0; k < g.size(); ++k) f[offset + k] -= lead * g[k];
      trim(f);
    }
    std::swap(f, g);
  }
  // f is the divisor of highest degree; its roots of odd order change its sign.
  if (f.empty()) return true;
  if (f.size() == 1) return false;
  const int a = value(f, lo).sign(), b = value(f, hi).sign();
  if (a == 0 || b == 0 || a != b) return true;
  return std::nullopt;
}

}  // namespace bezel::geometry_kernel
