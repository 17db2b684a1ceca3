#include "bezel/transfer/weighted_continuous.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bezel/base/error.hpp"
#include "bezel/base/parallel.hpp"
#include "bezel/numeric/short_names.hpp"
#include "bezel/numeric/sum.hpp"
#include "bezel/transfer/element_mass.hpp"
#include "bezel/transfer/sweep.hpp"
#include "bezel/transfer/weight.hpp"

namespace bezel::detail {
namespace {

using short_names::at;

/// The product of the weights as one field, empty without any.
std::optional<Field> whole_weight(std::span<const Field* const> weights) {
  if (weights.empty()) return std::nullopt;
  if (weights.size() == 1) return *weights[0];
  const Field first = in_coordinates_of(weights[1]->space(), *weights[0]);
  const int degree = first.space().highest_degree() + weights[1]->space().highest_degree();
  if (degree > Space::max_degree) {
    throw InputError(
        fmt::format("transfer: weight times density has degree {} on the target, expected at most "
                    "{}",
                    degree, Space::max_degree));
  }
  return product(first, *weights[1], {}, Space::discontinuous(weights[1]->space().mesh(), degree));
}

/// Largest degree in the coordinates of the elements.
int reference_degree(const Field& f) {
  return f.space().highest_degree() *
         (f.space().basis() == Basis::physical ? f.mesh().degree() : 1);
}

}  // namespace

WeightedContinuous::WeightedContinuous(std::shared_ptr<const Space> space,
                                       std::span<const Field* const> weights, MassMethod method,
                                       const MassSystemMaker& make_system, int threads)
    : threads_(threads),
      weight_(whole_weight(weights)),
      mass_(std::move(space), {}, threads, method, weight_ ? &*weight_ : nullptr, make_system) {}

/// Coefficients c of each element with M_e c = integrals of (moved - mean carrier) phi, M_e its
/// weighted mass matrix; shape (coefficient_count, components).
std::vector<double> WeightedContinuous::element_solutions(const Field& moved, const Field* carrier,
                                                          std::span<const double> mean) const {
  const auto& space = mass_.space();
  const ElementMass masses(Space::discontinuous(space->mesh(), space->highest_degree()),
                           reference_degree(moved), weight_ ? reference_degree(*weight_) : 0);
  const std::size_t nc = mean.size(), elements = space->mesh()->element_count();
  std::vector<double> c(space->coefficient_count() * nc);
  const auto one_element = [&](ElementId e, ElementMass::Element& element) {
    masses.prepare(e, element);
    const std::size_t points = element.points.size();
    std::vector<double> value(points, 1.0);
    if (weight_) weight_->evaluate(e, element.points, value);
    ElementMass::weigh(value, element);
    std::vector<double> f(points * nc);
    moved.evaluate(e, element.points, f);
    if (carrier != nullptr) {
      carrier->evaluate(e, element.points, value);
      for (std::size_t q = 0; q < points; ++q)
        for (std::size_t i = 0; i < nc; ++i) f[q * nc + i] -= mean[i] * value[q];
    }
    const std::span<double> own(c.data() + space->offset(e) * nc, element.integrals.size() * nc);
    ElementMass::load(element, f, own);
    if (!ElementMass::solve(element, own)) {
      throw NumericsError(fmt::format(
          "target triangle {}: weight and transferred density are not positive there, so no field "
          "can be recovered",
          e.value));
    }
  };
  parallel_for((elements + chunk_size - 1) / chunk_size,
               [&](std::size_t chunk) {
                 ElementMass::Element element;
                 for (std::size_t e = chunk * chunk_size;
                      e < std::min(elements, (chunk + 1) * chunk_size); ++e)
                   one_element(ElementId(e), element);
               },
               threads_);
  return c;
}

WeightedContinuous::Recovered WeightedContinuous::operator()(const Field& moved,
                                                             const Field* carrier) {
  const std::size_t nc = at(moved.components());
  std::vector<double> mean(nc, 0.0);
  if (carrier != nullptr) {
    mean = integral(moved, threads_);
    const double base = integral(*carrier, threads_)[0];
    for (double& m : mean) m /= base;
  }
  Recovered found;
  found.coefficients = element_solutions(moved, carrier, mean);
  found.outcome = make_continuous(mass_, moved.components(), {}, found.coefficients);
  const std::vector<double>& integrals = mass_.integrals();
  std::vector<double> terms(integrals.size());
  for (std::size_t i = 0; i < nc; ++i) {
    for (std::size_t n = 0; n < terms.size(); ++n) {
      found.coefficients[n * nc + i] += mean[i];
      terms[n] = integrals[n] * found.coefficients[n * nc + i];
    }
    found.mass.push_back(sum(terms));
  }
  return found;
}

}  // namespace bezel::detail
