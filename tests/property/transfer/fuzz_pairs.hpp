#pragma once
// One fuzzed pair of meshes: every pair of elements against an independent area.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/mesh_pairs.hpp"
#include "support/pair_areas.hpp"

namespace bezel::test {

struct FuzzVerdict {
  std::string kind;
  bool refused = false;  ///< the overlay said itself that it could not do it
  std::string refusal;
  int compared = 0, undecided = 0;  ///< pairs of elements; undecided by the independent method
  double worst = 0;                 ///< largest |difference of areas| / allowed
  double worst_of_smaller = 0;      ///< largest |difference of areas| / smaller element
  std::string complaint;            ///< what is wrong, empty when nothing
};

struct Measures {
  double area, perimeter, diameter, coordinate;
};

inline Measures measures(const TriangleMesh& mesh, ElementId e) {
  const auto b = mesh.gather(e);
  Measures m{area(mesh.degree(), b), 0.0, mesh.box(e).diameter(), 0.0};
  for (int side = 0; side < 3; ++side) {
    const auto c = bernstein::side<Vec2>(mesh.degree(), b, side);
    for (std::size_t i = 1; i < c.size(); ++i) m.perimeter += norm(c[i] - c[i - 1]);
  }
  for (const Vec2& p : b) m.coordinate = std::max({m.coordinate, std::abs(p[0]), std::abs(p[1])});
  return m;
}

/// What two areas may differ by: 1e-12 of the smaller element, or what moving its boundary by the
/// distance changes below which two edges count as one (1e-13 of the smaller element, and 32
/// roundings of the largest coordinate; the element itself may be much thinner than that distance).
inline double allowed_difference(const Measures& a, const Measures& b) {
  const double distance = std::max(1e-13 * std::min(a.diameter, b.diameter),
                                   32 * 0x1p-53 * std::max(a.coordinate, b.coordinate));
  return std::max(1e-12 * std::min(a.area, b.area), distance * std::min(a.perimeter, b.perimeter));
}

inline FuzzVerdict judge(const MeshPair& pair) {
  FuzzVerdict verdict;
  verdict.kind = pair.kind;
  std::map<std::pair<int, int>, double> found;
  try {
    for (const OverlapArea& o : overlap_areas(pair.donor, pair.target, 1))
      found[{o.target.value, o.donor.value}] = o.area;
  } catch (const NumericsError& e) {
    verdict.refused = true;
    verdict.refusal = e.what();
    return verdict;
  }
  std::ostringstream complaint;
  complaint.precision(17);
  const auto complain = [&](std::size_t t, std::size_t d, double is, double expected) {
    if (complaint.tellp() < 400) {
      complaint << "target " << t << " donor " << d << ": area " << is << ", expected " << expected
                << "; ";
    }
  };
  TriangleIntersector intersector;
  const int h = pair.donor->degree();
  const int g = pair.target->degree();
  std::vector<Measures> donor_measures;
  for (std::size_t d = 0; d < pair.donor->element_count(); ++d)
    donor_measures.push_back(measures(*pair.donor, ElementId(d)));
  for (std::size_t t = 0; t < pair.target->element_count(); ++t) {
    const auto a = pair.target->gather(ElementId(t));
    const Measures of_target = measures(*pair.target, ElementId(t));
    for (std::size_t d = 0; d < pair.donor->element_count(); ++d) {
      const auto at = found.find({static_cast<int>(t), static_cast<int>(d)});
      const double is = at == found.end() ? 0.0 : at->second;
      double expected = 0.0;
      if (pair.target->box(ElementId(t)).overlaps(pair.donor->box(ElementId(d)))) {
        const auto b = pair.donor->gather(ElementId(d));
        if (g == 1 && h == 1) {
          expected = straight_common_area({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
        } else if (!curved_common_area(intersector, g, a, h, b, expected)) {
          ++verdict.undecided;
          continue;
        }
      } else if (at == found.end()) {
        continue;
      }
      ++verdict.compared;
      const double off = std::abs(is - expected);
      const double ratio = off / allowed_difference(of_target, donor_measures[d]);
      verdict.worst = std::max(verdict.worst, ratio);
      verdict.worst_of_smaller = std::max(verdict.worst_of_smaller,
                                          off / std::min(of_target.area, donor_measures[d].area));
      if (!(ratio <= 1.0)) complain(t, d, is, expected);
    }
  }
  verdict.complaint = complaint.str();
  return verdict;
}

}  // namespace bezel::test
