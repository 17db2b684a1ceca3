#include "bezel/geometry/quick_ends.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/geometry/intersect_search.hpp"

namespace bezel::geometry_kernel {
namespace {

constexpr double least_sine_at_ends = 0.01;
/// Of the smaller curve: an end this far from the other is none of its points.
constexpr double farthest = 1e-3 * least_sine_at_ends;

struct EndContact {
  double s, t;
};

/// How the directions of two curves, reversed where asked for, lie to each other.
struct Directions {
  bool across;  ///< nowhere on either are they nearly parallel
  bool away;    ///< everywhere more than a right angle apart
};

Directions directions(const CurveCache& a, bool turn_a, const CurveCache& b, bool turn_b) {
  // With derivatives u + alpha u', v + beta v' (u' is u turned by 90 degrees, the same for v),
  // cross = cross(u, v) (1 + alpha beta) + dot(u, v) (beta - alpha) and
  // dot   = dot(u, v) (1 + alpha beta) - cross(u, v) (beta - alpha), extreme where both are.
  const double sine = cross(a.chord, b.chord);
  const double cosine = dot(a.chord, b.chord);
  const double least = 2.0 * least_sine_at_ends * a.chord_length * b.chord_length;
  const double turn = turn_a != turn_b ? -1.0 : 1.0;
  Directions result{true, true};
  const std::size_t corners = a.slope_lo < a.slope_hi || b.slope_lo < b.slope_hi ? 2 : 1;
  const std::array<double, 2> alphas = {a.slope_lo, a.slope_hi}, betas = {b.slope_lo, b.slope_hi};
  for (std::size_t i = 0; i < corners; ++i) {
    for (std::size_t j = 0; j < corners; ++j) {
      const double straight = 1.0 + alphas[i] * betas[j], bent = betas[j] - alphas[i];
      const double across = sine * straight + cosine * bent;
      const double along = turn * (cosine * straight - sine * bent);
      result.across = result.across && std::fabs(across) >= least && (across > 0.0) == (sine > 0.0);
      result.away = result.away && along < 0.0;
    }
  }
  return result;
}

double gap_at(const CurveCache& a, double s, const CurveCache& b, double t) {
  const auto at = [](const CurveCache& curve, double x) {
    if (x == 0.0) return curve.control.front();
    if (x == 1.0) return curve.control.back();
    return curve_point(static_cast<int>(curve.control.size()) - 1, curve.control.data(), x).value;
  };
  return norm(at(a, s) - at(b, t));
}

/// Both curves from end to end.
EndMeeting whole(const CurveCache& a, const CurveCache& b, bool reversed, double tau,
                 QuickEnds& out) {
  const std::size_t size = a.control.size();
  if (b.control.size() != size) return EndMeeting::unclear;
  double gap = 0.0;
  for (std::size_t i = 0; i < size; ++i)
    gap = std::max(gap, norm(a.control[i] - b.control[reversed ? size - 1 - i : i]));
  if (!(gap <= tau)) return EndMeeting::unclear;
  out = {0.0, reversed ? 1.0 : 0.0, 1.0, reversed ? 0.0 : 1.0, gap};
  return EndMeeting::part;
}

/// Ends of one curve inside the other.
std::size_t find_inner_ends(const CurveCache& a, const CurveCache& b, double tau, bool taken_a[2],
                            bool taken_b[2], EndContact* contacts) {
  std::size_t count = 0;
  std::array<double, 4> feet{};
  for (int end = 0; end < 2; ++end) {
    const Vec2& p = end == 0 ? a.control.front() : a.control.back();
    const int found = taken_a[end] ? 0 : inner_feet(p, b, tau, feet);
    if (found > 1) return 5;
    if (found == 1) contacts[count++] = {static_cast<double>(end), feet[0]};
  }
  for (int end = 0; end < 2; ++end) {
    const Vec2& p = end == 0 ? b.control.front() : b.control.back();
    const int found = taken_b[end] ? 0 : inner_feet(p, a, tau, feet);
    if (found > 1) return 5;
    if (found == 1) contacts[count++] = {feet[0], static_cast<double>(end)};
  }
  return count;
}

}  // namespace

bool nowhere_parallel(const CurveCache& a, const CurveCache& b) {
  return a.slope_hi - a.slope_lo <= 1.0 && b.slope_hi - b.slope_lo <= 1.0 &&
         directions(a, false, b, false).across;
}

EndMeeting meet_at_ends(const CurveCache& a, const CurveCache& b, double distance, QuickEnds& out) {
  // Then each runs forward along its chord, on both sides of any of its points.
  if (!(a.slope_hi - a.slope_lo <= 1.0 && b.slope_hi - b.slope_lo <= 1.0))
    return EndMeeting::unclear;
  const double magnitude = std::max(a.magnitude, b.magnitude);
  const double tau = std::max(distance, 0x1p-52 * magnitude);
  if (!(tau < farthest * std::min(a.diameter, b.diameter)) ||
      !(magnitude > 0x1p-300 && magnitude < 0x1p300))
    return EndMeeting::unclear;
  std::array<EndContact, 6> contacts;
  std::size_t count = 0;
  bool taken_a[2] = {}, taken_b[2] = {};
  for (int i = 0; i < 2; ++i) {
    const Vec2& p = i == 0 ? a.control.front() : a.control.back();
    for (int j = 0; j < 2; ++j) {
      const Vec2 apart = p - (j == 0 ? b.control.front() : b.control.back());
      if (!(dot(apart, apart) <= tau * tau)) continue;
      contacts[count++] = {static_cast<double>(i), static_cast<double>(j)};
      taken_a[i] = taken_b[j] = true;
    }
  }
  if (count == 2) return whole(a, b, contacts[0].t == 1.0, tau, out);
  if (count == 1) {
    const auto [s, t] = contacts[0];
    const auto [across, away] = directions(a, s == 1.0, b, t == 1.0);
    if (across || away) {
      out = {s, t, s, t, gap_at(a, s, b, t)};
      return EndMeeting::point;
    }
  }
  const bool straight = a.control.size() == 2 && b.control.size() == 2;
  const bool across = count == 0 && directions(a, false, b, false).across;
  if (!straight && !across) return EndMeeting::unclear;
  const std::size_t inner = find_inner_ends(a, b, tau, taken_a, taken_b, contacts.data() + count);
  count += inner;
  if (across && count == 1) {
    const auto [s, t] = contacts[0];
    out = {s, t, s, t, gap_at(a, s, b, t)};
    return EndMeeting::point;
  }
  // Straight edges are apart by less at points between.
  if (across || count != 2) return EndMeeting::unclear;
  if (contacts[0].s > contacts[1].s) std::swap(contacts[0], contacts[1]);
  const auto &p = contacts[0], &q = contacts[1];
  if (p.s == q.s || p.t == q.t) return EndMeeting::unclear;
  const double gap = std::max(gap_at(a, p.s, b, p.t), gap_at(a, q.s, b, q.t));
  if (!(gap <= tau)) return EndMeeting::unclear;
  out = {p.s, p.t, q.s, q.t, gap};
  return EndMeeting::part;
}

}  // namespace bezel::geometry_kernel
