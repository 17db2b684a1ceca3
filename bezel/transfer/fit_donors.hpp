#pragma once
// Internal: the donor elements of pairs that are integrated by interpolation, and the masses that
// mapped ones give to a region.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/transfer/edge_points.hpp"
#include "bezel/transfer/group.hpp"
#include "bezel/transfer/region_fit.hpp"

namespace bezel::detail {

/// Room for what is computed at the points of a table.
struct FitRoom {
  std::vector<double> u, v, x, y, du, dv, det;  // [point]
  std::vector<double> values, terms;            // [component][point], [component][term]
  std::vector<double> moments;                  // rows
  /// Makes room for the points of a table, values and terms, and moments of a degree.
  void reserve(const FitTable& table, std::size_t components, int degree);
};

/// What is known of a donor element.
struct FitDonor {
  std::int32_t element = exterior;
  MapPolynomial map;         ///< of mapped donors
  int degree = 0;            ///< likewise: of (f - mean) det
  std::vector<double> mean;  ///< by component, Group::constants_of
  std::vector<double> mass;  ///< of mapped donors, [component][row]: (f - mean) det in the frame of
                             ///< the reference triangle
};

/// Gauss points on a curve that is pulled back by an inverse map, beyond what a polynomial needs.
inline constexpr int pulled_extra = 1;
/// A reference triangle's bounding box lies in the box of this half around its centroid.
inline constexpr double reference_half = 2.0 / 3.0;

/// Per-thread store of donor elements of several groups of fields.
class FitDonors {
 public:
  FitDonors(const OverlayMesh& donor, const OverlayMesh& target, std::size_t groups);

  /// Element d for group number i; good until the next call.
  const FitDonor& of(std::size_t i, const Group& g, std::int32_t d);
  /// The mass that a mapped donor gives to the region bounded by a run, with straight pieces that
  /// close the region's joints: their starts and steps in the plane.
  /// @param area  of the region
  /// @param mass  out, [component]
  void integrate(const FitDonor& donor, std::span<const Segment> run, double area,
                 std::span<const std::array<Vec2, 2>> bridges, std::span<double> mass);
  /// Degree in the reference triangle of a mapped donor's polynomial of a degree, times the
  /// Jacobian.
  static int mass_degree(const OverlayMesh& donor, int degree) {
    return degree + 2 * (donor.degree - 1);
  }
  /// Points on a piece of a target edge by which masses of that degree in the donor's coordinates
  /// are integrated.
  static int mass_points(int degree);

 private:
  void make_mass(const Group& g, FitDonor& donor);
  /// Sets a point of boundary_ in the donor's reference triangle.
  void pull_point(std::int32_t d, const std::array<double, 3>& lambda, const Vec2& step,
                  std::size_t at);
  void append_one_by_one(std::int32_t d, const Part& part, int points);

  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  std::vector<std::vector<FitDonor>> kept_;  // by group, a place for each element number's rest
  EdgePoints points_;
  CurvePoints boundary_;
  FitRoom room_;
};

}  // namespace bezel::detail
