#pragma once
// Internal: several ordinary target elements at once: their pieces, their regions and their
// solutions side by side in the lanes. Each element gets the bits that it gets alone.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/lanes.hpp"
#include "bezel/transfer/piece_batch.hpp"

namespace bezel::detail {

/// At most eight target elements, their regions one after the other, each with a donor.
struct ElementBatch {
  std::size_t elements = 0;
  std::array<ElementCount, lanes> count;
  std::array<std::size_t, lanes + 1> first_region{};
  TargetPlaces places;
  TargetPlaces::Row area{}, size{};  ///< of the target elements; size: the boxes' diameter
  PieceBatch pieces;
  // By region, and some more that repeat the last one.
  std::vector<std::int64_t> owner;   ///< number of its element
  std::vector<const Frame*> frame;   ///< of the donor's polynomial
  std::vector<const double*> donor;  ///< as BatchRegion::donor
  std::vector<double> donor_area, donor_size;

  std::size_t regions() const { return first_region[elements]; }
  std::span<const ElementCount> counts() const { return std::span(count).first(elements); }
  void resize(std::size_t regions);
};

/// What the regions of a batch give to each element, and whether they are ordinary.
struct ElementSums {
  /// [element][n]: integrals of the monomials with the donors' polynomials less a constant (of one
  /// component only), of the monomials, the mass (likewise) and the area.
  std::vector<double> rows;
  std::size_t width = 0, basis = 0, mass = 0, area = 0;  ///< of rows; the last three: places in one
  std::vector<double> product;      ///< [element][n][component] of several components
  std::vector<double> masses;       ///< [element][component] likewise
  std::vector<double> region_area;  ///< by region
  std::vector<double> ordinary;     ///< by region: 1 where the pieces close around a positive
                                    ///< area and the donor is not far away; else 0
  bool all_ordinary = false;
  double max_joint_gap = 0;  ///< of the ordinary regions
  std::size_t product_stride = 0, mass_stride = 0;

  const double* row(std::size_t e) const { return rows.data() + e * width; }
};

/// Sums over the regions of the batch, whose pieces' sums have been made.
/// @param degree  of the polynomials, at most max_moment_degree
/// @param base    [element][component] the constants, and batch_padding numbers
void add_elements(int degree, const ElementBatch& batch, int components, const double* base,
                  ElementSums& sums);

/// solve_straight for one component of each element.
/// @param base          [element]
/// @param coefficients  [element]
/// @return  [element] |mass of the result - mass received|
TargetPlaces::Row solve_elements(int degree, const ElementBatch& batch, const ElementSums& sums,
                                 const double* base, std::span<double* const> coefficients);

}  // namespace bezel::detail
