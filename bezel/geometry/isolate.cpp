// Subdivision with a proof of at most one root per box; every rounding error is accounted for.
// docs/methods/geometry.md, "Isolating common points", derives the bounds.

#include "bezel/geometry/isolate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "bezel/geometry/isolate_kernel.hpp"

namespace bezel::geometry_kernel {

namespace {

constexpr double u = 0x1p-53;
constexpr int max_depth = 24;   // halvings of one curve
constexpr int max_work = 2000;  // boxes looked at
constexpr double max_q = 0.96;
constexpr double above = 1.0 + 0x1p-40;  // more than the rounding of a few operations
constexpr double underflow = 0x1p-1060;  // more than a few lost products
constexpr double growth = 1.375;  // of a Bernstein basis over [-3/16, 19/16], for each degree

template <int Room>
struct BoxPair {
  PairPoints<Room> p;
  alignas(16) double lo[2];
  alignas(16) double width[2];
  int depth[2];
};

/// A root or an open box with a sign whose enclosure reaches over the border of the box it was
/// found in, with the larger box in which it is alone.
struct Straddler {
  double s_lo, s_hi, t_lo, t_hi;
  double alone_s0, alone_s1, alone_t0, alone_t1;
  bool open;
  std::size_t index;
};

struct Enclosure {
  double s_lo, s_hi, t_lo, t_hi;
};
template <class P, class Q>
bool inside(const P& p, const Q& q) {
  return p.s_lo >= q.s_lo && p.s_hi <= q.s_hi && p.t_lo >= q.t_lo && p.t_hi <= q.t_hi;
}
template <class P, class Q>
bool disjoint(const P& p, const Q& q) {
  return p.s_hi < q.s_lo || q.s_hi < p.s_lo || p.t_hi < q.t_lo || q.t_hi < p.t_lo;
}
Enclosure alone_in(const Straddler& x) {
  return {x.alone_s0, x.alone_s1, x.alone_t0, x.alone_t1};
}

template <int D, int Room>
class Isolator {
 public:
  using Box = BoxPair<Room>;
  Isolator(const PairDegrees<D>& degrees, const Box& whole, double extent, Isolation& out)
      : degrees_(degrees), whole_(whole), rounding_(u * extent), out_(out) {}

  /// @param stack  room for stack_size boxes
  void run(Box* stack);
  static constexpr int stack_size = 3 * 2 * max_depth + 2;

 private:
  enum class Outcome { done, split };

  double error_of(const Box& box, int lane) const {
    return (1 + degrees_.of(lane) * box.depth[lane]) * rounding_;
  }
  bool rejected(const Box& box) const;
  Outcome examine(const Box& box);
  Outcome settle(const Box& box, Lanes start, double q, PairVector other_chord, double inverse,
                 int sign);
  Outcome settle_border(const Box& box, double s, double t, double r_s, double r_t, double q,
                        int sign);
  bool add(const Straddler& found, double s, double t, int sign, bool straddles, const Box& box);
  void leave_open(const Box& box) {
    out_.open.push_back({box.lo[0], box.lo[0] + box.width[0], box.lo[1], box.lo[1] + box.width[1],
                         0, box.lo[0] + 0.5 * box.width[0], box.lo[1] + 0.5 * box.width[1]});
  }
  bool nearly_parallel(const Box& box, PairVector chord) const;
  int split(const Box& box, Box* to) const;

  const PairDegrees<D> degrees_;
  const Box& whole_;
  const double rounding_;  // u times the largest |coordinate|
  Isolation& out_;
  int work_ = 0;
  int straddler_count_ = 0;
  std::array<Straddler, 24> straddlers_;
};

/// By control boxes and fat lines: no root in the closed box.
template <int D, int Room>
bool Isolator<D, Room>::rejected(const Box& box) const {
  const int n = degrees_.max();
  const PairPoints<Room>& p = box.p;
  const double error = error_of(box, 0) + error_of(box, 1);
  const PairVector p0 = p.at(0);
  PairVector lo = p0, hi = p0;
  for (int i = 1; i <= n; ++i) {
    const PairVector q = p.at(i);
    lo = {smaller(lo.x, q.x), smaller(lo.y, q.y)};
    hi = {larger(hi.x, q.x), larger(hi.y, q.y)};
  }
  // The differences are below 2 extent, their rounding below 2 u extent.
  const Lanes margin = both(error + 4 * rounding_);
  const auto apart = ((lo.x - swapped(hi.x)) > margin) | ((lo.y - swapped(hi.y)) > margin);
  if (any(apart)) return true;
  // cross(chord, .) of the own points (the last one's equals the first one's up to 2 u extent
  // |chord|, as the chord is rounded) and of the other's; each is rounded by less than 2.1 u extent
  // |chord|, where |.| is the sum norm.
  const PairVector chord = p.at(n) - p0;
  Lanes own_lo = cross(chord, p0), own_hi = own_lo;
  Lanes other_lo = cross(chord, swapped(p0)), other_hi = other_lo;
  for (int i = 1; i <= n; ++i) {
    const PairVector q = p.at(i);
    if (i < n) {
      const Lanes c = cross(chord, q);
      own_lo = smaller(own_lo, c);
      own_hi = larger(own_hi, c);
    }
    const Lanes c = cross(chord, swapped(q));
    other_lo = smaller(other_lo, c);
    other_hi = larger(other_hi, c);
  }
  const Lanes slack = sum_norm(chord) * both(error + 16 * rounding_) + both(underflow);
  const auto beside = ((other_lo - own_hi) > slack) | ((own_lo - other_hi) > slack);
  return any(beside);
}

/// C = [chord_a, -chord_b]^-1; with F = a(s) - b(t) in the pieces' own parameters, q bounds
/// ||I - C F'|| over the whole box, from the hodographs' control points.
template <int D, int Room>
typename Isolator<D, Room>::Outcome Isolator<D, Room>::examine(const Box& box) {
  const int n = degrees_.max();
  const PairPoints<Room>& p = box.p;
  const PairVector chord = p.at(n) - p.at(0), other = swapped(chord);
  const Lanes dets = cross(chord, other);  // det and -det
  const double det = dets[0], size = std::fabs(det);
  const Lanes factor = degrees_.as_factor();
  Lanes diagonal = both(0.0), off = both(0.0);
  for (int i = 0; i < n; ++i) {
    const PairVector e = edge(degrees_, p, i);
    diagonal = larger(diagonal, abs(dets - factor * cross(e, other)));
    off = larger(off, abs(cross(e, chord)));
  }
  // Of an edge: twice the points' error, and 2 u extent; its product with a chord: 3 u 2 extent.
  const double error_a = error_of(box, 0), error_b = error_of(box, 1);
  const double edges = degrees_.of(0) * (2 * error_a + 8 * rounding_) +
                       degrees_.of(1) * (2 * error_b + 8 * rounding_);
  const Lanes other_norm = sum_norm(other);
  const double q_size =
      larger(diagonal + swapped(factor * off) + other_norm * both(edges)) + underflow;
  const double q = q_size / size * above + 32 * u;
  // Not q >= max_q: it may be NaN.
  if (!(q < max_q)) {
    const int depth = std::min(box.depth[0], box.depth[1]);
    // A few more halvings often part curves that pass at a small angle; many open boxes mean that
    // they run along each other.
    const std::size_t open = out_.open.size();
    const int ready = open < 2 ? 10 : open < 6 ? 7 : open < 40 ? 4 : 3;
    if (depth >= ready && nearly_parallel(box, chord)) {
      leave_open(box);
      return Outcome::done;
    }
    return Outcome::split;
  }
  // Every root is within q / 2 of the middle's first approximation, in units of the box.
  const double inverse = 1.0 / det;
  PairVector middle;
  if constexpr (D == 3) {
    middle = both(0.125) * ((p.at(0) + p.at(3)) + both(3.0) * (p.at(1) + p.at(2)));
  } else {
    middle = expand(degrees_, p, both(0.5)).value;
  }
  const PairVector f = first_minus_second(middle);
  const Lanes offset = -(cross(f, other)) * both(inverse);
  const double points = error_a + error_b + (6 * n + 24) * rounding_;
  const Lanes reach =
      both(0.5 + 0.5 * q) + other_norm * both(points * std::fabs(inverse)) + both(16 * u);
  if (any(abs(offset) > reach)) return Outcome::done;
  const Lanes half = both(0.5);
  const Lanes inner = smaller(larger(half + offset, both(0.0)), both(1.0));
  return settle(box, lanes(box.lo) + lanes(box.width) * inner, q, other, inverse, det > 0 ? 1 : -1);
}

/// The root of a box that holds at most one.
template <int D, int Room>
typename Isolator<D, Room>::Outcome Isolator<D, Room>::settle(const Box& box, Lanes x, double q,
                                                              PairVector other_chord,
                                                              double inverse, int sign) {
  const Lanes lo = lanes(box.lo), width = lanes(box.width), hi = lo + width;
  // Of C F: the values' error, (3 d + 1) u extent each, and the products'.
  const Lanes noise = sum_norm(other_chord) *
                      both((6 * degrees_.max() + 24) * rounding_ * std::fabs(inverse) * above);
  const double largest_noise = larger(noise);
  for (int i = 0; i < 8; ++i) {
    const PairTaylor at = expand(degrees_, whole_.p, x);
    const PairVector f = first_minus_second(at.value);
    const Lanes chord_step = -(cross(f, other_chord)) * both(inverse);
    // A root of the box is within r of x, and within q r of x + chord_step.
    const double r = (larger(abs(chord_step)) + largest_noise) / (1 - q) * above + 8 * u;
    const Lanes reach = both(r) * width;
    const PairVector other_slope = swapped(at.slope);
    const double det = cross(at.slope, other_slope)[0];
    const double local = 1.0 / det;
    const Lanes newton = -(cross(f, other_slope)) * both(local);
    // Two terms more of the inverse function's series.
    Lanes step = newton;
    Lanes correction = both(0.0);
    for (int k = 0; k < 2; ++k) {
      const PairVector rest = first_minus_second((step * step) * (at.bend + step * at.twist));
      correction = -(cross(rest, other_slope)) * both(local);
      step = newton + correction;
    }
    const bool proven = all(((x - reach) > lo) & ((x + reach) < hi));
    const Lanes next = smaller(larger(x + step, lo), hi);
    if (proven) {
      const double size = larger(abs(newton)), bent = larger(abs(correction));
      const bool settled = size < 0x1p-50 || bent * bent <= 0x1p-58 * size;
      if (settled) {
        alignas(16) double low[2], high[2], found[2];
        const Lanes from = x - reach, to = x + reach;
        store(from, low);
        store(to, high);
        store(smaller(larger(x + step, from), to), found);
        const Straddler enclosure{low[0],  high[0], low[1],  high[1], low[0],
                                  high[0], low[1],  high[1], false,   0};
        return add(enclosure, found[0], found[1], sign, false, box) ? Outcome::done
                                                                    : Outcome::split;
      }
    } else {
      const Lanes centre = x + chord_step * width;
      const Lanes radius =
          (both(q * r) + noise) * width * both(above) + both(4 * u) * (both(1.0) + abs(chord_step));
      if (any(((centre - radius) > hi) | ((centre + radius) < lo))) return Outcome::done;
      const Lanes moved = abs(next - x);
      if (!(larger(moved) > 0x1p-50)) {
        alignas(16) double found[2], radii[2];
        store(x, found);
        store(reach, radii);
        return settle_border(box, found[0], found[1], radii[0], radii[1], q, sign);
      }
    }
    if (!all(next == next)) return Outcome::split;
    x = next;
  }
  return Outcome::split;
}

/// A root, if any, is within (r_s, r_t) of (s, t), which lies in the box; that reaches over its
/// border. In the box made larger by 3/16 of its width on each side, q is at most growth^(d-1)
/// times what it is in the box: C F' is linear in each hodograph.
template <int D, int Room>
typename Isolator<D, Room>::Outcome Isolator<D, Room>::settle_border(const Box& box, double s,
                                                                     double t, double r_s,
                                                                     double r_t, double q,
                                                                     int sign) {
  for (int i = 1; i < degrees_.max(); ++i) q *= growth;
  if (!(q < max_q)) return Outcome::split;
  const double w_s = box.width[0], w_t = box.width[1];
  // r was for the box: 1 / (1 - q) is at most 25 now.
  r_s *= 25;
  r_t *= 25;
  if (!(r_s <= w_s / 64 && r_t <= w_t / 64)) return Outcome::split;
  const Straddler found{s - r_s,
                        s + r_s,
                        t - r_t,
                        t + r_t,
                        box.lo[0] - 0.1875 * w_s,
                        box.lo[0] + 1.1875 * w_s,
                        box.lo[1] - 0.1875 * w_t,
                        box.lo[1] + 1.1875 * w_t,
                        !(s - r_s > 0 && s + r_s < 1 && t - r_t > 0 && t + r_t < 1),
                        0};
  return add(found, s, t, sign, true, box) ? Outcome::done : Outcome::split;
}

/// False: it may be one found before, or another; nothing is added then.
template <int D, int Room>
bool Isolator<D, Room>::add(const Straddler& found, double s, double t, int sign, bool straddles,
                            const Box& box) {
  if (straddles) {
    if (straddler_count_ == static_cast<int>(straddlers_.size())) {
      leave_open(box);
      return true;
    }
    const Enclosure alone = alone_in(found);
    for (const IsolatedRoot& root : out_.roots) {
      if (inside(root, alone)) return true;
      if (!disjoint(root, found)) return false;
    }
  }
  for (int i = 0; i < straddler_count_; ++i) {
    Straddler& before = straddlers_[static_cast<std::size_t>(i)];
    if (inside(found, alone_in(before)) || (straddles && inside(before, alone_in(found)))) {
      if (!before.open || found.open) return true;
      // What was open is decided now. Others keep their places in the list of open boxes.
      const OpenBox last = out_.open.back();
      for (int j = 0; j < straddler_count_; ++j) {
        Straddler& other = straddlers_[static_cast<std::size_t>(j)];
        if (other.open && other.index + 1 == out_.open.size()) other.index = before.index;
      }
      out_.open[before.index] = last;
      out_.open.pop_back();
      before.open = false;
      break;
    }
    if (!disjoint(found, before)) return false;
  }
  if (straddles) {
    Straddler& kept = straddlers_[static_cast<std::size_t>(straddler_count_++)];
    kept = found;
    kept.index = out_.open.size();
  }
  if (found.open)
    out_.open.push_back({std::max(0.0, std::min(box.lo[0], found.s_lo)),
                         std::min(1.0, std::max(box.lo[0] + box.width[0], found.s_hi)),
                         std::max(0.0, std::min(box.lo[1], found.t_lo)),
                         std::min(1.0, std::max(box.lo[1] + box.width[1], found.t_hi)), sign, s,
                         t});
  else
    out_.roots.push_back({s, t, found.s_lo, found.s_hi, found.t_lo, found.t_hi, sign});
  return true;
}

/// The pieces' directions are within about 30 degrees of a common line.
template <int D, int Room>
bool Isolator<D, Room>::nearly_parallel(const Box& box, PairVector chord) const {
  const PairVector line{first_in_both(chord.x), first_in_both(chord.y)};
  const Lanes along_chord = chord.x * line.x + chord.y * line.y;
  for (int i = 0; i < degrees_.max(); ++i) {
    const PairVector e = edge(degrees_, box.p, i);
    const Lanes dot = e.x * line.x + e.y * line.y;
    const Lanes along = along_chord < both(0.0) ? -dot : dot;
    if (!all(abs(cross(e, line)) <= both(0.6) * along)) return false;
  }
  return true;
}

/// Halves the longer curve, or both; keeps what is not rejected.
/// @return how many boxes, or -1 when that curve was halved often enough
template <int D, int Room>
int Isolator<D, Room>::split(const Box& box, Box* to) const {
  const int n = degrees_.max();
  PairVector lo = box.p.at(0), hi = lo;
  for (int i = 1; i <= n; ++i) {
    const PairVector q = box.p.at(i);
    lo = {smaller(lo.x, q.x), smaller(lo.y, q.y)};
    hi = {larger(hi.x, q.x), larger(hi.y, q.y)};
  }
  alignas(16) double extent[2];
  store(larger(hi.x - lo.x, hi.y - lo.y), extent);
  const bool split_a = extent[0] >= 0.5 * extent[1], split_b = extent[1] >= 0.5 * extent[0];
  if ((split_a && box.depth[0] == max_depth) || (split_b && box.depth[1] == max_depth)) return -1;
  PairPoints<Room> half[2];
  halve_both(degrees_, box.p, half[0], half[1]);
  int count = 0;
  for (int i = 0; i < (split_a ? 2 : 1); ++i)
    for (int j = 0; j < (split_b ? 2 : 1); ++j) {
      Box& child = to[count];
      const PairPoints<Room>& a = split_a ? half[i] : box.p;
      const PairPoints<Room>& b = split_b ? half[j] : box.p;
      for (int k = 0; k <= n; ++k) {
        const PairVector p = a.at(k), q = b.at(k);
        child.p.set(k, {joined(p.x, q.x), joined(p.y, q.y)});
      }
      child.width[0] = split_a ? 0.5 * box.width[0] : box.width[0];
      child.width[1] = split_b ? 0.5 * box.width[1] : box.width[1];
      child.lo[0] = i == 0 ? box.lo[0] : box.lo[0] + child.width[0];
      child.lo[1] = j == 0 ? box.lo[1] : box.lo[1] + child.width[1];
      child.depth[0] = box.depth[0] + (split_a ? 1 : 0);
      child.depth[1] = box.depth[1] + (split_b ? 1 : 0);
      if (!rejected(child)) ++count;
    }
  return count;
}

template <int D, int Room>
void Isolator<D, Room>::run(Box* stack) {
  if (rejected(whole_)) return;
  stack[0] = whole_;
  int count = 1;
  while (count > 0) {
    const Box box = stack[--count];
    if (++work_ > max_work) {
      leave_open(box);
      continue;
    }
    if (examine(box) == Outcome::done) continue;
    const int children = split(box, stack + count);
    if (children < 0)
      leave_open(box);
    else
      count += children;
  }
}

template <int D, int Room>
void isolate_pair(std::span<const Vec2> a, std::span<const Vec2> b, const Box2& box_a,
                  const Box2& box_b, Isolation& out) {
  PairDegrees<D> degrees{{static_cast<int>(a.size()) - 1, static_cast<int>(b.size()) - 1}};
  BoxPair<Room> whole;
  // Relative to a point where both may pass: coordinates are then rounded relative to the curves'
  // extents, not to their distance from the origin.
  Vec2 origin;
  for (int c = 0; c < 2; ++c)
    origin[c] = 0.5 * (std::max(box_a.lo[c], box_b.lo[c]) + std::min(box_a.hi[c], box_b.hi[c]));
  double extent = 0;
  for (int c = 0; c < 2; ++c)
    for (const Box2* box : {&box_a, &box_b})
      extent =
          std::max({extent, std::fabs(box->lo[c] - origin[c]), std::fabs(box->hi[c] - origin[c])});
  // Points, to rounding: nothing can be shown.
  if (extent < 0x1p-400) {
    out.open.push_back({0, 1, 0, 1, 0, 0.5, 0.5});
    return;
  }
  const int n = degrees.max();
  for (int lane = 0; lane < 2; ++lane) {
    const std::span<const Vec2> p = lane == 0 ? a : b;
    for (int i = 0; i <= n; ++i) {
      const Vec2 q = p[static_cast<std::size_t>(std::min(i, degrees.of(lane)))] - origin;
      whole.p.x[2 * i + lane] = q.x();
      whole.p.y[2 * i + lane] = q.y();
    }
    whole.lo[lane] = 0;
    whole.width[lane] = 1;
    whole.depth[lane] = 0;
  }
  using Search = Isolator<D, Room>;
  Search search(degrees, whole, extent, out);
  if constexpr (Room <= 8) {
    BoxPair<Room> stack[Search::stack_size];
    search.run(stack);
  } else {
    std::vector<BoxPair<Room>> stack(Search::stack_size);
    search.run(stack.data());
  }
}

}  // namespace

void isolate(std::span<const Vec2> a, std::span<const Vec2> b, Isolation& out) {
  out.clear();
  const int m = static_cast<int>(a.size()) - 1, n = static_cast<int>(b.size()) - 1;
  const Box2 box_a = control_box(m, a.data()), box_b = control_box(n, b.data());
  if (!box_a.overlaps(box_b)) return;
  if (m == n && m == 1)
    isolate_pair<1, 2>(a, b, box_a, box_b, out);
  else if (m == n && m == 2)
    isolate_pair<2, 3>(a, b, box_a, box_b, out);
  else if (m == n && m == 3)
    isolate_pair<3, 4>(a, b, box_a, box_b, out);
  else if (std::max(m, n) < 8)
    isolate_pair<0, 8>(a, b, box_a, box_b, out);
  else
    isolate_pair<0, max_curve_points>(a, b, box_a, box_b, out);
}

}  // namespace bezel::geometry_kernel
