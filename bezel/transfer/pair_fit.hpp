#pragma once
// Internal: the pairs of a target element by interpolation of the donor around each of them, for
// mapped fields and for polynomials of different degrees.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/transfer/edge_points.hpp"
#include "bezel/transfer/fit_donors.hpp"
#include "bezel/transfer/group.hpp"
#include "bezel/transfer/overlay.hpp"
#include "bezel/transfer/refilled.hpp"
#include "bezel/transfer/region_fit.hpp"

namespace bezel::detail {

/// Per-thread worker for the pairs of one group of fields after the other.
class PairFit {
 public:
  PairFit(const OverlayMesh& donor, const OverlayMesh& target, std::size_t groups);

  /// Whether the degrees of a group are in reach.
  static bool can(const Group& g, const OverlayMesh& donor, const OverlayMesh& target);

  /// Starts on target element t for group number i.
  /// @param around_a_constant  whether only what differs from the smallest of the donors' means is
  ///                           integrated
  void begin(std::size_t i, const Group& g, std::int32_t t, std::span<const Segment> segments,
             bool around_a_constant);
  /// Adds the pair with donor d, the segments begin .. end; false where the maps are too far from
  /// affine for it, or the region too thin.
  /// @param area  of the pair
  /// @param mass  out, [component]; of a mapped donor also when the answer is false
  bool add(std::int32_t d, std::size_t begin, std::size_t end, double area, std::span<double> mass);
  /// [component] what is taken off the donors' polynomials.
  std::span<const double> constants() const { return work_.constant; }
  /// The mass alone, of a mapped donor, with straight pieces that close the region's joints: their
  /// starts and steps in the plane.
  void mass_of(std::int32_t d, std::size_t begin, std::size_t end, double area,
               std::span<const std::array<Vec2, 2>> bridges, std::span<double> mass);
  /// Adds what the pairs since the last call gave: integrals with the powers l0^i l1^j l2^k of the
  /// target's barycentrics, product[n * components + c] of the fields less the constants, and
  /// basis[n].
  void take(double* product, double* basis);

 private:
  /// Where the points of a segment are.
  struct Run {
    std::uint32_t first = 0, count = 0;
    bool pulled = false, reversed = false;
  };
  /// Of the element and group at work; made anew by begin().
  struct Work {
    std::size_t group = 0;
    const Group* fields = nullptr;
    std::int32_t element = exterior;
    std::span<const Segment> segments;
    int degree = 0;                  ///< of the monomials, Jacobian included
    std::array<double, 2> centre{};  ///< of the target's monomials
    Refilled<double> constant;       ///< subtracted, by component
    Refilled<Run> runs;              ///< by segment
    bool placed = false;             ///< all points lie in the target's reference triangle
    bool any = false;                ///< pairs since the last take()
  };

  const FitDonor& donor_of(std::int32_t d) { return donors_.of(work_.group, *work_.fields, d); }
  void make_target_map();
  void choose_constants();
  void make_target_points();
  Run append_segment(std::size_t i, int degree);
  void place_in_target();
  void collect(std::size_t begin, std::size_t end);
  bool donor_places(std::int32_t d, std::size_t padded);
  bool place_points(std::int32_t d, int m, int p, const FitFrame& frame);
  bool plane_mass(std::int32_t d, std::span<const Segment> run, double area,
                  std::span<double> mass);
  /// [term] the target's Jacobian, of a degree, about its centre; good until the next
  /// interpolation.
  const std::vector<double>& target_jacobian(int degree);

  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  FitDonors donors_;
  EdgePoints points_;
  Work work_;
  MapPolynomial target_map_;
  CurvePoints own_, pulled_, boundary_;
  std::vector<double> sums_;  // [component, and the constant 1][row]
  struct Seen {
    std::uint32_t stamp = 0, segment = 0;
  };
  std::vector<Seen> seen_;  // by donor edge
  std::uint32_t stamp_ = 0;
  FitRoom room_;
};

}  // namespace bezel::detail
