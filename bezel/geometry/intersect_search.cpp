// Curve-curve intersection with a coincidence distance: subdivision with a test for at most one
// root per box.

#include "bezel/geometry/intersect_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "bezel/geometry/newton_intersection_kernel.hpp"

namespace bezel {
namespace geometry_kernel {

namespace {

constexpr int max_depth = 50;    // halvings of one curve
constexpr int max_work = 20000;  // boxes looked at
// Crossings of a larger condition get compensated residuals. Plain ones leave a parameter uncertain
// by 4 u condition: here 2^-31, digits that show in every use of the crossing. Ordinary meshes stay
// far below (1e3 for elements of size 1e-3 in a unit domain), and pay nothing.
constexpr double polish_condition = 0x1p20;
constexpr double polished_error = 0x1p-40;  // of parameters, at conditions beyond 1/u; else a few u

double extent(const Box2& box) {
  return std::max(box.hi.x() - box.lo.x(), box.hi.y() - box.lo.y());
}

/// M: the degree, or 0 when it is only known at run time.
template <int M>
CurvePiece make_piece(int degree, const Vec2* p, double lo, double hi, int depth) {
  const int m = M > 0 ? M : degree;
  CurvePiece piece;
  piece.p = p;
  piece.lo = lo;
  piece.hi = hi;
  piece.depth = depth;
  piece.box_lo_x = piece.box_hi_x = p[0].x();
  piece.box_lo_y = piece.box_hi_y = p[0].y();
  piece.chord = p[m] - p[0];
  piece.band_lo = piece.band_hi = 0;
  for (int i = 1; i <= m; ++i) {
    const double x = p[i].x(), y = p[i].y();
    piece.box_lo_x = x < piece.box_lo_x ? x : piece.box_lo_x;
    piece.box_hi_x = x > piece.box_hi_x ? x : piece.box_hi_x;
    piece.box_lo_y = y < piece.box_lo_y ? y : piece.box_lo_y;
    piece.box_hi_y = y > piece.box_hi_y ? y : piece.box_hi_y;
    if (i == m) break;
    const double c = cross(piece.chord, p[i] - p[0]);
    piece.band_lo = c < piece.band_lo ? c : piece.band_lo;
    piece.band_hi = c > piece.band_hi ? c : piece.band_hi;
  }
  return piece;
}

bool boxes_apart(const CurvePiece& a, const CurvePiece& b, double margin) {
  return a.box_lo_x > b.box_hi_x + margin || b.box_lo_x > a.box_hi_x + margin ||
         a.box_lo_y > b.box_hi_y + margin || b.box_lo_y > a.box_hi_y + margin;
}

/// As outside_fat_line, for pieces; N is q's degree.
template <int N>
bool fat_line_misses(const CurvePiece& a, const CurvePiece& b, int degree, double margin) {
  const int n = N > 0 ? N : degree;
  const double slack = margin * (std::fabs(a.chord.x()) + std::fabs(a.chord.y()));
  const double first = cross(a.chord, b.p[0] - a.p[0]);
  double lo = first, hi = first;
  for (int j = 1; j <= n; ++j) {
    const double c = cross(a.chord, b.p[j] - a.p[0]);
    lo = c < lo ? c : lo;
    hi = c > hi ? c : hi;
  }
  return hi < a.band_lo - slack || lo > a.band_hi + slack;
}

}  // namespace

IntersectSearch::IntersectSearch(const CurveCache& a, const CurveCache& b,
                                 const IntersectOptions& options, CurveIntersections& out)
    : ca_(a),
      cb_(b),
      m_(static_cast<int>(a.control.size()) - 1),
      n_(static_cast<int>(b.control.size()) - 1),
      a_(a.control.data()),
      b_(b.control.data()),
      out_(out),
      tol_(options.coincidence_distance),
      magnitude_(std::max(a.magnitude, b.magnitude)),
      rounding_(0x1p-52 * magnitude_),
      tau_(std::max(tol_, rounding_)),
      margin_(std::max(tol_, 0x1p-53 * magnitude_)),
      size_(std::min(extent(a.box), extent(b.box))),
      shallow_(std::max(1e-13, std::sqrt(tau_ / size_) / 32)),
      parallel_depth_(4) {}

IntersectSearch::Newton IntersectSearch::newton(double& s, double& t, double s0, double s1,
                                                double t0, double t1) const {
  // Relative to a point near the root the residual is accurate to u times the curves' size there.
  const Vec2 origin = curve_point(m_, a_, s).value;
  for (int i = 0; i < 12; ++i) {
    const CurvePoint p = curve_point(m_, a_, s, origin), q = curve_point(n_, b_, t, origin);
    const Vec2 f = p.value - q.value;
    const double det = cross(q.derivative, p.derivative);
    if (det == 0.0) return Newton::lost;
    // a' ds - b' dt = -f
    const double ds = cross(f, q.derivative) / det, dt = cross(f, p.derivative) / det;
    const double next_s = std::clamp(s + ds, s0, s1), next_t = std::clamp(t + dt, t0, t1);
    const bool same = next_s == s && next_t == t;
    const bool clamped = next_s != s + ds || next_t != t + dt;
    s = next_s;
    t = next_t;
    if (std::fabs(ds) <= 1e-9 * (s1 - s0) && std::fabs(dt) <= 1e-9 * (t1 - t0)) {
      if (!clamped) return Newton::root;
      // The root is beyond the box's border: on it to rounding, or a neighbour's (or nobody's).
      const Vec2 rest = curve_point(m_, a_, s, origin).value - curve_point(n_, b_, t, origin).value;
      return norm(rest) <= 4 * rounding_ ? Newton::root : Newton::none;
    }
    if (same) return norm(f) <= rounding_ ? Newton::root : Newton::lost;
  }
  return Newton::lost;
}

/// C = [chord_a, -chord_b]^-1; with F = a(s) - b(t) in the pieces' own parameters, ||I - C F'|| < 1
/// over the whole box (from the hodographs' control points) makes F one to one there, so it holds
/// at most one root, and every root is within that norm of C (b_0 - a_0).
template <int M, int N>
IntersectSearch::Outcome IntersectSearch::transversal(const CurvePiece& a, const CurvePiece& b) {
  const int m = M > 0 ? M : m_, n = N > 0 ? N : n_;
  const Vec2 *pa = a.p, *pb = b.p, chord_a = a.chord, chord_b = b.chord;
  const double det = cross(chord_a, chord_b);
  const double length_a = std::fabs(chord_a.x()) + std::fabs(chord_a.y());
  const double length_b = std::fabs(chord_b.x()) + std::fabs(chord_b.y());
  if (!(std::fabs(det) > shallow_ * length_a * length_b)) return Outcome::open;
  if (length_a < 256 * rounding_ || length_b < 256 * rounding_) return Outcome::open;
  const double inverse = 1.0 / det;
  double row1_a = 0, row2_a = 0, row1_b = 0, row2_b = 0;
  for (int i = 0; i < m; ++i) {
    const Vec2 e = pa[i + 1] - pa[i];
    const double x = m * cross(e, chord_b) * inverse, y = m * cross(e, chord_a) * inverse;
    row1_a = std::max(row1_a, std::fabs(1.0 - x));
    row2_a = std::max(row2_a, std::fabs(y));
  }
  for (int j = 0; j < n; ++j) {
    const Vec2 e = pb[j + 1] - pb[j];
    const double x = n * cross(e, chord_b) * inverse, y = n * cross(chord_a, e) * inverse;
    row1_b = std::max(row1_b, std::fabs(x));
    row2_b = std::max(row2_b, std::fabs(1.0 - y));
  }
  const double q = std::max(row1_a + row1_b, row2_a + row2_b);
  if (!(q < 0.98)) return Outcome::open;
  const Vec2 d = pb[0] - pa[0];
  const double x = cross(d, chord_b) * inverse, y = cross(d, chord_a) * inverse;
  if (x < -q - 1e-9 || x > 1 + q + 1e-9 || y < -q - 1e-9 || y > 1 + q + 1e-9) return Outcome::none;
  const double s0 = a.lo, s1 = a.hi, t0 = b.lo, t1 = b.hi;
  double s = s0 + (s1 - s0) * std::clamp(x, 0.0, 1.0), t = t0 + (t1 - t0) * std::clamp(y, 0.0, 1.0);
  const Newton result = newton(s, t, s0, s1, t0, t1);
  if (result == Newton::lost) return Outcome::open;
  if (result == Newton::none) return Outcome::none;
  add_crossing(s, t, s0, s1, t0, t1, det > 0 ? 1 : -1, true);
  return Outcome::one;
}

template <int M, int N>
void IntersectSearch::descend(const CurvePiece& a, const CurvePiece& b) {
  const int m = M > 0 ? M : m_, n = N > 0 ? N : n_;
  if (++work_ > max_work) {
    unresolved(a.lo, a.hi, b.lo, b.hi, "too many boxes");
    return;
  }
  if (transversal<M, N>(a, b) != Outcome::open) return;
  // A few more halvings often part curves that merely pass at a small angle; many open boxes mean
  // that they run along each other, and then the second stage is the shorter way.
  const int ready = work_ < 60 ? 7 : parallel_depth_;
  if (a.depth >= ready && b.depth >= ready && graph_like(a.p, b.p)) {
    parallel_.push_back({a.lo, a.hi, b.lo, b.hi});
    return;
  }
  const double extent_a = a.extent(), extent_b = b.extent(), smallest = 4 * tau_;
  if ((extent_a <= smallest || a.depth >= max_depth) &&
      (extent_b <= smallest || b.depth >= max_depth)) {
    unresolved(a.lo, a.hi, b.lo, b.hi, "the curves meet where one of them is singular");
    return;
  }
  const bool split_a = (extent_a >= 0.5 * extent_b && a.depth < max_depth) || b.depth >= max_depth;
  const bool split_b = (extent_b >= 0.5 * extent_a && b.depth < max_depth) || a.depth >= max_depth;
  constexpr int room_a = M > 0 ? M + 1 : max_curve_points,
                room_b = N > 0 ? N + 1 : max_curve_points;
  PointBuffer<2 * room_a> halves_a;
  PointBuffer<2 * room_b> halves_b;
  CurvePiece pieces_a[2] = {a, a}, pieces_b[2] = {b, b};
  if (split_a) {
    Vec2 *left = halves_a.data(), *right = left + m + 1;
    halve<M>(m, a.p, left, right);
    const double s = 0.5 * (a.lo + a.hi);
    pieces_a[0] = make_piece<M>(m, left, a.lo, s, a.depth + 1);
    pieces_a[1] = make_piece<M>(m, right, s, a.hi, a.depth + 1);
  }
  if (split_b) {
    Vec2 *left = halves_b.data(), *right = left + n + 1;
    halve<N>(n, b.p, left, right);
    const double t = 0.5 * (b.lo + b.hi);
    pieces_b[0] = make_piece<N>(n, left, b.lo, t, b.depth + 1);
    pieces_b[1] = make_piece<N>(n, right, t, b.hi, b.depth + 1);
  }
  for (int i = 0; i < (split_a ? 2 : 1); ++i)
    for (int j = 0; j < (split_b ? 2 : 1); ++j) {
      const CurvePiece &p = pieces_a[i], &q = pieces_b[j];
      if (!boxes_apart(p, q, margin_) && !fat_line_misses<N>(p, q, n, margin_) &&
          !fat_line_misses<M>(q, p, m, margin_))
        descend<M, N>(p, q);
    }
}

template <int M, int N>
void IntersectSearch::descend_all() {
  descend<M, N>(make_piece<M>(m_, a_, 0.0, 1.0, 0), make_piece<N>(n_, b_, 0.0, 1.0, 0));
}

void IntersectSearch::run() {
  find_contacts();
  if (!find_overlaps()) {
    if (m_ == 1 && n_ == 1)
      descend_all<1, 1>();
    else if (m_ == 2 && n_ == 2)
      descend_all<2, 2>();
    else if (m_ == 3 && n_ == 3)
      descend_all<3, 3>();
    else
      descend_all<0, 0>();
    if (!parallel_.empty()) resolve_parallel();
  }
  finish();
}

bool IntersectSearch::polish(double& s, double& t, double s0, double s1, double t0,
                             double t1) const {
  const NewtonCurve a(ca_.control), b(cb_.control);
  double x = s, y = t, before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 12; ++i) {
    const Vec2 f = residual(a, x, b, y, ResidualForm::compensated);
    Vec2 step;
    if (!(f == Vec2{}) && !solve(a.derivative(x), -b.derivative(y), f, step)) return false;
    // A root on the border may seem to lie outside, by rounding.
    const double next_x = x - step.x(), next_y = y - step.y();
    x = std::clamp(next_x, s0, s1);
    y = std::clamp(next_y, t0, t1);
    if (!(std::fabs(next_x - x) <= polished_error && std::fabs(next_y - y) <= polished_error))
      return false;
    const double length = std::hypot(step.x(), step.y());
    // Done at rounding level, or where rounding keeps the steps from shrinking further.
    if (length <= 0x1p-52 * std::hypot(x, y) ||
        (length <= polished_error && length > 0.25 * before)) {
      s = x;
      t = y;
      return true;
    }
    before = length;
  }
  return false;
}

void IntersectSearch::add_crossing(double s, double t, double s0, double s1, double t0, double t1,
                                   int sign, bool certified) {
  CurvePoint p = curve_point(m_, a_, s), q = curve_point(n_, b_, t);
  double speed_a = norm(p.derivative), speed_b = norm(q.derivative);
  const auto safe_sine_of = [&] {
    const double sine = std::fabs(cross(p.derivative, q.derivative)) / (speed_a * speed_b);
    return sine > 1e-300 ? sine : 1e-300;
  };
  double safe_sine = safe_sine_of();
  const bool polished = magnitude_ > polish_condition * std::min(speed_a, speed_b) * safe_sine &&
                        polish(s, t, s0, s1, t0, t1);
  if (polished) {
    p = curve_point(m_, a_, s);
    q = curve_point(n_, b_, t);
    speed_a = norm(p.derivative);
    speed_b = norm(q.derivative);
    safe_sine = safe_sine_of();
  }
  // Near an end point that lies on the other curve the two are one event: an end point within tau
  // of a curve crossed at this angle is within tau / sine of the crossing.
  for (int i = 0; i < contact_count_; ++i) {
    Contact& c = contacts_[static_cast<std::size_t>(i)];
    const double reach = std::min(4 * tau_ / safe_sine, 0.05 * size_) + 2 * tau_;
    if (std::fabs(s - c.s) * speed_a <= reach && std::fabs(t - c.t) * speed_b <= reach) {
      c.sign += sign;
      c.certified = c.certified || certified;
      return;
    }
  }
  // Neighbouring boxes both hold a root on their common border; the same simple root has the same
  // sign. Polished ones are told apart where the others are not: three crossings at a small angle
  // lie closer than the error that the angle leaves to each, and the third has the first one's
  // sign.
  const double error = 8 * rounding_ / safe_sine;
  std::size_t at = out_.crossings.size();
  for (std::size_t i = 0; i < out_.crossings.size(); ++i) {
    const Crossing& c = out_.crossings[i];
    if (c.sign != sign || !(std::fabs(s - c.s) * speed_a <= error) ||
        !(std::fabs(t - c.t) * speed_b <= error))
      continue;
    const bool both = polished && i < 64 && ((polished_ >> i) & 1U) != 0;
    if (!polished || (both && std::fabs(s - c.s) <= 2 * polished_error &&
                      std::fabs(t - c.t) <= 2 * polished_error))
      return;
    if (!both) at = i;  // the better one takes its place
  }
  Crossing c{};
  c.s = s;
  c.t = t;
  c.s_lo = s0;
  c.s_hi = s1;
  c.t_lo = t0;
  c.t_hi = t1;
  c.sign = sign;
  c.certified = certified;
  c.point_a = p.value;
  c.point_b = q.value;
  c.condition = magnitude_ / (std::min(speed_a, speed_b) * safe_sine);
  if (at == out_.crossings.size())
    out_.crossings.push_back(c);
  else
    out_.crossings[at] = c;
  if (polished && at < 64) polished_ |= std::uint64_t{1} << at;
}

void IntersectSearch::unresolved(double s0, double s1, double t0, double t1, const char* reason) {
  // Adjacent boxes grow into one.
  for (UnresolvedBox& box : out_.unresolved)
    if (s0 <= box.s_hi && box.s_lo <= s1 && t0 <= box.t_hi && box.t_lo <= t1) {
      box.s_lo = std::min(box.s_lo, s0);
      box.s_hi = std::max(box.s_hi, s1);
      box.t_lo = std::min(box.t_lo, t0);
      box.t_hi = std::max(box.t_hi, t1);
      return;
    }
  out_.unresolved.push_back({s0, s1, t0, t1, reason});
}

void IntersectSearch::finish() {
  auto& overlaps = out_.overlaps;
  if (overlaps.size() > 1)
    std::sort(overlaps.begin(), overlaps.end(),
              [](const Overlap& p, const Overlap& q) { return p.s0 < q.s0; });
  const auto covered = [&](double s, double t, double s_slack, double t_slack) {
    return std::any_of(overlaps.begin(), overlaps.end(), [&](const Overlap& o) {
      return s >= o.s0 - s_slack && s <= o.s1 + s_slack && t >= std::min(o.t0, o.t1) - t_slack &&
             t <= std::max(o.t0, o.t1) + t_slack;
    });
  };
  if (!overlaps.empty()) {
    const double s_slack = 16 * tau_ / std::max(extent(ca_.box), tau_);
    const double t_slack = 16 * tau_ / std::max(extent(cb_.box), tau_);
    std::erase_if(out_.crossings,
                  [&](const Crossing& c) { return covered(c.s, c.t, s_slack, t_slack); });
    std::erase_if(out_.tangencies,
                  [&](const Tangency& c) { return covered(c.s, c.t, s_slack, t_slack); });
    std::erase_if(out_.unresolved, [&](const UnresolvedBox& c) {
      return covered(c.s_lo, c.t_lo, s_slack, t_slack) && covered(c.s_hi, c.t_hi, s_slack, t_slack);
    });
    for (int i = 0; i < contact_count_; ++i) {
      Contact& c = contacts_[static_cast<std::size_t>(i)];
      c.in_overlap = covered(c.s, c.t, s_slack, t_slack);
    }
  }
  // What stayed open only around an end point on the other curve is that end point.
  if (!out_.unresolved.empty())
    std::erase_if(out_.unresolved, [&](const UnresolvedBox& box) {
      for (int i = 0; i < contact_count_; ++i) {
        const Contact& c = contacts_[static_cast<std::size_t>(i)];
        const double slack = 1e-6;
        if (c.s >= box.s_lo - slack && c.s <= box.s_hi + slack && c.t >= box.t_lo - slack &&
            c.t <= box.t_hi + slack && box.s_hi - box.s_lo <= slack && box.t_hi - box.t_lo <= slack)
          return true;
      }
      return false;
    });
  for (int i = 0; i < contact_count_; ++i) {
    const Contact& contact = contacts_[static_cast<std::size_t>(i)];
    if (contact.in_overlap) continue;
    const CurvePoint p = curve_point(m_, a_, contact.s), q = curve_point(n_, b_, contact.t);
    const double speeds = norm(p.derivative) * norm(q.derivative);
    const double turn = cross(p.derivative, q.derivative);
    Crossing c{};
    c.s = c.s_lo = c.s_hi = contact.s;
    c.t = c.t_lo = c.t_hi = contact.t;
    c.point_a = contact.s == 0.0 ? a_[0] : contact.s == 1.0 ? a_[m_] : p.value;
    c.point_b = contact.t == 0.0 ? b_[0] : contact.t == 1.0 ? b_[n_] : q.value;
    c.certified = contact.certified;
    c.sign = contact.sign > 0 ? 1 : contact.sign < 0 ? -1 : 0;
    if (c.sign == 0 && std::fabs(turn) > 1e-6 * speeds) c.sign = turn > 0 ? 1 : -1;
    c.condition =
        speeds > 0 && turn != 0
            ? magnitude_ * std::max(norm(p.derivative), norm(q.derivative)) / std::fabs(turn)
            : std::numeric_limits<double>::infinity();
    out_.crossings.push_back(c);
  }
  std::sort(out_.crossings.begin(), out_.crossings.end(), [](const Crossing& p, const Crossing& q) {
    return p.s != q.s ? p.s < q.s : p.t < q.t;
  });
  if (out_.tangencies.size() > 1)
    std::sort(
        out_.tangencies.begin(), out_.tangencies.end(),
        [](const Tangency& p, const Tangency& q) { return p.s != q.s ? p.s < q.s : p.t < q.t; });
}

}  // namespace geometry_kernel
}  // namespace bezel
