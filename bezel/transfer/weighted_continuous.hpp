#pragma once
// Internal: the target's side of a weighted transfer to continuous fields.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bezel/transfer/continuous.hpp"

namespace bezel::detail {

/// Continuous fields from what the transfer of their products left, for one choice of weights.
class WeightedContinuous {
 public:
  /// @param space    continuous
  /// @param weights  factors of the weight, on the same mesh: none, one or two of one component
  /// @throws InputError when their product has too high a degree; NumericsError naming a triangle
  ///         where it is not positive
  WeightedContinuous(std::shared_ptr<const Space> space, std::span<const Field* const> weights,
                     MassMethod method, const MassSystemMaker& make_system, int threads);

  struct Recovered {
    std::vector<double> coefficients;
    std::vector<double> mass;  ///< per component, times the weights
    ContinuousOutcome outcome;
  };
  /// The field t with integral of w t phi equal to that of `moved` phi for all continuous phi:
  /// around a constant, so that a constant comes back constant.
  /// @param carrier  what the constant 1 gave in the transfer; null: solve for all of it
  Recovered operator()(const Field& moved, const Field* carrier);

 private:
  std::vector<double> element_solutions(const Field& moved, const Field* carrier,
                                        std::span<const double> mean) const;

  int threads_;
  std::optional<Field> weight_;
  ContinuousMass mass_;
};

}  // namespace bezel::detail
