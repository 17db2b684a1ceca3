#pragma once
// One fuzzed transfer: what each target element gets from an engine that works on all of them, in
// several orders and in shares, against what it gets from one that has seen no other element, bit
// for bit.

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/transfer/operator_by.hpp"
#include "bezel/transfer/sweep.hpp"
#include "property/transfer/fuzz_fields.hpp"

namespace bezel::test {

/// A pair of field_pair(); of some the target is the donor with one half of it moved, so that only
/// some elements have edges in common, and some pairs are made 1 to 1e4 times smaller in one
/// direction, so that some elements, or all, are worked on where they are round.
inline MeshPair alone_pair(std::uint64_t seed) {
  RandomStream random("alone pairs", seed);
  MeshPair pair = field_pair(seed);
  if (random.below(4) == 0) {
    const Vec2 centre = pair.donor->box(ElementId(0)).centre();
    for (double by = 0.3;; by *= 0.5) {
      pair.target = with_control(pair.donor, [&](const Vec2& p, std::size_t) {
        const double x = std::max(0.0, p[0] - centre[0]);
        return p + by * Vec2{{x * (p[1] - centre[1]), x}};
      });
      if (all_valid(*pair.target)) break;
    }
    pair.kind += ", one half moved";
  }
  if (random.below(2) == 0) return pair;
  const double factor = std::pow(10.0, -4.0 * random.uniform());
  const double angle = random.below(3) == 0 ? 0.0 : random.uniform(0, 6.28);
  const Vec2 along{{std::cos(angle), std::sin(angle)}}, across{{-along[1], along[0]}};
  const auto flat = [&](const MeshPtr& mesh) {
    return with_control(mesh, [&](const Vec2& p, std::size_t) {
      return dot(along, p) * along + factor * dot(across, p) * across;
    });
  };
  MeshPair out{pair.kind + ", flattened", flat(pair.donor), flat(pair.target)};
  return all_valid(*out.donor) && all_valid(*out.target) ? out : pair;
}

/// All that one target element got and left behind.
struct ElementTrace {
  std::vector<double> coefficients;  ///< of all groups
  std::vector<std::int32_t> donors;
  std::vector<double> areas, masses;    ///< given by donors; masses of those that are kept
  std::vector<double> made, uncovered;  ///< when there are any
  detail::ElementBlocks blocks;         ///< of an operator
  friend bool operator==(const ElementTrace& a, const ElementTrace& b) {
    return a.coefficients == b.coefficients && a.donors == b.donors && a.areas == b.areas &&
           a.masses == b.masses && a.made == b.made && a.uncovered == b.uncovered &&
           a.blocks.donor == b.blocks.donor && a.blocks.mass == b.blocks.mass &&
           a.blocks.value == b.blocks.value && a.blocks.made_donor == b.blocks.made_donor &&
           a.blocks.made == b.blocks.made && a.blocks.area == b.blocks.area;
  }
  /// What two traces do not agree in.
  static std::string difference(const ElementTrace& a, const ElementTrace& b) {
    if (a.coefficients != b.coefficients) return "coefficients";
    if (a.donors != b.donors) return "donors";
    if (a.areas != b.areas) return "areas";
    if (a.masses != b.masses) return "masses given";
    if (a.made != b.made) return "masses made";
    if (a.uncovered != b.uncovered) return "the area uncovered";
    return "an operator's blocks";
  }
};

/// The worst of all elements and the sums of counts: they depend on no order.
struct SweepTotals {
  double partition_residual = 0, joint_gap = 0, mass_defect = 0, growth = 0;
  std::int64_t inconsistent = 0, pairs = 0, crossings = 0, tangencies = 0, overlaps = 0;
  friend bool operator==(const SweepTotals&, const SweepTotals&) = default;
  void add(const detail::ChunkResult& r) {
    partition_residual = std::max(partition_residual, r.max_partition_residual);
    joint_gap = std::max(joint_gap, r.max_joint_gap);
    mass_defect = std::max(mass_defect, r.max_mass_defect);
    growth = std::max(growth, r.extension.max_growth);
    inconsistent += r.inconsistent_count;
    pairs += r.counts.pairs;
    crossings += r.counts.crossings;
    tangencies += r.counts.tangencies;
    overlaps += r.counts.overlaps;
  }
};

struct AloneVerdict {
  std::string kind;
  bool refused = false;  ///< a mass matrix is singular
  std::size_t elements = 0;
  std::string complaint;  ///< what is wrong, empty when nothing
};

/// Judges one transfer and one operator.
class AloneJudge {
 public:
  /// @param alone   elements worked on by an engine each, about, chosen at random; 0: all
  /// @param orders  random ones in which all are worked on, besides the usual one
  explicit AloneJudge(std::uint64_t seed, std::size_t alone = 0, int orders = 3)
      : case_(field_case(seed, alone_pair(seed))),
        random_("elements alone", seed),
        alone_(alone),
        orders_(orders) {}

  AloneVerdict judge() {
    verdict_.kind = case_.meshes.kind;
    const detail::Sweeper judged =
        [this](const detail::OverlayMesh& d, const detail::OverlayMesh& t,
               const detail::FrontSearch& search, std::span<detail::Group> groups,
               const TransferOptions& options, const Progress&, const detail::VisitBlocks& visit) {
          const Sweep all{d, t, search, groups, options, static_cast<bool>(visit)};
          const Swept whole = judge_sweep(all);
          auto chunks = in_shares(3)(d, t, search, groups, options, {}, visit);
          if (!visit) compare_coefficients(whole, all);
          return chunks;
        };
    try {
      detail::transfer_by({judged}, case_.donors, case_.meshes.target, case_.options, {});
      const Field& some = case_.donors[random_.below(case_.donors.size())];
      detail::OperatorBy::make(judged, some.space_ptr(), case_.meshes.target, case_.options, {});
    } catch (const NumericsError&) {
      verdict_.refused = true;
    }
    verdict_.complaint = complaint_.str();
    return verdict_;
  }

 private:
  struct Sweep {
    const detail::OverlayMesh& donor;
    const detail::OverlayMesh& target;
    const detail::FrontSearch& search;
    std::span<detail::Group> groups;
    const TransferOptions& options;
    bool blocks;
  };
  struct Swept {
    std::map<std::int32_t, ElementTrace> elements;
    SweepTotals totals;
  };

  /// By one engine.
  static void sweep(const Sweep& s, std::span<const std::int32_t> elements, Swept& out) {
    TransferOptions options = s.options;
    options.threads = 1;
    options.conserve = Conserve::total;  // what was made is kept by element
    detail::VisitBlocks visit;
    if (s.blocks) {
      visit = [&](std::size_t, std::int32_t t, const detail::ElementBlocks& blocks) {
        out.elements[t].blocks = blocks;
      };
    }
    for (const detail::ChunkResult& chunk : detail::sweep_elements(
             s.donor, s.target, s.search, s.groups, elements, options, {}, visit)) {
      out.totals.add(chunk);
      const detail::GivenList& given = chunk.given;
      const std::size_t components = detail::component_count(s.groups);
      for (std::size_t i = 0; i < given.donor.size(); ++i) {
        ElementTrace& trace = out.elements[given.target[i]];
        trace.donors.push_back(given.donor[i]);
        trace.areas.push_back(given.area[i]);
      }
      for (std::size_t row = 0; row < given.massed.size(); ++row) {
        const auto entry = static_cast<std::size_t>(given.massed[row]);
        append(std::span(given.mass).subspan(row * components, components),
               out.elements[given.target[entry]].masses);
      }
      const detail::ElementMasses& made = chunk.element_made;
      for (std::size_t i = 0; i < made.element.size(); ++i)
        append(std::span(made.mass).subspan(i * components, components),
               out.elements[made.element[i]].made);
      for (const auto& [t, area] : chunk.uncovered) out.elements[t.value].uncovered.push_back(area);
    }
    if (s.blocks) return;
    for (detail::Group& g : s.groups)
      for (const std::int32_t t : elements) append(g.target_out(t), out.elements[t].coefficients);
  }
  static void append(std::span<const double> from, std::vector<double>& to) {
    to.insert(to.end(), from.begin(), from.end());
  }

  std::vector<std::int32_t> shuffled(std::vector<std::int32_t> order) {
    for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random_.below(k)]);
    return order;
  }

  Swept judge_sweep(const Sweep& s) {
    const std::vector<std::int32_t> usual = s.target.spatial_order();
    Swept whole;
    sweep(s, usual, whole);
    for (int i = 0; i < orders_; ++i) {
      Swept other;
      sweep(s, shuffled(usual), other);
      for (const std::int32_t t : usual) compare(t, whole, other, s, "in another order");
      if (!(other.totals == whole.totals)) complain() << "other totals in another order; ";
    }
    Swept alone;
    std::vector<std::int32_t> some = shuffled(usual);
    if (alone_ != 0) some.resize(std::min(some.size(), alone_));
    for (const std::int32_t t : some) {
      sweep(s, {&t, 1}, alone);
      compare(t, whole, alone, s, "alone");
    }
    verdict_.elements += some.size();
    if (alone_ == 0 && !(alone.totals == whole.totals)) complain() << "other totals alone; ";
    return whole;
  }

  void compare_coefficients(const Swept& whole, const Sweep& s) {
    for (const auto& [t, trace] : whole.elements) {
      std::vector<double> own;
      for (detail::Group& g : s.groups) append(g.target_out(t), own);
      if (own != trace.coefficients && complaint_.tellp() < 600)
        complain() << "coefficients of target " << t << " differ in shares; ";
    }
  }

  void compare(std::int32_t t, const Swept& whole, const Swept& other, const Sweep& s,
               const std::string& how) {
    const ElementTrace &a = whole.elements.at(t), &b = other.elements.at(t);
    if (a == b || complaint_.tellp() > 600) return;
    complain() << ElementTrace::difference(a, b) << " of target " << t << " differ " << how
               << (s.blocks ? " (operator); " : "; ");
  }
  std::ostream& complain() { return complaint_; }

  FieldCase case_;
  RandomStream random_;
  std::size_t alone_;
  int orders_;
  AloneVerdict verdict_;
  std::ostringstream complaint_;
};

}  // namespace bezel::test
