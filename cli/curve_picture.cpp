#include "cli/curve_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bezel/bernstein/interval.hpp"

namespace bezel::cli {
namespace {

constexpr int steps_per_curve = 96, steps_per_error = 192;

/// The parameter of the curve's point nearest to p, by Newton's method from a guess.
double foot(const SmoothCurve<2>& curve, const Vec2& p, double guess) {
  double t = guess;
  for (int i = 0; i < 20; ++i) {
    const CurveJet<2> jet = curve(t);
    const Vec2 gap = jet.x - p;
    const double speed = dot(jet.d1, jet.d1);
    const double slope = speed + dot(gap, jet.d2);
    const double step = dot(gap, jet.d1) / (slope > 0.25 * speed ? slope : speed);
    const double next = std::clamp(t - step, -1.0, 1.0);
    if (next == t) break;
    t = next;
  }
  return t;
}

/// Pairs of a point of the curve and the interpolant's offset from it.
struct Offset {
  Vec2 at, error;
};

std::vector<Offset> offsets(const SmoothCurve<2>& curve, const CurvePiece<2>& piece) {
  std::vector<Offset> out;
  const CurveInterpolant<2>& p = piece.interpolant;
  const std::vector<double>& t = p.nodes.t;
  const std::size_t last = t.size() - 1;
  for (int i = 0; i <= steps_per_error; ++i) {
    const double s = static_cast<double>(i) / steps_per_error;
    // Between the nodes' parameters, as if they lay at the Chebyshev points.
    const double place = std::acos(1.0 - 2.0 * s) / std::acos(-1.0) * static_cast<double>(last);
    const auto k = std::min(static_cast<std::size_t>(place), last - 1);
    const double part = place - static_cast<double>(k);
    const double own = (1.0 - part) * t[k] + part * t[k + 1];
    const double guess = 0.5 * ((1.0 - own) * piece.t0 + (1.0 + own) * piece.t1);
    const Vec2 point = bernstein::evaluate<Vec2>(p.control, s);
    const Vec2 nearest = curve(foot(curve, point, guess)).x;
    out.push_back({nearest, point - nearest});
  }
  return out;
}

}  // namespace

std::vector<std::vector<Vec2>> drawn_curve(const SmoothCurve<2>& curve) {
  std::vector<double> ends = {-1.0};
  ends.insert(ends.end(), curve.breakpoints().begin(), curve.breakpoints().end());
  ends.push_back(1.0);
  std::vector<std::vector<Vec2>> out;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double lo = ends[k], hi = ends[k + 1];
    const int steps = std::max(2, static_cast<int>(0.5 * (hi - lo) * steps_per_curve));
    const double h = (hi - lo) / steps;
    const double inside = 1e-9 * (hi - lo);  // derivatives on this side of a breakpoint
    for (int i = 0; i < steps; ++i) {
      const double a = i == 0 ? lo : lo + i * h, b = i + 1 == steps ? hi : lo + (i + 1) * h;
      const Vec2 from = curve(a).x, to = curve(b).x;
      const Vec2 leave = curve(i == 0 ? a + inside : a).d1;
      const Vec2 arrive = curve(i + 1 == steps ? b - inside : b).d1;
      out.push_back({from, from + (h / 3.0) * leave, to - (h / 3.0) * arrive, to});
    }
  }
  return out;
}

SmoothCurve<2> projected(const SmoothCurve<3>& curve) {
  const auto flat = [](const Vec3& p) { return Vec2{{p[0], p[1]}}; };
  return SmoothCurve<2>(
      [curve, flat](double t) {
        const CurveJet<3> jet = curve(t);
        return CurveJet<2>{flat(jet.x), flat(jet.d1), flat(jet.d2)};
      },
      {curve.breakpoints().begin(), curve.breakpoints().end()});
}

void draw_interpolants(CurvePicture& picture, const std::string& name, const SmoothCurve<2>& curve,
                       const std::vector<CurvePiece<2>>& pieces, bool alone) {
  if (alone) picture.shapes.push_back({name, drawn_curve(curve)});
  DrawnShape shape{!alone ? name : pieces.size() == 1 ? "interpolant" : "interpolants", {}};
  Box2 box;
  for (const CurvePiece<2>& piece : pieces) {
    shape.curves.push_back(piece.interpolant.control);
    for (const Vec2& p : piece.interpolant.nodal) box.include(p);
  }
  picture.shapes.push_back(std::move(shape));
  const auto marked = [&](const Vec2& p) {
    return std::any_of(picture.marks.begin(), picture.marks.end(), [&](const DrawnMark& mark) {
      return norm(mark.point - p) <= 1e-6 * box.diameter();
    });
  };
  for (const CurvePiece<2>& piece : pieces)
    for (const Vec2& p : piece.interpolant.nodal)
      if (!marked(p)) picture.marks.push_back({MarkKind::vertex, p, ""});
  if (!alone) return;
  double largest = 0.0;
  std::vector<std::vector<Offset>> errors;
  for (const CurvePiece<2>& piece : pieces) {
    errors.push_back(offsets(curve, piece));
    for (const Offset& o : errors.back()) largest = std::max(largest, norm(o.error));
  }
  // Up to a tenth of the picture; not for errors of the size of rounding.
  if (!(largest > 1e-15 * box.diameter())) return;
  const double power = std::floor(std::log10(0.15 * box.diameter() / largest));
  const double factor = std::pow(10.0, power);
  DrawnShape comb{power == 0.0 ? std::string("error")
                               : fmt::format("error times 1e{}", static_cast<int>(power)),
                  {}};
  for (const auto& list : errors)
    for (std::size_t i = 1; i < list.size(); ++i)
      comb.curves.push_back(
          {list[i - 1].at + factor * list[i - 1].error, list[i].at + factor * list[i].error});
  picture.shapes.push_back(std::move(comb));
}

}  // namespace bezel::cli
