#include "bezel/geometry/tube.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bezel/numeric/short_names.hpp"

namespace bezel::geometry_kernel {
namespace {

using short_names::at;
using short_names::u;

constexpr int finest_level = 12;  // halvings of a node's interval
constexpr int most_halvings = 60;

std::vector<double> rounded(const Polynomial& p) {
  std::vector<double> out;
  out.reserve(p.size());
  for (const Dyadic& c : p) out.push_back(c.to_double());
  return out;
}

/// sum |c_k| h^k from k = first on.
double majorant(const std::vector<double>& c, double h, std::size_t first = 0) {
  double sum = 0.0;
  for (std::size_t k = c.size(); k-- > first;) sum = sum * h + std::fabs(c[k]);
  return sum * std::pow(h, static_cast<double>(first)) * up;
}
double derivative_majorant(const std::vector<double>& c, double h) {
  double sum = 0.0;
  for (std::size_t k = c.size(); k-- > 1;) sum = sum * h + static_cast<double>(k) * std::fabs(c[k]);
  return sum * up;
}

double second_derivative_majorant(const std::vector<double>& c, double h) {
  double sum = 0.0;
  for (std::size_t k = c.size(); k-- > 2;)
    sum = sum * h + static_cast<double>(k * (k - 1)) * std::fabs(c[k]);
  return sum * up;
}

/// The polynomial about `centre`, its variable times `scale`.
std::vector<double> shifted(std::vector<double> c, double centre, double scale) {
  const std::size_t n = c.size() - 1;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = n; k-- > i;) c[k] += centre * c[k + 1];
  double power = 1.0;
  for (std::size_t k = 1; k <= n; ++k) {
    power *= scale;
    c[k] *= power;
  }
  return c;
}

double value(const std::vector<double>& c, double x) {
  double sum = 0.0;
  for (std::size_t k = c.size(); k-- > 0;) sum = sum * x + c[k];
  return sum;
}

Dyadic midpoint(const Dyadic& a, const Dyadic& b) {
  return (a + b).scaled(-1);
}

}  // namespace

void Resolution::add(const ResolvedRoot& root) {
  const auto inside = [](const ResolvedRoot& p, const ResolvedRoot& box) {
    return p.s >= box.s_lo && p.s <= box.s_hi && p.t >= box.t_lo && p.t <= box.t_hi;
  };
  // A place known to the last bit, in the box of another root, is that root. Two roots may share
  // their nearest doubles: then their signs differ.
  for (ResolvedRoot& known : roots)
    if (known.sign * root.sign >= 0 &&
        (inside(root, known) || (!known.rough && inside(known, root)))) {
      if (root.s_end || root.t_end) known = root;
      return;
    }
  roots.push_back(root);
}

TubeSearch::TubeSearch(const ExactCurve& a, const ExactCurve& b, bool swapped, int& nodes,
                       Resolution& out)
    : a_(a), b_(b), swapped_(swapped), nodes_(nodes), out_(out) {}

bool TubeSearch::graph(double t0, double t1) {
  if (b_.degree() == 0) return false;
  t0_ = t0;
  t1_ = t1;
  t_centre_ = 0.5 * (t0 + t1);
  t_radius_ = 0.5625 * (t1 - t0);
  const ExactTaylor taylor = b_.taylor(Dyadic(t_centre_));
  const std::vector<double> x = rounded(taylor[0]), y = rounded(taylor[1]);
  axis_ = std::fabs(x[1]) >= std::fabs(y[1]) ? 0 : 1;
  const std::vector<double>& main = axis_ == 0 ? x : y;
  const double first = std::fabs(main[1]);
  slowest_ = first / up - (derivative_majorant(main, t_radius_) - first);
  if (!(slowest_ > 0.3 * first) || !(first > 0x1p-400)) return false;
  speed_ = std::hypot(derivative_majorant(x, t_radius_), derivative_majorant(y, t_radius_)) * up;
  x_lo_ = b_(Dyadic(t0))[at(axis_)];
  x_hi_ = b_(Dyadic(t1))[at(axis_)];
  if (x_hi_ < x_lo_) std::swap(x_lo_, x_hi_);
  return true;
}

void TubeSearch::run(double s0, double s1) {
  s0_ = s0;
  s1_ = s1;
  stack_.clear();
  // Seen from a little beyond its ends.
  const double radius = 0.53125 * (s1 - s0);
  stack_.push_back({Dyadic(0.5 * (s0 + s1)), radius, 0, Dyadic(t_centre_), false, 0, 0});
  while (!stack_.empty()) {
    const Node node = std::move(stack_.back());
    stack_.pop_back();
    visit(node);
  }
}

Dyadic TubeSearch::find_opposite(const Dyadic& x, const Dyadic& start, double target) const {
  const Dyadic lo(t_centre_ - t_radius_), hi(t_centre_ + t_radius_);
  Dyadic t = start < lo ? lo : hi < start ? hi : start;
  const std::size_t n = at(b_.degree());
  const std::vector<Dyadic>& c = b_.monomial()[at(axis_)];
  for (int i = 0; i < 100; ++i) {
    Dyadic f = c[n], slope = c[n] * Dyadic(static_cast<double>(n));
    for (std::size_t k = n; k-- > 0;) f = f * t + c[k];
    const double rough = t.to_double();
    double derivative = 0.0;
    for (std::size_t k = n; k > 0; --k)
      derivative = derivative * rough + static_cast<double>(k) * c[k].to_double();
    if (!(std::fabs(derivative) >= slowest_)) derivative = std::copysign(slowest_, derivative);
    const double step = (x - f).to_double() / derivative;
    t += Dyadic(step);
    if (t < lo) {
      t = lo;
      if (step < 0 && i > 0) break;
    }
    if (hi < t) {
      t = hi;
      if (step > 0 && i > 0) break;
    }
    if (std::fabs(step) <= target) break;
  }
  return t;
}

bool TubeSearch::build(const Node& node, const ExactTaylor& a, const Dyadic& opposite, int order,
                       Model& model) const {
  const std::size_t x = at(axis_), y = 1 - x;
  const double h = node.h;
  const ExactTaylor b = b_.taylor(opposite);
  const auto ax = rounded(a[x]), ay = rounded(a[y]), bx = rounded(b[x]);
  const auto get = [](const std::vector<double>& c, std::size_t k) {
    return k < c.size() ? c[k] : 0.0;
  };
  model.t = opposite;
  const double p1 = get(ax, 1) / bx[1];
  model.phi = {0.0, p1};
  if (order > 1) {
    const double p2 = (get(ax, 2) - get(bx, 2) * p1 * p1) / bx[1];
    const double p3 = (get(ax, 3) - get(bx, 3) * p1 * p1 * p1 - 2.0 * get(bx, 2) * p1 * p2) / bx[1];
    model.phi.push_back(p2);
    model.phi.push_back(p3);
  }
  for (const double p : model.phi)
    if (!std::isfinite(p)) return false;
  const double reach = majorant(model.phi, h, 1);
  const double off_centre = std::fabs((opposite - Dyadic(t_centre_)).to_double()) * up;
  if (!(off_centre + reach <= t_radius_)) return false;

  Polynomial phi(model.phi.begin(), model.phi.end());
  // Short intervals ask for more digits of the slope than a double has.
  if (h < 0x1p-30 && a[x].size() > 1)
    phi[1] += Dyadic((a[x][1] - b[x][1] * phi[1]).to_double() / bx[1]);
  const auto difference = [&](std::size_t axis) {
    Polynomial c = compose(b[axis], phi);
    if (c.size() < a[axis].size()) c.resize(a[axis].size());
    for (Dyadic& v : c) v = -v;
    for (std::size_t k = 0; k < a[axis].size(); ++k) c[k] += a[axis][k];
    return c;
  };
  const Polynomial cx = difference(x), cy = difference(y);
  const auto velocity = [&](std::size_t axis) {
    Polynomial d;
    for (std::size_t k = 1; k < b[axis].size(); ++k)
      d.push_back(b[axis][k] * Dyadic(static_cast<double>(k)));
    return compose(d, phi);
  };
  Polynomial e = product(velocity(x), cy);
  const Polynomial other = product(velocity(y), cx);
  for (std::size_t k = 0; k < e.size(); ++k) e[k] -= other[k];

  const double size_x = majorant(rounded(cx), h), size_y = majorant(rounded(cy), h);
  model.width = size_x / slowest_ * up;
  // b's parameter must stay where b is known to be a graph: then one is opposite to every s.
  if (!(off_centre + reach + model.width <= t_radius_)) return false;
  const auto by = rounded(b[y]);
  const double room = reach + model.width;
  const double speed =
      std::hypot(derivative_majorant(bx, room), derivative_majorant(by, room)) * up;
  const double bend =
      std::hypot(second_derivative_majorant(bx, room), second_derivative_majorant(by, room)) * up;
  model.remainder = 0.5 * model.width * model.width * speed * bend * up;
  const double a_speed = std::hypot(derivative_majorant(ax, h), derivative_majorant(ay, h)) * up;
  model.derivative_remainder =
      (derivative_majorant(model.phi, h) * std::hypot(size_x, size_y) + model.width * a_speed) *
      bend * up;
  model.e = rounded(e);
  double power = 1.0, sum = 0.0;
  for (double& c : model.e) {
    c *= power;
    power *= h;
    sum += std::fabs(c);
  }
  model.noise = (2.0 * static_cast<double>(model.e.size()) + 4.0) * u * sum + 0x1p-1000;
  return true;
}

/// Intervals of [-1, 1] where |E| may be as small as its remainder.
void TubeSearch::search(const std::vector<double>& e, double centre, double radius, int level,
                        const Model& model, std::vector<Suspect>& out) const {
  double rest = 0.0;
  for (std::size_t k = 1; k < e.size(); ++k) rest += std::fabs(e[k]);
  const double threshold = model.remainder + (level + 2) * model.noise;
  if (std::fabs(e[0]) - rest * up > threshold) return;
  if (level == finest_level || std::fabs(e[0]) + rest <= 2.0 * threshold) {
    const double lo = centre - radius, hi = centre + radius;
    if (!out.empty() && out.back().hi >= lo)
      out.back().hi = hi;
    else
      out.push_back({lo, hi});
    return;
  }
  const double half = 0.5 * radius;
  search(shifted(e, -0.5, 0.5), centre - half, half, level + 1, model, out);
  search(shifted(e, 0.5, 0.5), centre + half, half, level + 1, model, out);
}

void TubeSearch::visit(const Node& node) {
  if (--nodes_ < 0) {
    leave(node, "more work than allowed");
    return;
  }
  const std::size_t x = at(axis_);
  const ExactTaylor a = a_.taylor(node.centre);
  const double spread = majorant(rounded(a[x]), node.h, 1);
  if (a[x][0] + Dyadic(spread) < x_lo_ || x_hi_ < a[x][0] - Dyadic(spread)) return;
  if (node.centre + Dyadic(node.h) < Dyadic(s0_) || Dyadic(s1_) < node.centre - Dyadic(node.h))
    return;
  const double h2 = node.h * node.h;
  const double target = std::min(0x1p-60, 0x1p-12 * h2 * h2);
  const Dyadic opposite = find_opposite(a[x][0], node.opposite, target);
  Model model;
  std::vector<Suspect> suspects;
  bool built = false;
  for (const int order : {1, 3}) {
    if (!build(node, a, opposite, order, model)) break;
    built = true;
    suspects.clear();
    search(model.e, 0.0, 1.0, 0, model, suspects);
    double covered = 0.0;
    for (const Suspect& s : suspects) covered += s.hi - s.lo;
    // A tighter tube pays only where the remainder decides.
    if (covered <= 0.5 || model.remainder <= 4.0 * model.noise) break;
  }
  const auto halve = [&] {
    if (node.halvings == most_halvings || node.h < smallest_radius) {
      leave(node, "touching, or nearly so, at a place that is no simple fraction");
      return;
    }
    const double half = 0.5 * node.h;
    for (const double side : {1.0, -1.0}) {
      Node child = node;
      child.centre = node.centre + Dyadic(side * half);
      child.h = half;
      child.halvings = node.halvings + 1;
      child.opposite = opposite;
      stack_.push_back(std::move(child));
    }
  };
  if (!built) {
    halve();
    return;
  }
  if (suspects.size() == 1 && suspects[0].hi - suspects[0].lo > 1.0) {
    // Nothing gained; a place of contact explains that.
    const Dyadic h(node.h), lo = node.centre - h, hi = node.centre + h;
    const double reach = majorant(model.phi, node.h, 1) + model.width;
    if (try_contact(node, lo, hi, model.t - Dyadic(reach), model.t + Dyadic(reach), false) ||
        try_straight(node, lo, hi))
      return;
    halve();
    return;
  }
  for (const Suspect& s : suspects) examine(node, model, s);
}

void TubeSearch::examine(const Node& node, const Model& model, const Suspect& suspect) {
  const double pad = 0x1p-11;
  const double lo = std::max(-1.0, suspect.lo - pad), hi = std::min(1.0, suspect.hi + pad);
  const double middle = 0.5 * (lo + hi), radius = 0.5 * (hi - lo);
  const std::vector<double> q = shifted(model.e, middle, radius);
  const double noise = 16.0 * model.noise;
  double rest = 0.0;
  for (std::size_t k = 2; k < q.size(); ++k) rest += static_cast<double>(k) * std::fabs(q[k]);
  const double first = q.size() > 1 ? std::fabs(q[1]) : 0.0;
  const double slope = first - rest * up - static_cast<double>(q.size()) * noise -
                       model.derivative_remainder * node.h * radius * up;
  const Dyadic s_lo = node.centre + Dyadic(node.h * lo), s_hi = node.centre + Dyadic(node.h * hi);
  const double threshold = model.remainder + noise;
  if (slope > 0.0) {
    const double left = value(q, -1.0), right = value(q, 1.0);
    if (std::fabs(left) > threshold && std::fabs(right) > threshold) {
      if ((left > 0) == (right > 0)) return;  // monotone without a zero
      double z = 0.0;
      std::vector<double> d;
      for (std::size_t k = 1; k < q.size(); ++k) d.push_back(static_cast<double>(k) * q[k]);
      for (int i = 0; i < 60; ++i) {
        const double step = value(q, z) / value(d, z);
        z = std::clamp(z - step, -1.0, 1.0);
        if (std::fabs(step) <= 0x1p-52) break;
      }
      const double sigma = node.h * (middle + radius * z);
      const double error =
          node.h * radius * ((threshold + std::fabs(value(q, z))) / slope) * up + 0x1p-50 * node.h;
      const double phi = value(model.phi, sigma);
      const double t_error = (model.width + derivative_majorant(model.phi, node.h) * error) * up +
                             0x1p-50 * std::fabs(phi);
      const Dyadic s = node.centre + Dyadic(sigma), t = model.t + Dyadic(phi);
      const bool axes = axis_ == 0;
      // E' = -cross(a', b') up to its remainder, in the order of the axes.
      const int sign = (q[1] > 0) == axes ? -1 : 1;
      Node certified = node;
      if (!node.certified) {
        certified.certified = true;
        certified.unique_lo = s_lo.to_double();
        certified.unique_hi = s_hi.to_double();
      }
      certified.opposite = t;
      certified.centre = s;
      certified.h = std::max({8.0 * error, 0x1p-20 * node.h * radius, smallest_radius});
      finish_root(certified, s, error, t, t_error, sign, value(d, z) / (node.h * radius));
      return;
    }
  }
  // Not told apart: a contact, or something to look at more closely.
  const double reach = derivative_majorant(model.phi, node.h) * node.h * radius * up + model.width;
  const Dyadic t = model.t + Dyadic(value(model.phi, node.h * middle));
  if (try_contact(node, s_lo, s_hi, t - Dyadic(reach), t + Dyadic(reach), false) ||
      try_straight(node, s_lo, s_hi))
    return;
  const double h = 1.25 * radius * node.h;
  Node closer = node;
  closer.centre = node.centre + Dyadic(node.h * middle);
  closer.h = std::max(h, 0x1p-30 * node.h);
  closer.opposite = t;
  if (closer.h < smallest_radius || ++closer.halvings > most_halvings) {
    leave(closer, "touching, or nearly so, at a place that is no simple fraction");
    return;
  }
  stack_.push_back(std::move(closer));
}

void TubeSearch::push_interval(const Dyadic& lo, const Dyadic& hi, const Node& from) {
  if (!(lo < hi)) return;
  Node node = from;
  node.centre = midpoint(lo, hi);
  node.h = (hi - lo).to_double() * 0.5 * up;
  ++node.halvings;
  if (node.halvings > most_halvings || node.h < smallest_radius) {
    leave(node, "close to a contact");
    return;
  }
  stack_.push_back(std::move(node));
}

void TubeSearch::emit(ResolvedRoot root) {
  root.s_lo = std::max(root.s_lo, 0.0);
  root.t_lo = std::max(root.t_lo, 0.0);
  root.s_hi = std::min(root.s_hi, 1.0);
  root.t_hi = std::min(root.t_hi, 1.0);
  if (swapped_) {
    std::swap(root.s, root.t);
    std::swap(root.s_lo, root.t_lo);
    std::swap(root.s_hi, root.t_hi);
    std::swap(root.s_end, root.t_end);
    root.sign = -root.sign;
    root.contact_sign = -root.contact_sign;
  }
  out_.add(root);
}

void TubeSearch::leave(const Node& node, const char* reason) {
  const double s = node.centre.to_double();
  const double width = speed_ / slowest_ * up * node.h;
  const double t = node.opposite.to_double();
  Undecided box{std::max(s0_, s - node.h), std::min(s1_, s + node.h), std::max(t0_, t - width),
                std::min(t1_, t + width), reason};
  if (box.s0 > box.s1 || box.t0 > box.t1) return;
  if (swapped_) {
    std::swap(box.s0, box.t0);
    std::swap(box.s1, box.t1);
  }
  out_.undecided.push_back(box);
}

}  // namespace bezel::geometry_kernel
