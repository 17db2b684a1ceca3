#include "bezel/fit/curve_interpolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bezel/base/error.hpp"
#include "bezel/fit/lobatto.hpp"
#include "bezel/geometry/curve.hpp"
#include "support/smooth_curves.hpp"

namespace {

using namespace bezel;
using namespace bezel::testing;
constexpr double pi = std::numbers::pi;
constexpr CurveMethod all_methods[] = {CurveMethod::standard,      CurveMethod::chord,
                                       CurveMethod::arc_length,    CurveMethod::l2,
                                       CurveMethod::equal_tangent, CurveMethod::orthogonal_distance,
                                       CurveMethod::best};

const CurveInterpolator& interpolator() {
  static const CurveInterpolator tables(12);
  return tables;
}

TEST(CurveInterpolation, NodesAreOnTheCurveAndControlPointsAreTheSamePolynomial) {
  const PlaneCurve curve = paper_curve(5);
  const LobattoBasis basis(6);
  for (const CurveMethod method : all_methods) {
    const CurveInterpolant<2> found = interpolator().interpolate(curve, 6, method);
    if (method == CurveMethod::chord || method == CurveMethod::equal_tangent) continue;
    ASSERT_EQ(found.nodes.status, CurveStatus::ok) << name(method);
    ASSERT_EQ(found.degree(), 6);
    ASSERT_EQ(found.control.size(), 7u);
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_EQ(found.nodal[i], curve(found.nodes.t[i]).x);
      if (i > 0) {
        EXPECT_LT(found.nodes.t[i - 1], found.nodes.t[i]);
      }
      const Vec2 p = Curve(found.control)(0.5 * (1.0 + basis.nodes()[i]));
      EXPECT_NEAR(norm(p - found.nodal[i]), 0.0, 2e-14) << name(method);
    }
    EXPECT_EQ(found.nodes.t.front(), -1.0);
    EXPECT_EQ(found.nodes.t.back(), 1.0);
  }
}

TEST(CurveInterpolation, DegreeOneIsTheChord) {
  for (const CurveMethod method : all_methods) {
    const CurveInterpolant<2> found = interpolator().interpolate(paper_curve(1), 1, method);
    ASSERT_TRUE(found.ok()) << name(method);
    // The chord of an arc of half-angle pi/3 is 1 - cos(pi/3) = 1/2 away in the middle.
    EXPECT_NEAR(found.errors.distance_max, 0.5, 1e-3);
    EXPECT_NEAR(found.errors.arc_length, 2.0 * pi / 3.0 - std::sqrt(3.0), 4e-15);
    EXPECT_NEAR(found.errors.min_speed, std::sqrt(3.0) / (2.0 * pi / 3.0), 4e-15);
    EXPECT_EQ(found.nodes.kind, CurveKind::placed);
  }
}

TEST(CurveInterpolation, AStraightLineIsExact) {
  const PlaneCurve line([](double t) {
    // Unevenly parametrised.
    const double s = t + 0.3 * (t * t - 1.0);
    return CurveJet<2>{Vec2{{3.0 * s, 4.0 * s}},
                       Vec2{{3.0 * (1.0 + 0.6 * t), 4.0 * (1.0 + 0.6 * t)}}, Vec2{{1.8, 2.4}}};
  });
  for (const CurveMethod method : all_methods)
    for (const int n : {1, 2, 5, 12}) {
      const CurveInterpolant<2> found = interpolator().interpolate(line, n, method);
      ASSERT_TRUE(found.ok()) << name(method) << n;
      EXPECT_LE(found.errors.distance_max, 4e-15) << name(method) << n;
      // The other methods leave the parametrisation open: any with ordered nodes is exact.
      if (found.nodes.kind == CurveKind::placed && method != CurveMethod::l2) {
        EXPECT_NEAR(found.errors.min_speed, 1.0, 1e-12) << name(method) << n;
      }
    }
}

TEST(CurveInterpolation, StandardPlacesXAffinelyAlsoAtVerticalEnds) {
  const PlaneCurve half = ellipse(10.0, 1.0, 0.0, pi);  // x falls, x' = 0 at both ends
  const LobattoBasis basis(9);
  for (const CurveMethod method : {CurveMethod::standard, CurveMethod::chord}) {
    const CurveInterpolant<2> found = interpolator().interpolate(half, 9, method);
    ASSERT_TRUE(found.ok());
    for (std::size_t i = 0; i < 10; ++i)
      EXPECT_NEAR(found.nodal[i][0], -10.0 * basis.nodes()[i], 4e-15);
    EXPECT_TRUE(found.errors.monotone);
  }
}

TEST(CurveInterpolation, ArcLengthPlacesLengthAffinely) {
  const PlaneCurve half = ellipse(10.0, 1.0, 0.0, pi);
  const LobattoBasis basis(9);
  const CurveNodes found = interpolator().place(half, 9, CurveMethod::arc_length);
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(half.length_to(found.t[i]), 0.5 * half.length() * (1.0 + basis.nodes()[i]),
                1e-14 * half.length());
}

TEST(CurveInterpolation, SaysWhereAMethodDoesNotApply) {
  const PlaneCurve closed = ellipse(2.0, 1.0, 0.0, 2.0 * pi),
                   hook = ellipse(1.0, 1.0, 0.0, 1.9 * pi);
  const auto status = [&](const PlaneCurve& curve, CurveMethod method) {
    const CurveInterpolant<2> found = interpolator().interpolate(curve, 5, method);
    EXPECT_TRUE(found.nodal.empty() && found.control.empty() && found.nodes.t.empty());
    return found.nodes.status;
  };
  EXPECT_EQ(status(closed, CurveMethod::chord), CurveStatus::closed);
  EXPECT_EQ(status(closed, CurveMethod::standard), CurveStatus::not_a_graph);
  EXPECT_EQ(status(closed, CurveMethod::l2), CurveStatus::not_a_graph);
  EXPECT_EQ(status(hook, CurveMethod::chord), CurveStatus::not_a_chord_map);
  EXPECT_EQ(status(hook, CurveMethod::standard), CurveStatus::not_a_graph);
  // The other methods do not need a graph.
  EXPECT_LE(interpolator().interpolate(closed, 10).errors.distance_max, 1e-6);
  EXPECT_EQ(interpolator().interpolate(closed, 10).errors.l2, -1.0);
}

TEST(CurveInterpolation, DegreesOutOfRangeAreErrors) {
  const PlaneCurve curve = paper_curve(1);
  EXPECT_THROW(static_cast<void>(interpolate_curve(curve, 0)), InputError);
  EXPECT_THROW(static_cast<void>(interpolate_curve(curve, 31)), InputError);
  EXPECT_THROW(static_cast<void>(interpolator().place(curve, 13, CurveMethod::best)), InputError);
  EXPECT_THROW(CurveInterpolator(0), InputError);
  EXPECT_THROW(CurveInterpolator(31), InputError);
  try {
    static_cast<void>(interpolator().interpolate(curve, 13));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.message(), "curve degree 13, expected 1 to 12");
  }
}

TEST(CurveInterpolation, ErrorsOfAnyNodalValues) {
  const PlaneCurve curve = paper_curve(1);
  // The chord moved by 1/100 towards the arc: 0.49 from its middle.
  const std::vector<Vec2> nodal{curve(-1.0).x + Vec2{{0.0, 0.01}},
                                curve(1.0).x + Vec2{{0.0, 0.01}}};
  EXPECT_NEAR(interpolator().errors<2>(curve, nodal).distance_max, 0.49, 1e-3);
  EXPECT_NEAR(interpolator().largest_distance<2>(curve, nodal), 0.49, 0.01);
  EXPECT_THROW(static_cast<void>(interpolator().errors<2>(curve, std::vector<Vec2>(1))),
               InputError);
  EXPECT_THROW(static_cast<void>(interpolator().errors<2>(curve, std::vector<Vec2>(14))),
               InputError);
  std::vector<Vec2> bad = nodal;
  bad[1][0] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(static_cast<void>(interpolator().errors<2>(curve, bad)), InputError);
}

TEST(CurveInterpolation, CurvesInSpace) {
  double last = 1.0;
  for (const int n : {3, 5, 7, 9}) {
    const CurveInterpolant<3> best = interpolator().interpolate(helix(), n);
    const CurveInterpolant<3> arc = interpolator().interpolate(helix(), n, CurveMethod::arc_length);
    ASSERT_TRUE(best.ok());
    EXPECT_LE(best.errors.distance_l2, arc.errors.distance_l2 * (1.0 + 1e-6));
    EXPECT_LT(best.errors.distance_l2, 0.05 * last);
    last = best.errors.distance_l2;
  }
  // A plane curve in space has the errors of the plane curve.
  const PlaneCurve flat = paper_curve(1);
  const SpaceCurve tilted([flat](double t) {
    const CurveJet<2> j = flat(t);
    const auto lift = [](const Vec2& v) { return Vec3{{v[0], 0.6 * v[1], 0.8 * v[1]}}; };
    return CurveJet<3>{lift(j.x), lift(j.d1), lift(j.d2)};
  });
  for (int n = 2; n <= 6; ++n)
    EXPECT_NEAR(interpolator().interpolate(tilted, n).errors.distance_l2 /
                    interpolator().interpolate(flat, n).errors.distance_l2,
                1.0, 0.02)
        << n;
}

TEST(CurveInterpolation, TheSameBitsTwice) {
  for (int number = 1; number <= 5; ++number) {
    const CurveNodes a = interpolator().place(paper_curve(number), 9, CurveMethod::best);
    const CurveNodes b = CurveInterpolator(9).place(paper_curve(number), 9, CurveMethod::best);
    EXPECT_EQ(a.t, b.t);
  }
}

TEST(CurvePieces, ABreakpointMakesTwoArcsAsGoodAsOne) {
  const auto whole = interpolator().interpolate(two_arcs(false), 8);
  const auto pieces = interpolate_pieces(two_arcs(true), 8);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].t1, 0.0);
  EXPECT_EQ(pieces[0].interpolant.control.back(), pieces[1].interpolant.control.front());
  for (const auto& piece : pieces) {
    EXPECT_TRUE(piece.interpolant.ok());
    EXPECT_LE(piece.interpolant.errors.distance_max, 1e-8);
  }
  EXPECT_GE(whole.errors.distance_max, 1e-6);
}

TEST(CurvePieces, AdaptiveReachesEachToleranceWithFewPieces) {
  const PlaneCurve curve = ellipse(10.0, 1.0, 0.0, 2.0 * pi);
  std::size_t last = 1;
  for (const double tolerance : {1e-1, 1e-4}) {
    const AdaptiveCurve<2> found =
        interpolate_adaptive(curve, 3, {.tolerance = tolerance, .max_pieces = 500});
    EXPECT_TRUE(found.reached) << tolerance;
    EXPECT_LE(found.distance_max, tolerance);
    EXPECT_GE(found.pieces.size(), last);
    last = found.pieces.size();
    for (std::size_t i = 1; i < found.pieces.size(); ++i) {
      EXPECT_EQ(found.pieces[i - 1].t1, found.pieces[i].t0);
      EXPECT_EQ(found.pieces[i - 1].interpolant.control.back(),
                found.pieces[i].interpolant.control.front());
    }
    EXPECT_EQ(found.pieces.front().t0, -1.0);
    EXPECT_EQ(found.pieces.back().t1, 1.0);
  }
  // By arc length, order 4 instead of 6, it takes many more.
  const auto arc = interpolate_adaptive(curve, 3, {.tolerance = 1e-4}, CurveMethod::arc_length);
  EXPECT_TRUE(arc.reached);
  EXPECT_LE(3 * last, 2 * arc.pieces.size());
}

TEST(CurvePieces, AdaptiveSpreadsTheError) {
  const auto found = interpolate_adaptive(paper_curve(2), 4, {.tolerance = 1e-7});
  ASSERT_TRUE(found.reached);
  double least = 1.0;
  for (const auto& piece : found.pieces)
    least = std::min(least, piece.interpolant.errors.distance_max);
  EXPECT_GE(least, 0.01 * found.distance_max);
}

TEST(CurvePieces, AdaptiveSaysWhenThereIsNoRoom) {
  const auto found = interpolate_adaptive(ellipse(10.0, 1.0, 0.0, 2.0 * pi), 2,
                                          {.tolerance = 1e-9, .max_pieces = 5});
  EXPECT_FALSE(found.reached);
  EXPECT_GT(found.distance_max, 1e-9);
  EXPECT_LE(found.pieces.size(), 5u);
  EXPECT_EQ(found.pieces.back().t1, 1.0);
}

TEST(CurvePieces, EverySmoothPartHasAPieceAlsoWithoutRoom) {
  const auto found = interpolate_adaptive(two_arcs(true), 2, {.tolerance = 1e-9, .max_pieces = 1});
  EXPECT_FALSE(found.reached);
  ASSERT_EQ(found.pieces.size(), 2u);
  EXPECT_EQ(found.pieces[0].t1, 0.0);
  EXPECT_EQ(found.pieces[1].t1, 1.0);
}

TEST(CurvePieces, AToleranceBelowRoundingEnds) {
  const auto found = interpolate_adaptive(paper_curve(1), 7, {.tolerance = 1e-30});
  EXPECT_FALSE(found.reached);
  EXPECT_LE(found.pieces.size(), 8u);
  EXPECT_LE(found.distance_max, 1e-14);
}

TEST(CurvePieces, RefusesBadOptions) {
  const PlaneCurve curve = paper_curve(1);
  EXPECT_THROW(static_cast<void>(interpolate_adaptive(curve, 3, {.tolerance = 0.0})), InputError);
  EXPECT_THROW(static_cast<void>(interpolate_adaptive(curve, 3, {.tolerance = std::nan("")})),
               InputError);
  EXPECT_THROW(
      static_cast<void>(interpolate_adaptive(curve, 3, {.tolerance = 1.0, .max_pieces = 0})),
      InputError);
  EXPECT_THROW(static_cast<void>(interpolate_adaptive(curve, 40, {})), InputError);
  EXPECT_THROW(static_cast<void>(interpolate_pieces(curve, 0)), InputError);
}

}  // namespace
