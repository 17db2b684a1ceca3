#include "bezel/geometry/exact_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bezel/bernstein/exact.hpp"

namespace bezel::geometry_kernel {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// c becomes the coefficients about `centre`.
void shift(std::vector<Dyadic>& c, const Dyadic& centre) {
  const std::size_t n = c.size() - 1;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = n; k-- > i;) c[k] += centre * c[k + 1];
}

void trim(std::vector<Dyadic>& c) {
  while (!c.empty() && c.back().sign() == 0) c.pop_back();
}

Dyadic value(const std::vector<Dyadic>& c, const Dyadic& x) {
  Dyadic h;
  for (std::size_t k = c.size(); k-- > 0;) h = h * x + c[k];
  return h;
}

/// Magnitude of a product of double polynomials, truncated to `size` coefficients.
std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b,
                            std::size_t size) {
  std::vector<double> out(std::min(size, a.size() + b.size() - 1), 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size() && i + k < out.size(); ++k) out[i + k] += a[i] * b[k];
  return out;
}

}  // namespace

ExactCurve::ExactCurve(std::span<const Vec2> control, std::int64_t exponent) {
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<Dyadic> b;
    for (const Vec2& p : control) b.push_back(Dyadic(p[axis]).scaled(-exponent));
    const bernstein::ExactPolynomial polynomial{std::span<const Dyadic>(b)};
    c_[at(axis)].assign(polynomial.monomial().begin(), polynomial.monomial().end());
  }
  while (c_[0].size() > 1 && c_[0].back().sign() == 0 && c_[1].back().sign() == 0) {
    c_[0].pop_back();
    c_[1].pop_back();
  }
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
  const auto coefficient = [](const std::vector<Dyadic>& c, std::size_t k) {
    return k < c.size() ? c[k] : Dyadic();
  };
  // With h = beta^2 mu and b's parameter beta theta(mu), b[x] = a[x] reads
  //   theta + sum_{k>=2} b_k beta^(k-2) theta^k = sum a_k beta^(2k-2) mu^k:
  // theta has exact coefficients. delta = a[y] - b[y] in powers of mu follows.
  const std::size_t n = b[x].size() - 1;
  std::vector<Dyadic> scaled_x{Dyadic(), Dyadic(1.0)}, scaled_y{Dyadic(), b[y][1] * beta};
  Dyadic power = 1.0;
  for (std::size_t k = 2; k <= n; ++k) {
    scaled_x.push_back(b[x][k] * power);
    power *= beta;
    scaled_y.push_back(b[y][k] * power * beta);
  }
  std::vector<std::vector<Dyadic>> theta(n + 1);  // theta[k]: coefficients of theta^k
  for (auto& t : theta) t.emplace_back();         // all without a constant term
  Dyadic power_a = 1.0, delta;                    // beta^(2j-2)
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
  if (order == 0) return {0, 0.0};

  // In doubles, in units of h: majorants of what stays beyond the order.
  constexpr double up = 1.0 + 0x1p-40;
  const auto r = at(order);
  std::vector<double> tau(r + 1, 0.0);  // |coefficients| of b's parameter
  Dyadic divisor = beta;                // beta^(2j-1)
  for (std::size_t j = 1; j <= r; ++j) {
    tau[j] = std::fabs(quotient(theta[1][j], divisor)) * up;
    divisor *= beta_squared;
  }
  // All relative to |beta|.
  std::array<std::vector<double>, 2> size_a, size_b;
  for (const std::size_t w : {x, y}) {
    for (const Dyadic& v : a[w]) size_a[w].push_back(std::fabs(quotient(v, beta)) * up);
    for (const Dyadic& v : b[w]) size_b[w].push_back(std::fabs(quotient(v, beta)) * up);
  }
  Dyadic beta_power = beta;  // delta / beta^(2 order) / beta
  for (int j = 0; j < order; ++j) beta_power *= beta_squared;
  const double leading = std::fabs(quotient(delta, beta_power)) / up;
  const std::size_t full = std::max(size_a[0].size(), n * r + 1);
  std::array<std::vector<double>, 2> rest;
  for (const std::size_t w : {x, y}) {
    std::vector<double> composed{size_b[w][n]};
    for (std::size_t k = n; k-- > 1;) {
      composed = product(composed, tau, full);
      composed[0] += size_b[w][k];
    }
    composed = product(composed, tau, full);
    composed.resize(full, 0.0);
    for (std::size_t j = 0; j < size_a[w].size(); ++j) composed[j] += size_a[w][j];
    for (std::size_t j = 0; j <= r; ++j) composed[j] = 0.0;
    rest[w] = composed;
  }
  const auto sum = [up](const std::vector<double>& c, double h, std::size_t from) {
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
    for (std::size_t k = n; k >= 2; --k) speed -= static_cast<double>(k) * size_b[x][k] *
                                                  std::pow(t, static_cast<double>(k - 1)) * up;
    for (std::size_t k = 1; k <= n; ++k)
      along_y += static_cast<double>(k) * size_b[y][k] * std::pow(t, static_cast<double>(k - 1));
    if (!(speed > 0.25)) continue;
    // |a[x] - b[x]| <= off h^(r+1), so b's parameter is off by w <= off h^(r+1) / speed.
    const double w = off_power / speed * up;
    if (!(sum(tau, h, 0) + w <= t)) continue;
    if (leading > h * (sum(rest[y], h, r + 1) + along_y * up * off / speed) * up)
      return {order, h};
  }
  return {order, 0.0};
}

std::optional<bool> common_root(std::vector<Dyadic> f, std::vector<Dyadic> g, const Dyadic& lo,
                                const Dyadic& hi) {
  trim(f);
  trim(g);
  if (f.size() > 13 || g.size() > 13) return std::nullopt;
  while (!g.empty()) {
    if (f.size() < g.size()) std::swap(f, g);
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
