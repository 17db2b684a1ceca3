#pragma once
// One fuzzed transfer: its fields against slow projections, the polynomials that it must keep, and
// itself done in other ways.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/transfer/operator.hpp"
#include "bezel/transfer/sweep.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/field_pairs.hpp"
#include "support/in_shares.hpp"
#include "support/slow_projection.hpp"

namespace bezel::test {

/// A polynomial in x and y about a place.
struct PlanePolynomial {
  int degree = 0;
  Vec2 centre;
  double size = 1;
  std::vector<double> c;  ///< of the powers (x - centre)^j (y - centre)^k / size^(j + k)
  Real operator()(RealPoint x) const {
    const Real s = (x.x - Real(centre[0])) / Real(size), t = (x.y - Real(centre[1])) / Real(size);
    Real sum = 0;
    std::size_t n = 0;
    for (int k = 0; k <= degree; ++k)
      for (int j = 0; j + k <= degree; ++j, ++n)
        sum += Real(c[n]) * std::pow(s, Real(j)) * std::pow(t, Real(k));
    return sum;
  }
};

/// What a donor field is.
enum class Content { constant, polynomial, jumps };

struct FieldCase {
  MeshPair meshes;
  std::vector<Field> donors;
  std::vector<Content> contents;
  std::vector<PlanePolynomial> polynomials;  ///< [field] of every component
  TransferOptions options;
};

/// The coefficients of a polynomial of at most that degree on a triangle given by a frame or, in
/// the reference basis of a straight element, by its corners.
inline std::vector<double> coefficients_of(const PlanePolynomial& f, const Space& space,
                                           ElementId e) {
  const int p = space.degree(e);
  const auto b = space.mesh()->gather(e);
  const std::array<Vec2, 3> corner =
      space.basis() == Basis::physical ? space.frame(e).corners() : std::array{b[0], b[1], b[2]};
  std::vector<double> values;
  for (int k = 0; k <= p; ++k) {
    for (int j = 0; j + k <= p; ++j) {
      const Real u = p == 0 ? Real(1) / 3 : Real(j) / p, v = p == 0 ? Real(1) / 3 : Real(k) / p;
      values.push_back(static_cast<double>(
          f((1 - u - v) * real(corner[0]) + u * real(corner[1]) + v * real(corner[2]))));
    }
  }
  return bernstein::from_lagrange<double>(p, values);
}

/// Fields on the donor of a pair of meshes, and what is asked for.
inline FieldCase field_case(std::uint64_t seed, MeshPair meshes) {
  RandomStream random("field cases", seed);
  FieldCase out;
  out.meshes = std::move(meshes);
  const MeshPtr &donor = out.meshes.donor, &target = out.meshes.target;
  const int g = donor->degree(), h = target->degree();
  // Most cases go the shortest way, at least on some elements: one degree up to 3, no maps.
  const bool ordinary = random.below(4) > 0;
  // Degree 3 most often: powers of the places are the largest there.
  const int degree = ordinary ? std::array{0, 1, 2, 2, 3, 3, 3, 3}[random.below(8)]
                              : static_cast<int>(random.below(7));
  const auto basis = [&] { return (random.below(2) == 0 ? Basis::reference : Basis::physical); };
  out.options.threads = 1;
  out.options.uncovered = random.below(3) == 0 ? Uncovered::zero : Uncovered::extend;
  out.options.same_basis = random.below(2) == 0;
  out.options.basis = ordinary ? Basis::physical : basis();
  if (!ordinary && random.below(2) == 0) out.options.degree = static_cast<int>(random.below(7));
  const std::size_t fields = 1 + random.below(4);
  Box2 box = target->box(ElementId(0));
  for (std::size_t e = 1; e < target->element_count(); ++e) {
    box.include(target->box(ElementId(e)).lo);
    box.include(target->box(ElementId(e)).hi);
  }
  for (std::size_t i = 0; i < fields; ++i) {
    const Basis own = ordinary && (g > 1 || h > 1) ? Basis::physical : basis();
    std::shared_ptr<const Space> space;
    const int p = ordinary && random.below(20) != 0 ? degree : static_cast<int>(random.below(7));
    if (!ordinary && random.below(4) == 0) {
      std::vector<int> degrees;
      const int range = 1 + static_cast<int>(random.below(4));
      for (std::size_t e = 0; e < donor->element_count(); ++e)
        degrees.push_back(
            std::min(6, p + static_cast<int>(random.below(static_cast<std::uint64_t>(range)))));
      space = Space::discontinuous(donor, degrees, own);
    } else {
      space = Space::discontinuous(donor, p, own);
    }
    const bool mapped = own == Basis::reference && g > 1;
    const int components = 1 + static_cast<int>(random.below(3));
    Content content = std::array{Content::constant, Content::polynomial, Content::jumps,
                                 Content::jumps}[random.below(4)];
    if (mapped && content == Content::polynomial) content = Content::jumps;
    PlanePolynomial f{0, box.centre(), 0.5 * box.diameter(), {}};
    if (content == Content::constant) f.c = {random.uniform(-3, 3)};
    if (content == Content::polynomial) {
      f.degree = out.options.degree >= 0 ? out.options.degree : 6;
      for (std::size_t e = 0; e < donor->element_count(); ++e)
        f.degree = std::min(f.degree, space->degree(ElementId(e)));
      for (int n = 0; n < bernstein::triangle_size(f.degree); ++n)
        f.c.push_back(random.uniform(-1, 1));
    }
    std::vector<double> c;
    for (std::size_t e = 0; e < donor->element_count(); ++e) {
      const auto size =
          static_cast<std::size_t>(bernstein::triangle_size(space->degree(ElementId(e))));
      std::vector<double> here(size, f.c.empty() ? 0.0 : f.c[0]);
      if (content == Content::polynomial) here = coefficients_of(f, *space, ElementId(e));
      for (std::size_t n = 0; n < size; ++n)
        for (int k = 0; k < components; ++k)
          c.push_back(content == Content::jumps ? random.uniform(-1, 1) : here[n] * (k + 1));
    }
    out.donors.emplace_back("field " + std::to_string(i), space, std::move(c), components);
    out.contents.push_back(content);
    out.polynomials.push_back(std::move(f));
  }
  return out;
}

inline FieldCase field_case(std::uint64_t seed) {
  return field_case(seed, field_pair(seed));
}

struct FieldVerdict {
  std::string kind;
  bool refused = false;  ///< the transfer said itself that it could not do it
  std::string refusal;
  int compared = 0, undecided = 0;           ///< target elements; without a slow projection
  double worst = 0;                          ///< largest difference / allowed
  double worst_exact = 0, worst_mapped = 0;  ///< largest difference / (magnification * scale)
  std::string complaint;                     ///< what is wrong, empty when nothing
};

/// How much the rounding of the sums may be magnified: the transfer's own limit for powers of
/// barycentrics is 256, a handful of operations each.
inline constexpr double rounding_allowed = 1024 * 0x1p-53;
/// Where a polynomial is mapped, integrals are by interpolation to a thousandth of what it changes
/// over a pair, or by quadrature.
inline constexpr double mapped_allowed = 2e-3;

/// Judges one transfer.
class FieldJudge {
 public:
  /// @param pairs  of elements that are projected slowly, about, for each field; a tenth of it
  ///               where one is mapped
  explicit FieldJudge(std::uint64_t seed, int pairs = 600)
      : case_(field_case(seed)), random_("field judge", seed), pairs_(pairs) {}

  FieldVerdict judge() {
    FieldVerdict verdict;
    verdict.kind = case_.meshes.kind;
    std::optional<TransferResult> result;
    try {
      result.emplace(transfer(case_.donors, case_.meshes.target, case_.options));
    } catch (const NumericsError& e) {
      verdict.refused = true;
      verdict.refusal = e.what();
      return verdict;
    }
    complaint_.precision(17);
    find_neighbours();
    for (std::size_t i = 0; i < case_.donors.size(); ++i) {
      if (case_.contents[i] != Content::jumps) expect_polynomial(i, *result, verdict);
    }
    expect_projections(*result, verdict);
    expect_same_otherwise(*result);
    verdict.complaint = complaint_.str();
    return verdict;
  }

 private:
  const TriangleMesh& donor() const { return *case_.meshes.donor; }
  const TriangleMesh& target() const { return *case_.meshes.target; }
  std::ostream* complain() {
    if (complaint_.tellp() > 600) return nullptr;
    return &complaint_;
  }

  void find_neighbours() {
    near_.resize(target().element_count());
    double coordinate = 0.0;
    std::vector<double> width;
    const auto width_of = [&](const TriangleMesh& mesh, ElementId e) {
      return area(mesh.degree(), mesh.gather(e)) / mesh.box(e).diameter();
    };
    for (const Vec2& p : donor().control())
      coordinate = std::max({coordinate, std::abs(p[0]), std::abs(p[1])});
    for (std::size_t d = 0; d < donor().element_count(); ++d)
      width.push_back(width_of(donor(), ElementId(d)));
    for (std::size_t t = 0; t < near_.size(); ++t) {
      Near& near = near_[t];
      const Box2 box = target().box(ElementId(t));
      double thinnest = width_of(target(), ElementId(t));
      const double own = thinnest;
      for (std::size_t d = 0; d < donor().element_count(); ++d) {
        if (!box.overlaps(donor().box(ElementId(d)))) continue;
        near.donors.push_back(static_cast<std::int32_t>(d));
        thinnest = std::min(thinnest, width[d]);
      }
      // Coordinates are rounded, and edges nearer to each other than this count as one: the values
      // of steep polynomials change by the first, regions by the second.
      const double rounded = 32 * 0x1p-53 * coordinate;
      near.slope = rounded / thinnest;
      near.moved = std::max(rounded, 1e-13 * box.diameter()) *
                   static_cast<double>(4 + near.donors.size()) / own;
    }
  }

  /// The largest coefficient near a target element.
  double scale(const Field& f, std::size_t t) const {
    double largest = 0.0;
    for (const std::int32_t d : near_[t].donors)
      for (const double c : f.coefficients(ElementId(static_cast<std::size_t>(d))))
        largest = std::max(largest, std::abs(c));
    return largest;
  }

  const SlowSystem& system(const Space& space, std::size_t t) {
    auto& known = systems_[{&space, t}];
    if (!known) known = std::make_unique<SlowSystem>(space, ElementId(t));
    return *known;
  }

  /// Rounding everywhere, and regions moved by a little, where the field may jump by twice its
  /// largest coefficient.
  double allowed(const Field& from, const Field& to, std::size_t t) {
    return rounded(from, to, t) + system(to.space(), t).local_magnification * 2.0 * near_[t].moved;
  }
  double rounded(const Field& from, const Field& to, std::size_t t) {
    const double p = std::max(from.space().highest_degree(), to.space().highest_degree());
    return system(to.space(), t).magnification * (rounding_allowed + p * near_[t].slope);
  }

  static bool mapped(const Field& f) {
    return f.space().basis() == Basis::reference && f.mesh().degree() > 1;
  }

  /// Constants, and polynomials where neither basis is mapped.
  void expect_polynomial(std::size_t i, const TransferResult& result, FieldVerdict& verdict) {
    const Field &from = case_.donors[i], &to = result.fields[i];
    const bool constant = case_.contents[i] == Content::constant;
    if (!constant && (mapped(from) || mapped(to))) return;
    std::vector<double> uncovered(target().element_count(), 0.0);
    for (const auto& [e, area] : result.report.uncovered_elements) uncovered[e.index()] = area;
    // A mass that areas are off by is off by as much, and reported.
    const double residual = 2.0 * result.report.max_partition_residual;
    std::vector<double> value(static_cast<std::size_t>(to.components()));
    for (std::size_t t = 0; t < target().element_count(); ++t) {
      double growth = 1.0;
      if (uncovered[t] > 0.0) {
        if (case_.options.uncovered == Uncovered::zero) continue;
        if (!constant && result.report.extension_held_area > 0.0) continue;
        growth = std::max(1.0, result.report.extension_growth);
      }
      if (near_[t].donors.empty()) continue;
      double largest = scale(from, t);
      if (growth > 1.0)
        for (const double c : from.coefficients()) largest = std::max(largest, std::abs(c));
      const double bound =
          constant ? largest * ((to.space().highest_degree() < 6 ? 1e-13 : 1e-12) + residual)
                   : largest * growth * rounded(from, to, t);
      double worst = 0.0;
      for (int k = 0; k <= 3; ++k) {
        for (int j = 0; j + k <= 3; ++j) {
          const double u = j / 3.0, v = k / 3.0;
          to.evaluate(ElementId(t), {1.0 - u - v, u, v}, value);
          const RealPoint x = real(bernstein::evaluate<Vec2>(
              target().degree(), target().gather(ElementId(t)), {1.0 - u - v, u, v}));
          const Real exact = case_.polynomials[i](x);
          for (std::size_t c = 0; c < value.size(); ++c)
            worst = std::max(
                worst,
                static_cast<double>(std::abs(Real(value[c]) - exact * static_cast<Real>(c + 1))));
        }
      }
      verdict.worst = std::max(verdict.worst, worst / bound);
      if (!(worst <= bound)) {
        if (std::ostream* out = complain())
          *out << from.name() << (constant ? ", constant" : ", polynomial") << " at target " << t
               << ": off by " << worst << ", allowed " << bound << "; ";
      }
    }
  }

  /// Some elements against the slow projection.
  void expect_projections(const TransferResult& result, FieldVerdict& verdict) {
    for (std::size_t i = 0; i < case_.donors.size(); ++i) {
      const Field &from = case_.donors[i], &to = result.fields[i];
      const bool exact = !mapped(from) && !mapped(to);
      int pairs_left = exact ? pairs_ : pairs_ / 10;
      const std::size_t count = target().element_count();
      const std::size_t first = random_.below(count);
      // Neighbours in the mesh are mostly neighbours in the order of the work.
      for (std::size_t step = 0; step < count && pairs_left > 0; ++step) {
        const std::size_t t = (first + step) % count;
        pairs_left -= static_cast<int>(near_[t].donors.size());
        expect_projection(i, t, from, to, exact, verdict);
      }
    }
  }

  void expect_projection(std::size_t i, std::size_t t, const Field& from, const Field& to,
                         bool exact, FieldVerdict& verdict) {
    const SlowSystem& slow = system(to.space(), t);
    const auto nc = static_cast<std::size_t>(from.components());
    std::array<std::vector<Real>, 2> sums;
    Real covered = 0;
    for (auto& s : sums) s.assign(slow.size * nc, 0);
    SlowPair pair;
    for (const std::int32_t d : near_[t].donors) {
      const ElementId id(static_cast<std::size_t>(d));
      const std::vector<SlowRegion>* regions = regions_of(t, d);
      bool found = regions != nullptr;
      for (std::size_t k = 0; k < (exact ? 1U : 2U) && found; ++k) {
        found = slow_pair(*regions, to.space(), ElementId(t), from, id, k == 0 ? 6 : 12, pair);
        for (std::size_t n = 0; n < pair.integrals.size() && found; ++n)
          sums[k][n] += pair.integrals[n];
      }
      if (!found) {
        ++verdict.undecided;
        return;
      }
      covered += pair.area;
    }
    // What is continued beyond the donors is not projected here.
    const Real gap = slow.area - covered;
    const double largest = scale(from, t);
    if (gap > 1e-9L * slow.area && case_.options.uncovered == Uncovered::extend) return;
    const double unit = slow.magnification * largest;
    double bound = largest * allowed(from, to, t) + unit * (exact ? 0.0 : mapped_allowed) +
                   largest * slow.local_magnification *
                       std::max(0.0, static_cast<double>(std::min(gap / slow.area, Real(1e-9))));
    double worst = 0.0, own_error = 0.0;
    for (std::size_t c = 0; c < nc; ++c) {
      std::array<std::vector<Real>, 2> result;
      for (std::size_t k = 0; k < (exact ? 1U : 2U); ++k) {
        for (std::size_t n = 0; n < slow.size; ++n) result[k].push_back(sums[k][n * nc + c]);
        slow.solve(result[k]);
      }
      for (std::size_t n = 0; n < slow.size; ++n) {
        const Real best = exact ? result[0][n] : result[1][n];
        const double is = to.coefficients(ElementId(t))[n * nc + c];
        worst = std::max(worst, static_cast<double>(std::abs(Real(is) - best)));
        own_error = std::max(own_error, static_cast<double>(std::abs(result[0][n] - best)));
      }
    }
    if (own_error > 0.3 * bound) {
      ++verdict.undecided;
      return;
    }
    ++verdict.compared;
    verdict.worst = std::max(verdict.worst, worst / bound);
    double& figure = exact ? verdict.worst_exact : verdict.worst_mapped;
    figure = std::max(figure, worst / unit);
    if (!(worst <= bound)) {
      if (std::ostream* out = complain())
        *out << case_.donors[i].name() << " at target " << t << ": coefficient off by " << worst
             << ", allowed " << bound << " (" << near_[t].donors.size() << " donors near); ";
    }
  }

  const std::vector<SlowRegion>* regions_of(std::size_t t, std::int32_t d) {
    const auto [at, fresh] = regions_.try_emplace({t, d});
    if (fresh) {
      at->second.decided =
          common_regions(kernel_, target(), ElementId(t), donor(),
                         ElementId(static_cast<std::size_t>(d)), at->second.regions);
    }
    return at->second.decided ? &at->second.regions : nullptr;
  }

  /// Threads, the order of the elements, shares: the same bits.
  void expect_same_otherwise(const TransferResult& result) {
    const auto same = [&](const TransferResult& other, const std::string& how) {
      for (std::size_t i = 0; i < result.fields.size(); ++i) {
        if (std::ranges::equal(result.fields[i].coefficients(), other.fields[i].coefficients()))
          continue;
        if (std::ostream* out = complain())
          *out << case_.donors[i].name() << " has other bits " << how << "; ";
      }
    };
    TransferOptions threads = case_.options;
    threads.threads = 3;
    same(transfer(case_.donors, case_.meshes.target, threads), "with three threads");
    const auto shares = static_cast<std::size_t>(2 + random_.below(4));
    same(detail::transfer_by({in_shares(shares)}, case_.donors, case_.meshes.target, case_.options,
                             {}),
         "in shares");
    const std::uint64_t shuffle = random_.next();
    const detail::Sweeper shuffled = [&](const detail::OverlayMesh& d, const detail::OverlayMesh& t,
                                         const detail::FrontSearch& search,
                                         std::span<detail::Group> groups,
                                         const TransferOptions& options, const Progress& progress,
                                         const detail::VisitBlocks& visit) {
      std::vector<std::int32_t> order(t.element_count());
      std::iota(order.begin(), order.end(), 0);
      RandomStream random("shuffled", shuffle);
      for (std::size_t k = order.size(); k > 1; --k)
        std::swap(order[k - 1], order[random.below(k)]);
      return detail::sweep_elements(d, t, search, groups, order, options, progress, visit);
    };
    same(detail::transfer_by({shuffled}, case_.donors, case_.meshes.target, case_.options, {}),
         "in another order");
    const std::size_t i = random_.below(case_.donors.size());
    const TransferOperator op(case_.donors[i].space_ptr(), case_.meshes.target, options_of(i));
    near_enough(i, result.fields[i], op.apply(case_.donors[i], 1), "by the operator");
    const TransferResult alone =
        transfer({&case_.donors[i], 1}, case_.meshes.target, case_.options);
    near_enough(i, result.fields[i], alone.fields[0], "without the other fields");
    one_by_one(i, result);
  }

  TransferOptions options_of(std::size_t) const { return case_.options; }

  /// Equal up to rounding.
  void near_enough(std::size_t i, const Field& is, const Field& other, const std::string& how) {
    for (std::size_t t = 0; t < target().element_count(); ++t) {
      const auto a = is.coefficients(ElementId(t));
      compare_element(i, t, is, a, other.coefficients(ElementId(t)), how);
    }
  }
  void compare_element(std::size_t i, std::size_t t, const Field& to, std::span<const double> a,
                       std::span<const double> b, const std::string& how) {
    double worst = 0.0, largest = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) {
      worst = std::max(worst, std::abs(a[n] - b[n]));
      largest = std::max(largest, std::abs(a[n]));
    }
    const double bound = std::max(scale(case_.donors[i], t), largest) *
                         allowed(case_.donors[i], to, t) * (near_[t].donors.empty() ? 1e6 : 1.0);
    if (worst <= bound) return;
    if (std::ostream* out = complain())
      *out << case_.donors[i].name() << " at target " << t << " differs by " << worst << ' ' << how
           << ", allowed " << bound << "; ";
  }

  /// Target elements as meshes of their own: nothing comes before or after them.
  void one_by_one(std::size_t i, const TransferResult& result) {
    for (int tries = 0; tries < 4; ++tries) {
      const std::size_t t = random_.below(target().element_count());
      if (near_[t].donors.empty()) continue;
      std::vector<NodeId> nodes;
      const auto own = target().nodes(ElementId(t));
      nodes.assign(own.begin(), own.end());
      const auto mesh = std::make_shared<const TriangleMesh>(
          target().degree(),
          std::vector<Vec2>(target().control().begin(), target().control().end()),
          std::move(nodes));
      const TransferResult alone = transfer(case_.donors, mesh, case_.options);
      compare_element(i, t, result.fields[i], result.fields[i].coefficients(ElementId(t)),
                      alone.fields[i].coefficients(ElementId(0)), "from the element alone");
    }
  }

  struct Near {
    std::vector<std::int32_t> donors;  // whose boxes meet the element's
    double slope = 0, moved = 0;
  };
  struct Regions {
    bool decided = false;
    std::vector<SlowRegion> regions;
  };
  FieldCase case_;
  RandomStream random_;
  int pairs_;
  std::vector<Near> near_;
  std::map<std::pair<const Space*, std::size_t>, std::unique_ptr<SlowSystem>> systems_;
  std::map<std::pair<std::size_t, std::int32_t>, Regions> regions_;
  TriangleIntersector kernel_;
  std::ostringstream complaint_;
};

}  // namespace bezel::test
