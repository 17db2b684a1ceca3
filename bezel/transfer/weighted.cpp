#include "bezel/transfer/weighted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "bezel/base/parallel.hpp"
#include "bezel/numeric/short_names.hpp"
#include "bezel/numeric/sum.hpp"
#include "bezel/transfer/element_mass.hpp"
#include "bezel/transfer/layout.hpp"
#include "bezel/transfer/report.hpp"
#include "bezel/transfer/sweep.hpp"
#include "bezel/transfer/weight.hpp"
#include "bezel/transfer/weighted_continuous.hpp"

namespace bezel::detail {
namespace {

using short_names::at;

// Conservation element by element and in all, and constants: the product of a mapped field with the
// weight is split, element by element, into the field's mean times the weight, which is a
// polynomial in x and y and integrated exactly, and the rest. All mapped products have one degree,
// so that one rule integrates them: a field that is a constant times the density gives exactly the
// constant times what the density gives.

/// The donor's side: products to transfer, and what they stand for.
class Products {
 public:
  Products(std::span<const Field> donors, const TransferOptions& options);

  /// One field per donor, or two: its smooth part (means times weight) and the rest. Last, with a
  /// weight, the weight itself: what the constant 1 gives.
  std::vector<Field> fields;
  bool split = false;
  std::size_t density = none;  ///< index of the density among the donors
  int weight_degree = 0;       ///< in x and y, on donor and target

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  bool carried(std::size_t k) const { return density != none && k != density; }
  /// Integral of the absolute value of a donor's product with weight and density.
  std::vector<double> size(std::size_t k, int threads) const {
    return integral_abs(wholes_[k], threads);
  }

 private:
  std::vector<Field> wholes_;
};

void check_coordinates(std::span<const Field> donors) {
  const Space& first = donors.front().space();
  for (const Field& f : donors) {
    if (f.space().basis() != first.basis() ||
        !std::ranges::equal(f.space().frames(), first.frames()))
      throw InputError(
          fmt::format("transfer: field '{}' is written in other coordinates than field '{}', "
                      "expected one basis for all fields of a weighted transfer",
                      f.name(), donors.front().name()));
  }
}

std::size_t find_density(std::span<const Field> donors, const std::string& name) {
  if (name.empty()) return Products::none;
  for (std::size_t k = 0; k < donors.size(); ++k) {
    if (donors[k].name() != name) continue;
    if (donors[k].components() != 1)
      throw InputError(fmt::format("transfer: the density '{}' has {} components, expected 1", name,
                                   donors[k].components()));
    return k;
  }
  throw InputError(
      fmt::format("transfer: the density '{}' is none of the fields that are moved", name));
}

/// Means over the elements, shape (elements, components).
std::vector<double> means(const Field& f, std::span<const double> areas, int threads) {
  std::vector<double> mean = element_integrals(f, threads);
  const std::size_t nc = at(f.components());
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] /= areas[i / nc];
  return mean;
}

Products::Products(std::span<const Field> donors, const TransferOptions& options) {
  check_coordinates(donors);
  density = find_density(donors, options.density);
  const Space& space = donors.front().space();
  const auto& mesh = space.mesh();
  const Formula one("1");
  const Formula& w = options.weight ? *options.weight : one;
  weight_degree = detail::weight_degree(w, mesh, "donor", options.threads);
  const Field weight = weight_field(w, weight_degree, mesh, "donor", options.threads);
  const Field own = in_coordinates_of(space, weight);

  int highest = 0;
  for (std::size_t k = 0; k < donors.size(); ++k) {
    const int carried_degree = carried(k) ? donors[density].space().highest_degree() : 0;
    const int degree =
        own.space().uniform_degree() + carried_degree + donors[k].space().highest_degree();
    if (degree > Space::max_degree)
      throw InputError(fmt::format(
          "transfer: field '{}' times {} has degree {}, expected at most {}", donors[k].name(),
          carried(k) ? "weight and density" : "weight", degree, Space::max_degree));
    highest = std::max(highest, degree);
  }
  split = space.basis() == Basis::reference && mesh->degree() > 1;
  const auto made = [&](int degree) {
    if (space.basis() == Basis::reference) return Space::discontinuous(mesh, degree);
    return Space::discontinuous(mesh, std::vector<int>(mesh->element_count(), degree),
                                std::vector<Frame>(space.frames().begin(), space.frames().end()));
  };
  const auto common = made(highest);
  const std::vector<double> areas = element_integrals(
      Field("one", Space::discontinuous(mesh, 0), std::vector<double>(mesh->element_count(), 1.0)),
      options.threads);
  std::optional<Field> weighted_density;
  std::vector<double> density_mean;
  if (density != none) {
    const Field& rho = donors[density];
    weighted_density =
        product(own, rho, {}, made(own.space().uniform_degree() + rho.space().highest_degree()));
    density_mean = means(rho, areas, options.threads);
  }
  for (std::size_t k = 0; k < donors.size(); ++k) {
    const Field& f = donors[k];
    const Field& factor = carried(k) ? *weighted_density : own;
    wholes_.push_back(product(factor, f, {}, common));
    if (!split) {
      fields.push_back(wholes_.back());
      continue;
    }
    // Element by element: mean * weight, and weight * (f - mean) or weight * (rho f - mean).
    std::vector<double> mean = means(f, areas, options.threads);
    const std::size_t nc = at(f.components());
    if (carried(k)) {
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] *= density_mean[i / nc];
    }
    const std::size_t size = at(bernstein::triangle_size(weight_degree));
    std::vector<double> smooth(weight.space().coefficient_count() * nc);
    for (std::size_t i = 0; i < smooth.size(); ++i) {
      const std::size_t row = i / nc;
      smooth[i] = weight.coefficients()[row] * mean[row / size * nc + i % nc];
    }
    fields.emplace_back(f.name(), weight.space_ptr(), std::move(smooth), f.components());
    if (carried(k)) {
      const auto without =
          made(donors[density].space().highest_degree() + f.space().highest_degree());
      fields.push_back(product(own, product(donors[density], f, {}, without), mean, common));
    } else {
      fields.push_back(product(own, f, mean, common));
    }
  }
  if (!options.weight) return;
  // In the space of what it is compared with.
  if (split) {
    fields.push_back(weight);
  } else {
    const auto constant = made(0);
    fields.push_back(product(
        own, Field("one", constant, std::vector<double>(mesh->element_count(), 1.0)), {}, common));
  }
}

/// The target's side of one field.
struct Recovered {
  std::vector<double> coefficients;
  std::vector<double> mass;  // per component
  double max_mass_defect = 0;
};

/// Solves for t on every element: the integrals of w t phi are those of `moved` phi. Around the
/// element's weighted mean, so that a constant comes back constant.
/// @param weights  factors of w, on the target
/// @param carrier  what the constant 1 gave in the transfer; null: 1
/// @param partial  elements that are covered in part and must not be filled from the mean
Recovered recover(const Field& moved, const std::shared_ptr<const Space>& space,
                  const std::vector<const Field*>& weights, const Field* carrier,
                  const std::vector<char>& partial, int threads) {
  int weight_degree = 0;
  for (const Field* w : weights)
    weight_degree += w->space().highest_degree() *
                     (w->space().basis() == Basis::physical ? space->mesh()->degree() : 1);
  const ElementMass masses(space, moved.space().highest_degree(), weight_degree);
  const std::size_t nc = at(moved.components());
  const std::size_t elements = space->mesh()->element_count();
  Recovered out;
  out.coefficients.assign(space->coefficient_count() * nc, 0.0);
  std::vector<double> mass(elements * nc, 0.0);
  std::vector<double> defect(elements, 0.0);
  const auto one_element = [&](std::size_t e, ElementMass::Element& element) {
    const ElementId id(e);
    masses.prepare(id, element);
    const std::size_t points = element.points.size();
    const std::size_t n = element.basis.size() / points;
    std::vector<double> w(points, 1.0);
    std::vector<double> value(points);
    for (const Field* factor : weights) {
      factor->evaluate(id, element.points, value);
      for (std::size_t q = 0; q < points; ++q) w[q] *= value[q];
    }
    ElementMass::weigh(w, element);
    const double total = sum(element.integrals);
    if (std::ranges::all_of(w, [](double x) { return x == 0.0; })) return;  // no density: nothing
    std::vector<double> f(points * nc);
    moved.evaluate(id, element.points, f);
    if (carrier != nullptr) carrier->evaluate(id, element.points, w);
    std::vector<double> received(nc, 0.0);
    double base = 0.0;
    for (std::size_t q = 0; q < points; ++q) {
      base += element.measure[q] * w[q];
      for (std::size_t c = 0; c < nc; ++c) received[c] += element.measure[q] * f[q * nc + c];
    }
    std::vector<double> mean(nc, 0.0);
    if (partial[e] == 0) {
      for (std::size_t c = 0; c < nc; ++c) mean[c] = received[c] / base;
    }
    for (std::size_t q = 0; q < points; ++q) {
      for (std::size_t c = 0; c < nc; ++c) f[q * nc + c] -= mean[c] * w[q];
    }
    const std::span<double> result(out.coefficients.data() + space->offset(id) * nc, n * nc);
    ElementMass::load(element, f, result);
    if (!ElementMass::solve(element, result)) {
      throw NumericsError(fmt::format(
          "target triangle {}: weight and transferred density are not positive there, so no field "
          "can be recovered",
          e));
    }
    for (std::size_t c = 0; c < nc; ++c) {
      double missing = 0.0;
      for (int sweep = 0; sweep < 3; ++sweep) {
        double got = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
          if (sweep == 0) result[i * nc + c] += mean[c];
          got += result[i * nc + c] * element.integrals[i];
        }
        missing = received[c] - got;
        mass[e * nc + c] = got;
        if (sweep == 2) break;
        for (std::size_t i = 0; i < n; ++i) result[i * nc + c] += missing / total;
      }
      defect[e] = std::max(defect[e], std::abs(missing));
    }
  };
  parallel_for((elements + chunk_size - 1) / chunk_size,
               [&](std::size_t chunk) {
                 ElementMass::Element element;
                 for (std::size_t e = chunk * chunk_size;
                      e < std::min(elements, (chunk + 1) * chunk_size); ++e)
                   one_element(e, element);
               },
               threads);
  out.max_mass_defect = *std::ranges::max_element(defect);
  for (std::size_t c = 0; c < nc; ++c) {
    std::vector<double> column(elements);
    for (std::size_t e = 0; e < elements; ++e) column[e] = mass[e * nc + c];
    out.mass.push_back(sum(column));
  }
  return out;
}

/// Sum of fields on one space.
Field added(const Field& a, const Field& b) {
  std::vector<double> c(a.coefficients().begin(), a.coefficients().end());
  for (std::size_t i = 0; i < c.size(); ++i) c[i] += b.coefficients()[i];
  return Field(a.name(), a.space_ptr(), std::move(c), a.components());
}

}  // namespace

TransferResult transfer_weighted(const Crew& crew, std::span<const Field> donors,
                                 const std::shared_ptr<const TriangleMesh>& target,
                                 const TransferOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const bool continuous = options.continuity == Continuity::continuous;
  if (options.bounds.kind != Bounds::Kind::none || options.conserve != Conserve::covered ||
      options.keep_boundary) {
    throw InputError(
        "transfer: weights need a target without bounds or kept boundary values that conserves "
        "what is covered");
  }
  const Products products(donors, options);
  const auto degree_of = [&](std::size_t k) {
    return options.degree >= 0 ? options.degree : donors[k].space().highest_degree();
  };
  TransferOptions plain = options;
  plain.weight.reset();
  plain.density.clear();
  plain.same_basis = false;
  plain.continuity = Continuity::discontinuous;
  plain.mass_method = MassMethod::automatic;
  plain.basis = continuous           ? Basis::reference
                : options.same_basis ? donors.front().space().basis()
                                     : options.basis;
  plain.degree = 0;
  for (std::size_t k = 0; k < donors.size(); ++k)
    plain.degree = std::max(plain.degree, degree_of(k));
  std::optional<Field> weight;
  if (options.weight) {
    const int degree = std::max(products.weight_degree,
                                weight_degree(*options.weight, target, "target", options.threads));
    weight = weight_field(*options.weight, degree, target, "target", options.threads);
  }
  const TransferResult moved = transfer_by(crew, products.fields, target, plain, progress);

  TransferResult result;
  result.report = moved.report;
  std::vector<char> partial(target->element_count(), 0);
  if (options.uncovered == Uncovered::zero && products.density == Products::none) {
    for (const auto& [element, area] : moved.report.uncovered_elements)
      partial[element.index()] = 1;
  }
  const std::size_t parts = products.split ? 2 : 1;
  const auto moved_product = [&](std::size_t k) {
    return products.split ? added(moved.fields[2 * k], moved.fields[2 * k + 1]) : moved.fields[k];
  };
  std::vector<std::shared_ptr<const Space>> spaces(at(Space::max_degree) + 1);
  const auto space_of = [&](std::size_t k) {
    auto& space = spaces[at(degree_of(k))];
    if (!space) space = Space::discontinuous(target, degree_of(k), plain.basis);
    return space;
  };
  std::vector<const Field*> weights;
  if (weight) weights.push_back(&*weight);
  std::vector<std::optional<Field>> fields(donors.size());
  std::vector<Recovered> recovered(donors.size());
  std::vector<std::vector<MassSolve>> mass_solve(donors.size());
  // Masses with the present weights, by degree: the density's, then the others'.
  std::vector<std::unique_ptr<WeightedContinuous>> masses(spaces.size());
  std::vector<std::shared_ptr<const Space>> continuous_spaces(spaces.size());
  // Where the field counts as 0 in part, a constant is no solution; but it is for a field that is
  // carried, whose density counts as 0 there too.
  const bool whole =
      options.uncovered != Uncovered::zero || moved.report.uncovered_elements.empty();
  const auto solve_continuous = [&](std::size_t k, const Field* carrier) {
    const std::size_t p = at(degree_of(k));
    if (!continuous_spaces[p]) continuous_spaces[p] = Space::continuous(target, degree_of(k));
    if (!masses[p]) {
      masses[p] = std::make_unique<WeightedContinuous>(
          continuous_spaces[p], weights, options.mass_method, crew.mass_system, options.threads);
    }
    auto found = (*masses[p])(moved_product(k), whole || products.carried(k) ? carrier : nullptr);
    recovered[k].mass = std::move(found.mass);
    recovered[k].max_mass_defect = *std::ranges::max_element(found.outcome.max_element_change);
    mass_solve[k] = std::move(found.outcome.solve);
    fields[k].emplace(donors[k].name(), continuous_spaces[p], std::move(found.coefficients),
                      donors[k].components());
  };
  const auto solve = [&](std::size_t k, const Field* carrier) {
    if (continuous) return solve_continuous(k, carrier);
    recovered[k] =
        recover(moved_product(k), space_of(k), weights, carrier, partial, options.threads);
    fields[k].emplace(donors[k].name(), space_of(k), std::move(recovered[k].coefficients),
                      donors[k].components());
  };
  const Field* carrier = weight ? &moved.fields.back() : nullptr;
  std::optional<Field> carried_density;
  if (products.density != Products::none) {
    solve(products.density, carrier);
    carried_density = moved_product(products.density);
    carrier = &*carried_density;
    weights.push_back(&*fields[products.density]);
    std::ranges::fill(masses, nullptr);
  }
  for (std::size_t k = 0; k < donors.size(); ++k) {
    if (k != products.density) solve(k, carrier);
  }

  detail::Reports reports(donors.size(), options.threads);
  std::size_t line = 0;  // of the inner report
  for (std::size_t k = 0; k < donors.size(); ++k) {
    const std::vector<double> size = products.size(k, options.threads);
    for (std::size_t c = 0; c < size.size(); ++c) {
      FieldReport out;
      out.name = donors[k].name();
      out.component = static_cast<int>(c);
      for (std::size_t part = 0; part < parts; ++part) {
        const FieldReport& in = moved.report.fields[line + part * size.size() + c];
        out.mass_before += in.mass_before;
        out.mass_outside += in.mass_outside;
        out.mass_made += in.mass_made;
      }
      out.mass_after = recovered[k].mass[c];
      const double scale = size[c] > 0.0 ? size[c] : 1.0;
      out.relative_mass_defect =
          std::abs(out.mass_after - (out.mass_before - out.mass_outside + out.mass_made)) / scale;
      out.max_element_defect = recovered[k].max_mass_defect / scale;
      if (continuous) out.mass_solve = mass_solve[k][c];
      reports.add(k, donors[k], *fields[k], std::move(out));
    }
    line += parts * size.size();
  }
  result.report.fields = reports.finish();
  for (std::optional<Field>& field : fields) result.fields.push_back(std::move(*field));
  result.report.seconds.total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace bezel::detail
