// End points of one curve on the other, and overlaps between them.

#include <algorithm>
#include <cmath>

#include "bezel/geometry/intersect_search.hpp"

namespace bezel::geometry_kernel {
namespace {

/// All places where a curve passes within tau of the origin, between its ends.
class FootSearch {
 public:
  FootSearch(int degree, const Vec2* control, const Vec2& p, double tau)
      : degree_(degree), control_(control), p_(p), tau_(tau) {}

  /// c: control points on [s0, s1] minus p.
  void descend(const Vec2* c, double s0, double s1, int depth) {
    if (++work_ > 400 || count_ == 4) return;
    const Box2 box = control_box(degree_, c);
    if (box.lo.x() > tau_ || box.hi.x() < -tau_ || box.lo.y() > tau_ || box.hi.y() < -tau_) return;
    const Vec2 chord = c[degree_] - c[0];
    double lo = cross(chord, c[0]), hi = lo, forward = 1.0;
    const double slack = tau_ * (std::fabs(chord.x()) + std::fabs(chord.y()));
    for (int i = 1; i <= degree_; ++i) {
      const double d = cross(chord, c[i]);
      lo = std::min(lo, d);
      hi = std::max(hi, d);
      forward = std::min(forward, dot(chord, c[i] - c[i - 1]));
    }
    // The fat line through the piece: cross(chord, c - 0) of one sign means the origin is beside
    // it.
    if (lo > slack || hi < -slack) return;
    if (forward > 0) {
      const double q0 = -dot(chord, c[0]), q1 = dot(chord, c[degree_]);
      const double guess = q0 + q1 > 0 ? std::clamp(q0 / (q0 + q1), 0.0, 1.0) : 0.5;
      if (refine(s0 + guess * (s1 - s0), s0, s1)) return;
    }
    if (depth >= 50) {
      offer(0.5 * (s0 + s1));
      return;
    }
    PointBuffer<max_curve_points> left, right;
    halve(degree_, c, left.data(), right.data());
    const double s = 0.5 * (s0 + s1);
    descend(left.data(), s0, s, depth + 1);
    descend(right.data(), s, s1, depth + 1);
  }
  int count() const { return count_; }
  double operator[](int i) const { return found_[static_cast<std::size_t>(i)]; }

 private:
  /// Gauss-Newton from s. The last iterations start from a grid value near the root, so that the
  /// result is a function of the point and the curve alone, whatever piece the search came through.
  bool refine(double s, double s0, double s1) {
    const double width = s1 - s0;
    bool near = false;
    for (int i = 0; i < 12 && !near; ++i) {
      const CurvePoint f = curve_point(degree_, control_, s, p_);
      const double speed_squared = dot(f.derivative, f.derivative);
      if (!(speed_squared > 0)) return false;
      const double step = dot(f.value, f.derivative) / speed_squared;
      s -= step;
      if (!(s >= s0 - 0.25 * width && s <= s1 + 0.25 * width)) return false;
      near = std::fabs(step) <= 1e-6 * width;
    }
    if (!near) return false;
    const double canonical = (std::floor(s * 1024.0 + 0.381966) + 0.618034 - 0.381966) / 1024.0;
    double z = canonical;
    for (int i = 0; i < 20; ++i) {
      const CurvePoint f = curve_point(degree_, control_, z, p_);
      const double speed_squared = dot(f.derivative, f.derivative);
      if (!(speed_squared > 0)) break;
      const double step = dot(f.value, f.derivative) / speed_squared;
      z -= step;
      if (std::fabs(step) <= 1e-15) break;
    }
    if (std::fabs(z - s) <= 1e-5 * width + 1e-12) s = z;
    return offer(s);
  }
  bool offer(double s) {
    if (!(s > 0 && s < 1)) return false;
    const Vec2 f = curve_point(degree_, control_, s, p_).value;
    if (!(dot(f, f) <= tau_ * tau_)) return false;
    for (int i = 0; i < count_; ++i)
      if (std::fabs(found_[static_cast<std::size_t>(i)] - s) <= 1e-7) return true;
    found_[static_cast<std::size_t>(count_++)] = s;
    return true;
  }

  int degree_;
  const Vec2* control_;
  Vec2 p_;
  double tau_;
  std::array<double, 4> found_{};
  int count_ = 0, work_ = 0;
};

/// Whether p may lie within tau of the curve, by its box and the band around its chord.
bool is_near(const Vec2& p, const CurveCache& curve, double tau) {
  if (p.x() < curve.box.lo.x() - tau || p.x() > curve.box.hi.x() + tau ||
      p.y() < curve.box.lo.y() - tau || p.y() > curve.box.hi.y() + tau)
    return false;
  const double slack = tau * curve.chord_length;
  const double height = cross(curve.chord, p - curve.control.front());
  const double size = 0x1p-50 * curve.chord_length * curve.box.diameter();
  return height >= curve.band_lo - slack - size && height <= curve.band_hi + slack + size;
}

}  // namespace

int inner_feet(const Vec2& p, const CurveCache& curve, double tau, std::array<double, 4>& feet) {
  if (!is_near(p, curve, tau)) return 0;
  const int degree = static_cast<int>(curve.control.size()) - 1;
  PointBuffer<max_curve_points> buffer;
  Vec2* shifted = buffer.data();
  for (int i = 0; i <= degree; ++i) shifted[i] = curve.control[static_cast<std::size_t>(i)] - p;
  FootSearch search(degree, curve.control.data(), p, tau);
  search.descend(shifted, 0.0, 1.0, 0);
  for (int i = 0; i < search.count(); ++i) feet[static_cast<std::size_t>(i)] = search[i];
  return search.count();
}

/// All control points coincide to rounding: the curve counts as its point at parameter 0.
bool IntersectSearch::is_point(const CurveCache& curve) const {
  return curve.box.hi.x() - curve.box.lo.x() <= rounding_ &&
         curve.box.hi.y() - curve.box.lo.y() <= rounding_;
}

void IntersectSearch::add_contact(double s, double t, bool a_end, bool b_end) {
  for (int i = 0; i < contact_count_; ++i) {
    Contact& c = contacts_[static_cast<std::size_t>(i)];
    if (c.s == s && c.t == t) {
      c.a_end = c.a_end || a_end;
      c.b_end = c.b_end || b_end;
      return;
    }
  }
  if (contact_count_ == static_cast<int>(contacts_.size())) return;
  contacts_[static_cast<std::size_t>(contact_count_++)] = {s, t, a_end, b_end, 0, false, false};
}

void IntersectSearch::find_contact(const Vec2& p, const CurveCache& curve, bool of_a, double end) {
  const double tau = tau_;
  if (!is_near(p, curve, tau)) return;
  const auto add = [&](double other, bool is_end) {
    if (of_a)
      add_contact(end, other, true, is_end);
    else
      add_contact(other, end, is_end, true);
  };
  const int degree = static_cast<int>(curve.control.size()) - 1;
  const Vec2 first = curve.control.front() - p, last = curve.control.back() - p;
  const double tau_squared = tau * tau;
  const bool at_first = dot(first, first) <= tau_squared, at_last = dot(last, last) <= tau_squared;
  const bool point = is_point(curve);
  if (at_first || (at_last && point)) add(0.0, true);
  if (point) return;
  if (at_last) add(1.0, true);
  // A straight curve that has p at an end has it nowhere else.
  if (degree == 1 && (at_first || at_last)) return;
  if (at_first || at_last) {
    // Only a curve that turns back can meet p again.
    bool turns = at_first && at_last;
    for (std::size_t i = 0; i + 1 < curve.control.size() && !turns; ++i)
      turns = dot(curve.chord, curve.control[i + 1] - curve.control[i]) <= 0;
    if (!turns) return;
  }
  std::array<double, 4> feet;
  const int count = inner_feet(p, curve, tau, feet);
  for (int i = 0; i < count; ++i) {
    const double s = feet[static_cast<std::size_t>(i)];
    const Vec2 q = curve_point(degree, curve.control.data(), s).value;
    if (at_first && norm(q - curve.control.front()) <= 4 * tau && s < 0.5) continue;
    if (at_last && norm(q - curve.control.back()) <= 4 * tau && s > 0.5) continue;
    add(s, false);
  }
}

void IntersectSearch::find_contacts() {
  find_contact(a_[0], cb_, true, 0.0);
  if (!is_point(ca_)) find_contact(a_[m_], cb_, true, 1.0);
  find_contact(b_[0], ca_, false, 0.0);
  if (!is_point(cb_)) find_contact(b_[n_], ca_, false, 1.0);
  std::sort(contacts_.begin(), contacts_.begin() + contact_count_,
            [](const Contact& p, const Contact& q) { return p.s != q.s ? p.s < q.s : p.t < q.t; });
}

bool IntersectSearch::coincide(const Contact& p, const Contact& q, double& gap) const {
  // Quick refusal: a point in between.
  const auto foot = [&](double s, double t) {
    const Vec2 origin = curve_point(m_, a_, s).value;
    for (int i = 0; i < 30; ++i) {
      const CurvePoint f = curve_point(n_, b_, t, origin);
      const double speed_squared = dot(f.derivative, f.derivative);
      if (!(speed_squared > 0)) break;
      const double step = dot(f.value, f.derivative) / speed_squared;
      t = std::clamp(t - step, 0.0, 1.0);
      if (std::fabs(step) <= 1e-15) break;
    }
    return norm(curve_point(n_, b_, t, origin).value);
  };
  const auto at = [&](double x) { return foot(p.s + x * (q.s - p.s), p.t + x * (q.t - p.t)); };
  if (!(at(0.4142) <= tau_)) return false;
  // Two polynomial curves that coincide, both traced once, differ by an affine change of parameter:
  // compare the control points on the two intervals.
  if (m_ == n_) {
    PointBuffer<max_curve_points> buffer_a, buffer_b;
    Vec2 *on_a = buffer_a.data(), *on_b = buffer_b.data();
    const bool reversed = p.t > q.t;
    restrict_curve(m_, a_, p.s, q.s, on_a);
    restrict_curve(n_, b_, std::min(p.t, q.t), std::max(p.t, q.t), on_b);
    double worst = 0;
    for (int i = 0; i <= m_; ++i) {
      const Vec2 d = on_a[i] - on_b[reversed ? n_ - i : i];
      worst = std::max(worst, norm(d));
    }
    if (worst <= tau_) {
      gap = worst;
      return true;
    }
  }
  // Different degree, or parametrised unlike: the distance at more places than two curves can meet
  // in.
  const int count = m_ * n_ + 2 * (m_ + n_) + 1;
  gap = 0;
  for (int i = 1; i < count; ++i) {
    gap = std::max(gap, at(static_cast<double>(i) / count));
    if (!(gap <= tau_)) return false;
  }
  return true;
}

/// @return true when an overlap leaves nothing else to look for
bool IntersectSearch::find_overlaps() {
  if (is_point(ca_) || is_point(cb_)) return true;  // a point: contacts are all there is
  bool all = false;
  for (int i = 0; i + 1 < contact_count_; ++i) {
    const Contact &p = contacts_[static_cast<std::size_t>(i)],
                  &q = contacts_[static_cast<std::size_t>(i) + 1];
    if (p.s == q.s || p.t == q.t) continue;
    double gap = 0;
    if (!coincide(p, q, gap)) continue;
    out_.overlaps.push_back({p.s, q.s, p.t, q.t, gap});
    const bool whole_a = p.s == 0.0 && q.s == 1.0;
    // When neither curve turns by a right angle they are graphs over one direction. At each end of
    // the overlap one of them ends, so at most one goes on there, and they meet nowhere else.
    const Vec2 direction = whole_a ? cb_.chord : ca_.chord;
    bool graph = true;
    int sign = 0;
    for (const CurveCache* curve : {&ca_, &cb_})
      for (std::size_t k = 0; k + 1 < curve->control.size(); ++k) {
        const double d = dot(direction, curve->control[k + 1] - curve->control[k]);
        if (k == 0) sign = d > 0 ? 1 : -1;
        graph = graph && d * sign > 0;
      }
    all = all || graph;
  }
  return all;
}

}  // namespace bezel::geometry_kernel
