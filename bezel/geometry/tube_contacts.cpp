// Common points at places known exactly: fractions, contact with straight lines, end points.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "bezel/geometry/tube.hpp"

namespace bezel::geometry_kernel {
namespace {

constexpr int most_order = 100;  // of contact, looked for

/// The simplest fraction in the interval when it is simple for the interval's width: among random
/// fractions one as simple would be rare.
std::optional<Ratio> candidate(const Dyadic& lo, const Dyadic& hi) {
  if (hi.sign() < 0) return std::nullopt;
  if (lo.sign() <= 0) return Ratio{};
  const Dyadic width = hi - lo;
  const int bits = width.sign() == 0 ? 200 : static_cast<int>(-width.exponent() / 2);
  return simplest_between(lo, hi, std::clamp(bits, 2, 200));
}

/// Within 2^-140 or so.
Dyadic near(const Ratio& x) {
  return floor_quotient(x.num.scaled(140), x.den).scaled(-140);
}

}  // namespace

/// Contact with a straight curve: b's parameter need not be a fraction.
bool TubeSearch::try_straight(const Node& node, const Dyadic& s_lo, const Dyadic& s_hi) {
  if (!b_.direction()) return false;
  const auto s = candidate(s_lo, s_hi);
  if (!s) return false;
  // The distance from the line, times a constant, in powers of s - s*.
  const ExactPoint& along = *b_.direction();
  const ExactTaylor a = a_.taylor(*s);
  Dyadic scale = 1.0;
  for (int i = 0; i < a_.degree(); ++i) scale *= s->den;
  Polynomial height;
  for (std::size_t k = 0; k < a[0].size(); ++k)
    height.push_back(along[0] * a[1][k] - along[1] * a[0][k]);
  height[0] -= scale * (along[0] * b_.monomial()[1][0] - along[1] * b_.monomial()[0][0]);
  std::size_t order = 0;
  while (order < height.size() && height[order].sign() == 0) ++order;
  if (order < 2 || order == height.size()) return false;
  double radius = 0.25;
  for (;; radius *= 0.5) {
    if (radius < 0x1p-42) return false;
    double rest = 0.0;
    for (std::size_t k = height.size(); k-- > order + 1;)
      rest = (rest + std::fabs(quotient(height[k], height[order])) * up) * radius;
    if (rest * up < 1.0) break;
  }
  const Dyadic place = near(*s);
  const Dyadic t =
      find_opposite(a_(place)[static_cast<std::size_t>(axis_)], node.opposite, 0x1p-120);
  if (t.sign() >= 0 && !(Dyadic(1.0) < t) && s->num.sign() >= 0 && compare(*s, {1.0}) <= 0) {
    ResolvedRoot root{};
    root.s = to_double(*s);
    root.t = t.to_double();
    root.order = static_cast<int>(order);
    if (order % 2 != 0) {  // a passes to the left of the line's direction, which b goes or comes
      const auto x = static_cast<std::size_t>(axis_);
      const Dyadic forward = b_(Dyadic(t1_))[x] - b_(Dyadic(t0_))[x];
      root.contact_sign = -height[order].sign() * forward.sign() * along[x].sign();
    }
    root.s_end = s->num.sign() == 0 || compare(*s, {1.0}) == 0;
    root.s_lo = std::max(s0_, root.s - radius);
    root.s_hi = std::min(s1_, root.s + radius);
    root.t_lo = t_centre_ - t_radius_;
    root.t_hi = t_centre_ + t_radius_;
    emit(root);
  }
  const Dyadic reach(radius * 0.999);
  push_interval(s_lo, place - reach, node);
  push_interval(place + reach, s_hi, node);
  return true;
}

bool TubeSearch::try_contact(const Node& node, const Dyadic& s_lo, const Dyadic& s_hi,
                             const Dyadic& t_lo, const Dyadic& t_hi, bool certified) {
  const auto s = candidate(s_lo, s_hi), t = candidate(t_lo, t_hi);
  if (!s || !t) return false;
  const auto contact = verify_contact(a_, b_, *s, *t);
  if (!contact) return false;
  ResolvedRoot root{};
  root.s = root.s_lo = root.s_hi = to_double(*s);
  root.t = root.t_lo = root.t_hi = to_double(*t);
  const Ratio one{1.0};
  root.s_end = s->num.sign() == 0 || compare(*s, one) == 0;
  root.t_end = t->num.sign() == 0 || compare(*t, one) == 0;
  const bool within = compare(*s, one) <= 0 && compare(*t, one) <= 0;
  const int limit = std::min(most_order, a_.degree() * b_.degree());
  const ContactOrder order = contact_order(*contact, axis_, certified ? 1 : limit, 0.25);
  root.order = order.order;
  if (order.order > 1) root.contact_sign = order.sign;
  if (order.order == 1) {
    const Dyadic turn = contact->a[0][1] * contact->b[1][1] - contact->a[1][1] * contact->b[0][1];
    root.sign = turn.sign();
    Dyadic scale = 1.0;
    for (int i = 0; i < a_.degree(); ++i) scale *= s->den;
    for (int i = 0; i < b_.degree(); ++i) scale *= t->den;
    root.turn = std::fabs(quotient(turn, scale * scale));
  }
  if (certified) {
    root.order = 1;
    root.s_lo = node.unique_lo;
    root.s_hi = node.unique_hi;
    root.t_lo = t_centre_ - t_radius_;
    root.t_hi = t_centre_ + t_radius_;
    if (within) emit(root);
    return true;
  }
  if (order.order == 0 || !(order.s_radius > 0x1p-42)) return false;
  if (within) {
    root.s_lo = std::max(s0_, root.s - order.s_radius);
    root.s_hi = std::min(s1_, root.s + order.s_radius);
    root.t_lo = t_centre_ - t_radius_;
    root.t_hi = t_centre_ + t_radius_;
    emit(root);
  }
  // Looked at are the parts of the interval beyond the contact's neighbourhood.
  const Dyadic radius(order.s_radius * 0.999), place(to_double(*s));
  push_interval(s_lo, place - radius, node);
  push_interval(place + radius, s_hi, node);
  return true;
}

void TubeSearch::finish_root(const Node& node, const Dyadic& s, double s_error, const Dyadic& t,
                             double t_error, int sign, double turn) {
  const Dyadic s_lo = s - Dyadic(s_error), s_hi = s + Dyadic(s_error);
  const Dyadic t_lo = t - Dyadic(t_error), t_hi = t + Dyadic(t_error);
  const Dyadic one(1.0);
  if (s_hi.sign() < 0 || t_hi.sign() < 0 || one < s_lo || one < t_lo) return;
  const bool inside = s_lo.sign() > 0 && t_lo.sign() > 0 && s_hi < one && t_hi < one;
  const double s_value = s.to_double(), t_value = t.to_double();
  const auto fine = [](double error, double x) {
    return error <= 0x1p-57 * std::max(std::fabs(x), 0x1p-20);
  };
  if (!inside || !fine(s_error, s_value) || !fine(t_error, t_value)) {
    if (!inside && s_error < 0x1p-40 && t_error < 0x1p-40 &&
        try_contact(node, s_lo, s_hi, t_lo, t_hi, true))
      return;
    if (node.h > smallest_radius && s_error > 0x1p-190) {
      stack_.push_back(node);
      return;
    }
    // Still on the border: is it the end point, at a parameter of the other that is no fraction?
    ResolvedRoot root{};
    bool on = false;
    for (int end = 0; end < 2 && !on; ++end) {
      const Dyadic place(static_cast<double>(end));
      const auto test = [&](const ExactCurve& still, const ExactCurve& moving, const Dyadic& lo,
                            const Dyadic& hi) {
        const ExactPoint p = still(place);
        ExactTaylor c = moving.monomial();
        c[0][0] -= p[0];
        c[1][0] -= p[1];
        return common_root(c[0], c[1], lo, hi).value_or(false);
      };
      if (!(s_hi < place) && !(place < s_lo) && test(a_, b_, t_lo, t_hi)) {
        on = root.s_end = true;
        root.s = end;
        root.t = std::clamp(t_value, 0.0, 1.0);
      } else if (!(t_hi < place) && !(place < t_lo) && test(b_, a_, s_lo, s_hi)) {
        on = root.t_end = true;
        root.t = end;
        root.s = std::clamp(s_value, 0.0, 1.0);
      }
    }
    if (!on) {
      leave(node, "an end point on the other curve, or nearly so");
      return;
    }
    root.s_lo = node.unique_lo;
    root.s_hi = node.unique_hi;
    root.t_lo = t_centre_ - t_radius_;
    root.t_hi = t_centre_ + t_radius_;
    root.order = 1;
    root.sign = sign;
    root.turn = std::fabs(turn);
    emit(root);
    return;
  }
  ResolvedRoot root{};
  root.s = s_value;
  root.t = t_value;
  root.s_lo = std::min(node.unique_lo, s_value);
  root.s_hi = std::max(node.unique_hi, s_value);
  root.t_lo = t_centre_ - t_radius_;
  root.t_hi = t_centre_ + t_radius_;
  root.order = 1;
  root.sign = sign;
  root.turn = std::fabs(turn);
  emit(root);
}

}  // namespace bezel::geometry_kernel
