#pragma once
// The scalar of a field that a picture shows, element by element.

#include <span>
#include <string>
#include <vector>

#include "bezel/field/field.hpp"

namespace bezel::view {

/// One component of a field, or its Euclidean norm (component -1), on one element at a time.
class ElementScalar {
 public:
  ElementScalar(const Field& field, int component);
  void move_to(ElementId e);
  /// Values at reference points whose physical places are x: all spans of one size.
  void evaluate(std::span<const Lambda> lambda, std::span<const Vec2> x, std::span<double> out);

 private:
  const Field& field_;
  int component_;
  ElementId element_;
  int degree_ = 0;
  std::vector<std::vector<double>> coefficients_;  // per component used
  std::vector<double> u_, v_, value_;
};

/// Range of the scalar: certified for a component (value_range); for the norm, from the values on a
/// lattice of 2 d + 4 intervals a side on every element.
bernstein::Range scalar_range(const Field& field, int component);
/// "u", "u[1]" or "|u|".
std::string scalar_name(const Field& field, int component);

}  // namespace bezel::view
