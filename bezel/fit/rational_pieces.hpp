#pragma once
// Rational Bezier pieces one after the other, evaluated with their derivatives.

#include <memory>
#include <span>
#include <vector>

#include "bezel/fit/smooth_curve.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::fit {

/// Piece k covers breaks[k] .. breaks[k+1] with degree + 1 control points in homogeneous
/// coordinates (w x, w); w = 1 throughout when not rational. Cheap to copy.
template <int dim>
class RationalPieces {
 public:
  static constexpr int max_degree = 60;

  RationalPieces(int degree, bool rational, std::vector<double> breaks,
                 std::vector<Vec<dim + 1>> control);
  CurveJet<dim> operator()(double u) const;
  std::span<const double> breaks() const { return data_->breaks; }

 private:
  struct Data {
    int degree;
    bool rational;
    std::vector<double> breaks;
    std::vector<Vec<dim + 1>> control;
  };
  CurveJet<dim> jet(std::size_t k, double u) const;
  template <int capacity>
  CurveJet<dim> jet(std::size_t k, double u) const;

  std::shared_ptr<const Data> data_;
};

extern template class RationalPieces<2>;
extern template class RationalPieces<3>;

}  // namespace bezel::fit
