#pragma once
// Exact values for the studies: errors and condition numbers from them are right to the last digits
// shown.

#include <cmath>
#include <vector>

#include "bezel/bernstein/exact.hpp"
#include "bezel/numeric/dyadic.hpp"

namespace bezel::cli {

inline Dyadic magnitude(const Dyadic& x) {
  return x.sign() < 0 ? -x : x;
}

/// |value - exact| / |exact|; infinite when only exact is zero.
inline double relative_error(double value, const Dyadic& exact) {
  const Dyadic error = magnitude(Dyadic(value) - exact);
  return error.sign() == 0 ? 0.0 : error.to_double() / magnitude(exact).to_double();
}

/// A Bernstein polynomial's exact value and p~, the value of sum |b_j| B_j.
class ExactValues {
 public:
  explicit ExactValues(const std::vector<double>& b) : p_(b), absolute_(absolute(b)) {}
  Dyadic value(double s) const { return p_(Dyadic(s)); }
  /// cond(p, s) = p~ / |p|, s in [0, 1].
  double condition(double s) const { return absolute_sum(s) / magnitude(value(s)).to_double(); }
  double absolute_sum(double s) const { return absolute_(Dyadic(s)).to_double(); }

 private:
  static std::vector<double> absolute(std::vector<double> b) {
    for (double& x : b) x = std::fabs(x);
    return b;
  }
  bernstein::ExactPolynomial p_, absolute_;
};

/// `count` points from lo to hi as numpy.linspace rounds them.
inline std::vector<double> linspace(double lo, double hi, int count) {
  std::vector<double> s;
  const double step = (hi - lo) / (count - 1);
  for (int j = 0; j < count; ++j) s.push_back(j * step + lo);
  s.back() = hi;
  return s;
}

}  // namespace bezel::cli
