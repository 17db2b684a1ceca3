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
#include "bezel/transfer/bounds.hpp"

namespace bezel {

/// What happens where a target element is not covered by the donor mesh.
enum class Uncovered {
  error,   ///< UncoveredError naming elements and areas
  extend,  ///< the nearest donor polynomial is extended, as far as it does not grow too much
  zero     ///< the field counts as zero there
};

/// How the global mass system of a continuous target is solved.
enum class MassMethod {
  automatic,            ///< of the two below the faster one, by size
  cholesky,             ///< sparse, direct
  conjugate_gradients,  ///< with an additive Schwarz preconditioner
  petsc                 ///< by PETSc, in builds that have it
};

/// Does this build have the method? All but petsc are always there.
bool is_available(MassMethod method);

/// Which mass is kept where the meshes do not cover each other.
enum class Conserve {
  covered,  ///< after = before - outside + made: what the two meshes have in common
  total     ///< after = before: the difference is spread over elements at the target's boundary;
            ///< constants change there
};

struct TransferOptions {
  int degree = -1;  ///< of the target fields; -1: the donor's highest degree
  Basis basis = Basis::reference;
  bool same_basis = true;  ///< use each donor's basis instead of `basis`; a continuous target uses
                           ///< the reference basis then
  Continuity continuity = Continuity::discontinuous;  ///< of the target fields
  bool keep_boundary = false;  ///< continuous targets: the dofs on the boundary interpolate the
                               ///< donor, and mass is no longer conserved
  MassMethod mass_method = MassMethod::automatic;  ///< of continuous targets
  Uncovered uncovered = Uncovered::error;
  /// total: what an element made is taken from it again, and what a donor element has outside goes
  /// to the target's boundary elements near it (to all of them when none is near), as a constant
  /// each.
  Conserve conserve = Conserve::covered;
  Bounds bounds;    ///< kept by the whole of each target polynomial, mass conserved
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

/// The solution of the global mass system of a continuous target.
struct MassSolve {
  std::size_t dofs = 0;
  MassMethod method = MassMethod::automatic;  ///< the one used; never automatic in a report
  int iterations = 0;                         ///< 0 for cholesky
  double relative_residual = 0;               ///< of the system, over the dofs solved for
  double boundary_mass_change = 0;  ///< mass after - mass received: the price of keep_boundary
};

struct FieldReport {
  std::string name;
  int component = 0;
  double mass_before = 0,
         mass_after = 0;    ///< integrals of donor and target field, from their coefficients, times
                            ///< weight and density if there are any
  double mass_outside = 0;  ///< donor mass over parts that no target element covers
  double mass_made = 0;     ///< target mass over parts that no donor element covers
  double mass_spread = 0;   ///< mass added at the boundary (Conserve::total)
  double max_spread_change =
      0;  ///< by which a value changed most by that: |mass added| / area of an element
  double relative_mass_defect = 0;  ///< |mass_after - (mass_before - mass_outside + mass_made +
                                    ///< mass_spread)| / integral of |f_D|
  double min_before = 0, max_before = 0, min_after = 0, max_after = 0;  ///< certified ranges
  double max_element_defect = 0;  ///< largest |element mass - mass received| / integral of |f_D|,
                                  ///< before bounds move mass; rounding, but for continuous targets
  std::optional<MassSolve> mass_solve;  ///< of continuous targets
  BoundsReport bounds;
};

struct TransferReport {
  std::vector<FieldReport> fields;
  std::int64_t pairs = 0, crossings = 0, tangencies = 0, overlaps = 0, unresolved = 0;
  double uncovered_area = 0;        ///< target area without donor, in squared length units
  double extension_growth = 0;      ///< largest growth of a continued polynomial beyond its donor's
                                    ///< coefficients: (sum of |barycentrics|)^degree, limited to
                                    ///< 2^20; 1 inside, 0 when nothing was continued
  double extension_moved_area = 0;  ///< target area that another donor than the nearest fills,
                                    ///< whose polynomial grows much less there
  double extension_held_area = 0;   ///< target area that is too far from the donors for their
                                    ///< polynomials: the values are those of places nearer to them
  double outside_area = 0;          ///< donor area without target
  std::int64_t spread_elements = 0;  ///< target elements that Conserve::total changed
  double max_partition_residual =
      0;  ///< max over targets of |sum of pair areas - covered area| / area
  double max_joint_gap =
      0;  ///< max over pairs of the largest boundary gap / smaller element diameter
  std::vector<std::pair<ElementId, double>>
      uncovered_elements;  ///< and their uncovered areas, above 1e-10 of the element
  struct Seconds {
    double total = 0;    ///< wall time
    double prepare = 0;  ///< of it, laying out meshes and fields (0 where another transfer did)
    double report = 0;   ///< of it, making the fields, their masses and ranges
    double overlay = 0, integrate = 0, solve = 0;  ///< the rest, summed over the threads
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

/// Moves fields (all on one donor mesh) to a target mesh: the L2-best fields, mass conserved.
///
/// Discontinuous targets conserve the mass that each element receives. Continuous ones conserve the
/// total and the mass weighted by each continuous basis function; with keep_boundary neither, and
/// relative_mass_defect and MassSolve::boundary_mass_change say by how much.
/// @throws InputError for bad options, inverted elements, fields on several meshes, a continuous
///         target in physical basis or of degree 0, keep_boundary without a continuous target or
///         with bounds, petsc in a build without it, bounds that leave out 0 where uncovered parts
///         count as 0; UncoveredError; NumericsError where the overlay does not close, a mass
///         matrix is singular, or bounds cannot hold a field's mass
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
