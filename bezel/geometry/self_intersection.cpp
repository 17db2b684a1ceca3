#include "bezel/geometry/self_intersection.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "bezel/bernstein/exact.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/geometry/curve_check.hpp"
#include "bezel/geometry/curve_incidence.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/geometry/newton_intersection_kernel.hpp"
#include "bezel/numeric/dyadic.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using bernstein::ExactPolynomial;
using geometry_kernel::NewtonCurve;
using short_names::at;
using short_names::u;

constexpr int max_level = 40;

/// [lo, hi]^2 around a cusp, or [0, hi] x [lo, 1] at the joint of a closed curve: holds no pair.
struct Excluded {
  double s_lo, s_hi, t_lo, t_hi;
};

/// D on a box: coefficient (i, j), of degree n - 1 in s and in t, at i n + j.
struct Patch {
  std::vector<Vec2> c;
  double s_lo, s_hi, t_lo, t_hi;
  int level;
};

class SelfSearch {
 public:
  explicit SelfSearch(std::span<const Vec2> curve)
      : curve_(curve), n_(static_cast<int>(curve.size()) - 1) {}

  SelfIntersections run() {
    out_.closed = curve_.front() == curve_.back();
    if (std::all_of(curve_.begin(), curve_.end(), [&](const Vec2& b) { return b == curve_[0]; })) {
      out_.closed = true;
      return std::move(out_);
    }
    for (const auto& incidence : geometry_kernel::vanishing_speed(curve_)) {
      out_.cusps.push_back({incidence.lo, incidence.lo, incidence.hi, incidence.proven});
      if (incidence.proven && incidence.lo == incidence.hi) exclude_around(incidence.lo);
    }
    if (n_ < 2) return std::move(out_);
    scale();
    newton_.emplace(control_);
    if (out_.closed) exclude_joint();
    const double boxes = std::min(20000.0, 4e8 / (static_cast<double>(n_) * n_ * n_));
    most_boxes_ = static_cast<int>(boxes);
    root_ = {divided_difference(), 0.0, 1.0, 0.0, 1.0, 0};
    search(root_);
    resolve();
    auto& crossings = out_.pairs.crossings;
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
      return a.s != b.s ? a.s < b.s : a.t < b.t;
    });
    auto& tangencies = out_.pairs.tangencies;
    std::sort(tangencies.begin(), tangencies.end(),
              [](const Tangency& a, const Tangency& b) { return a.s < b.s; });
    return std::move(out_);
  }

 private:
  // ---- What is excluded by monotone directions ----

  /// n . b' >= 0 on both sides of the cusp and not zero throughout makes n . b strictly monotone.
  void exclude_around(double s) {
    std::vector<Dyadic> x, y;
    for (int i = 0; i < n_; ++i) {
      x.push_back(Dyadic(curve_[at(i + 1)].x()) - Dyadic(curve_[at(i)].x()));
      y.push_back(Dyadic(curve_[at(i + 1)].y()) - Dyadic(curve_[at(i)].y()));
    }
    ExactPolynomial dx{std::span<const Dyadic>(x)}, dy{std::span<const Dyadic>(y)};
    // The first derivative of b' that does not vanish: along it after an even one, across it after
    // an odd one, the curve goes on.
    for (int k = 1; k < n_; ++k) {
      dx = dx.derivative();
      dy = dy.derivative();
      const Dyadic a = dx(Dyadic(s)), b = dy(Dyadic(s));
      if (a.sign() == 0 && b.sign() == 0) continue;
      std::vector<Dyadic> along(x.size());
      for (std::size_t i = 0; i < x.size(); ++i)
        along[i] = k % 2 == 0 ? a * x[i] + b * y[i] : a * y[i] - b * x[i];
      const ExactPolynomial p{std::span<const Dyadic>(along)};
      if (p.is_zero()) return;
      for (double h = 1.0; h >= 0x1p-40; h *= 0.5) {
        const double lo = std::max(0.0, s - h), hi = std::min(1.0, s + h);
        const int left = lo < s ? one_sign(p.specialize(Dyadic(lo), Dyadic(s))) : 0;
        const int right = s < hi ? one_sign(p.specialize(Dyadic(s), Dyadic(hi))) : 0;
        if ((left != 0 || lo == s) && (right != 0 || hi == s) && left * right >= 0) {
          excluded_.push_back({lo, hi, lo, hi});
          return;
        }
      }
      return;
    }
  }

  static int one_sign(const std::vector<Dyadic>& c) {
    int sign = 0;
    for (const Dyadic& x : c) {
      if (sign * x.sign() < 0) return 0;
      if (x.sign() != 0) sign = x.sign();
    }
    return sign;
  }

  /// A direction in which both ends of a closed curve go on excludes pairs around the joint.
  void exclude_joint() {
    const std::vector<Vec2> hodograph = bernstein::differentiate(std::span<const Vec2>(control_));
    double largest = 0.0;
    for (const Vec2& e : hodograph)
      largest = std::max({largest, std::fabs(e.x()), std::fabs(e.y())});
    // At a joint without speed the next difference gives the direction.
    const auto moves = [](const Vec2& e) { return !(e == Vec2{}); };
    const auto start = std::find_if(hodograph.begin(), hodograph.end(), moves);
    const auto stop = std::find_if(hodograph.rbegin(), hodograph.rend(), moves);
    const auto at_rest = start - hodograph.begin(), at_rest_last = stop - hodograph.rbegin();
    const Vec2 n = (1.0 / norm(*start)) * *start + (1.0 / norm(*stop)) * *stop;
    // Specializing costs 3 d u, the differences and the product a few u more, in two coordinates.
    const double error = 16.0 * (n_ + 1) * u * largest * (std::fabs(n.x()) + std::fabs(n.y()));
    const auto forward = [&](const Vec2& e) { return dot(e, n) > error; };
    for (double h = 0.25; h >= 0x1p-30; h *= 0.5) {
      const std::span<const Vec2> all(hodograph);
      const auto head = bernstein::specialize(all, 0.0, h),
                 tail = bernstein::specialize(all, 1.0 - h, 1.0);
      // Coefficients that are zero stay exactly zero at the ends.
      if (std::all_of(head.begin() + at_rest, head.end(), forward) &&
          std::all_of(tail.begin(), tail.end() - at_rest_last, forward)) {
        excluded_.push_back({0.0, h, 1.0 - h, 1.0});
        return;
      }
    }
  }

  // ---- D ----

  /// Scaled by a power of two, so that products neither overflow nor vanish.
  void scale() {
    for (const Vec2& b : curve_)
      magnitude_ = std::max({magnitude_, std::fabs(b.x()), std::fabs(b.y())});
    const int exponent = std::ilogb(magnitude_) + 1;
    magnitude_ = std::ldexp(magnitude_, -exponent);
    for (const Vec2& b : curve_)
      control_.push_back(Vec2{{std::ldexp(b.x(), -exponent), std::ldexp(b.y(), -exponent)}});
  }

  /// D = sum over k of the blossom of the differences with k arguments s and n - 1 - k arguments
  /// t: coefficients Delta_{i+j} of degree (k, n-1-k), raised to (n-1, n-1).
  std::vector<Vec2> divided_difference() {
    const int n = n_;
    std::vector<Vec2> delta(at(n)), c(at(n * n));
    for (int i = 0; i < n; ++i) {
      delta[at(i)] = control_[at(i + 1)] - control_[at(i)];
      largest_ = std::max({largest_, std::fabs(delta[at(i)].x()), std::fabs(delta[at(i)].y())});
    }
    for (int k = 0; k < n; ++k) {
      std::vector<std::vector<Vec2>> rows;  // k+1 of them, raised in t
      for (int i = 0; i <= k; ++i)
        rows.push_back(
            bernstein::elevate(std::span<const Vec2>(delta).subspan(at(i), at(n - k)), k));
      for (int j = 0; j < n; ++j) {
        std::vector<Vec2> column;
        for (int i = 0; i <= k; ++i) column.push_back(rows[at(i)][at(j)]);
        column = bernstein::elevate(std::span<const Vec2>(column), n - 1 - k);
        for (int i = 0; i < n; ++i) c[at(i * n + j)] += column[at(i)];
      }
    }
    return c;
  }

  /// Of the coefficients of a box after `level` halvings in each parameter: raising degrees costs
  /// 8 n u for each of n terms of size `largest`, their sum and differences n^2 + n more, each
  /// halving 2 (n-1) roundings of values up to n `largest`.
  double coefficient_error(int level) const {
    return (10.0 + 2.0 * level) * n_ * n_ * u * largest_ + 0x1p-1000;
  }

  enum class Hull { misses, open, lost };
  /// misses: all coefficients lie on one side of a line through the origin, beyond their error:
  /// across x, y, the mean, and what the mean slopes in s and t leave. lost: in one of these
  /// directions nothing but rounding is left, so that halving will not help.
  Hull hull(const Patch& box, const Vec2& slope_s, const Vec2& slope_t) const {
    const double error = coefficient_error(box.level);
    Vec2 mean;
    for (const Vec2& c : box.c) mean += c;
    const Vec2 directions[] = {Vec2{{1, 0}}, Vec2{{0, 1}}, mean, Vec2{{-slope_s.y(), slope_s.x()}},
                               Vec2{{-slope_t.y(), slope_t.x()}}};
    bool lost = false;
    for (const Vec2& n : directions) {
      const double size = std::fabs(n.x()) + std::fabs(n.y());
      // The products' rounding: coefficients are at most n_ largest.
      const double margin = size * (error + 4.0 * u * n_ * largest_);
      double lo = dot(box.c[0], n), hi = lo;
      for (const Vec2& c : box.c) {
        const double x = dot(c, n);
        lo = std::min(lo, x);
        hi = std::max(hi, x);
      }
      if (lo > margin || hi < -margin) return Hull::misses;
      lost = lost || (lo >= -4.0 * margin && hi <= 4.0 * margin);
    }
    return lost ? Hull::lost : Hull::open;
  }

  struct Slopes {
    Vec2 s, t;
  };
  /// Mean derivatives in the box's own parameters.
  Slopes slopes(const Patch& box) const {
    const int n = n_;
    Slopes out;
    for (int k = 0; k < n; ++k) {
      out.s += box.c[at((n - 1) * n + k)] - box.c[at(k)];
      out.t += box.c[at(k * n + n - 1)] - box.c[at(k * n)];
    }
    out.s *= 1.0 / n;
    out.t *= 1.0 / n;
    return out;
  }

  /// Krawczyk's operator on a box, in its own parameters: C the inverse of the mean slopes, q >=
  /// the maximum norm of I - C D' (from differences of the coefficients), centre - C D(centre).
  struct Krawczyk {
    double q, x, y, slack;
  };
  std::optional<Krawczyk> krawczyk(const Patch& box, const Slopes& slope, double error) const {
    const int n = n_;
    const double det = cross(slope.s, slope.t);
    const double size = (std::fabs(slope.s.x()) + std::fabs(slope.s.y())) *
                        (std::fabs(slope.t.x()) + std::fabs(slope.t.y()));
    if (!(std::fabs(det) > 1e-8 * size)) return std::nullopt;
    // Rows of C: (t.y, -t.x) / det and (-s.y, s.x) / det.
    const double c00 = slope.t.y() / det, c01 = -slope.t.x() / det, c10 = -slope.s.y() / det,
                 c11 = slope.s.x() / det;
    const double row0 = std::fabs(c00) + std::fabs(c01), row1 = std::fabs(c10) + std::fabs(c11);
    double s0 = 0, s1 = 0, t0 = 0, t1 = 0, steepest = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        if (i + 1 < n) {
          const Vec2 e = (n - 1.0) * (box.c[at((i + 1) * n + j)] - box.c[at(i * n + j)]);
          s0 = std::max(s0, std::fabs(1.0 - (c00 * e.x() + c01 * e.y())));
          s1 = std::max(s1, std::fabs(c10 * e.x() + c11 * e.y()));
          steepest = std::max({steepest, std::fabs(e.x()), std::fabs(e.y())});
        }
        if (j + 1 < n) {
          const Vec2 e = (n - 1.0) * (box.c[at(i * n + j + 1)] - box.c[at(i * n + j)]);
          t0 = std::max(t0, std::fabs(c00 * e.x() + c01 * e.y()));
          t1 = std::max(t1, std::fabs(1.0 - (c10 * e.x() + c11 * e.y())));
          steepest = std::max({steepest, std::fabs(e.x()), std::fabs(e.y())});
        }
      }
    // Coefficients off by `error` change each slope by 2 (n-1) error; rounding: differences, scale,
    // products and sums, at most 6 u row steepest for each of s and t.
    const double row = std::max(row0, row1);
    const double q = std::max(s0 + t0, s1 + t1) +
                     1.01 * row * (4.0 * (n - 1) * error + 12.0 * u * steepest) + 1e-12;
    Vec2 value;
    std::vector<Vec2> w(at(n));
    for (int i = 0; i < n; ++i)
      w[at(i)] = bernstein::evaluate(std::span<const Vec2>(box.c).subspan(at(i * n), at(n)), 0.5);
    value = bernstein::evaluate(std::span<const Vec2>(w), 0.5);
    const double slack = row * 2.0 * (error + 8.0 * n * u * n * largest_) + 1e-15;
    return Krawczyk{q, 0.5 - (c00 * value.x() + c01 * value.y()),
                    0.5 - (c10 * value.x() + c11 * value.y()), slack};
  }

  void halve_s(const Patch& box, std::vector<Vec2>& left, std::vector<Vec2>& right) const {
    const int n = n_;
    std::vector<Vec2> column(at(n)), a(at(n)), b(at(n));
    left.resize(box.c.size());
    right.resize(box.c.size());
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) column[at(i)] = box.c[at(i * n + j)];
      geometry_kernel::halve(n - 1, column.data(), a.data(), b.data());
      for (int i = 0; i < n; ++i) {
        left[at(i * n + j)] = a[at(i)];
        right[at(i * n + j)] = b[at(i)];
      }
    }
  }
  void halve_t(const std::vector<Vec2>& c, std::vector<Vec2>& left,
               std::vector<Vec2>& right) const {
    const int n = n_;
    left.resize(c.size());
    right.resize(c.size());
    for (int i = 0; i < n; ++i)
      geometry_kernel::halve(n - 1, c.data() + i * n, left.data() + i * n, right.data() + i * n);
  }

  /// D on any box, from the whole: as accurate as a few levels of halving.
  Patch patch(double s_lo, double s_hi, double t_lo, double t_hi) const {
    const int n = n_;
    Patch out{root_.c, s_lo, s_hi, t_lo, t_hi, 4};
    std::vector<Vec2> column(at(n));
    for (int i = 0; i < n; ++i) {
      const auto row =
          bernstein::specialize(std::span<const Vec2>(out.c).subspan(at(i * n), at(n)), t_lo, t_hi);
      std::copy(row.begin(), row.end(), out.c.begin() + i * n);
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) column[at(i)] = out.c[at(i * n + j)];
      const auto cut = bernstein::specialize(std::span<const Vec2>(column), s_lo, s_hi);
      for (int i = 0; i < n; ++i) out.c[at(i * n + j)] = cut[at(i)];
    }
    return out;
  }

  // ---- The search ----

  void search(const Patch& box) {
    ++boxes_;
    for (const Excluded& e : excluded_)
      if (box.s_lo >= e.s_lo && box.s_hi <= e.s_hi && box.t_lo >= e.t_lo && box.t_hi <= e.t_hi)
        return;
    const Slopes slope = slopes(box);
    const Hull position = hull(box, slope.s, slope.t);
    if (position == Hull::misses) return;
    const bool diagonal = box.s_hi > box.t_lo;
    if (!diagonal) {
      const auto k = krawczyk(box, slope, coefficient_error(box.level));
      if (k && k->q < 0.9) {
        const double reach = 0.5 * k->q + k->slack;
        if (std::fabs(k->x - 0.5) > 0.5 + reach || std::fabs(k->y - 0.5) > 0.5 + reach) return;
        if (add_root(box, *k)) return;
      }
    }
    // Two small pieces far from each other that D's linear part does not separate: nearly parallel,
    // which `intersect` is made for.
    const bool parallel = box.level >= 12 && box.t_lo - box.s_hi >= 1024 * (box.s_hi - box.s_lo);
    // (Straight curves are lost across their line from the start.)
    const bool lost = position == Hull::lost && box.level >= 8;
    if (parallel || lost || box.level >= max_level || boxes_ >= most_boxes_) {
      leave_open(box);
      return;
    }
    Patch part{{}, 0, 0, 0, 0, box.level + 1};
    std::vector<Vec2> halves[2];
    halve_s(box, halves[0], halves[1]);
    const double s = 0.5 * (box.s_lo + box.s_hi), t = 0.5 * (box.t_lo + box.t_hi);
    for (const int i : {0, 1}) {
      std::vector<Vec2> quarters[2];
      halve_t(halves[i], quarters[0], quarters[1]);
      for (const int j : {0, 1}) {
        if (diagonal && i > j) continue;  // s > t
        part.c = std::move(quarters[j]);
        part.s_lo = i == 0 ? box.s_lo : s;
        part.s_hi = i == 0 ? s : box.s_hi;
        part.t_lo = j == 0 ? box.t_lo : t;
        part.t_hi = j == 0 ? t : box.t_hi;
        search(part);
      }
    }
  }

  /// Newton's method from (s, t) to a root no further than `reach` in each parameter.
  bool polish(double& s, double& t, double reach) const {
    const double start_s = s, start_t = t;
    for (int i = 0; i < 20; ++i) {
      const Vec2 f = geometry_kernel::residual(*newton_, s, *newton_, t, ResidualForm::compensated);
      Vec2 step;
      if (!geometry_kernel::solve(newton_->derivative(s), -newton_->derivative(t), f, step))
        return false;
      s -= step.x();
      t -= step.y();
      if (!(std::fabs(s - start_s) <= reach && std::fabs(t - start_t) <= reach)) return false;
      if (std::fabs(step.x()) + std::fabs(step.y()) <= 0x1p-52 * (std::fabs(s) + std::fabs(t)))
        break;
    }
    return true;
  }

  /// Exactly one root within w of (s, t) in each parameter, and it is within r.
  struct Proof {
    double w, r;
  };
  std::optional<Proof> prove(double s, double t, double largest) const {
    for (double w = std::min(largest, 0.25 / n_); w >= 0x1p-38; w *= 0.25) {
      if (!(s + w < t - w)) continue;
      const Patch around = patch(s - w, s + w, t - w, t + w);
      // Outside [0, 1] by at most 1 / (4 d): rounding grows by (1 + 1 / (2 d))^(2 d) < e.
      const double error = 3.0 * coefficient_error(around.level);
      const auto proof = krawczyk(around, slopes(around), error);
      if (!proof || !(proof->q < 0.5)) continue;
      // The root's distance from the centre is at most |C D(centre)| / (1 - q), in units of 2 w.
      const double off =
          (std::max(std::fabs(proof->x - 0.5), std::fabs(proof->y - 0.5)) + proof->slack) /
          (1.0 - proof->q);
      if (!(off < 0.25)) return std::nullopt;
      return Proof{w, 2.0 * w * off};
    }
    return std::nullopt;
  }

  /// At most one root in the box: finds it, and proves it in a box around it. False: not settled.
  bool add_root(const Patch& box, const Krawczyk& k) {
    const double width_s = box.s_hi - box.s_lo, width_t = box.t_hi - box.t_lo;
    double s = box.s_lo + width_s * std::clamp(k.x, 0.0, 1.0),
           t = box.t_lo + width_t * std::clamp(k.y, 0.0, 1.0);
    if (!polish(s, t, std::max(width_s, width_t))) return false;
    // Large enough to cover the box from a root on its border.
    const auto proof = prove(s, t, 1.001 * std::max(width_s, width_t));
    if (!proof) return false;
    const double r = proof->r, w = proof->w;
    if (s + r < box.s_lo || s - r > box.s_hi || t + r < box.t_lo || t - r > box.t_hi)
      return false;  // a neighbour's: smaller boxes exclude it here
    add_proven(s, t, *proof);
    // A root that may lie just outside says nothing of the box, unless the proof covers it.
    const bool inside =
        s - r > box.s_lo && s + r < box.s_hi && t - r > box.t_lo && t + r < box.t_hi;
    const bool covered =
        s - w <= box.s_lo && s + w >= box.s_hi && t - w <= box.t_lo && t + w >= box.t_hi;
    return inside || covered;
  }

  void add_proven(double s, double t, const Proof& proof) {
    const double r = proof.r, w = proof.w;
    // The joint of a closed curve is no crossing, and what is outside [0, 1] is none.
    if (out_.closed && s <= r && t >= 1.0 - r) return;
    if (s < -r || t > 1.0 + r) return;
    // Two boxes with a common border may both find one.
    for (const Crossing& c : out_.pairs.crossings)
      if (std::fabs(c.s - s) < w && std::fabs(c.t - t) < w) return;
    add_crossing(s, t, w, s >= r && t <= 1.0 - r);
  }

  void add_crossing(double s, double t, double w, bool certified) {
    const auto inside = [](double x) { return std::clamp(x, 0.0, 1.0); };
    Crossing c{};
    c.s = inside(s);
    c.t = inside(t);
    c.s_lo = inside(s - w);
    c.s_hi = inside(s + w);
    c.t_lo = inside(t - w);
    c.t_hi = inside(t + w);
    c.point_a = geometry_kernel::curve_point(n_, curve_.data(), c.s).value;
    c.point_b = geometry_kernel::curve_point(n_, curve_.data(), c.t).value;
    const Vec2 p = newton_->derivative(c.s), q = newton_->derivative(c.t);
    const double speed_p = norm(p), speed_q = norm(q);
    const double sine = cross((1.0 / speed_p) * p, (1.0 / speed_q) * q);
    c.condition = magnitude_ / (std::min(speed_p, speed_q) * std::fabs(sine));
    c.sign = sine > 0 ? 1 : -1;
    c.certified = certified;
    out_.pairs.crossings.push_back(c);
  }

  void leave_open(const Patch& box) {
    UnresolvedBox joined{box.s_lo, box.s_hi, box.t_lo, box.t_hi, "not excluded"};
    auto& open = out_.pairs.unresolved;
    for (bool again = true; again;) {
      again = false;
      for (std::size_t i = 0; i < open.size(); ++i) {
        const UnresolvedBox o = open[i];
        if (!(joined.s_lo <= o.s_hi && o.s_lo <= joined.s_hi && joined.t_lo <= o.t_hi &&
              o.t_lo <= joined.t_hi))
          continue;
        joined.s_lo = std::min(joined.s_lo, o.s_lo);
        joined.s_hi = std::max(joined.s_hi, o.s_hi);
        joined.t_lo = std::min(joined.t_lo, o.t_lo);
        joined.t_hi = std::max(joined.t_hi, o.t_hi);
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(i));
        again = true;
        break;
      }
    }
    open.push_back(std::move(joined));
  }

  /// Boxes off the diagonal that stayed open: two different pieces, for `intersect`.
  void resolve() {
    std::vector<UnresolvedBox> open = std::move(out_.pairs.unresolved);
    out_.pairs.unresolved.clear();
    for (UnresolvedBox& box : open) {
      if (box.s_hi >= box.t_lo) {
        box.reason = "a cusp, or the curve meets itself at almost equal parameters";
        out_.pairs.unresolved.push_back(std::move(box));
        continue;
      }
      // A wider piece than the box, as far as there is room: events near its ends are seen whole.
      const double room = 0.25 * (box.t_lo - box.s_hi);
      const double w = std::min(room, 0x1p-10);
      const double s_lo = std::max(0.0, box.s_lo - w), s_hi = box.s_hi + w, t_lo = box.t_lo - w,
                   t_hi = std::min(1.0, box.t_hi + w);
      const std::span<const Vec2> scaled(control_);
      const CurveIntersections found = intersect(bernstein::specialize(scaled, s_lo, s_hi),
                                                 bernstein::specialize(scaled, t_lo, t_hi));
      bool any = false;
      const auto s_of = [&](double x) { return s_lo + x * (s_hi - s_lo); };
      const auto t_of = [&](double x) { return t_lo + x * (t_hi - t_lo); };
      const auto here = [&](double s, double t) {
        const double slack = 0x1p-20;
        return s >= box.s_lo - slack && s <= box.s_hi + slack && t >= box.t_lo - slack &&
               t <= box.t_hi + slack;
      };
      for (const Tangency& c : found.tangencies)
        if (here(s_of(c.s), t_of(c.t))) {
          out_.pairs.tangencies.push_back({s_of(c.s), t_of(c.t), c.order, c.sign});
          any = true;
        }
      for (const Crossing& c : found.crossings) {
        const double s = s_of(c.s), t = t_of(c.t);
        const bool known = std::any_of(
            out_.pairs.crossings.begin(), out_.pairs.crossings.end(), [&](const Crossing& k) {
              return s >= k.s_lo && s <= k.s_hi && t >= k.t_lo && t <= k.t_hi;
            });
        if (known || !here(s, t) || (out_.closed && s == 0.0 && t == 1.0)) continue;
        any = true;
        double x = s, y = t;
        if (polish(x, y, w)) {
          const auto proof = prove(x, y, w);
          if (proof) {
            add_proven(x, y, *proof);
            continue;
          }
        }
        add_crossing(s, t, 0.0, false);
        Crossing& added = out_.pairs.crossings.back();
        added.s_lo = box.s_lo;
        added.s_hi = box.s_hi;
        added.t_lo = box.t_lo;
        added.t_hi = box.t_hi;
      }
      if (!any) {
        box.reason = "not excluded, nothing found";
        out_.pairs.unresolved.push_back(std::move(box));
      }
    }
  }

  std::span<const Vec2> curve_;
  int n_;
  std::optional<NewtonCurve> newton_;  // of the scaled curve
  std::vector<Vec2> control_;          // scaled
  double magnitude_ = 0.0, largest_ = 0.0;
  std::vector<Excluded> excluded_;
  Patch root_;
  int boxes_ = 0, most_boxes_ = 0;
  SelfIntersections out_{};
};

}  // namespace

SelfIntersections self_intersections(std::span<const Vec2> curve) {
  geometry_kernel::checked_degree(curve);
  return SelfSearch(curve).run();
}

}  // namespace bezel
