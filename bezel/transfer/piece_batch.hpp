#pragma once
// Internal: the moments of all regions of a few target elements at once, each boundary piece done
// once for the regions on both its sides.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/lanes.hpp"
#include "bezel/transfer/moments.hpp"
#include "bezel/transfer/overlay.hpp"

namespace bezel::detail {

/// Barycentrics 1 and 2, less 1/3, of the target's triangle and their inverse.
struct TargetPlace {
  Vec2 centre, first, second;  ///< coordinates (dot(first, x - centre), dot(second, x - centre))
  Vec2 along_first, along_second;  ///< columns of the inverse
  double area;                     ///< of the plane per unit of the coordinates
};

inline TargetPlace place_of(const Frame& frame) {
  const Vec2 &first = frame.gradient[1], &second = frame.gradient[2];
  const double area = 1.0 / cross(first, second);
  return {frame.centre,
          first,
          second,
          Vec2{{second[1] * area, -second[0] * area}},
          Vec2{{-first[1] * area, first[0] * area}},
          area};
}

/// Where at most eight target elements lie, one in each lane.
struct TargetPlaces {
  using Row = std::array<double, lanes>;
  Row centre_x{}, centre_y{}, first_x{}, first_y{}, second_x{}, second_y{};
  Row along_first_x{}, along_first_y{}, along_second_x{}, along_second_y{}, area{};
  Row origin_x{}, origin_y{};  ///< areas of curved pieces are taken about it

  TargetPlaces() = default;
  /// One element.
  TargetPlaces(const TargetPlace& place, const Vec2& origin) { set(0, place, origin); }
  void set(std::size_t lane, const TargetPlace& place, const Vec2& origin) {
    centre_x[lane] = place.centre.x();
    centre_y[lane] = place.centre.y();
    first_x[lane] = place.first.x();
    first_y[lane] = place.first.y();
    second_x[lane] = place.second.x();
    second_y[lane] = place.second.y();
    along_first_x[lane] = place.along_first.x();
    along_first_y[lane] = place.along_first.y();
    along_second_x[lane] = place.along_second.x();
    along_second_y[lane] = place.along_second.y();
    area[lane] = place.area;
    origin_x[lane] = origin.x();
    origin_y[lane] = origin.y();
  }
};

/// How much of the lists one of the elements takes.
struct ElementCount {
  std::uint32_t pieces = 0, regions = 0;
};

/// Joints open by more than this fraction of the smaller element mean that the overlay is wrong
/// there.
inline constexpr double largest_joint_gap = 1e-10;

/// Whether a region's joints are closed to far less than an element's width, 2 area / size.
inline bool closes(double gap, double size, double area) {
  return gap * size <= 2.0 * largest_joint_gap * area;
}

inline constexpr int max_batch_degree = 3;  ///< of the pieces

/// The boundary pieces of at most eight target elements, those of one element after those of
/// another, and what they add up to.
struct PieceBatch {
  std::size_t count = 0, stride = 0;  ///< stride: count, padded
  std::vector<double> from, to;       ///< [piece] parameters on its curve, either order
  std::vector<double> x, y;           ///< [control point][piece] of the curves
  std::vector<std::int64_t> owner;    ///< [piece] number of its element; 0 where nobody sets it
  std::size_t width = 0;              ///< numbers per piece and per region
  std::vector<double> moments;        ///< [piece][n]
  /// [region][n]: moments about its element's centre in its coordinates, n = triangle_index(degree,
  /// a, b), and more.
  std::vector<double> sums;
  std::size_t open = 0;  ///< n: by how much the pieces fail to close, first coordinate; + 1: second
  std::size_t area = 0;  ///< n: the area
  bool area_in_units = false;  ///< in units of the element's coordinates, else of the plane
  void resize(std::size_t pieces, int degree);
  const double* region(std::size_t i) const { return sums.data() + i * width; }
};

/// PieceBatch::width, open and area for so many moments.
constexpr std::size_t sums_width(std::size_t moments, bool curved) {
  return padded_to_lanes(moments + (curved ? 3 : 2));
}
constexpr std::size_t sums_open(std::size_t moments) {
  return moments;
}
constexpr std::size_t sums_area(std::size_t moments, bool curved) {
  return curved ? moments + 2 : 0;
}

/// Fills batch.sums.
/// @param table     for pieces of one degree, at most max_batch_degree; the batch's are of this one
/// @param degree    of the moments: 0, 2, 4 or 6
/// @param pieces    batch.count of them; their regions are numbered within the element
/// @param elements  at most eight
void region_sums(const PieceTable& table, int degree, const TargetPlaces& places,
                 std::span<const BoundaryPiece> pieces, std::span<const ElementCount> elements,
                 PieceBatch& batch);

/// A region that gets a donor's polynomial.
struct BatchRegion {
  const Frame* frame;   ///< of the donor's polynomial
  const double* donor;  ///< coefficients of the donor's monomials, [n][component], and
                        ///< batch_padding numbers; nullptr: the region gets nothing
  bool far;  ///< out: not added, for the donor's polynomial is much steeper than the target's
};

/// Numbers behind those of donors, bases, masses and products that add_batch and solve_straight may
/// read.
inline constexpr std::size_t batch_padding = 16;

/// add_region for the regions of a batch, about the target's centre, of the donors' polynomials
/// less a constant; the masses are those of the whole polynomials.
/// @param base  [component] the constants, and batch_padding numbers; likewise product
/// @param mass  [region][component]
void add_batch(int degree, const TargetPlace& place, const PieceBatch& batch,
               std::span<BatchRegion> regions, int components, const double* base, double* product,
               double* basis, double* mass);

/// What solve_straight takes: batch_padding numbers behind product, mass and base may be read.
struct StraightSystem {
  int degree, components;
  double area;            ///< of the triangle
  double covered;         ///< sum of its regions' areas
  const double* product;  ///< [n][component], as from add_batch
  const double* basis;    ///< [n]
  const double* mass;     ///< [component] received
  const double* base;     ///< [component]
};

/// The L2 projection on a straight triangle, from moments about its centre: Bernstein coefficients
/// [n][component] with the masses received.
/// @return  largest over components of |mass of the result - mass received|
double solve_straight(const StraightSystem& system, double* coefficients);

/// From moments on the triangle of area 1/2 to Bernstein coefficients, transposed: the row of
/// moment m, padded with zeros to whole blocks, has the factors of coefficients n.
/// @param degree  0 .. max_moment_degree
const double* projection_rows(int degree);

/// powers[n][component] += integrals with l0^i l1^j l2^k from those with the monomials.
/// @param degree  0 .. 2 max_moment_degree
void powers_from_moments(int degree, int components, const double* moments, double* powers);

}  // namespace bezel::detail
