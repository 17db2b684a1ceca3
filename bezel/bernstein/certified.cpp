// Certified evaluation: a level for all points, the failing ones packed for the next level.

#include "bezel/bernstein/certified.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bezel/bernstein/certified_batch.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "bezel/bernstein/compensated_batch.hpp"
#include "bezel/bernstein/exact.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/numeric/eft.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::bernstein {
namespace {

using short_names::infinity;
using short_names::u;

constexpr double smallest_kept = 0x1p-960;  // of scaled results: below, their bounds are subnormal
constexpr double underflow_bound = 0x1p-1000;  // of all underflows together, coefficients near 1

CertifiedValue exact_value(const ExactPolynomial& p, double s) {
  const Dyadic exact = p(Dyadic(s));
  const double value = exact.to_double();
  if (!std::isfinite(value)) return {value, infinity, Certificate::exact};
  const double error = std::fabs((exact - Dyadic(value)).to_double());
  const bool same = exact == Dyadic(value);
  return {value, same ? 0.0 : std::nextafter(error, infinity), Certificate::exact};
}

class Evaluation {
 public:
  Evaluation(std::span<const double> b, std::span<const double> s, std::span<double> value,
             std::span<double> bound, std::span<Certificate> certificate)
      : b_(b),
        d_(static_cast<int>(b.size()) - 1),
        s_(s),
        value_(value),
        bound_(bound),
        certificate_(certificate) {}

  void run() {
    double magnitude = 0.0;
    for (const double c : b_) magnitude = std::max(magnitude, std::fabs(c));
    if (magnitude == 0.0 || d_ == 0) {
      for (std::size_t q = 0; q < s_.size(); ++q) put(q, {b_[0], 0.0, Certificate::doubled});
      return;
    }
    // The levels work near 1, far from under- and overflow; powers of two scale exactly, or lose
    // what underflow_bound covers.
    exponent_ = std::ilogb(magnitude);
    if (exponent_ >= -30 && exponent_ < 30) exponent_ = 0;
    for (std::size_t j = 0; j < b_.size(); ++j)
      scaled_[j] = exponent_ == 0 ? b_[j] : std::ldexp(b_[j], -exponent_);

    std::vector<std::size_t> left = doubled();
    if (!left.empty()) left = reflected(left);
    for (int K = 3; K <= 4 && !left.empty(); ++K) left = folded(left, K);
    left.insert(left.end(), exact_only_.begin(), exact_only_.end());
    if (left.empty()) return;
    const ExactPolynomial exact(b_);
    for (const std::size_t q : left) put(q, exact_value(exact, s_[q]));
  }

 private:
  void put(std::size_t q, const CertifiedValue& v) {
    value_[q] = v.value;
    if (!bound_.empty()) bound_[q] = v.error_bound;
    if (!certificate_.empty()) certificate_[q] = v.certificate;
  }

  /// Undoes the scaling; false when the result or its bound might be subnormal and rounded again.
  bool put_scaled(std::size_t q, double value, double bound, Certificate certificate) {
    if (exponent_ != 0) {
      value = std::ldexp(value, exponent_);
      bound = std::nextafter(std::ldexp(bound, exponent_), infinity);
    }
    if (!(std::fabs(value) >= smallest_kept && std::fabs(value) < infinity)) return false;
    put(q, {value, bound, certificate});
    return true;
  }

  std::vector<std::size_t> doubled() {
    const DoubledForm form = doubled_form(d_, scaled_.data(), false);
    s_max_ = form.s_max;
    if (!certificate_.empty())
      std::fill(certificate_.begin(), certificate_.end(), Certificate::doubled);
    constexpr std::size_t block = 512;
    std::array<std::size_t, block> failed;
    std::vector<std::size_t> left;
    for (std::size_t first = 0; first < s_.size(); first += block) {
      const std::size_t here = std::min(block, s_.size() - first);
      const std::size_t failures =
          evaluate_doubled(form, s_.data() + first, here, value_.data() + first,
                           bound_.empty() ? nullptr : bound_.data() + first, failed.data());
      for (std::size_t i = 0; i < failures; ++i) left.push_back(first + failed[i]);
    }
    if (exponent_ == 0) return left;
    // Rarely needed: scale back, point by point.
    std::size_t next = 0;
    for (std::size_t q = 0; q < s_.size(); ++q) {
      if (next < left.size() && left[next] == q) {
        ++next;
      } else if (!put_scaled(q, value_[q], bound_.empty() ? 0.0 : bound_[q],
                             Certificate::doubled)) {
        exact_only_.push_back(q);
      }
    }
    return left;
  }

  /// End points are exact, points outside [0, 1] go to exact arithmetic, and what failed only
  /// because it is near 1 is tried from the other end.
  std::vector<std::size_t> reflected(const std::vector<std::size_t>& points) {
    std::vector<std::size_t> left, near_one;
    for (const std::size_t q : points) {
      const double s = s_[q];
      if (s == 0.0 || s == 1.0) {
        put(q, {s == 0.0 ? b_.front() : b_.back(), 0.0, Certificate::doubled});
      } else if (!(s > 0.0 && s < 1.0)) {
        exact_only_.push_back(q);
      } else {
        (s > s_max_ ? near_one : left).push_back(q);
      }
    }
    if (near_one.empty()) return left;
    const DoubledForm form = doubled_form(d_, scaled_.data(), true);
    std::vector<double> t, value(near_one.size()), bound(near_one.size());
    for (const std::size_t q : near_one) t.push_back(1.0 - s_[q]);  // exact: s_max >= 1/2
    std::vector<std::size_t> failed(near_one.size());
    failed.resize(
        evaluate_doubled(form, t.data(), t.size(), value.data(), bound.data(), failed.data()));
    std::size_t next = 0;
    for (std::size_t i = 0; i < near_one.size(); ++i) {
      if (next < failed.size() && failed[next] == i) {
        ++next;
        left.push_back(near_one[i]);
      } else if (!put_scaled(near_one[i], value[i], bound[i], Certificate::doubled)) {
        exact_only_.push_back(near_one[i]);
      }
    }
    return left;
  }

  /// The K-fold compensated de Casteljau algorithm, its levels summed without loss.
  std::vector<std::size_t> folded(const std::vector<std::size_t>& points, int K) {
    const std::size_t n = points.size();
    std::vector<double> s, levels(n * static_cast<std::size_t>(K)), absolute(n), magnitudes;
    for (const std::size_t q : points) s.push_back(s_[q]);
    for (std::size_t j = 0; j < b_.size(); ++j) magnitudes.push_back(std::fabs(scaled_[j]));
    compensated_point_levels(d_, scaled_.data(), s.data(), n, K, levels.data());
    evaluate(magnitudes, s, absolute);
    double factor = error_multiplier(d_, K) * (1.0 + 0x1p-30);
    for (int f = 0; f < K; ++f) factor *= u;
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < n; ++i) {
      double v[4];  // last level first: after the passes of vec_sum the total is at the end
      for (int f = 0; f < K; ++f) v[K - 1 - f] = levels[static_cast<std::size_t>(f) * n + i];
      for (int pass = 1; pass < K; ++pass)
        for (int f = 1; f < K; ++f) {
          const WithError t = two_sum(v[f], v[f - 1]);
          v[f] = t.value;
          v[f - 1] = t.error;
        }
      // p = v[K-1] + v[K-2] + rest, |rest| <= below; v[K-1] is v[K-1] + v[K-2] rounded to nearest.
      double below = factor * absolute[i] + underflow_bound;
      for (int f = 0; f + 2 < K; ++f) below += std::fabs(v[f]);
      below *= 1.0 + 0x1p-50;
      const double value = v[K - 1];
      const auto certificate = K == 3 ? Certificate::tripled : Certificate::quadrupled;
      if (!(std::fabs(value) * (0.5 * u) > below)) {
        left.push_back(points[i]);
      } else if (!put_scaled(points[i], value, (std::fabs(v[K - 2]) + below) * (1.0 + 2 * u),
                             certificate)) {
        exact_only_.push_back(points[i]);
      }
    }
    return left;
  }

  std::span<const double> b_;
  int d_;
  std::span<const double> s_;
  std::span<double> value_, bound_;
  std::span<Certificate> certificate_;
  int exponent_ = 0;
  double s_max_ = 1.0;
  std::array<double, max_interval_degree + 1> scaled_{};
  std::vector<std::size_t> exact_only_;
};

}  // namespace

CertifiedValue evaluate_certified(std::span<const double> b, double s) {
  checks::interval(b);
  checks::finite(s, "parameter");
  CertifiedValue v{};
  Evaluation(b, {&s, 1}, {&v.value, 1}, {&v.error_bound, 1}, {&v.certificate, 1}).run();
  return v;
}

void evaluate_certified(std::span<const double> b, std::span<const double> s,
                        std::span<double> value, std::span<double> error_bound,
                        std::span<Certificate> certificate) {
  checks::interval(b);
  checks::finite(s, "parameter");
  checks::size(value.size(), s.size(), "places for values");
  if (!error_bound.empty()) checks::size(error_bound.size(), s.size(), "places for error bounds");
  if (!certificate.empty()) checks::size(certificate.size(), s.size(), "places for certificates");
  Evaluation(b, s, value, error_bound, certificate).run();
}

}  // namespace bezel::bernstein
