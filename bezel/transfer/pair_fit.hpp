#pragma once
// Internal: the pairs of a target element by interpolation of the donor around each of them, for
// mapped fields and for polynomials of different degrees.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/quadrature.hpp"
#include "bezel/transfer/group.hpp"
#include "bezel/transfer/overlay.hpp"
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
  std::span<const double> constants() const { return constant_; }
  /// The mass alone, of a mapped donor, with straight pieces that close the region's joints: their
  /// starts and steps in the plane.
  void mass_of(std::int32_t d, std::size_t begin, std::size_t end, double area,
               std::span<const std::array<Vec2, 2>> bridges, std::span<double> mass);
  /// Points on a piece of a target edge by which masses of that degree in the donor's coordinates
  /// are integrated.
  static int mass_points(int degree);
  /// Adds what the pairs since the last call gave: integrals with the powers l0^i l1^j l2^k of the
  /// target's barycentrics, product[n * components + c] of the fields less the constants, and
  /// basis[n].
  void take(double* product, double* basis);

 private:
  struct Rule {
    std::size_t count = 0, blocks = 0;
    std::vector<double> node, weight;  // padded
  };
  /// Where the points of a segment are.
  struct Run {
    std::uint32_t first = 0, count = 0;
    bool pulled = false, reversed = false;
  };
  /// What is known of a donor element.
  struct Donor {
    std::int32_t element = exterior;
    MapPolynomial map;
    std::vector<double> mean;
    std::vector<double> mass;  // [component][row]: (f - mean) det in the frame of the reference
                               // triangle
  };

  const Rule& rule(int points);
  const Donor& donor_of(std::int32_t d);
  /// Makes room for the points of a table, values and terms, and moments of a degree.
  void reserve(const FitTable& table, std::size_t components, int moments);
  void make_target_map();
  void make_target_points(std::span<const Segment> segments);
  void append_side(const OverlayMesh& mesh, std::int32_t element, const Part& part, int points,
                   CurvePoints& to);
  std::size_t append_curve(std::span<const Vec2> control, const Part& part, const Vec2& origin,
                           int points, CurvePoints& to);
  void collect(std::size_t begin, std::size_t end);
  bool donor_places(std::int32_t d, std::size_t padded);
  bool place_points(std::int32_t d, int m, int p, const FitFrame& frame);
  void donor_mass(const Donor& donor, std::size_t begin, std::size_t end, double area,
                  std::span<const std::array<Vec2, 2>> bridges, std::span<double> mass);
  /// Sets a point of boundary_ in the donor's reference triangle.
  void pull_point(std::int32_t d, const std::array<double, 3>& lambda, const Vec2& step,
                  std::size_t at);
  void append_one_by_one(std::int32_t d, const Part& part, int points);
  bool plane_mass(std::int32_t d, std::size_t begin, std::size_t end, double area,
                  std::span<double> mass);

  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  std::vector<Rule> rules_;
  std::vector<std::vector<Donor>> donors_;  // by group, a place for each element number's rest

  // Of the element and group at work.
  std::size_t group_ = 0;
  const Group* g_ = nullptr;
  std::int32_t t_ = 0;
  std::span<const Segment> segments_;
  int target_degree_ = 0;  // of the monomials, Jacobian included
  bool ready_ = false;
  Vec2 origin_;
  MapPolynomial target_map_;
  std::array<double, 2> centre_{};  // of the target's monomials
  CurvePoints own_, pulled_, boundary_;
  std::vector<Run> runs_;
  std::vector<double> sums_;  // [component, and the constant 1][row]
  bool any_ = false;
  std::vector<double> constant_;  // subtracted, by component
  struct Seen {
    std::uint32_t stamp = 0, segment = 0;
  };
  std::vector<Seen> seen_;  // by donor edge
  std::uint32_t stamp_ = 0;
  std::vector<double> moments_, terms_, values_;
  std::vector<double> u_, v_, x_, y_, du_, dv_, det_;  // at the points of a table
};

}  // namespace bezel::detail
