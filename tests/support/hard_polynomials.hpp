#pragma once
// Polynomials and parameters that are hard to evaluate: clustered roots, values cancelled to any
// condition number, exact zeros, values next to powers of two, extreme and mixed magnitudes.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "support/exact_values.hpp"

namespace support {

/// Coefficients and a parameter where something is hard about them.
struct Hard {
  std::vector<double> b;
  double s = 0.0;
};

class HardPolynomials {
 public:
  using Doubles = std::vector<double>;

  /// @param extreme  magnitudes from 2^-1074 to below 2^1024; otherwise nothing underflows unless
  ///                 the parameters are tiny
  HardPolynomials(std::uint64_t seed, bool extreme) : random_(seed), extreme_(extreme) {}

  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double signed_one() { return below(2) == 0 ? 1.0 : -1.0; }
  /// +-[1, 2), all bits random.
  double mantissa() { return signed_one() * (1.0 + unit()); }
  /// Small ones more often.
  int degree(int largest) {
    const double x = unit();
    return 1 + static_cast<int>(x * x * x * largest);
  }

  /// In [0, 1], often near 0, 1/2, 1 or with few bits.
  double parameter() {
    switch (below(12)) {
      case 0:
        return std::ldexp(unit(), -below(60));
      case 1:
        return 1.0 - std::ldexp(unit(), -below(54));
      case 2:
        return 0.5 + std::ldexp(unit() - 0.5, -below(54));
      case 3:
        return static_cast<double>(below(257)) / 256.0;
      case 4:
        return special();
      default:
        return unit();
    }
  }
  double special() {
    static constexpr double some[] = {
        0.0, 1.0,     -0.0,    0x1p-1074,   0x1p-1022,   0x1p-600,    0x1p-60, 0x1p-20,
        0.5, 0x1p-26, 0x1p-27, 1 - 0x1p-53, 1 - 0x1p-52, 1 - 0x1p-30, 0.25,    0.75};
    return some[below(16)];
  }
  /// Outside [0, 1], moderately or far.
  double outside() {
    const double x = below(4) == 0 ? std::ldexp(unit(), below(100) - 50) : 4.0 * unit();
    return below(2) == 0 ? -x : 1.0 + x;
  }

  Hard draw(int n) {
    Hard h;
    switch (below(11)) {
      case 0:
        h = {coefficients(n), parameter()};
        break;
      case 1:
        h = near_root(n);
        break;
      case 2:
        h = integer_zero(n);
        break;
      case 3:
        h = nearly_constant(n);
        break;
      case 4:
        h = sparse(n);
        break;
      case 5:
      case 6:
        h = near_binade(n);
        break;
      case 7:
        h = vanishing(n);
        break;
      default:
        h = cancelled(n);
    }
    if (extreme_ && below(3) == 0) rescale(h);
    return h;
  }

  /// The hard parameter, its neighbours, and others.
  Doubles parameters(const Hard& h, int count) {
    Doubles s;
    const int mix = below(4);  // 0: hard ones only, 3: mostly others
    for (int q = 0; q < count; ++q) {
      const int kind = below(16);
      if (kind < 3 * mix)
        s.push_back(parameter());
      else if (kind < 10)
        s.push_back(h.s);
      else if (kind < 12)
        s.push_back(std::nextafter(h.s, below(2) == 0 ? 2.0 : -1.0));
      else if (kind < 15)
        s.push_back(h.s * (1.0 + std::ldexp(unit() - 0.5, -below(53))));
      else
        s.push_back(below(4) == 0 ? outside() : special());
    }
    return s;
  }

  /// Random: of one size, of wide range, or with alternating signs.
  Doubles coefficients(int n) {
    Doubles b(static_cast<std::size_t>(n) + 1);
    const int kind = below(4), range = 1 + below(extreme_ ? 1000 : 60);
    for (std::size_t j = 0; j < b.size(); ++j) {
      switch (kind) {
        case 0:
          b[j] = 2.0 * unit() - 1.0;
          break;
        case 1:
          b[j] = std::ldexp(mantissa(), below(2 * range + 1) - range);
          break;
        case 2:
          b[j] = (j % 2 == 0 ? 1.0 : -1.0) * (1.0 + unit());
          break;
        default:
          b[j] = below(8) == 0 ? 0.0 : mantissa();
      }
    }
    return b;
  }

  /// A root of any multiplicity at a random double, times random linear factors; s near the root.
  Hard near_root(int n) {
    const double root = below(4) == 0 ? static_cast<double>(1 + below(15)) / 16.0 : parameter();
    const int multiplicity = 1 + below(n);
    std::vector<long double> b{1.0L};
    for (int m = 1; m <= n; ++m) {
      const bool at_root = m <= multiplicity;
      const long double low = at_root ? -root : static_cast<long double>(mantissa());
      const long double high = at_root ? 1.0L - root : static_cast<long double>(mantissa());
      b.push_back(0.0L);
      for (std::size_t j = b.size(); j-- > 0;) {
        const long double part = static_cast<long double>(j) / m;
        b[j] = (1.0L - part) * low * b[j] + (j > 0 ? part * high * b[j - 1] : 0.0L);
      }
    }
    Hard h;
    for (const long double x : b) h.b.push_back(static_cast<double>(x));
    h.s = root + std::ldexp(unit() - 0.5, -below(53));
    return h;
  }

  /// p(s) = 0 exactly, or off by one last place of a coefficient.
  Hard integer_zero(int n) {
    const int k = 1 + below(std::max(1, std::min(4, 40 / n)));
    // s = 2^-k: the sum of b_j C(n,j) (2^k - 1)^(n-j) vanishes when b_n is the others' negative
    // sum.
    Hard h{Doubles(static_cast<std::size_t>(n) + 1), std::ldexp(1.0, -k)};
    mpz_class sum, scale;
    for (int j = 0; j < n; ++j) {
      const int value = below(n > 40 ? 2 : 9) - (n > 40 ? 0 : 4);
      h.b[static_cast<std::size_t>(j)] = value;
      mpz_ui_pow_ui(scale.get_mpz_t(), (1UL << k) - 1, static_cast<unsigned long>(n - j));
      sum += value * binomial(n, j) * scale;
    }
    h.b.back() = -sum.get_d();
    if (below(4) == 0) {
      double& one = h.b[static_cast<std::size_t>(below(n + 1))];
      one = std::nextafter(one, HUGE_VAL);
    }
    if (below(2) == 0) {
      std::reverse(h.b.begin(), h.b.end());
      h.s = 1.0 - h.s;
    }
    return h;
  }

  /// Tiny powers of s (or 1-s) times coefficients that make up for them, their sum cancelled: where
  /// errors of products underflow, and matter.
  Hard vanishing(int n) {
    const int terms = 2 + below(std::min(n, 3));
    const bool reversed = below(4) == 0;
    const int largest_power = reversed ? 50 : extreme_ ? 1800 / (terms - 1) : 30;
    const int power = 1 + below(std::min(1060, largest_power));
    const int first = below(std::min(n - terms + 1, extreme_ ? 900 / power : 4) + 1);
    Hard h{Doubles(static_cast<std::size_t>(n) + 1), std::ldexp(1.0 + unit(), -power)};
    if (reversed) h.s = std::ldexp(std::round(std::ldexp(h.s, 53)), -53);
    std::vector<int> usable;
    for (int i = 0; i < terms; ++i) {
      const int exponent = power * i - power * (terms - 1) / 2;
      h.b[static_cast<std::size_t>(first + i)] = std::ldexp(mantissa(), exponent);
      if (i > 0) usable.push_back(first + i);
    }
    if (below(4) > 0) {
      Number target =
          Number(mantissa()) * power_of(h.s, first) * Number(h.b[static_cast<std::size_t>(first)]);
      target.e -= below(120);
      if (below(2) == 0) std::reverse(usable.begin(), usable.end());
      solve(h, target, usable);
    }
    if (reversed) {
      std::reverse(h.b.begin(), h.b.end());
      h.s = 1.0 - h.s;
    }
    return h;
  }

  Hard nearly_constant(int n) {
    Hard h{Doubles(static_cast<std::size_t>(n) + 1, below(2) == 0 ? 1.0 : mantissa()), parameter()};
    const int spread = below(4);
    for (double& x : h.b)
      for (int i = below(spread + 1); i > 0; --i) x = std::nextafter(x, signed_one() * HUGE_VAL);
    return h;
  }

  /// Many zero coefficients; with a tiny s or 1-s the value is tiny as well.
  Hard sparse(int n) {
    Hard h{Doubles(static_cast<std::size_t>(n) + 1), parameter()};
    for (int i = 1 + below(3); i > 0; --i) h.b[static_cast<std::size_t>(below(n + 1))] = mantissa();
    if (below(2) == 0) h.s = std::ldexp(1.0 + unit(), -1 - below(extreme_ ? 1000 : 30));
    return h;
  }

  /// |p(s)| within 2 u of a power of two, or a double, or the middle of two.
  Hard near_binade(int n) {
    Hard h{coefficients(n), parameter()};
    const double scale = signed_one() * std::ldexp(1.0, below(7) - 3);
    Number target;
    switch (below(3)) {
      case 0:
        target = Number(scale) * (Number(1.0) + Number(std::ldexp(4.0 * unit() - 2.0, -53)));
        break;
      case 1:
        target = Number(scale * (1.0 + unit()));
        break;
      default:
        target = Number(scale * (1.0 + unit())) + Number(std::ldexp(scale, -53));
    }
    solve(h, target, 1 + below(3));
    return h;
  }

  /// p(s) = p~(s) / cond with any cond up to 2^200, the thresholds of twice, three times and four
  /// times the working precision more often.
  Hard cancelled(int n) {
    Hard h{coefficients(n), parameter()};
    double bits = 200.0 * unit();
    const double N = n;
    if (below(3) > 0) {
      const double multipliers[] = {2000 * N * N, 3 * N * (3 * N + 7) / 2,
                                    3 * N * (3 * N * N + 36 * N + 61) / 2, std::pow(3 * N, 4) / 24};
      const int K = 2 + below(3);
      const double multiplier = multipliers[K == 2 ? below(2) : K - 1];
      bits = 53.0 * (K - 1) - std::log2(multiplier) + 16.0 * unit() - 8.0;
    }
    double absolute = 0.0;
    for (int j = 0; j <= n; ++j)
      absolute += std::fabs(h.b[static_cast<std::size_t>(j)]) * basis_double(n, j, h.s);
    if (!(absolute > 0.0) || std::isinf(absolute)) return h;
    // Most is cancelled by one coefficient, which doubles p~.
    Number target = Number(2.0 * absolute) * Number(mantissa());
    target.e -= static_cast<long>(std::lround(bits));
    solve(h, target, 2 + static_cast<int>(bits / 52.0));
    return h;
  }

  /// Makes p(s) as near to the target as `corrections` random coefficients allow.
  void solve(Hard& h, const Number& target, int corrections) {
    const int n = static_cast<int>(h.b.size()) - 1;
    double largest = 0.0;
    std::vector<int> usable;
    for (int j = 0; j <= n; ++j) largest = std::fmax(largest, basis_double(n, j, h.s));
    for (int j = 0; j <= n; ++j)
      if (basis_double(n, j, h.s) > 0x1p-40 * largest) usable.push_back(j);
    std::shuffle(usable.begin(), usable.end(), random_);
    usable.resize(std::min(usable.size(), static_cast<std::size_t>(corrections)));
    solve(h, target, usable);
  }
  /// The same with the given coefficients, in turn.
  void solve(Hard& h, const Number& target, const std::vector<int>& usable) {
    const int n = static_cast<int>(h.b.size()) - 1;
    const Number s(h.s), r = Number(1.0) - s;
    if (s.sign() == 0 || r.sign() == 0) return;
    for (const int j : usable) h.b[static_cast<std::size_t>(j)] = 0.0;
    Number missing = target;
    std::vector<Number> s_power{Number(1.0)}, r_power{Number(1.0)};
    for (int j = 1; j <= n; ++j) {
      s_power.push_back(s_power.back() * s);
      r_power.push_back(r_power.back() * r);
    }
    const auto value = [&](int j) {
      const Number product =
          s_power[static_cast<std::size_t>(j)] * r_power[static_cast<std::size_t>(n - j)];
      return Number(binomial(n, j) * product.m, product.e);
    };
    for (int j = 0; j <= n; ++j) {
      const double b = h.b[static_cast<std::size_t>(j)];
      if (b != 0.0) missing = missing - Number(b) * value(j);
    }
    for (const int j : usable) {
      if (missing.sign() == 0) break;
      const Number here = value(j);
      double& b = h.b[static_cast<std::size_t>(j)];
      b = quotient(missing, here);
      if (!std::isfinite(b)) b = 0.0;
      missing = missing - Number(b) * here;
    }
  }

  /// Times a power of two: the value or the largest coefficient comes near a limit of the doubles.
  void rescale(Hard& h) {
    double top = 0.0;
    for (const double x : h.b) top = std::fmax(top, std::fabs(x));
    if (!(top > 0.0)) return;
    const int highest = 1024 - (std::ilogb(top) + 1);
    int shift = 0;
    switch (below(4)) {
      case 0:
        shift = highest - below(4);
        break;
      case 1:
        shift = -1074 - std::ilogb(top) + below(200);
        break;
      case 2:
        shift = -969 - std::ilogb(top) + below(400) - 100;
        break;
      default: {
        // The value becomes subnormal or just not.
        const Number p = ExactValues(h.b)(h.s);
        if (p.sign() == 0) return;
        const auto bits = static_cast<long>(mpz_sizeinbase(p.m.get_mpz_t(), 2)) + p.e;
        shift = static_cast<int>(-1080 + below(80) - bits);
      }
    }
    shift = std::min(shift, highest);
    for (double& x : h.b) x = std::ldexp(x, shift);
  }

 private:
  static Number power_of(double x, int n) { return power(Number(x), n); }
  static double basis_double(int n, int j, double s) {
    return binomial(n, j).get_d() * std::pow(std::fabs(s), j) * std::pow(std::fabs(1.0 - s), n - j);
  }
  /// a / b truncated to 53 bits.
  static double quotient(const Number& a, const Number& b) {
    const auto bits = [](const Number& x) {
      return static_cast<long>(mpz_sizeinbase(x.m.get_mpz_t(), 2));
    };
    const long more = std::max(0L, 64 + bits(b) - bits(a));
    mpz_class q;
    mpz_tdiv_q(q.get_mpz_t(), shifted(a.m, more).get_mpz_t(), b.m.get_mpz_t());
    return static_cast<double>(approximate({q, a.e - more - b.e}));
  }

  std::mt19937_64 random_;
  bool extreme_;
};

}  // namespace support
