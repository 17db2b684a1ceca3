#pragma once
// A regular curve given by a function, with its first two derivatives.

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// Point, first and second derivative of a curve at one parameter.
template <int dim>
struct CurveJet {
  Vec<dim> x, d1, d2;
};

/// A regular curve g on [-1, 1] in the plane (dim 2) or in space (dim 3). Immutable, cheap to copy,
/// and as safe to use from several threads as its function is.
template <int dim>
class SmoothCurve {
 public:
  using Function = std::function<CurveJet<dim>(double)>;

  /// Takes a curve, looks at a sample of it, and measures its length.
  ///
  /// @param function     t in [-1, 1] -> point and derivatives with respect to t; must return the
  ///                     same bits for the same t. It is also called at t = -1 and 1
  /// @param breakpoints  strictly ascending, in (-1, 1): where the curve is less smooth than the
  ///                     interpolation degree asks for (a jump of curvature, a corner)
  /// @throws   InputError when the function is empty, breakpoints are out of order or range, and
  ///           for a value that is not finite or a speed of zero at one of 65 points per smooth
  ///           part (the message says at which t; zero: below 1e-12 of the largest speed seen)
  /// @cost     some hundred evaluations of the function
  /// @limits   between the sampled points the speed is not looked at. At the very ends of [-1, 1] a
  ///           speed of zero is an error too
  explicit SmoothCurve(Function function, std::vector<double> breakpoints = {});

  CurveJet<dim> operator()(double t) const { return state_->function(t); }
  std::span<const double> breakpoints() const { return state_->breakpoints; }

  /// Arc length, by Gauss rules on halved panels that end at the breakpoints.
  ///
  /// @accuracy estimated, not proven: 1e-14 of the length where 2000 panels suffice
  double length() const { return state_->panels.back().length_before; }
  /// Arc length from t = -1. @param t in [-1, 1] @accuracy as length() @cost 16 evaluations
  double length_to(double t) const;
  /// The parameter where the arc length from t = -1 is s.
  ///
  /// @param s in [0, length()]; clamped to it
  double at_length(double s) const;

  /// Points looked at by the constructor, 65 per smooth part, ascending from t = -1 to 1.
  struct Sample {
    double t;
    Vec<dim> x;
  };
  std::span<const Sample> samples() const { return state_->samples; }

  /// The part between two parameters as a curve on [-1, 1] again, with the breakpoints inside it.
  /// At an end that is a breakpoint the derivatives are those of the part's side.
  ///
  /// @throws InputError unless -1 <= t0 < t1 <= 1; as the constructor
  SmoothCurve piece(double t0, double t1) const;

 private:
  struct Panel {
    double t, length_before;
  };
  struct State {
    Function function;
    std::vector<double> breakpoints;
    std::vector<Sample> samples;
    std::vector<Panel> panels;  // ends of panels, ascending; the last one is {1, length}
  };
  std::shared_ptr<const State> state_;
};

using PlaneCurve = SmoothCurve<2>;
using SpaceCurve = SmoothCurve<3>;

extern template class SmoothCurve<2>;
extern template class SmoothCurve<3>;

}  // namespace bezel
