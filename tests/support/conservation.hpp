#pragma once
// What a transfer must keep on elements of any shape: constants, and mass to the last digits.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/exact_integrals.hpp"

namespace bezel::test {

/// A constant, and a polynomial on each element at random.
inline Field constant_and_noise(const std::shared_ptr<const Space>& space) {
  std::vector<double> c(space->coefficient_count() * 2);
  RandomStream random("constant and noise", 1);
  for (std::size_t i = 0; i < c.size(); i += 2) {
    c[i] = 3.25;
    c[i + 1] = random.uniform(-1.0, 2.0);
  }
  return {"constant and noise", space, c, 2};
}

/// By how much the constant is off, relative to it.
inline double off_constant(const Field& f) {
  double worst = 0.0;
  for (std::size_t i = 0; i < f.coefficients().size(); i += 2)
    worst = std::max(worst, std::abs(f.coefficients()[i] / 3.25 - 1.0));
  return worst;
}

/// As the report has it, and from the coefficients alone where they say all.
inline double mass_defect(const Field& donor, const TransferResult& result) {
  double worst = 0.0;
  for (const FieldReport& line : result.report.fields) {
    worst = std::max(worst, line.relative_mass_defect);
    const Field& moved = result.fields[0];
    const bool curved = moved.mesh().degree() > 1 || donor.mesh().degree() > 1;
    const bool physical =
        moved.space().basis() == Basis::physical || donor.space().basis() == Basis::physical;
    if (curved && physical) continue;
    const auto k = static_cast<std::size_t>(line.component);
    const ExactMass before = exact_mass(donor, k), after = exact_mass(moved, k);
    const DoubleDouble defect = after.total - (before.total - DoubleDouble(line.mass_outside) +
                                               DoubleDouble(line.mass_made));
    worst = std::max(worst, std::abs(defect.hi) / before.size);
  }
  return worst;
}

}  // namespace bezel::test
