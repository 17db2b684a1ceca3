#pragma once
// Conservative transfer of fields between two curved meshes by common refinement.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/progress.hpp"
#include "bezel/field/field.hpp"

namespace bezel {

/// What happens where a target element is not covered by the donor mesh.
enum class Uncovered {
  error,   ///< UncoveredError naming elements and areas
  extend,  ///< the nearest donor polynomial is extended
  zero     ///< the field counts as zero there
};

struct TransferOptions {
  int degree = -1;  ///< of the target fields; -1: the donor's highest degree
  Basis basis = Basis::reference;
  bool same_basis = true;  ///< use each donor's basis instead of `basis`
  Uncovered uncovered = Uncovered::error;
  int threads = 0;  ///< 0: all; the result does not depend on it
  /// A polynomial in x and y of degree 0 to 4, not negative on the meshes (it may vanish on lines
  /// such as an axis): projection and mass are those of the inner product with this weight. For
  /// axisymmetric fields, the distance from the axis.
  std::optional<Formula> weight{};
  /// Name of a scalar donor field (empty: none): every other field u is carried as density * u. The
  /// integral of density * u is conserved, and u is recovered by the projection whose weight is the
  /// density on the target, so that a constant u stays constant.
  std::string density{};
};

struct FieldReport {
  std::string name;
  int component = 0;
  double mass_before = 0,
         mass_after = 0;    ///< integrals of donor and target field, from their coefficients, times
                            ///< weight and density if there are any
  double mass_outside = 0;  ///< donor mass over parts that no target element covers
  double mass_made = 0;     ///< target mass over parts that no donor element covers
  double relative_mass_defect =
      0;  ///< |mass_after - (mass_before - mass_outside + mass_made)| / integral of |f_D|
  double min_before = 0, max_before = 0, min_after = 0, max_after = 0;  ///< certified ranges
  double max_element_defect = 0;  ///< largest |element mass - mass received| / integral of |f_D|
};

struct TransferReport {
  std::vector<FieldReport> fields;
  std::int64_t pairs = 0, crossings = 0, tangencies = 0, overlaps = 0, unresolved = 0;
  double uncovered_area = 0;  ///< target area without donor, in squared length units
  double outside_area = 0;    ///< donor area without target
  double max_partition_residual =
      0;  ///< max over targets of |sum of pair areas - covered area| / area
  double max_joint_gap =
      0;  ///< max over pairs of the largest boundary gap / smaller element diameter
  std::vector<std::pair<ElementId, double>>
      uncovered_elements;  ///< and their uncovered areas, above 1e-10 of the element
  struct Seconds {
    double total = 0;                              ///< wall time
    double overlay = 0, integrate = 0, solve = 0;  ///< summed over the threads
  } seconds;
};

struct TransferResult {
  std::vector<Field> fields;
  TransferReport report;
};

/// Thrown with Uncovered::error when the donor mesh does not cover the target mesh.
class UncoveredError : public InputError {
 public:
  UncoveredError(const std::string& message, std::vector<std::pair<ElementId, double>> elements,
                 double area)
      : InputError(message), elements_(std::move(elements)), area_(area) {}
  const std::vector<std::pair<ElementId, double>>& elements() const { return elements_; }
  double area() const { return area_; }

 private:
  std::vector<std::pair<ElementId, double>> elements_;
  double area_;
};

/// Moves fields (all on one donor mesh) to a target mesh: the L2-best discontinuous fields, mass
/// conserved.
TransferResult transfer(std::span<const Field> donors, std::shared_ptr<const TriangleMesh> target,
                        const TransferOptions& options = {}, const Progress& progress = {});

/// The area that one target and one donor element share.
struct OverlapArea {
  ElementId target, donor;
  double area;  ///< squared length units, exact up to rounding
};

/// The pairs of elements of two meshes that overlap, with the areas of their intersections, by
/// target, then donor. Pairs that only touch may appear with an area of the size of rounding.
/// @throws InputError for inverted elements; NumericsError where the overlay does not close
/// @cost   as transfer() without fields
std::vector<OverlapArea> overlap_areas(std::shared_ptr<const TriangleMesh> donor,
                                       std::shared_ptr<const TriangleMesh> target, int threads = 0);

}  // namespace bezel
