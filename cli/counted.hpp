#pragma once
// The K-fold compensated de Casteljau algorithm on numbers that count their operations. The library
// has it on plain doubles (bezel/bernstein/compensated_kernel.hpp); this copy, written from
// [hermes2018, algorithms 5.2 and 5.3], measures its cost, and its values must be the same bits.

#include <cmath>
#include <vector>

namespace bezel::cli::counting {

/// Operations of one evaluation.
struct Tally {
  int flops = 0;      ///< sums, differences, products and fused products, each as one
  int two_prods = 0;  ///< products with their error
};

/// A double whose operations are counted. Changing the sign is free.
struct Counted {
  double v = 0.0;
  static inline Tally tally;
};
inline Counted counted(double v) {
  ++Counted::tally.flops;
  return {v};
}
inline Counted operator+(Counted a, Counted b) {
  return counted(a.v + b.v);
}
inline Counted operator-(Counted a, Counted b) {
  return counted(a.v - b.v);
}
inline Counted operator*(Counted a, Counted b) {
  return counted(a.v * b.v);
}
inline Counted operator-(Counted a) {
  return {-a.v};
}

struct CountedWithError {
  Counted value, error;
};

inline CountedWithError two_sum(Counted a, Counted b) {
  const Counted s = a + b, z = s - a;
  return {s, (a - (s - z)) + (b - z)};
}

/// How the error of a product is found.
enum class Product { fused, dekker };

inline CountedWithError two_prod(Counted a, Counted b, Product how) {
  ++Counted::tally.two_prods;
  const Counted p = a * b;
  if (how == Product::fused) return {p, counted(std::fma(a.v, b.v, -p.v))};
  const auto split = [](Counted x) {  // upper and lower half of the digits
    const Counted c = Counted{0x1p27 + 1.0} * x, high = c - (c - x);
    return CountedWithError{high, x - high};
  };
  const CountedWithError x = split(a), y = split(b);
  return {p,
          x.error * y.error - (((p - x.value * y.value) - x.error * y.value) - x.value * y.error)};
}

inline Counted sum_k(std::vector<Counted> p, int K) {
  for (int pass = 1; pass < K; ++pass)
    for (std::size_t j = 1; j < p.size(); ++j) {
      const CountedWithError t = two_sum(p[j], p[j - 1]);
      p[j] = t.value;
      p[j - 1] = t.error;
    }
  Counted sum = p[0];
  for (std::size_t j = 1; j < p.size(); ++j) sum = sum + p[j];
  return sum;
}

/// p(s), K >= 2; Counted::tally tells the operations.
inline double evaluate_counted(const std::vector<double>& b, double s_, int K, Product how) {
  Counted::tally = {};
  const Counted s{s_};
  const auto levels = static_cast<std::size_t>(K);
  const CountedWithError r = two_sum(Counted{1.0}, -s);
  std::vector<std::vector<Counted>> level(levels, std::vector<Counted>(b.size()));
  for (std::size_t j = 0; j < b.size(); ++j) level[0][j] = {b[j]};
  for (std::size_t k = b.size() - 1; k-- > 0;) {
    for (std::size_t j = 0; j <= k; ++j) {
      const CountedWithError p1 = two_prod(r.value, level[0][j], how);
      const CountedWithError p2 = two_prod(s, level[0][j + 1], how);
      const CountedWithError sum = two_sum(p1.value, p2.value);
      std::vector<Counted> e = {p1.error, p2.error, sum.error};
      Counted below = level[0][j];
      level[0][j] = sum.value;
      for (std::size_t f = 1; f + 1 < levels; ++f) {
        std::vector<Counted> eta;  // local_error_eft, then three more terms
        Counted l = e[0];
        const auto add = [&](Counted term) {
          const CountedWithError t = two_sum(l, term);
          l = t.value;
          eta.push_back(t.error);
        };
        const auto add_product = [&](Counted factor, Counted term) {
          const CountedWithError p = two_prod(factor, term, how);
          eta.push_back(p.error);
          add(p.value);
        };
        for (std::size_t i = 1; i < e.size(); ++i) add(e[i]);
        add_product(r.error, below);
        add_product(s, level[f][j + 1]);
        below = level[f][j];
        add_product(r.value, below);
        level[f][j] = l;
        e = eta;
      }
      Counted l = e[0];
      for (std::size_t i = 1; i < e.size(); ++i) l = l + e[i];
      l = l + r.error * below;
      std::vector<Counted>& last = level[levels - 1];
      last[j] = (l + s * last[j + 1]) + r.value * last[j];
    }
  }
  std::vector<Counted> parts;
  for (std::size_t f = 0; f < levels; ++f) parts.push_back(level[f][0]);
  return sum_k(parts, K).v;
}

}  // namespace bezel::cli::counting
