// Computes the fully symmetric triangle rules of
// bezel/numeric/triangle_rule_table.hpp and prints the table. Not part of the
// build: c++ -O2 -std=c++20 -I/usr/include/eigen3 generate_triangle_rules.cpp
//
// Unknowns: per orbit of 1, 3, 6 points its weight and its 0, 1, 2 coordinates.
// Equations: a symmetric polynomial is one in e2 = l0 l1 + l1 l2 + l2 l0 and e3
// = l0 l1 l2, so exactness to degree p means the moments of e2^i e3^j, 2i + 3j
// <= p. Levenberg-Marquardt from random starts in long double; a solution
// counts when all weights are positive and all points inside.
#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

struct Orbits {
  int degree, ones, threes, sixes;
};

// Integral of l0^a l1^b l2^c over the triangle of area 1.
Real monomial(int a, int b, int c) {
  return 2 * std::exp(std::lgamma(a + 1.0L) + std::lgamma(b + 1.0L) + std::lgamma(c + 1.0L) -
                      std::lgamma(a + b + c + 3.0L));
}

// Integral of (3 e2)^i (27 e3)^j, by expansion; all terms are positive.
Real moment(int i, int j) {
  Real sum = 0;
  for (int p = 0; p <= i; ++p)
    for (int q = 0; p + q <= i; ++q) {  // (l0 l1)^p (l1 l2)^q (l2 l0)^r
      const int r = i - p - q;
      const Real count = std::round(std::exp(std::lgamma(i + 1.0L) - std::lgamma(p + 1.0L) -
                                             std::lgamma(q + 1.0L) - std::lgamma(r + 1.0L)));
      sum += count * monomial(p + r + j, p + q + j, q + r + j);
    }
  return sum * std::pow(3.0L, i) * std::pow(27.0L, j);
}

int main(int argc, char** argv) {
  const std::vector<Orbits> wanted{{6, 0, 2, 1},  {7, 0, 1, 2},  {8, 1, 3, 1},  {9, 1, 4, 1},
                                   {10, 1, 2, 3}, {11, 1, 5, 2}, {12, 0, 5, 3}, {13, 1, 6, 3},
                                   {14, 0, 6, 4}, {15, 1, 4, 6}, {16, 1, 6, 6}, {17, 0, 8, 6},
                                   {18, 1, 6, 9}, {19, 1, 8, 8}, {20, 1, 8, 9}};
  const int from = argc > 1 ? std::atoi(argv[1]) : 6, to = argc > 2 ? std::atoi(argv[2]) : 10;
  const int limit = argc > 3 ? std::atoi(argv[3]) : 20000;
  for (const Orbits& o : wanted) {
    if (o.degree < from || o.degree > to) continue;
    std::vector<std::pair<int, int>> powers;
    for (int j = 0; 3 * j <= o.degree; ++j)
      for (int i = 0; 2 * i + 3 * j <= o.degree; ++i) powers.push_back({i, j});
    const int rows = static_cast<int>(powers.size()), n = o.ones + 2 * o.threes + 3 * o.sixes;
    Vector exact(rows);
    for (int k = 0; k < rows; ++k) exact(k) = moment(powers[k].first, powers[k].second);
    const auto system = [&](const Vector& x, Vector& f, Matrix& jac) {
      f = -exact;
      jac.setZero(rows, n);
      const auto add = [&](Real m, Real w, Real e2, Real e3, int at_w, int at, int count,
                           const Real* d2, const Real* d3) {
        for (int k = 0; k < rows; ++k) {
          const auto [i, j] = powers[k];
          const Real p = std::pow(3 * e2, i), q = std::pow(27 * e3, j);
          f(k) += m * w * p * q;
          jac(k, at_w) += m * p * q;
          const Real by2 = i == 0 ? 0 : 3 * i * std::pow(3 * e2, i - 1) * q;
          const Real by3 = j == 0 ? 0 : 27 * j * std::pow(27 * e3, j - 1) * p;
          for (int c = 0; c < count; ++c) jac(k, at + c) += m * w * (by2 * d2[c] + by3 * d3[c]);
        }
      };
      int at = 0;
      if (o.ones) add(1, x(0), 1.0L / 3, 1.0L / 27, 0, 0, 0, nullptr, nullptr), ++at;
      for (int t = 0; t < o.threes; ++t, at += 2) {
        const Real a = x(at + 1), d2 = 2 - 6 * a, d3 = 2 * a - 6 * a * a;
        add(3, x(at), 2 * a - 3 * a * a, a * a * (1 - 2 * a), at, at + 1, 1, &d2, &d3);
      }
      for (int t = 0; t < o.sixes; ++t, at += 3) {
        const Real a = x(at + 1), b = x(at + 2), c = 1 - a - b;
        const Real d2[2] = {1 - 2 * a - b, 1 - a - 2 * b}, d3[2] = {b * (c - a), a * (c - b)};
        add(6, x(at), a * b + (a + b) * c, a * b * c, at, at + 1, 2, d2, d3);
      }
    };
    std::mt19937_64 random(static_cast<unsigned>(o.degree));
    const auto unit = [&] { return static_cast<Real>(random() >> 11) * 0x1p-53L; };
    const int points = o.ones + 3 * o.threes + 6 * o.sixes;
    bool found = false;
    for (int start = 0; start < limit && !found; ++start) {
      Vector x(n);
      int at = 0;
      if (o.ones) x(at++) = 1.0L / points;
      for (int t = 0; t < o.threes; ++t, at += 2) x(at) = 1.0L / points, x(at + 1) = 0.5L * unit();
      for (int t = 0; t < o.sixes; ++t, at += 3) {
        Real a = unit(), b = unit();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        x(at) = 1.0L / points, x(at + 1) = a, x(at + 2) = b;
      }
      Real damping = 1e-3L;
      Vector f, trial_f;
      Matrix jac, trial_jac;
      system(x, f, jac);
      for (int step = 0; step < 150 && f.norm() > 1e-18L; ++step) {
        Matrix normal = jac.transpose() * jac;
        normal.diagonal() *= 1 + damping;
        normal.diagonal().array() += 1e-22L;
        Vector dx;
        if (f.norm() < 1e-6L)
          dx = -jac.completeOrthogonalDecomposition().solve(f);
        else
          dx = -normal.ldlt().solve(jac.transpose() * f);
        const Vector y = x + dx;
        system(y, trial_f, trial_jac);
        if (trial_f.norm() < f.norm()) {
          x = y, f = trial_f, jac = trial_jac;
          damping = std::max(damping / 5, 1e-12L);
        } else {
          damping *= 4;
          if (damping > 1e6L || f.norm() < 1e-6L) break;
        }
      }
      if (!(f.norm() < 5e-18L)) continue;
      found = true;
      at = 0;
      if (o.ones && !(x(at++) > 0)) found = false;
      for (int t = 0; t < o.threes; ++t, at += 2)
        if (!(x(at) > 0 && x(at + 1) > 1e-4L && x(at + 1) < 0.4999L)) found = false;
      for (int t = 0; t < o.sixes; ++t, at += 3)
        if (!(x(at) > 0 && x(at + 1) > 1e-4L && x(at + 2) > 1e-4L &&
              x(at + 1) + x(at + 2) < 0.9999L))
          found = false;
      if (!found) continue;
      std::fprintf(stderr, "degree %d: %d points, start %d, residual %.2Lg\n", o.degree, points,
                   start, f.norm());
      // weights for area 1/2
      std::printf("    {%d, %d, %d, %d,\n     {", o.degree, o.ones, o.threes, o.sixes);
      at = 0;
      std::vector<Real> out;
      if (o.ones) out.push_back(x(at++) / 2);
      for (int t = 0; t < o.threes; ++t, at += 2)
        out.push_back(x(at) / 2), out.push_back(x(at + 1));
      for (int t = 0; t < o.sixes; ++t, at += 3)
        out.push_back(x(at) / 2), out.push_back(x(at + 1)), out.push_back(x(at + 2));
      for (std::size_t k = 0; k < out.size(); ++k)
        std::printf("%.20Lg%s", out[k], k + 1 < out.size() ? ", " : "}},\n");
      std::fflush(stdout);
    }
    if (!found) std::fprintf(stderr, "degree %d: none found\n", o.degree);
  }
}
