// Gordon-Hall maps of regions inside four curves.

#include <fmt/format.h>

#include "bezel/base/error.hpp"
#include "bezel/fit/gordon_hall.hpp"

namespace bezel {
namespace {

Vec2 swapped(const Vec2& p) {
  return {p.y(), p.x()};
}

/// The mirror image in the line x = y.
PlaneCurve swapped(const PlaneCurve& curve) {
  return PlaneCurve(
      [curve](double t) {
        const CurveJet<2> jet = curve(t);
        return CurveJet<2>{swapped(jet.x), swapped(jet.d1), swapped(jet.d2)};
      },
      {curve.breakpoints().begin(), curve.breakpoints().end()});
}

std::vector<Vec2> side_nodes(const PlaneCurve& curve, const char* which, int degree,
                             CurveMethod method, const CurveInterpolator& interpolator) {
  CurveNodes nodes = interpolator.place(curve, degree, method);
  if (nodes.status == CurveStatus::not_a_graph)
    nodes = interpolator.place(swapped(curve), degree, method);
  if (nodes.t.empty())
    throw InputError(fmt::format("the {} side has no interpolant by the method {}: {}", which,
                                 name(method), name(nodes.status)));
  std::vector<Vec2> out;
  for (const double t : nodes.t) out.push_back(curve(t).x);
  return out;
}

}  // namespace

GordonHall gordon_hall(const QuadCurves& curves, int degree, CurveMethod method,
                       const CurveInterpolator& interpolator) {
  const auto side = [&](const PlaneCurve& curve, const char* which) {
    return side_nodes(curve, which, degree, method, interpolator);
  };
  return GordonHall({side(curves.bottom, "bottom"), side(curves.right, "right"),
                     side(curves.top, "top"), side(curves.left, "left")});
}

GordonHall gordon_hall(const QuadCurves& curves, int degree, CurveMethod method) {
  return gordon_hall(curves, degree, method, CurveInterpolator(degree));
}

}  // namespace bezel
