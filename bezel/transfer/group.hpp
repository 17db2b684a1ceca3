#pragma once
// Internal: donor fields that are integrated together, laid out for the sums.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bezel/field/survey.hpp"
#include "bezel/numeric/numbers.hpp"
#include "bezel/transfer/overlay_mesh.hpp"

namespace bezel::detail {

/// The triangle itself as a frame: lambda_k are its barycentrics.
Frame affine_frame(const std::array<Vec2, 3>& corners);

/// Degrees of a donor's elements.
struct DonorDegree {
  int highest = 0;
  int uniform = -1;  ///< -1 when they differ
};

/// Coefficients of one element times multinomials, shape (components, n): kept by the group, or
/// made for the caller.
class ScaledCoefficients {
 public:
  explicit ScaledCoefficients(std::span<const double> kept) : all_(kept) {}
  explicit ScaledCoefficients(std::vector<double> made) : own_(std::move(made)), all_(own_) {}
  ScaledCoefficients(const ScaledCoefficients&) = delete;
  ScaledCoefficients& operator=(const ScaledCoefficients&) = delete;
  const double* data() const { return all_.data(); }
  std::size_t size() const { return all_.size(); }
  operator std::span<const double>() const { return all_; }

 private:
  std::vector<double> own_;
  std::span<const double> all_;
};

/// The components of all donor fields that share a donor space and go to the same target space.
struct Group {
  Group(Group&&) noexcept = default;
  Group& operator=(Group&&) noexcept = default;
  /// @param fields  must stay until drop_donor()
  Group(const OverlayMesh& donor, const OverlayMesh& target, std::span<const Field* const> fields,
        std::shared_ptr<const Space> target_space, int threads);
  /// The donor's basis functions as components: component c is basis function c of every element
  /// (zero on elements of lower degree).
  /// @param degree  of the whole donor, on a part too
  Group(const OverlayMesh& donor, const OverlayMesh& target,
        std::shared_ptr<const Space> donor_space, std::shared_ptr<const Space> target_space,
        DonorDegree degree, int threads);

  /// On parts of the meshes: `scaled` and `donor_mass` are those of a group on the whole ones.
  Group(const OverlayMesh& donor, const OverlayMesh& target,
        std::shared_ptr<const Space> donor_space, std::shared_ptr<const Space> target_space,
        int components, DonorDegree donor_degree, std::span<const double> scaled,
        std::vector<double> donor_mass, int threads);

  std::shared_ptr<const Space> donor_space, target_space;
  std::shared_ptr<const Space> continuous_space;  ///< where the result is projected next, or null
  int components = 0;
  DonorDegree donor_degree;          ///< of the whole donor, on a part too
  bool donor_mapped, target_mapped;  ///< polynomial in reference coordinates of a curved element
  /// Affine triangles of the donor's polynomials that are not mapped.
  std::span<const Frame> donor_frame;
  /// Affine triangles on which the target's polynomials are computed: straight elements themselves,
  /// else the space's own frames.
  std::span<const Frame> target_frame;
  /// Of meshes moved to another plane: the frames of physical bases in the plane that they came
  /// from; else empty.
  std::vector<Frame> given_donor_frame, given_target_frame;
  std::vector<double> donor_mass;  ///< per element [component]
  /// Of groups of fields: what is known of the donor space, and of the fields (but for the
  /// integrals, which are donor_mass).
  std::shared_ptr<field_detail::SpaceMeasures> donor_measures;
  field_detail::Survey donor_survey;
  /// Coefficients of the monomials in the barycentrics less 1/3, per element [n][component]: of
  /// donors that are not mapped and have at most max_moment_degree.
  Numbers powers;
  std::vector<double> out;  ///< target coefficients, per element [n][component]

  /// Frames of donors and targets that are not mapped, in the plane that the meshes came from.
  const Frame& given_frame_of_donor(std::int32_t e) const {
    return (given_donor_frame.empty() ? donor_frame
                                      : given_donor_frame)[static_cast<std::size_t>(e)];
  }
  const Frame& given_frame_of_target(std::int32_t e) const {
    return (given_target_frame.empty() ? target_frame
                                       : given_target_frame)[static_cast<std::size_t>(e)];
  }
  /// Whether the components are the donor's basis functions.
  bool of_basis() const { return !scaled_offset_.empty(); }
  ScaledCoefficients donor_scaled(std::int32_t e) const;
  const double* donor_powers(std::int32_t e) const {
    return powers.data() + donor_space->offset(ElementId(e)) * static_cast<std::size_t>(components);
  }
  /// By component, the mean of a donor element's polynomial, or, when all coefficients are equal up
  /// to rounding, the first of them: a constant less this number is 0.
  void constants_of(const OverlayMesh& donor, std::int32_t e, std::span<double> constants) const;
  std::span<double> target_out(std::int32_t e);
  /// Frees the donor's coefficients: nothing can be integrated any more.
  void drop_donor();
  /// Whether the space's own frame of a target element is another one than target_frame.
  bool in_other_frame(std::int32_t t) const {
    return !made_target_frame_.empty() && target_space->basis() == Basis::physical &&
           !target_space->is_own_frame(ElementId(t));
  }

 private:
  /// Whether all donor polynomials are integrated as powers, but for a few.
  bool by_powers() const;
  void make_powers(std::size_t elements, int threads);
  void make_frames(const OverlayMesh& donor, const OverlayMesh& target, int threads);
  Numbers scaled_;  // donor coefficients times multinomials, per element
                    // [component][n]; of basis functions per degree; empty
                    // where they are taken from the fields
  std::vector<field_detail::Column> fields_;                 // of groups of fields
  std::vector<std::size_t> scaled_offset_;                   // per degree, for basis functions
  std::vector<Frame> made_donor_frame_, made_target_frame_;  // those that no space has
};

/// Of constants that may be taken off the donors around an element, those of smallest magnitude, by
/// component: then the rounding of an integral of the constant over the element is rounding of the
/// integral of |f|, also where f is 0 on nearly all donors.
class SmallestConstants {
 public:
  /// @param constants  [component] out; they keep what they hold until the first take()
  explicit SmallestConstants(std::span<double> constants) : constants_(constants) {}
  /// @param donors  [component] constants of a donor
  void take(const double* donors) {
    for (std::size_t c = 0; c < constants_.size(); ++c)
      if (!any_ || std::abs(donors[c]) < std::abs(constants_[c])) constants_[c] = donors[c];
    any_ = true;
  }

 private:
  std::span<double> constants_;
  bool any_ = false;
};

/// The coefficients of a group's fields, one field after the other; taken out of the group.
/// @param components  of each field
/// @param aim         what to look for in the coefficients on the way
std::vector<std::vector<double>> take_fields(Group& g, std::span<const std::size_t> components,
                                             const field_detail::SurveyAim& aim,
                                             field_detail::Survey& survey, int threads);

/// Where point x lies for the polynomial of donor element d: barycentrics 1 and 2 in its frame, or
/// in the reference triangle when it is mapped. `warm`: the last barycentrics found in d, when
/// have_warm says so; of a mapped donor it says in the end whether the map could be inverted at x:
/// if not, the place is one in the direction of x.
std::array<double, 2> donor_place(const Group& g, const OverlayMesh& donor, std::int32_t d,
                                  const Vec2& x, std::array<double, 3>& warm, bool& have_warm);

}  // namespace bezel::detail
