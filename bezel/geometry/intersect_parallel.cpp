// Nearly parallel pieces: over a common direction d both are graphs, and everything about them is
// in the signed distance delta(s) from a(s) to b. It is sampled (with b found by Newton),
// interpolated by polynomials whose error is measured at further points, and read off by
// subdivision: signs, zeros, and the intervals where it stays within the coincidence distance.

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/geometry/intersect_search.hpp"

namespace bezel::geometry_kernel {
namespace {

constexpr int degree = 8;  // of the interpolants
constexpr std::size_t nodes = degree + 1;
using Values = std::array<double, nodes>;

/// Chebyshev points of the second kind on [0, 1]: (1 - cos(i pi / 8)) / 2.
constexpr Values points{
    0.0, 0.038060233744356621936, 0.14644660940672623780, 0.30865828381745511414,
    0.5, 0.69134171618254488586,  0.85355339059327376220, 0.96193976625564337806,
    1.0};

using Matrix = std::array<std::array<double, nodes>, nodes>;

/// From values at the points to Bernstein coefficients: inverse of the Bernstein-Vandermonde
/// matrix.
constexpr Matrix interpolation_matrix() {
  std::array<std::array<double, 2 * nodes>, nodes> w{};
  for (std::size_t i = 0; i < nodes; ++i) {
    double binomial = 1;
    for (std::size_t j = 0; j < nodes; ++j) {
      double value = binomial;
      for (std::size_t k = 0; k < j; ++k) value *= points[i];
      for (std::size_t k = j; k < degree; ++k) value *= 1.0 - points[i];
      w[i][j] = value;
      binomial = binomial * static_cast<double>(degree - j) / static_cast<double>(j + 1);
    }
    w[i][nodes + i] = 1.0;
  }
  const auto size = [](double v) { return v < 0 ? -v : v; };
  for (std::size_t c = 0; c < nodes; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c + 1; i < nodes; ++i)
      if (size(w[i][c]) > size(w[pivot][c])) pivot = i;
    const auto row = w[c];
    w[c] = w[pivot];
    w[pivot] = row;
    const double scale = 1.0 / w[c][c];
    for (double& v : w[c]) v *= scale;
    for (std::size_t i = 0; i < nodes; ++i) {
      const double f = w[i][c];
      if (i == c || f == 0.0) continue;
      for (std::size_t j = 0; j < 2 * nodes; ++j) w[i][j] -= f * w[c][j];
    }
  }
  Matrix result{};
  for (std::size_t i = 0; i < nodes; ++i)
    for (std::size_t j = 0; j < nodes; ++j) result[i][j] = w[i][nodes + j];
  return result;
}
constexpr Matrix to_bernstein = interpolation_matrix();

double evaluate(const Values& c, double x) {
  Values q = c;
  for (std::size_t d = degree; d > 0; --d)
    for (std::size_t i = 0; i < d; ++i) q[i] = (1.0 - x) * q[i] + x * q[i + 1];
  return q[0];
}

struct Piece {
  double s0, s1;
  Values c;  // Bernstein coefficients of delta
};

/// delta is above +threshold, within it, or below -threshold on [s0, s1].
struct Segment {
  double s0, s1;
  int state;
};

void append(std::vector<Segment>& list, double s0, double s1, int state) {
  if (!list.empty() && list.back().state == state && list.back().s1 == s0)
    list.back().s1 = s1;
  else
    list.push_back({s0, s1, state});
}

/// Where a monotone polynomial with p(0) and p(1) on different sides of target passes it.
double passing(const Values& c, double target) {
  const bool rising = c[degree] > c[0];
  double lo = 0, hi = 1, x = (target - c[0]) / (c[degree] - c[0]);
  for (int i = 0; i < 60; ++i) {
    Values q = c;
    for (std::size_t d = degree; d > 1; --d)
      for (std::size_t k = 0; k < d; ++k) q[k] = (1.0 - x) * q[k] + x * q[k + 1];
    const double slope = degree * (q[1] - q[0]), value = (1.0 - x) * q[0] + x * q[1] - target;
    ((value > 0) == rising ? hi : lo) = x;
    double next = slope != 0 ? x - value / slope : lo;
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    const double step = std::fabs(next - x);
    x = next;
    if (step <= 4e-16 || (i > 5 && step <= 1e-14)) break;
  }
  return x;
}

bool monotone(const Values& c) {
  bool up = true, down = true;
  for (std::size_t i = 0; i < degree; ++i) {
    up = up && c[i + 1] > c[i];
    down = down && c[i + 1] < c[i];
  }
  return up || down;
}

void classify(const Values& c, double threshold, double s0, double s1, int depth,
              std::vector<Segment>& list) {
  const auto [least, most] = std::minmax_element(c.begin(), c.end());
  int state = 0;
  if (*least > threshold) {
    state = 1;
  } else if (*most < -threshold) {
    state = -1;
  } else if (depth > 0 && !(*most <= threshold && *least >= -threshold)) {
    const auto side = [&](double v) { return v > threshold ? 1 : v < -threshold ? -1 : 0; };
    if (monotone(c)) {
      const int first = side(c[0]), last = side(c[degree]);
      double at = s0;
      const auto until = [&](double target, int now) {
        const double s = std::clamp(s0 + (s1 - s0) * passing(c, target), at, s1);
        append(list, at, s, now);
        at = s;
      };
      if (first != 0 && last != first) until(first * threshold, first);
      if (last != 0 && last != first) until(last * threshold, 0);
      append(list, at, s1, last);
      return;
    }
    Values left, right = c;
    left[0] = right[0];
    for (std::size_t r = 1; r < nodes; ++r) {
      for (std::size_t i = 0; i + r < nodes; ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
      left[r] = right[0];
    }
    const double s = 0.5 * (s0 + s1);
    if (s > s0 && s < s1) {
      classify(left, threshold, s0, s, depth - 1, list);
      classify(right, threshold, s, s1, depth - 1, list);
      return;
    }
  }
  append(list, s0, s1, state);
}

}  // namespace

/// The signed distance of b from a over [s0, s1] x [t0, t1], and what follows from it.
class ParallelPair {
 public:
  ParallelPair(IntersectSearch& search, double s0, double s1, double t0, double t1)
      : f_(search), s0_(s0), s1_(s1), t0_(t0), t1_(t1) {
    const Vec2 from = curve_point(f_.m_, f_.a_, s0).value, to = curve_point(f_.m_, f_.a_, s1).value;
    const Vec2 chord = to - from;
    d_ = (1.0 / norm(chord)) * chord;
    const Vec2 chord_b = curve_point(f_.n_, f_.b_, t1).value - curve_point(f_.n_, f_.b_, t0).value;
    reversed_ = dot(d_, chord_b) < 0;
  }

  void run() {
    if (!clip()) return;
    interpolate(s0_, s1_, 10);
    read_band();
  }

 private:
  struct Sample {
    double delta, t, slope_a, slope_b;
  };

  /// b's parameter opposite s, along the normal of d.
  double opposite(double s) const {
    const Vec2 origin = curve_point(f_.m_, f_.a_, s).value;
    double lo = t0_, hi = t1_;  // d . (b - origin) rises from lo to hi, or falls when reversed
    double t = last_t_ > t0_ && last_t_ < t1_ ? last_t_ : 0.5 * (t0_ + t1_);
    for (int i = 0; i < 60; ++i) {
      const CurvePoint q = curve_point(f_.n_, f_.b_, t, origin);
      const double g = dot(d_, q.value), slope = dot(d_, q.derivative);
      if (g == 0.0) break;
      if ((g > 0) != reversed_)
        hi = t;
      else
        lo = t;
      double next = slope != 0 ? t - g / slope : 0.5 * (lo + hi);
      if (!(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
      const double step = std::fabs(next - t);
      t = next;
      if (step <= 2e-16 * (t1_ - t0_) || (i > 4 && step <= 1e-14 * (t1_ - t0_))) break;
    }
    last_t_ = t;
    return t;
  }

  /// b's parameter on the normal of a at s: what is reported.
  double foot(double s) const {
    double t = opposite(s);
    const CurvePoint p = curve_point(f_.m_, f_.a_, s);
    for (int i = 0; i < 2; ++i) {
      const CurvePoint q = curve_point(f_.n_, f_.b_, t, p.value);
      const double slope = dot(p.derivative, q.derivative);
      if (slope != 0) t = std::clamp(t - dot(p.derivative, q.value) / slope, t0_, t1_);
    }
    return t;
  }

  /// Restricts [s0, s1] to where b is opposite; notes whether the ends are ends of b.
  bool clip() {
    const Vec2 b0 = curve_point(f_.n_, f_.b_, reversed_ ? t1_ : t0_).value;
    const Vec2 b1 = curve_point(f_.n_, f_.b_, reversed_ ? t0_ : t1_).value;
    const auto solve = [&](const Vec2& target) {  // d . (a(s) - target) = 0, rising
      double lo = s0_, hi = s1_, s = 0.5 * (lo + hi);
      for (int i = 0; i < 60; ++i) {
        const CurvePoint p = curve_point(f_.m_, f_.a_, s, target);
        const double g = dot(d_, p.value), slope = dot(d_, p.derivative);
        if (g == 0.0) break;
        (g > 0 ? hi : lo) = s;
        double next = slope != 0 ? s - g / slope : 0.5 * (lo + hi);
        if (!(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
        const double step = std::fabs(next - s);
        s = next;
        if (step <= 2e-16) break;
      }
      return s;
    };
    double lo = s0_, hi = s1_;
    if (dot(d_, curve_point(f_.m_, f_.a_, s0_, b0).value) < 0) {
      if (dot(d_, curve_point(f_.m_, f_.a_, s1_, b0).value) <= 0) return false;
      lo = solve(b0);
      lo_is_b_ = true;
    }
    if (dot(d_, curve_point(f_.m_, f_.a_, s1_, b1).value) > 0) {
      if (dot(d_, curve_point(f_.m_, f_.a_, s0_, b1).value) >= 0) return false;
      hi = solve(b1);
      hi_is_b_ = true;
    }
    if (!(lo < hi)) return false;
    s0_ = lo;
    s1_ = hi;
    return true;
  }

  Sample sample(double s) const {
    const CurvePoint p = curve_point(f_.m_, f_.a_, s);
    const double t = opposite(s);
    const CurvePoint q = curve_point(f_.n_, f_.b_, t, p.value);
    const double along_a = dot(d_, p.derivative), along_b = dot(d_, q.derivative);
    const double slope_a = along_a != 0 ? cross(d_, p.derivative) / along_a : 0.0;
    const double slope_b = along_b != 0 ? cross(d_, q.derivative) / along_b : 0.0;
    const double delta = cross(d_, q.value) - dot(d_, q.value) * slope_b;
    return {delta / std::sqrt(1.0 + slope_a * slope_a), t, slope_a, slope_b};
  }

  void interpolate(double s0, double s1, int depth) {
    Values v{};
    const double h = s1 - s0;
    for (std::size_t i = 0; i < nodes; ++i) {
      v[i] = sample(s0 + h * points[i]).delta;
    }
    Piece piece{s0, s1, {}};
    for (std::size_t i = 0; i < nodes; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < nodes; ++j) sum += to_bernstein[i][j] * v[j];
      piece.c[i] = sum;
    }
    piece.c[0] = v[0];
    piece.c[degree] = v[degree];
    double error = 0;
    for (const double x : {0.0123, 0.2718, 0.5772, 0.9877})
      error = std::max(error, std::fabs(evaluate(piece.c, x) - sample(s0 + h * x).delta));
    const double allowed = std::max(f_.tau_ / 128, 4 * f_.rounding_);
    // Where delta stays far from zero its exact shape does not matter.
    const auto [least, most] = std::minmax_element(piece.c.begin(), piece.c.end());
    const double away = std::max(*least, -*most);
    const bool clear = away > f_.tau_ + 16 * error && away > 0;
    if (error <= allowed || clear || depth == 0 || !(h > 1e-12)) {
      if (!(error <= allowed) && !clear)
        f_.unresolved(s0, s1, std::min(opposite(s0), opposite(s1)),
                      std::max(opposite(s0), opposite(s1)),
                      "the distance between nearly parallel pieces is not smooth");
      pieces_.push_back(piece);
      return;
    }
    const double middle = 0.5 * (s0 + s1);
    interpolate(s0, middle, depth - 1);
    interpolate(middle, s1, depth - 1);
  }

  double delta_at(double s) const {
    for (const Piece& p : pieces_)
      if (s <= p.s1) return evaluate(p.c, (s - p.s0) / (p.s1 - p.s0));
    return pieces_.back().c[degree];
  }

  /// A zero of the interpolant between s0 and s1, where it has different signs.
  double zero(double s0, double s1) const {
    // Illinois: false position, halving the value at an end that stays.
    double v0 = delta_at(s0), v1 = delta_at(s1);
    for (int i = 0; i < 100 && v0 * v1 < 0; ++i) {
      double s = s0 - v0 * (s1 - s0) / (v1 - v0);
      if (!(s > s0 && s < s1)) s = 0.5 * (s0 + s1);
      if (!(s > s0 && s < s1)) break;
      const double v = delta_at(s);
      if (v == 0) return s;
      if (v * v1 < 0) {
        s0 = s1;
        v0 = v1;
      } else {
        v0 *= 0.5;
      }
      s1 = s;
      v1 = v;
      if (s0 > s1) {
        std::swap(s0, s1);
        std::swap(v0, v1);
      }
    }
    return std::fabs(v0) < std::fabs(v1) ? s0 : s1;
  }

  Contact* contact_in(double s0, double s1, double t0, double t1, int& count) const {
    Contact* found = nullptr;
    count = 0;
    for (int i = 0; i < f_.contact_count_; ++i) {
      Contact& c = f_.contacts_[static_cast<std::size_t>(i)];
      if (c.s >= s0 && c.s <= s1 && c.t >= t0 && c.t <= t1) {
        found = &c;
        ++count;
      }
    }
    return found;
  }

  /// One event in [s0, s1]: the states before and after are -1, +1, or 0 when unknown.
  void event(double s0, double s1, int before, int after) {
    const double ta = opposite(s0), tb = opposite(s1);
    const Vec2 middle_speed = curve_point(f_.m_, f_.a_, 0.5 * (s0 + s1)).derivative;
    const double pad_s = 4 * f_.tau_ / std::max(norm(middle_speed), f_.tau_) + 1e-12;
    const double pad_t =
        4 * f_.tau_ / std::max(norm(curve_point(f_.n_, f_.b_, ta).derivative), f_.tau_) + 1e-12;
    int count = 0;
    Contact* contact = contact_in(s0 - pad_s, s1 + pad_s, std::min(ta, tb) - pad_t,
                                  std::max(ta, tb) + pad_t, count);
    const int sign = before * after < 0 ? (reversed_ ? -after : after) : 0;
    if (contact != nullptr) {
      if (count == 1 && contact->sign == 0) contact->sign = sign;
      return;
    }
    if (before * after < 0) {
      const double s = zero(s0, s1);
      f_.add_crossing(s, foot(s), s0, s1, std::min(ta, tb), std::max(ta, tb), sign, false);
      return;
    }
    // Touching: the smallest distance in between.
    double best_s = 0.5 * (s0 + s1), best = std::numeric_limits<double>::infinity();
    double lo = s0, hi = s1;
    for (int round = 0; round < 24; ++round) {
      const double h = (hi - lo) / 8;
      for (int i = 0; i <= 8; ++i) {
        const double s = lo + h * i, v = std::fabs(delta_at(s));
        if (v < best) {
          best = v;
          best_s = s;
        }
      }
      lo = std::max(s0, best_s - h);
      hi = std::min(s1, best_s + h);
    }
    const double t = foot(best_s);
    if (before == 0 || after == 0) {
      // The pieces end here; what lies beyond belongs to a neighbour.
      f_.halves_.push_back({s0, s1, t, before, after, reversed_});
      return;
    }
    for (const Tangency& c : f_.out_.tangencies)
      if (std::fabs(c.s - best_s) <= 1e-6 && std::fabs(c.t - t) <= 1e-6) return;
    f_.out_.tangencies.push_back({best_s, t, 0});
  }

  void read_band() {
    std::vector<Segment> list;
    for (const Piece& p : pieces_) classify(p.c, f_.tau_, p.s0, p.s1, 48, list);
    const double touch = 64 * std::sqrt(f_.tau_ * f_.size_);
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Segment& g = list[i];
      if (g.state != 0) {
        if (i > 0 && list[i - 1].state != 0) event(g.s0, g.s0, list[i - 1].state, g.state);
        continue;
      }
      const int before = i > 0 ? list[i - 1].state : 0,
                after = i + 1 < list.size() ? list[i + 1].state : 0;
      const Vec2 p = curve_point(f_.m_, f_.a_, g.s0).value,
                 q = curve_point(f_.m_, f_.a_, g.s1).value;
      if (norm(q - p) <= touch)
        event(g.s0, g.s1, before, after);
      else
        overlap(g, i == 0, i + 1 == list.size());
    }
  }

  void overlap(const Segment& g, bool first, bool last) {
    Overlap o{g.s0, g.s1, foot(g.s0), foot(g.s1),
              std::max(std::fabs(delta_at(g.s0)), std::fabs(delta_at(g.s1)))};
    if (first && lo_is_b_) o.t0 = reversed_ ? t1_ : t0_;
    if (last && hi_is_b_) o.t1 = reversed_ ? t0_ : t1_;
    // Ends that are end points of a curve have their parameters from the contacts.
    const double near = 64 * std::sqrt(f_.tau_ * f_.size_);
    const auto snap = [&](double& s, double& t) {
      const Vec2 p = curve_point(f_.m_, f_.a_, s).value;
      double best = near;
      double bs = s, bt = t;
      for (int i = 0; i < f_.contact_count_; ++i) {
        const Contact& c = f_.contacts_[static_cast<std::size_t>(i)];
        const double distance = norm(curve_point(f_.m_, f_.a_, c.s).value - p) +
                                norm(curve_point(f_.n_, f_.b_, c.t).value - p);
        if (distance < best) {
          best = distance;
          bs = c.s;
          bt = c.t;
        }
      }
      s = bs;
      t = bt;
    };
    snap(o.s0, o.t0);
    snap(o.s1, o.t1);
    for (const Piece& p : pieces_) {
      if (p.s1 < g.s0 || p.s0 > g.s1) continue;
      for (int i = 0; i <= 8; ++i) {
        const double s = p.s0 + (p.s1 - p.s0) * i / 8;
        if (s >= g.s0 && s <= g.s1) o.gap = std::max(o.gap, std::fabs(delta_at(s)));
      }
    }
    if (!(o.s0 < o.s1)) return;
    // Join with what a neighbouring cluster, or the comparison between contacts, found.
    for (Overlap& k : f_.out_.overlaps) {
      const bool same_way = (k.t0 < k.t1) == (o.t0 < o.t1);
      const double slack = 1e-9;
      const bool t_touch = std::min(o.t0, o.t1) <= std::max(k.t0, k.t1) + slack &&
                           std::min(k.t0, k.t1) <= std::max(o.t0, o.t1) + slack;
      if (!same_way || o.s0 > k.s1 + slack || k.s0 > o.s1 + slack || !t_touch) continue;
      if (o.s0 < k.s0) {
        k.s0 = o.s0;
        k.t0 = o.t0;
      }
      if (o.s1 > k.s1) {
        k.s1 = o.s1;
        k.t1 = o.t1;
      }
      k.gap = std::max(k.gap, o.gap);
      return;
    }
    f_.out_.overlaps.push_back(o);
  }

  IntersectSearch& f_;
  double s0_, s1_, t0_, t1_;
  bool reversed_ = false, lo_is_b_ = false, hi_is_b_ = false;
  Vec2 d_;
  mutable double last_t_ = -1;
  std::vector<Piece> pieces_;
};

/// All hodograph vectors of both pieces within 40 degrees of one line.
bool IntersectSearch::graph_like(const Vec2* pa, const Vec2* pb) const {
  const Vec2 chord = pa[m_] - pa[0];
  const double length = norm(chord);
  if (!(length > 64 * rounding_)) return false;
  for (int i = 0; i < m_; ++i) {
    const Vec2 e = pa[i + 1] - pa[i];
    if (!(dot(chord, e) >= 0.77 * length * norm(e) && (e.x() != 0 || e.y() != 0))) return false;
  }
  const double way = dot(chord, pb[n_] - pb[0]) >= 0 ? 1.0 : -1.0;
  for (int j = 0; j < n_; ++j) {
    const Vec2 e = pb[j + 1] - pb[j];
    if (!(way * dot(chord, e) >= 0.77 * length * norm(e) && (e.x() != 0 || e.y() != 0)))
      return false;
  }
  return true;
}

/// Halves that meet at a common border make one event; the others are the shoulder of something
/// known, or curve ends.
void IntersectSearch::join_halves() {
  constexpr double slack = 1e-9;
  std::sort(halves_.begin(), halves_.end(), [](const HalfEvent& p, const HalfEvent& q) {
    return p.s0 != q.s0 ? p.s0 < q.s0 : p.t < q.t;
  });
  for (std::size_t i = 0; i < halves_.size(); ++i)
    for (std::size_t j = i + 1; j < halves_.size();) {
      HalfEvent &p = halves_[i], &q = halves_[j];
      if (q.s0 <= p.s1 + slack && std::fabs(q.t - p.t) <= slack + 2 * (p.s1 - p.s0 + q.s1 - q.s0)) {
        p.s1 = std::max(p.s1, q.s1);
        if (p.before == 0) p.before = q.before;
        if (p.after == 0 || q.after != 0) p.after = q.after;
        halves_.erase(halves_.begin() + static_cast<std::ptrdiff_t>(j));
      } else {
        ++j;
      }
    }
  for (const HalfEvent& h : halves_) {
    const double s = 0.5 * (h.s0 + h.s1);
    const auto near = [&](double other_s, double other_t) {
      const double reach = slack + h.s1 - h.s0;
      return std::fabs(other_s - s) <= reach && std::fabs(other_t - h.t) <= 4 * reach;
    };
    const bool crossing = h.before * h.after < 0;
    const auto known = [&] {
      for (const Crossing& c : out_.crossings)
        if (near(c.s, c.t)) return true;
      for (const Tangency& c : out_.tangencies)
        if (near(c.s, c.t)) return true;
      for (const Overlap& o : out_.overlaps)
        if (near(o.s0, o.t0) || near(o.s1, o.t1)) return true;
      return false;
    };
    if (known()) continue;
    if (crossing)
      add_crossing(s, h.t, h.s0, h.s1, h.t, h.t, h.reversed ? -h.after : h.after, false);
    else
      out_.tangencies.push_back({s, h.t, 0});
  }
  halves_.clear();
}

void IntersectSearch::analyse(double s0, double s1, double t0, double t1) {
  ParallelPair(*this, s0, s1, t0, t1).run();
}

void IntersectSearch::resolve_cluster(std::span<const ParallelBox> boxes) {
  ParallelBox hull = boxes[0];
  for (const ParallelBox& box : boxes) {
    hull.s0 = std::min(hull.s0, box.s0);
    hull.s1 = std::max(hull.s1, box.s1);
    hull.t0 = std::min(hull.t0, box.t0);
    hull.t1 = std::max(hull.t1, box.t1);
  }
  if (boxes.size() > 1) {
    PointBuffer<max_curve_points> pa, pb;
    restrict_curve(m_, a_, hull.s0, hull.s1, pa.data());
    restrict_curve(n_, b_, hull.t0, hull.t1, pb.data());
    if (!graph_like(pa.data(), pb.data())) {
      const double middle = 0.5 * (hull.s0 + hull.s1);
      std::vector<ParallelBox> left, right;
      for (const ParallelBox& box : boxes) (box.s0 < middle ? left : right).push_back(box);
      if (left.empty() || right.empty()) {
        for (const ParallelBox& box : boxes) analyse(box.s0, box.s1, box.t0, box.t1);
        return;
      }
      resolve_cluster(left);
      resolve_cluster(right);
      return;
    }
  }
  analyse(hull.s0, hull.s1, hull.t0, hull.t1);
}

void IntersectSearch::resolve_parallel() {
  // Boxes that touch belong together.
  std::vector<ParallelBox> open(std::move(parallel_)), cluster;
  while (!open.empty()) {
    cluster.assign(1, open.back());
    open.pop_back();
    for (std::size_t i = 0; i < cluster.size(); ++i)
      for (std::size_t j = 0; j < open.size();) {
        const ParallelBox &p = cluster[i], &q = open[j];
        if (p.s0 <= q.s1 && q.s0 <= p.s1 && p.t0 <= q.t1 && q.t0 <= p.t1) {
          cluster.push_back(q);
          open[j] = open.back();
          open.pop_back();
        } else {
          ++j;
        }
      }
    std::sort(cluster.begin(), cluster.end(), [](const ParallelBox& p, const ParallelBox& q) {
      return p.s0 != q.s0 ? p.s0 < q.s0 : p.t0 < q.t0;
    });
    resolve_cluster(cluster);
  }
  join_halves();
}

}  // namespace bezel::geometry_kernel
