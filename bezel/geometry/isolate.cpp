// Subdivision with a proof of at most one root per box; every rounding error is accounted for.
// docs/methods/geometry.md, "Isolating common points", derives the bounds.

#include "bezel/geometry/isolate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

#include "bezel/geometry/isolate_kernel.hpp"

namespace bezel::geometry_kernel {

namespace {

constexpr double u = 0x1p-53;
constexpr int max_depth = 24;   // halvings of one curve
constexpr int max_work = 2000;  // boxes looked at
constexpr double max_q = 0.96;
constexpr double above = 1.0 + 0x1p-40;  // more than the rounding of a few operations
constexpr double underflow = 0x1p-1060;  // more than a few lost products
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double growth = 1.375;  // of a Bernstein basis over [-3/16, 19/16], for each degree

/// A piece of each curve, and its parameters.
template <int Room>
struct BoxPair {
  PairPoints<Room> p;
  Lanes lo, width;
  Lanes extent;  // larger side of the control points' box
  Lanes error;   // of the control points
  int depth[2];  // halvings
};

/// A piece of each curve, and the boxes of their control points.
template <int Room>
struct Pieces {
  PairPoints<Room> points;
  PairVector lo, hi;

  void measure(int n) {
    lo = hi = points.p[0];
    for (int i = 1; i <= n; ++i) {
      const PairVector q = points.p[i];
      lo = {smaller(lo.x, q.x), smaller(lo.y, q.y)};
      hi = {larger(hi.x, q.x), larger(hi.y, q.y)};
    }
  }
};

/// What the edges of a box's control polygons are, times the degree, in terms of the chords:
/// between along_lo and along_hi times the own chord, and up to `across` times the other.
struct Basis {
  Lanes along_lo, along_hi, across;
  Lanes inverse;  // 1 / cross(chord, other chord)
  PairVector other_chord;
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
  Isolator(const PairDegrees<D>& degrees, const PairPoints<Room>& whole, double extent,
           Isolation& out)
      : degrees_(degrees), whole_(whole), rounding_(u * extent), out_(out) {}

  /// @param stack  room for stack_size boxes
  void run(const Pieces<Room>& whole, Box* stack);
  static constexpr int stack_size = 16 + 3 * 2 * max_depth;

 private:
  enum class Outcome { done, split };

  template <int K>
  unsigned overlapping(const Pieces<Room>* pieces, Lanes error) const;
  bool consider(const Pieces<Room>& first, const Pieces<Room>& second, Box& box);
  Outcome settle(const Box& box, Lanes start, const Basis& basis);
  Outcome settle_border(const Box& box, Lanes x, double r, const Basis& basis);
  bool add(const Straddler& found, double s, double t, const Basis& basis, bool straddles,
           const Box& box);
  void leave_open(const Box& box) {
    out_.open.push_back({box.lo[0], box.lo[0] + box.width[0], box.lo[1], box.lo[1] + box.width[1],
                         0, box.lo[0] + 0.5 * box.width[0], box.lo[1] + 0.5 * box.width[1]});
  }
  bool nearly_parallel(const Box& box, PairVector chord) const;
  int split(Box* stack, int count);

  const PairDegrees<D> degrees_;
  const PairPoints<Room>& whole_;
  const double rounding_;  // u times the largest |coordinate|
  Isolation& out_;
  int work_ = 0;
  int straddler_count_ = 0;
  std::array<Straddler, 24> straddlers_;
};

/// The box of a's piece in `first` and b's in `second`, whose control boxes are not apart: whether
/// it must be halved. If not, it is done with. Of `box`, parameters and depths are given.
template <int D, int Room>
bool Isolator<D, Room>::consider(const Pieces<Room>& first, const Pieces<Room>& second, Box& box) {
  const int n = degrees_.max();
  const PairVector *pa = first.points.p, *pb = second.points.p;
  const double error_a = box.error[0], error_b = box.error[1], error = error_a + error_b;

  // cross(chord, .) of the own points (the last one's equals the first one's up to 2 u extent
  // |chord|, as the chord is rounded) and of the other's; each is rounded by less than 2.1 u extent
  // |chord|, where |.| is the sum norm.
  const PairVector chord = joined(pa[n], pb[n]) - joined(pa[0], pb[0]);
  Lanes band[Room], across[Room];
  band[0] = band[n] = cross(chord, joined(pa[0], pb[0]));
  Lanes band_lo = band[0], band_hi = band[0];
  for (int i = 1; i < n; ++i) {
    band[i] = cross(chord, joined(pa[i], pb[i]));
    band_lo = smaller(band_lo, band[i]);
    band_hi = larger(band_hi, band[i]);
  }
  across[0] = cross(chord, swapped(joined(pa[0], pb[0])));
  Lanes across_lo = across[0], across_hi = across[0];
  for (int i = 1; i <= n; ++i) {
    across[i] = cross(chord, swapped(joined(pa[i], pb[i])));
    across_lo = smaller(across_lo, across[i]);
    across_hi = larger(across_hi, across[i]);
  }
  const Lanes chord_norm = sum_norm(chord);
  const Lanes slack = chord_norm * both(error + 16 * rounding_) + both(underflow);
  if (any(((across_lo - band_hi) > slack) | ((band_lo - across_hi) > slack))) return false;

  // The chords as a basis: in the lane of a the edges times the degree are along chord_a - across
  // chord_b, or with the other sign; in that of b the same with the roles exchanged.
  const PairVector other = swapped(chord);
  const Lanes dets = cross(chord, other);  // det and -det
  const Lanes inverse = both(1.0) / dets;
  const Lanes factor = degrees_.as_factor() * inverse;
  Basis basis{both(infinity), both(-infinity), both(0.0), inverse, other};
  for (int i = 0; i < n; ++i) {
    const Lanes along =
        degrees_.where_edge(i, factor * swapped(across[i] - across[i + 1]), both(1.0));
    basis.along_lo = smaller(basis.along_lo, along);
    basis.along_hi = larger(basis.along_hi, along);
    basis.across =
        larger(basis.across, degrees_.where_edge(i, abs(band[i + 1] - band[i]), both(0.0)));
  }
  // Of an edge: twice the points' error; of its product with a chord: that of two, and of the
  // difference.
  const Lanes edge_error =
      abs(factor) * (both(2.0) * box.error + both(12 * rounding_)) * both(above);
  const Lanes along_error = swapped(chord_norm) * edge_error + both(32 * u);
  basis.along_lo -= along_error;
  basis.along_hi += along_error;
  basis.across = abs(factor) * basis.across + chord_norm * edge_error + both(32 * u);
  // The cross product of any two edges of a and b has the sign of det: a root is alone. Not the
  // negation of this: there may be NaN.
  const bool alone =
      basis.along_lo[0] > 0 && basis.along_lo[1] > 0 &&
      basis.across[0] * basis.across[1] * above < basis.along_lo[0] * basis.along_lo[1];
  if (alone) {
    // Newton's method for the chords instead of the curves, from the middle or a corner.
    Lanes start;
    if constexpr (D == 3) {
      const auto middle = [](const Lanes* c) {
        return both(0.125) * ((c[0] + c[3]) + both(3.0) * (c[1] + c[2]));
      };
      start = both(0.5) + swapped(middle(across) - middle(band)) * inverse;
    } else {
      start = swapped(across[0] - band[0]) * inverse;
    }
    start = smaller(larger(start, both(0.0)), both(1.0));
    if (settle(box, box.lo + box.width * start, basis) == Outcome::done) return false;
  }
  for (int i = 0; i <= n; ++i) box.p.p[i] = joined(pa[i], pb[i]);
  // A few more halvings often part curves that pass at a small angle. Chords that are parallel to
  // four digits, or many open boxes, mean that they run along each other.
  const std::size_t open = out_.open.size();
  const bool parallel = std::fabs(dets[0]) <= 0x1p-14 * chord_norm[0] * chord_norm[1];
  const int ready = open >= 16 ? 3 : parallel || open >= 4 ? 4 : open >= 2 ? 7 : 10;
  if (!alone && box.depth[0] >= ready && box.depth[1] >= ready && nearly_parallel(box, chord)) {
    leave_open(box);
    return false;
  }
  const PairVector sides = joined(first.hi, second.hi) - joined(first.lo, second.lo);
  box.extent = larger(sides.x, sides.y);
  return true;
}

/// The root of a box that holds at most one.
template <int D, int Room>
typename Isolator<D, Room>::Outcome Isolator<D, Room>::settle(const Box& box, Lanes x,
                                                              const Basis& basis) {
  const Lanes lo = box.lo, hi = lo + box.width;
  const int d = degrees_.max();
  // Of F: the values' error, (3 d + 1) u extent each, and of what is computed from it.
  const double value_error = (6 * d + 24) * rounding_ * above;
  const double slope_error = 32 * d * d * rounding_;  // of both slopes and their product
  const double bend = 8.0 * d * d * (rounding_ / u);  // bounds |a''| + |b''| on [0, 1]
  for (int i = 0; i < 7; ++i) {
    const PairTaylor at = expand(degrees_, whole_, x);
    const PairVector f = first_minus_second(at.value);
    // On the border, and F shows outward by more than the other curve turns: the root is beyond.
    const LaneMask at_lo = x <= lo, at_hi = x >= hi;
    if (any(at_lo | at_hi)) {
      const Lanes chord_step = cross(f, basis.other_chord) * both(-basis.inverse[0]);
      const Lanes outward = at_hi ? chord_step : -chord_step;
      const Lanes noise = abs(basis.inverse) * sum_norm(basis.other_chord) * both(value_error);
      const LaneMask beyond =
          swapped(basis.along_lo) * (outward - noise) >
          swapped(basis.across) * (swapped(abs(chord_step) + noise)) * both(above);
      if (any((at_lo | at_hi) & beyond)) return Outcome::done;
    }
    const PairVector other_slope = swapped(at.slope);
    const double local = 1.0 / cross(at.slope, other_slope)[0];
    const Lanes newton = cross(f, other_slope) * both(-local);
    // Two terms more of the inverse function's series, by substitution into F' x = -F - F'' x^2 / 2 -
    // F''' x^3 / 6. What the own and the other parameter contribute to each lane:
    const PairVector solve = Lanes{local, -local} * other_slope;
    const Lanes own_bend = cross(at.bend, solve), other_bend = cross(swapped(at.bend), solve);
    const Lanes own_twist = cross(at.twist, solve), other_twist = cross(swapped(at.twist), solve);
    Lanes step = newton, correction = both(0.0);
    for (int k = 0; k < 2; ++k) {
      const Lanes turned = swapped(step);
      correction = (other_bend + turned * other_twist) * (turned * turned) -
                   (own_bend + step * own_twist) * (step * step);
      step = newton + correction;
    }
    // With C the inverse of the derivative here, ||I - C F'|| <= 1/2 on the ball of radius r.
    const double norm = larger(sum_norm(other_slope)) * std::fabs(local) * above;
    const double size = larger(abs(newton)), bent = larger(abs(correction));
    const double r = (size + norm * value_error) * (2 * above) + 8 * u;
    const double turn = norm * (r * bend + slope_error);
    const Lanes low = x - both(r), high = x + both(r);
    const Lanes next = smaller(larger(x + step, lo), hi);
    if (turn < 0.49 && all((low > lo) & (high < hi))) {
      // The next term of the series would be about 5 bent^3 / size^2, but for the fourth
      // derivative.
      if (size < 0x1p-50 ||
          (bent * bent * bent <= 0x1p-60 * (size * size) && (D > 0 || size <= 0x1p-16))) {
        const Lanes found = smaller(larger(x + step, low), high);
        const Straddler enclosure{low[0],  high[0], low[1],  high[1], low[0],
                                  high[0], low[1],  high[1], false,   0};
        return add(enclosure, found[0], found[1], basis, false, box) ? Outcome::done
                                                                     : Outcome::split;
      }
    } else if (!(larger(abs(next - x)) > 0x1p-50)) {
      // Beyond [0, 1] by 1/64 at most |a''| is at most (1 + 1/32)^58 < 8 times larger.
      return norm * (8 * r * bend + slope_error) < 0.49 ? settle_border(box, x, r, basis)
                                                        : Outcome::split;
    }
    if (!all(next == next)) return Outcome::split;
    x = next;
  }
  return Outcome::split;
}

/// Exactly one root is within r of x, which lies in the box; that reaches over its border. It is
/// alone in the box made larger by 3/16 of its width on each side when ||I - C F'|| < 1 there, C
/// the inverse for the chords: its entries are linear in each hodograph, so that they grow by at
/// most growth^(d-1).
template <int D, int Room>
typename Isolator<D, Room>::Outcome Isolator<D, Room>::settle_border(const Box& box, Lanes x,
                                                                     double r, const Basis& basis) {
  const Lanes along = larger(basis.along_hi - both(1.0), both(1.0) - basis.along_lo);
  double q = larger(along + swapped(basis.across)) * above;
  for (int i = 1; i < degrees_.max(); ++i) q *= growth;
  const double w_s = box.width[0], w_t = box.width[1];
  if (!(q < max_q && r <= w_s / 64 && r <= w_t / 64)) return Outcome::split;
  const double s = x[0], t = x[1];
  const Straddler found{s - r,
                        s + r,
                        t - r,
                        t + r,
                        box.lo[0] - 0.1875 * w_s,
                        box.lo[0] + 1.1875 * w_s,
                        box.lo[1] - 0.1875 * w_t,
                        box.lo[1] + 1.1875 * w_t,
                        !(s - r > 0 && s + r < 1 && t - r > 0 && t + r < 1),
                        0};
  return add(found, s, t, basis, true, box) ? Outcome::done : Outcome::split;
}

/// False: it may be one found before, or another; nothing is added then.
template <int D, int Room>
bool Isolator<D, Room>::add(const Straddler& found, double s, double t, const Basis& basis,
                            bool straddles, const Box& box) {
  const int sign = basis.inverse[0] > 0 ? 1 : -1;
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

/// Halves the longer curve of the last box on the stack, or both. What must be halved further takes
/// its place. @return how many boxes are on the stack then
template <int D, int Room>
int Isolator<D, Room>::split(Box* stack, int count) {
  const Box& box = stack[--count];
  const int n = degrees_.max();
  const bool split_a = box.extent[0] >= 0.5 * box.extent[1];
  const bool split_b = box.extent[1] >= 0.5 * box.extent[0];
  if (++work_ > max_work || (split_a && box.depth[0] == max_depth) ||
      (split_b && box.depth[1] == max_depth)) {
    leave_open(box);
    return count;
  }
  Pieces<Room> half[2];
  halve_both(degrees_, box.p, half[0].points, half[1].points);
  if (!split_a || !split_b)
    for (int i = 0; i <= n; ++i)
      for (Pieces<Room>& h : half) {
        PairVector& p = h.points.p[i];
        p = split_a ? joined(p, box.p.p[i]) : joined(box.p.p[i], p);
      }
  half[0].measure(n);
  half[1].measure(n);
  const Lanes lo = box.lo;
  const Lanes width = box.width * Lanes{split_a ? 0.5 : 1.0, split_b ? 0.5 : 1.0};
  const Lanes error = box.error + degrees_.as_factor() *
                                      Lanes{split_a ? rounding_ : 0.0, split_b ? rounding_ : 0.0};
  const int s_depth = box.depth[0] + (split_a ? 1 : 0), t_depth = box.depth[1] + (split_b ? 1 : 0);
  unsigned rest = overlapping<2>(half, error) & (split_a && split_b ? 0b1111U : 0b1001U);
  for (; rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest), i = k / 2, j = k % 2;
    Box& to = stack[count];
    to.lo = lo + width * Lanes{split_a ? static_cast<double>(i) : 0.0,
                               split_b ? static_cast<double>(j) : 0.0};
    to.width = width;
    to.error = error;
    to.depth[0] = s_depth;
    to.depth[1] = t_depth;
    if (consider(half[i], half[j], to)) ++count;
  }
  return count;
}

/// Bit K i + j: the control boxes of a's piece i and b's piece j are not apart.
template <int D, int Room>
template <int K>
unsigned Isolator<D, Room>::overlapping(const Pieces<Room>* pieces, Lanes error) const {
  // The boxes are widened by that; the sums are below 2 extent, their rounding below 2 u extent.
  const Lanes margin = both(error[0] + error[1] + 4 * rounding_);
  unsigned bits = 0;
  for (int j = 0; j < K; j += 2) {
    const Pieces<Room>&p = pieces[j], &q = pieces[j + 1];
    const Lanes lo_x = seconds(p.lo.x, q.lo.x) - margin, hi_x = seconds(p.hi.x, q.hi.x) + margin;
    const Lanes lo_y = seconds(p.lo.y, q.lo.y) - margin, hi_y = seconds(p.hi.y, q.hi.y) + margin;
    for (int i = 0; i < K; ++i) {
      const Pieces<Room>& a = pieces[i];
      bits |= lane_bits((first_in_both(a.lo.x) <= hi_x) & (first_in_both(a.hi.x) >= lo_x) &
                        (first_in_both(a.lo.y) <= hi_y) & (first_in_both(a.hi.y) >= lo_y))
              << (K * i + j);
    }
  }
  return bits;
}

template <int D, int Room>
void Isolator<D, Room>::run(const Pieces<Room>& whole, Box* stack) {
  const int n = degrees_.max();
  const PairVector sides = whole.hi - whole.lo;
  const Lanes extent = larger(sides.x, sides.y);
  int count = 0;
  if (std::min(degrees_.of(0), degrees_.of(1)) < 3 || any(extent < both(0.5) * swapped(extent))) {
    Box& box = stack[0];
    box.lo = both(0.0);
    box.width = both(1.0);
    box.error = both(rounding_);
    box.depth[0] = box.depth[1] = 0;
    count = consider(whole, whole, box) ? 1 : 0;
  } else {
    // Nothing can be shown of whole curves as a rule, or of halves: quarters.
    Pieces<Room> half[2], quarter[4];
    halve_both(degrees_, whole.points, half[0].points, half[1].points);
    for (int i = 0; i < 2; ++i)
      halve_both(degrees_, half[i].points, quarter[2 * i].points, quarter[2 * i + 1].points);
    for (Pieces<Room>& q : quarter) q.measure(n);
    const Lanes error = both(rounding_) + degrees_.as_factor() * both(2 * rounding_);
    unsigned rest = overlapping<4>(quarter, error);
    for (; rest != 0; rest &= rest - 1) {
      const int k = std::countr_zero(rest), i = k / 4, j = k % 4;
      Box& to = stack[count];
      to.lo = both(0.25) * Lanes{static_cast<double>(i), static_cast<double>(j)};
      to.width = both(0.25);
      to.error = error;
      to.depth[0] = to.depth[1] = 2;
      if (consider(quarter[i], quarter[j], to)) ++count;
    }
  }
  while (count > 0) count = split(stack, count);
}

template <int D, int Room>
void isolate_pair(std::span<const Vec2> a, std::span<const Vec2> b, Isolation& out) {
  const PairDegrees<D> degrees{{static_cast<int>(a.size()) - 1, static_cast<int>(b.size()) - 1}};
  const int n = degrees.max();
  Pieces<Room> whole;
  for (int i = 0; i <= n; ++i) {
    const Vec2& p = a[static_cast<std::size_t>(std::min(i, degrees.of(0)))];
    const Vec2& q = b[static_cast<std::size_t>(std::min(i, degrees.of(1)))];
    whole.points.p[i] = {Lanes{p.x(), q.x()}, Lanes{p.y(), q.y()}};
  }
  whole.measure(n);
  const PairVector lo = whole.lo, hi = whole.hi;
  if (any((lo.x > swapped(hi.x)) | (lo.y > swapped(hi.y)))) return;
  // Relative to a point where both may pass: coordinates are then rounded relative to the curves'
  // extents, not to their distance from the origin.
  const auto middle = [](Lanes low, Lanes high) {
    return both(0.5) * larger(low, swapped(low)) + both(0.5) * smaller(high, swapped(high));
  };
  const PairVector origin{middle(lo.x, hi.x), middle(lo.y, hi.y)};
  for (int i = 0; i <= n; ++i) whole.points.p[i] = whole.points.p[i] - origin;
  whole.lo = lo - origin;
  whole.hi = hi - origin;
  const double extent = larger(
      larger(larger(abs(whole.lo.x), abs(whole.hi.x)), larger(abs(whole.lo.y), abs(whole.hi.y))));
  // Points, to rounding: nothing can be shown.
  if (extent < 0x1p-400) {
    out.open.push_back({0, 1, 0, 1, 0, 0.5, 0.5});
    return;
  }
  using Search = Isolator<D, Room>;
  Search search(degrees, whole.points, extent, out);
  if constexpr (Room <= 8) {
    BoxPair<Room> stack[Search::stack_size];
    search.run(whole, stack);
  } else {
    const auto stack = std::make_unique_for_overwrite<BoxPair<Room>[]>(Search::stack_size);
    search.run(whole, stack.get());
  }
}

}  // namespace

void isolate(std::span<const Vec2> a, std::span<const Vec2> b, Isolation& out) {
  out.clear();
  const int m = static_cast<int>(a.size()) - 1, n = static_cast<int>(b.size()) - 1;
  if (m == n && m == 1)
    isolate_pair<1, 2>(a, b, out);
  else if (m == n && m == 2)
    isolate_pair<2, 3>(a, b, out);
  else if (m == n && m == 3)
    isolate_pair<3, 4>(a, b, out);
  else if (std::max(m, n) < 8)
    isolate_pair<0, 8>(a, b, out);
  else
    isolate_pair<0, max_curve_points>(a, b, out);
}

}  // namespace bezel::geometry_kernel
