#include "bezel/geometry/curve_incidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "bezel/bernstein/exact.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/numeric/dyadic.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::geometry_kernel {
namespace {

using Exact = std::vector<Dyadic>;
using short_names::u;

constexpr double tiny = 0x1p-1050;  // covers underflow in at most 45 * 60 roundings
constexpr int doubled_levels = 45, levels = 120;

/// +1 or -1 when all coefficients that are not zero have that sign (no root inside), 0 when signs
/// differ or all are zero.
int one_sign(const Exact& c) {
  int sign = 0;
  for (const Dyadic& x : c) {
    const int next = x.sign();
    if (next == 0) continue;
    if (sign * next < 0) return 0;
    sign = next;
  }
  return sign;
}

int variations(const Exact& c) {
  int count = 0, last = 0;
  for (const Dyadic& x : c) {
    const int sign = x.sign();
    if (sign == 0) continue;
    if (sign * last < 0) ++count;
    last = sign;
  }
  return count;
}

bool is_zero(const Exact& c) {
  return std::all_of(c.begin(), c.end(), [](const Dyadic& x) { return x.sign() == 0; });
}

class Search {
 public:
  /// Of the curve with control points plus - minus and the origin.
  Search(std::span<const Vec2> plus, std::span<const Vec2> minus)
      : plus_(plus), minus_(minus), d_(static_cast<int>(plus.size()) - 1) {}
  /// Of a curve and a point.
  Search(std::span<const Vec2> plus, const Vec2& p)
      : plus_(plus), point_(p), d_(static_cast<int>(plus.size()) - 1) {}
  Search(std::span<const Vec2> plus, const ExactCurvePoint& p)
      : plus_(plus),
        point_(p.rounded()),
        exact_(&p),
        d_(static_cast<int>(plus.size()) - 1),
        shift_(p.error()) {}

  PointOnCurve run() {
    PointBuffer<max_curve_points> storage;
    Vec2* c = storage.data();
    for (int i = 0; i <= d_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      c[i] = plus_[k] - minus(k);
      largest_ = std::max({largest_, std::fabs(c[i].x()), std::fabs(c[i].y())});
    }
    if (largest_ < 0x1p1000)
      search(c, 0.0, 1.0, 0);
    else
      search_exactly(0.0, 1.0, 0);
    std::sort(out_.incidences.begin(), out_.incidences.end(),
              [](const Incidence& a, const Incidence& b) {
                return a.lo != b.lo ? a.lo < b.lo : a.hi < b.hi;
              });
    // Ends of neighbouring pieces come from both.
    out_.incidences.erase(std::unique(out_.incidences.begin(), out_.incidences.end(),
                                      [](const Incidence& a, const Incidence& b) {
                                        return a.lo == a.hi && b.lo == b.hi && a.lo == b.lo;
                                      }),
                          out_.incidences.end());
    return std::move(out_);
  }

 private:
  const Vec2& minus(std::size_t k) const { return minus_.empty() ? point_ : minus_[k]; }
  Dyadic exact_minus(std::size_t k, int axis) const {
    return exact_ != nullptr ? exact_->exact()[static_cast<std::size_t>(axis)]
                             : Dyadic(minus(k)[axis]);
  }

  /// c: the control points of the piece minus p, each coordinate within (1 + d level) u largest
  /// (1 + 2^-20) of the exact one, and the error of p: one rounding for the difference, d for each
  /// halving.
  void search(const Vec2* c, double lo, double hi, int level) {
    const double error = (2.0 + d_ * level) * u * largest_ + tiny + shift_;
    const Box2 box = control_box(d_, c);
    if (box.lo.y() > error || box.hi.y() < -error || box.hi.x() < -error) return;
    if (box.lo.x() > error) {
      out_.ray_crossings +=
          (above(c[d_].y(), hi, error) ? 1 : 0) - (above(c[0].y(), lo, error) ? 1 : 0);
      return;
    }
    const double size = std::max({std::fabs(box.lo.x()), std::fabs(box.hi.x()),
                                  std::fabs(box.lo.y()), std::fabs(box.hi.y())});
    if (level == doubled_levels || size <= 4.0 * error) {
      search_exactly(lo, hi, level);
      return;
    }
    PointBuffer<max_curve_points> left, right;
    halve(d_, c, left.data(), right.data());
    const double mid = 0.5 * (lo + hi);
    search(left.data(), lo, mid, level + 1);
    search(right.data(), mid, hi, level + 1);
  }

  /// Is the curve at s above p? y is its computed height over p.
  bool above(double y, double s, double error) {
    if (std::fabs(y) > error) return y > 0.0;
    prepare();
    return y_->sign(Dyadic(s)) > 0;
  }

  void prepare() {
    if (y_) return;
    Exact x, y;
    for (std::size_t i = 0; i < plus_.size(); ++i) {
      x.push_back(Dyadic(plus_[i].x()) - exact_minus(i, 0));
      y.push_back(Dyadic(plus_[i].y()) - exact_minus(i, 1));
    }
    // One coordinate a multiple of the other (or zero): they share all roots.
    std::size_t k = 0;
    while (k + 1 < x.size() && x[k].sign() == 0 && y[k].sign() == 0) ++k;
    dependent_ = true;
    for (std::size_t i = 0; i < x.size(); ++i)
      dependent_ = dependent_ && x[k] * y[i] == x[i] * y[k];
    x_.emplace(std::span<const Dyadic>(x));
    y_.emplace(std::span<const Dyadic>(y));
  }

  void search_exactly(double lo, double hi, int level) {
    prepare();
    if (x_->is_zero() && y_->is_zero()) {  // the curve is the point
      out_.incidences.push_back({lo, lo, true});
      out_.incidences.push_back({hi, hi, true});
      return;
    }
    Exact x, y;
    if (lo == 0.0 && hi == 1.0) {
      x.assign(x_->coefficients().begin(), x_->coefficients().end());
      y.assign(y_->coefficients().begin(), y_->coefficients().end());
    } else {
      x = x_->specialize(Dyadic(lo), Dyadic(hi));
      y = y_->specialize(Dyadic(lo), Dyadic(hi));
    }
    if (x.front().sign() == 0 && y.front().sign() == 0) out_.incidences.push_back({lo, lo, true});
    if (x.back().sign() == 0 && y.back().sign() == 0) out_.incidences.push_back({hi, hi, true});
    halve_exactly(std::move(x), std::move(y), lo, hi, level);
  }

  /// Incidences inside (lo, hi), and ray crossings; lo and hi stay once they are neighbours.
  void halve_exactly(Exact x, Exact y, double lo, double hi, int level) {
    for (;; ++level) {
      const int sign_x = one_sign(x), sign_y = one_sign(y);
      if (sign_x != 0) {
        if (sign_x > 0) cross(y, 1);
        return;
      }
      if (sign_y != 0) {
        // Only an end can be at the height of p.
        cross(y, y.front().sign() == 0 ? x.front().sign() : x.back().sign());
        return;
      }
      const bool smallest = std::nextafter(lo, 2.0) >= hi;
      // Roots of one are roots of both when dependent: an odd number of variations proves one.
      const int count = dependent_ ? variations(is_zero(x) ? y : x) : 0;
      if (level >= levels || (smallest && count == 1)) {
        out_.incidences.push_back({lo, hi, count % 2 == 1});
        return;
      }
      Exact left_x = bernstein::bisect_exactly(x), left_y = bernstein::bisect_exactly(y);
      const double mid = smallest ? lo : lo + 0.5 * (hi - lo);
      if (x.front().sign() == 0 && y.front().sign() == 0)
        out_.incidences.push_back({mid, smallest ? hi : mid, true});
      halve_exactly(std::move(left_x), std::move(left_y), lo, smallest ? hi : mid, level + 1);
      if (!smallest) lo = mid;
    }
  }

  void cross(const Exact& y, int side) {
    if (side <= 0) return;
    out_.ray_crossings += (y.back().sign() > 0 ? 1 : 0) - (y.front().sign() > 0 ? 1 : 0);
  }

  std::span<const Vec2> plus_, minus_;
  Vec2 point_;                              // when minus_ is empty
  const ExactCurvePoint* exact_ = nullptr;  // what point_ stands for
  int d_;
  double shift_ = 0.0;  // bound of the difference between the two
  double largest_ = 0.0;
  bool dependent_ = false;
  std::optional<bernstein::ExactPolynomial> x_, y_;
  PointOnCurve out_;
};

}  // namespace

PointOnCurve point_on_curve(std::span<const Vec2> curve, const Vec2& p) {
  return Search(curve, p).run();
}

PointOnCurve point_on_curve(std::span<const Vec2> curve, const ExactCurvePoint& p) {
  return Search(curve, p).run();
}

// de Casteljau's algorithm: within 3 d u max|b|, as bernstein::evaluate.
ExactCurvePoint::ExactCurvePoint(std::span<const Vec2> curve, double s)
    : curve_(curve),
      s_(s),
      rounded_(curve_point(static_cast<int>(curve.size()) - 1, curve.data(), s).value) {
  double largest = 0.0;
  for (const Vec2& c : curve) largest = std::max({largest, std::fabs(c.x()), std::fabs(c.y())});
  error_ =
      s == 0.0 || s == 1.0 ? 0.0 : 3.0 * static_cast<double>(curve.size()) * u * largest + tiny;
}

const std::array<Dyadic, 2>& ExactCurvePoint::exact() const {
  if (!exact_) {
    std::array<std::vector<Dyadic>, 2> b;
    for (const Vec2& c : curve_)
      for (const int axis : {0, 1}) b[static_cast<std::size_t>(axis)].emplace_back(c[axis]);
    const Dyadic s(s_);
    exact_ = std::array<Dyadic, 2>{bernstein::ExactPolynomial(std::span<const Dyadic>(b[0]))(s),
                                   bernstein::ExactPolynomial(std::span<const Dyadic>(b[1]))(s)};
  }
  return *exact_;
}

std::vector<Incidence> vanishing_speed(std::span<const Vec2> curve) {
  return Search(curve.subspan(1), curve.first(curve.size() - 1)).run().incidences;
}

}  // namespace bezel::geometry_kernel
