#include "bezel/geometry/intersect_exact.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bezel/geometry/curve_incidence.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/geometry/intersect_collinear.hpp"
#include "bezel/geometry/isolate.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::geometry_kernel {
namespace {

using short_names::u;

constexpr int deepest = 40;  // halvings of each curve
// Roots of a larger condition get exact residuals: the first stage leaves parameters uncertain by
// 4 u condition, here 2^-31, digits that show in every use of the crossing.
constexpr double finish_condition = 0x1p20;

bool is_point(const CurveCache& c) {
  return c.box.lo == c.box.hi;
}

int degree_of(std::span<const Vec2> c) {
  return static_cast<int>(c.size()) - 1;
}

Dyadic end(int i) {
  return Dyadic(static_cast<double>(i));
}

struct Box {
  double s0, s1, t0, t1;
  int depth;
};

class ExactSearch {
 public:
  ExactSearch(const CurveCache& a, const CurveCache& b, CurveIntersections& out)
      : a_(a.control),
        b_(b.control),
        near_a_(a_),
        near_b_(b_),
        a_is_point_(is_point(a)),
        b_is_point_(is_point(b)),
        out_(out),
        magnitude_(std::max(a.magnitude, b.magnitude)) {}

  void run() {
    if (a_is_point_ || b_is_point_) {
      points();
      return;
    }
    exponent_ = std::ilogb(magnitude_) + 1;
    if (!isolate_scaled()) isolation_.open.push_back({0.0, 1.0, 0.0, 1.0, 0, 0.5, 0.5});
    for (const IsolatedRoot& r : isolation_.roots) {
      const Crossing c = crossing(r);
      // Ill-conditioned ones are computed again: exactly.
      if (c.condition <= finish_condition)
        out_.crossings.push_back(c);
      else
        isolation_.open.push_back({r.s_lo, r.s_hi, r.t_lo, r.t_hi, r.sign, r.s, r.t});
    }
    if (!isolation_.open.empty()) {
      for (const Crossing& c : out_.crossings) resolution_.roots.push_back(known(c));
      known_ = resolution_.roots.size();
      nodes_ = allowed_nodes();
      exact_a_.emplace(a_, exponent_);
      exact_b_.emplace(b_, exponent_);
      for (const OpenBox& box : isolation_.open)
        if (box.sign != 0) border(box);
      if (parallel()) return;
    }
    report();
  }

 private:
  // ---- A curve that is a point ----

  void points() {
    const bool first = a_is_point_;
    const std::span<const Vec2> curve = first ? b_ : a_;
    const Vec2 p = first ? a_[0] : b_[0];
    const auto add = [&](double s) {
      ResolvedRoot root{};
      root.s = root.s_lo = root.s_hi = first ? 0.0 : s;
      root.t = root.t_lo = root.t_hi = first ? s : 0.0;
      root.s_end = root.t_end = true;
      resolution_.roots.push_back(root);
    };
    if (a_is_point_ && b_is_point_) {
      if (curve[0] == p) add(0.0);
    } else {
      for (const Incidence& place : point_on_curve(curve, p).incidences) {
        if (place.lo == place.hi || place.proven) {
          add(place.lo);
          continue;
        }
        const ExactCurve c(curve, 0);
        ExactTaylor f = c.monomial();
        for (int x = 0; x < 2; ++x) f[static_cast<std::size_t>(x)][0] -= Dyadic(p[x]);
        const auto common = common_root(f[0], f[1], Dyadic(place.lo), Dyadic(place.hi));
        if (common && *common) add(place.lo);
        if (!common)
          resolution_.undecided.push_back({first ? 0.0 : place.lo, first ? 0.0 : place.hi,
                                           first ? place.lo : 0.0, first ? place.hi : 0.0,
                                           "a point on the curve, or nearly so"});
      }
    }
    report();
  }

  // ---- The first stage ----

  /// False when coordinates that differ by more than doubles hold cannot be scaled exactly. From
  /// then on `near_a_` and `near_b_` are what doubles can be used with.
  bool isolate_scaled() {
    unit_ = exponent_;
    bool exact = true;
    if (exponent_ <= -300 || exponent_ >= 300) {
      const auto scaled = [&](std::span<const Vec2> c) {
        std::vector<Vec2> out(c.begin(), c.end());
        for (Vec2& p : out)
          for (int x = 0; x < 2; ++x) {
            const double before = p[x];
            p[x] = std::ldexp(before, static_cast<int>(-exponent_));
            exact = exact && std::ldexp(p[x], static_cast<int>(exponent_)) == before;
          }
        return out;
      };
      scaled_a_ = scaled(a_);
      scaled_b_ = scaled(b_);
      near_a_ = scaled_a_;
      near_b_ = scaled_b_;
      unit_ = 0;
      magnitude_ = std::ldexp(magnitude_, static_cast<int>(-exponent_));
    }
    if (exact) isolate(near_a_, near_b_, isolation_);
    return exact;
  }

  /// Work allowed: less where exact numbers are long, for high degrees and where the coordinates'
  /// exponents are far apart.
  int allowed_nodes() const {
    int largest = -2000, smallest = 2000;
    for (const auto& c : {a_, b_})
      for (const Vec2& p : c)
        for (int x = 0; x < 2; ++x)
          if (p[x] != 0.0) {
            largest = std::max(largest, std::ilogb(p[x]));
            smallest = std::min(smallest, std::ilogb(p[x]));
          }
    const double spread = std::max(0, largest - smallest - 40) / 64.0;
    const double nodes = 60000.0 / (degree_of(a_) * degree_of(b_) * (1.0 + spread * spread));
    return std::max(256, static_cast<int>(nodes));
  }

  Crossing crossing(const IsolatedRoot& r) const {
    return crossing({r.s, r.t, r.s_lo, r.s_hi, r.t_lo, r.t_hi, 1, r.sign, 0.0, false, false, true});
  }
  static ResolvedRoot known(const Crossing& c) {
    return {c.s, c.t, c.s_lo, c.s_hi, c.t_lo, c.t_hi, 1, c.sign, 0.0, false, false, true};
  }

  /// A simple root close to the border of [0, 1]^2, or ill-conditioned.
  void border(const OpenBox& box) {
    // A common end point is the root.
    for (const int i : {0, 1})
      for (const int j : {0, 1})
        if ((i == 0 ? box.s0 == 0.0 : box.s1 == 1.0) && (j == 0 ? box.t0 == 0.0 : box.t1 == 1.0) &&
            (i == 0 ? a_.front() : a_.back()) == (j == 0 ? b_.front() : b_.back())) {
          const double s = i, t = j;
          ResolvedRoot root{s, t,        box.s0, box.s1, box.t0, box.t1,
                            1, box.sign, 0.0,    true,   true,   false};
          resolution_.roots.push_back(root);
          return;
        }
    // Not below what the doubles around s and t can tell.
    const double ds = std::max(0x1p-10 * (box.s1 - box.s0), 0x1p-36);
    const double dt = std::max(0x1p-10 * (box.t1 - box.t0), 0x1p-36);
    const std::size_t before = resolution_.roots.size();
    process({std::max(0.0, box.s - ds), std::min(1.0, box.s + ds), std::max(0.0, box.t - dt),
             std::min(1.0, box.t + dt), deepest - 10});
    if (resolution_.roots.size() == before) process({box.s0, box.s1, box.t0, box.t1, 0});
  }

  // ---- Nearly parallel pieces ----

  /// True when the answer is complete.
  bool parallel() {
    std::vector<Box> boxes;
    for (const OpenBox& box : isolation_.open)
      if (box.sign == 0) boxes.push_back({box.s0, box.s1, box.t0, box.t1, 0});
    if (boxes.empty()) return false;
    for (const Box& box : boxes)
      if (find_coincidence(box)) break;
    if (map_) {
      report_overlap();
    } else if (collinear(a_, b_)) {
      intersect_collinear(a_, b_, out_);
      return true;
    } else {
      join(boxes);
    }
    // A hard place must not take the work that others need.
    int left = nodes_;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const int share = left / static_cast<int>(boxes.size() - i) + 1;
      nodes_ = share;
      process(boxes[i]);
      left -= share - std::max(nodes_, 0);
    }
    return false;
  }

  /// Boxes that touch become one where one of the curves is a graph over the whole.
  void join(std::vector<Box>& boxes) {
    TubeSearch on_b(*exact_a_, *exact_b_, false, nodes_, resolution_);
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t k = 0; k < boxes.size(); ++k) {
        const Box &p = boxes[i], &q = boxes[k];
        if (i == k || p.s0 > q.s1 || q.s0 > p.s1 || p.t0 > q.t1 || q.t0 > p.t1) continue;
        const Box whole{std::min(p.s0, q.s0), std::max(p.s1, q.s1), std::min(p.t0, q.t0),
                        std::max(p.t1, q.t1), 0};
        if (!on_b.graph(whole.t0, whole.t1)) continue;
        boxes[i] = whole;
        boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(k));
        i = static_cast<std::size_t>(-1);  // from the start again
        break;
      }
  }

  // ---- Curves that coincide ----

  /// An end point of one curve on the other, at which both turn out to be one curve.
  bool find_coincidence(const Box& box) {
    const auto touches = [](int i, double lo, double hi) { return i == 0 ? lo == 0.0 : hi == 1.0; };
    for (const int i : {0, 1})
      for (const int j : {0, 1})
        if (touches(i, box.s0, box.s1) && touches(j, box.t0, box.t1) &&
            (i == 0 ? a_.front() : a_.back()) == (j == 0 ? b_.front() : b_.back()) &&
            try_map({end(i)}, {end(j)}))
          return true;
    for (const int i : {0, 1}) {
      for (const double x : {0.5, 0.0, 1.0}) {
        if (touches(i, box.s0, box.s1)) {
          const auto t =
              foot(*exact_b_, near_b_, (*exact_a_)(end(i)),
                   i == 0 ? near_a_.front() : near_a_.back(), box.t0 + x * (box.t1 - box.t0));
          if (t && try_map({end(i)}, *t)) return true;
        }
        if (touches(i, box.t0, box.t1)) {
          const auto s =
              foot(*exact_a_, near_a_, (*exact_b_)(end(i)),
                   i == 0 ? near_b_.front() : near_b_.back(), box.s0 + x * (box.s1 - box.s0));
          if (s && try_map(*s, {end(i)})) return true;
        }
      }
    }
    return false;
  }

  bool try_map(const Ratio& s, const Ratio& t) {
    const auto contact = verify_contact(*exact_a_, *exact_b_, s, t);
    if (!contact) return false;
    const auto change = coincide(*contact);
    if (!change) return false;
    map_.emplace(*contact, *change);
    return true;
  }

  /// The rational parameter of p on a curve, if it seems to be on it, by Newton's method from
  /// `start`.
  std::optional<Ratio> foot(const ExactCurve& curve, std::span<const Vec2> control,
                            const ExactPoint& p, const Vec2& rounded, double start) {
    const int d = degree_of(control);
    double near = start;
    for (int i = 0; i < 40; ++i) {
      const CurvePoint f = curve_point(d, control.data(), near, rounded);
      const double speed_squared = dot(f.derivative, f.derivative);
      if (!(speed_squared > 0) || !std::isfinite(speed_squared)) return std::nullopt;
      const double step = dot(f.value, f.derivative) / speed_squared;
      near = std::clamp(near - step, -0.25, 1.25);
      if (std::fabs(step) <= 0x1p-48) break;
    }
    const CurvePoint f = curve_point(d, control.data(), near, rounded);
    if (!(norm(f.value) <= 0x1p-40 * magnitude_)) return std::nullopt;
    // Exactly: simple fractions are found at once, others after a few steps.
    Dyadic t(near);
    const double scale = std::ldexp(1.0, static_cast<int>(-unit_));
    const Vec2 slope = scale * f.derivative;
    double step = 0.0;
    for (int i = 0; i < 12; ++i) {
      const ExactPoint q = curve(t);
      const Vec2 off{{(p[0] - q[0]).to_double(), (p[1] - q[1]).to_double()}};
      step = dot(off, slope) / dot(slope, slope);
      if (!std::isfinite(step)) return std::nullopt;
      if (step == 0.0) break;
      t += Dyadic(step);
      if (std::fabs(step) < 0x1p-330) break;
    }
    if (t.sign() < 0) return std::nullopt;
    if (step == 0.0) return Ratio{t};
    const Dyadic pad = Dyadic(0x1p-320);
    return simplest_between(t < pad ? Dyadic() : t - pad, t + pad, 150);
  }

  void report_overlap() {
    const Ratio zero{}, one{1.0};
    Ratio first = map_->backward(zero), last = map_->backward(one);
    Ratio t_first = zero, t_last = one;
    if (compare(last, first) < 0) {
      std::swap(first, last);
      std::swap(t_first, t_last);
    }
    if (compare(first, zero) < 0) {
      first = zero;
      t_first = map_->forward(zero);
    }
    if (compare(one, last) < 0) {
      last = one;
      t_last = map_->forward(one);
    }
    const int order = compare(first, last);
    if (order < 0)
      out_.overlaps.push_back(
          {to_double(first), to_double(last), to_double(t_first), to_double(t_last), 0.0});
    if (order == 0) {
      const double s = to_double(first), t = to_double(t_first);
      const auto is_end = [&](const Ratio& x) {
        return compare(x, zero) == 0 || compare(x, one) == 0;
      };
      resolution_.roots.push_back(
          {s, t, s, s, t, t, 0, 0, 0.0, is_end(first), is_end(t_first), false});
    }
  }

  enum class Diagonal { beside, alone, unclear };
  /// Where the box lies to the pairs (s, map(s)): beside; or no others are in it.
  Diagonal diagonal(const Box& box) const {
    double lo = 0.0, hi = 0.0;
    map_->image(box.s0, box.s1, lo, hi);
    if (hi < box.t0 || lo > box.t1) return Diagonal::beside;
    lo = std::min(lo, box.t0);
    hi = std::max(hi, box.t1);
    // b(map(s)) = b(t) needs map(s) = t when b moves in one direction between.
    const double centre = 0.5 * (lo + hi), radius = 0.5 * (hi - lo) * (1.0 + 0x1p-40);
    if (one_way(exact_b_->taylor(Dyadic(centre)), radius, false)) return Diagonal::alone;
    const auto cusp = simplest_between(Dyadic(std::max(lo, 0.0)), Dyadic(std::max(hi, 0.0)), 30);
    if (cusp && cusp->den == Dyadic(1.0)) return Diagonal::unclear;
    const ExactTaylor at_cusp = exact_b_->taylor(cusp.value_or(Ratio{Dyadic(centre)}));
    if (one_way(at_cusp, 2.0 * radius, true)) return Diagonal::alone;
    return Diagonal::unclear;
  }

  /// Whether a direction exists in which the curve strictly moves within the radius.
  /// @param rest  also where the first derivative vanishes in the middle
  static bool one_way(const ExactTaylor& c, double radius, bool rest) {
    std::size_t j = 1;
    const std::size_t n = c[0].size() - 1;
    while (rest && j < n && c[0][j].sign() == 0 && c[1][j].sign() == 0) ++j;
    if (rest && j == 1) return false;
    std::array<Dyadic, 2> direction{c[0][j], c[1][j]};
    if (j % 2 == 0) direction = {-c[1][j], c[0][j]};
    // Of direction . derivative: coefficient of h^(k-1), relative to the first that does not
    // vanish.
    std::size_t first = 0;
    double sum = 0.0, leading = 0.0, power = 1.0;
    for (std::size_t k = 1; k <= n; ++k) {
      const Dyadic along = direction[0] * c[0][k] + direction[1] * c[1][k];
      if (first == 0) {
        if (along.sign() == 0) continue;
        first = k;
        leading = static_cast<double>(k) * std::fabs(along.to_double());
        continue;
      }
      power *= radius;
      sum += static_cast<double>(k) * std::fabs(along.to_double()) * power;
    }
    return first % 2 == 1 && leading > sum * (1.0 + 0x1p-40) && leading > 0x1p-900;
  }

  // ---- Boxes ----

  void process(const Box& start) {
    std::vector<Box> queue{start};  // larger boxes first
    TubeSearch on_b(*exact_a_, *exact_b_, false, nodes_, resolution_);
    TubeSearch on_a(*exact_b_, *exact_a_, true, nodes_, resolution_);
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const Box box = queue[next];
      if (--nodes_ < 0) {
        resolution_.undecided.push_back({box.s0, box.s1, box.t0, box.t1, "more work than allowed"});
        continue;
      }
      if (apart(box)) continue;
      bool near_diagonal = false;
      if (map_) {
        const Diagonal where = diagonal(box);
        if (where == Diagonal::alone) continue;
        near_diagonal = where == Diagonal::unclear;
      }
      if (!near_diagonal) {
        // A straight curve is the better graph.
        const bool a_first = exact_a_->direction() && !exact_b_->direction();
        if (a_first && on_a.graph(box.s0, box.s1)) {
          on_a.run(box.t0, box.t1);
          continue;
        }
        if (on_b.graph(box.t0, box.t1)) {
          on_b.run(box.s0, box.s1);
          continue;
        }
        if (on_a.graph(box.s0, box.s1)) {
          on_a.run(box.t0, box.t1);
          continue;
        }
      }
      if (box.depth == deepest) {
        resolution_.undecided.push_back({box.s0, box.s1, box.t0, box.t1,
                                         near_diagonal ? "on a curve that coincides and is singular"
                                                       : "both curves are singular"});
        continue;
      }
      const double s = 0.5 * (box.s0 + box.s1), t = 0.5 * (box.t0 + box.t1);
      const int depth = box.depth + 1;
      queue.push_back({s, box.s1, t, box.t1, depth});
      queue.push_back({s, box.s1, box.t0, t, depth});
      queue.push_back({box.s0, s, t, box.t1, depth});
      queue.push_back({box.s0, s, box.t0, t, depth});
    }
  }

  /// The control points of the parts lie in boxes that are apart, also after rounding.
  bool apart(const Box& box) const {
    PointBuffer<max_curve_points> on_a, on_b;
    const int m = degree_of(a_), n = degree_of(b_);
    restrict_curve(m, near_a_.data(), box.s0, box.s1, on_a.data());
    restrict_curve(n, near_b_.data(), box.t0, box.t1, on_b.data());
    const Box2 p = control_box(m, on_a.data()), q = control_box(n, on_b.data());
    const double room = 8.0 * (m + n + 2) * u * magnitude_ + 0x1p-1060;
    return p.lo.x() > q.hi.x() + room || q.lo.x() > p.hi.x() + room || p.lo.y() > q.hi.y() + room ||
           q.lo.y() > p.hi.y() + room;
  }

  // ---- The answer ----

  /// Of the curves used in doubles, as a point of the given ones.
  Vec2 unscaled(const Vec2& p) const {
    const int e = static_cast<int>(exponent_ - unit_);
    return e == 0 ? p : Vec2{{std::ldexp(p.x(), e), std::ldexp(p.y(), e)}};
  }

  /// A parameter that is no end of its curve is not reported as one: consumers take exactly 0 and 1
  /// for the end points, so it stays a rounding away from them.
  static double reported(double x, bool end) {
    constexpr double least = std::numeric_limits<double>::denorm_min(), most = 1.0 - 0x1p-53;
    return end ? x : std::clamp(x, least, most);
  }

  Crossing crossing(ResolvedRoot root) const {
    root.s = reported(root.s, root.s_end);
    root.t = reported(root.t, root.t_end);
    const CurvePoint p = curve_point(degree_of(a_), near_a_.data(), root.s);
    const CurvePoint q = curve_point(degree_of(b_), near_b_.data(), root.t);
    Crossing c{};
    c.s = root.s;
    c.t = root.t;
    c.s_lo = std::min(root.s_lo, root.s);
    c.s_hi = std::max(root.s_hi, root.s);
    c.t_lo = std::min(root.t_lo, root.t);
    c.t_hi = std::max(root.t_hi, root.t);
    c.certified = true;
    c.sign = root.sign;
    c.point_a = root.s == 0.0 ? a_.front() : root.s == 1.0 ? a_.back() : unscaled(p.value);
    c.point_b = root.t == 0.0 ? b_.front() : root.t == 1.0 ? b_.back() : unscaled(q.value);
    const double fast_squared =
        std::max(dot(p.derivative, p.derivative), dot(q.derivative, q.derivative));
    double turn = std::fabs(cross(p.derivative, q.derivative));
    if (root.turn > 0.0) turn = std::ldexp(root.turn, static_cast<int>(2 * unit_));
    c.condition = root.sign != 0 && turn > 0.0 ? magnitude_ * std::sqrt(fast_squared) / turn
                                               : std::numeric_limits<double>::infinity();
    return c;
  }

  void report() {
    for (std::size_t i = known_; i < resolution_.roots.size(); ++i) {
      const ResolvedRoot& root = resolution_.roots[i];
      if (root.order != 1 && !root.s_end && !root.t_end)
        out_.tangencies.push_back(
            {reported(root.s, false), reported(root.t, false), root.order, root.contact_sign});
      else
        out_.crossings.push_back(crossing(root));
    }
    const auto earlier = [](const auto& p, const auto& q) {
      return p.s != q.s ? p.s < q.s : p.t < q.t;
    };
    if (out_.crossings.size() > 1) std::sort(out_.crossings.begin(), out_.crossings.end(), earlier);
    if (out_.tangencies.size() > 1)
      std::sort(out_.tangencies.begin(), out_.tangencies.end(), earlier);
    for (const Undecided& box : resolution_.undecided) {
      bool joined = false;
      for (UnresolvedBox& known : out_.unresolved) {
        if (box.s0 > known.s_hi || known.s_lo > box.s1 || box.t0 > known.t_hi ||
            known.t_lo > box.t1)
          continue;
        known = {std::min(known.s_lo, box.s0), std::max(known.s_hi, box.s1),
                 std::min(known.t_lo, box.t0), std::max(known.t_hi, box.t1), known.reason};
        joined = true;
        break;
      }
      if (!joined) out_.unresolved.push_back({box.s0, box.s1, box.t0, box.t1, box.reason});
    }
  }

  std::span<const Vec2> a_, b_;
  std::span<const Vec2> near_a_, near_b_;  // the same, or scaled to coordinates below 1
  std::vector<Vec2> scaled_a_, scaled_b_;
  bool a_is_point_, b_is_point_;
  CurveIntersections& out_;
  double magnitude_;           // largest |coordinate| of near_a_ and near_b_
  std::int64_t exponent_ = 0;  // the exact curves are a_ and b_ times 2^-exponent_
  std::int64_t unit_ = 0;      // and near_a_ and near_b_ times 2^-unit_
  Isolation isolation_;
  Resolution resolution_;
  std::size_t known_ = 0;  // of its roots: already reported
  std::optional<ExactCurve> exact_a_, exact_b_;
  std::optional<CoincidenceMap> map_;
  int nodes_ = 0;
};

}  // namespace

CoincidenceMap::CoincidenceMap(const ExactContact& contact, const AffineChange& change)
    : s_(contact.s), t_(contact.t), p_(change.p), q_(change.q) {
  if (q_.sign() < 0) {
    p_ = -p_;
    q_ = -q_;
  }
}

// t + (p / q) (s - s0)
Ratio CoincidenceMap::forward(const Ratio& s) const {
  return {t_.num * q_ * s.den * s_.den + p_ * t_.den * (s.num * s_.den - s_.num * s.den),
          t_.den * q_ * s.den * s_.den};
}

Ratio CoincidenceMap::backward(const Ratio& t) const {
  const bool negative = p_.sign() < 0;
  const Dyadic p = negative ? -p_ : p_, q = negative ? -q_ : q_;
  return {s_.num * p * t.den * t_.den + q * s_.den * (t.num * t_.den - t_.num * t.den),
          s_.den * p * t.den * t_.den};
}

void CoincidenceMap::image(double s0, double s1, double& lo, double& hi) const {
  const Ratio from = forward({Dyadic(s0)}), to = forward({Dyadic(s1)});
  lo = quotient(from.num, from.den);
  hi = quotient(to.num, to.den);
  if (lo > hi) std::swap(lo, hi);
  const double room = 8.0 * u * std::max(std::fabs(lo), std::fabs(hi)) + 0x1p-1000;
  lo -= room;
  hi += room;
}

void intersect_exactly(const CurveCache& a, const CurveCache& b, CurveIntersections& out) {
  ExactSearch(a, b, out).run();
}

}  // namespace bezel::geometry_kernel
