#pragma once
// Curve-curve intersection without tolerance: every verdict is a proof about the control points as
// given. Internal.

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/tube.hpp"

namespace bezel::geometry_kernel {

/// b's parameter where both curves are one: t + (p / q) (s - s0), exactly.
class CoincidenceMap {
 public:
  CoincidenceMap(const ExactContact& contact, const AffineChange& change);
  /// The parameter on b of s, and the other way round.
  Ratio forward(const Ratio& s) const;
  Ratio backward(const Ratio& t) const;
  /// Range on b of [s0, s1], rounded outwards.
  void image(double s0, double s1, double& lo, double& hi) const;

 private:
  Ratio s_, t_;
  Dyadic p_, q_;
};

/// @param out  cleared by the caller
void intersect_exactly(const CurveCache& a, const CurveCache& b, CurveIntersections& out);

}  // namespace bezel::geometry_kernel
