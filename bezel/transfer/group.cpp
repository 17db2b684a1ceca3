#include "bezel/transfer/group.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/field/integrals.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/moments.hpp"
#include "bezel/transfer/piece_batch.hpp"

namespace bezel::detail {
namespace {

/// The target's polynomials may stay on the triangle they were computed on when the space's frame
/// is that triangle, up to the rounding of barycentric coordinates at its place in the plane.
bool is_frame(const Frame& frame, const std::array<Vec2, 3>& corners) {
  double slope = 0.0;
  for (const Vec2& g : frame.gradient) slope = std::max({slope, std::abs(g[0]), std::abs(g[1])});
  const double reach = std::max(std::abs(frame.centre[0]), std::abs(frame.centre[1]));
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Lambda l = frame.lambda(corners[k]);
    for (std::size_t i = 0; i < 3; ++i)
      largest = std::max(largest, std::abs(l[i] - (i == k ? 1.0 : 0.0)));
  }
  return largest <= 0x1p-51 * (2.0 + reach * slope);
}

}  // namespace

Frame affine_frame(const std::array<Vec2, 3>& p) {
  Frame frame;
  const Vec2 a = p[1] - p[0];
  const Vec2 b = p[2] - p[0];
  const double det = cross(a, b);
  frame.gradient[1] = Vec2{{b[1] / det, -b[0] / det}};
  frame.gradient[2] = Vec2{{-a[1] / det, a[0] / det}};
  frame.gradient[0] = -(frame.gradient[1] + frame.gradient[2]);
  frame.centre = p[0] + (a + b) * (1.0 / 3.0);
  return frame;
}

Group::Group(const OverlayMesh& donor, const OverlayMesh& target,
             std::span<const Field* const> fields, std::shared_ptr<const Space> target_space_in)
    : donor_space(fields.front()->space_ptr()),
      target_space(std::move(target_space_in)),
      donor_degree{donor_space->highest_degree(), donor_space->uniform_degree()},
      donor_mapped(donor_space->basis() == Basis::reference && donor.degree > 1),
      target_mapped(target_space->basis() == Basis::reference && target.degree > 1) {
  for (const Field* f : fields) components += f->components();
  make_frames(donor, target);

  const std::size_t elements = donor.element_count();
  const auto nc = static_cast<std::size_t>(components);
  scaled.resize(donor_space->coefficient_count() * nc);
  donor_mass.resize(elements * nc);
  donor_integrals = field_detail::basis_integrals(*donor_space);
  std::size_t c0 = 0;
  for (const Field* f : fields) {
    const auto own = static_cast<std::size_t>(f->components());
    const std::vector<double> masses = field_detail::element_integrals(*f, donor_integrals);
    for (std::size_t e = 0; e < elements; ++e) {
      const auto coefficients = f->coefficients(ElementId(e));
      const auto factors = multinomials(donor_space->degree(ElementId(e)));
      double* place = scaled.data() + donor_space->offset(ElementId(e)) * nc;
      for (std::size_t c = 0; c < own; ++c) {
        for (std::size_t n = 0; n < factors.size(); ++n) {
          place[(c0 + c) * factors.size() + n] = coefficients[n * own + c] * factors[n];
        }
        donor_mass[e * nc + c0 + c] = masses[e * own + c];
      }
    }
    c0 += own;
  }
  out.resize(target_space->coefficient_count() * nc);
  make_powers(elements);
}

Group::Group(const OverlayMesh& donor, const OverlayMesh& target,
             std::shared_ptr<const Space> donor_space_in,
             std::shared_ptr<const Space> target_space_in, int components_in,
             DonorDegree donor_degree_in, std::vector<double> scaled_in,
             std::vector<double> donor_mass_in)
    : donor_space(std::move(donor_space_in)),
      target_space(std::move(target_space_in)),
      components(components_in),
      donor_degree(donor_degree_in),
      donor_mapped(donor_space->basis() == Basis::reference && donor.degree > 1),
      target_mapped(target_space->basis() == Basis::reference && target.degree > 1),
      scaled(std::move(scaled_in)),
      donor_mass(std::move(donor_mass_in)) {
  make_frames(donor, target);
  out.resize(target_space->coefficient_count() * static_cast<std::size_t>(components));
  make_powers(donor.element_count());
}

void Group::make_powers(std::size_t elements) {
  const auto nc = static_cast<std::size_t>(components);
  if (donor_mapped || target_mapped) return;
  powers.assign(scaled.size() + batch_padding, 0.0);
  for (std::size_t e = 0; e < elements; ++e) {
    const int degree = donor_space->degree(ElementId(e));
    if (degree > max_moment_degree) continue;
    const std::vector<double>& matrix = power_matrix(degree);
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
    const double* from = scaled.data() + donor_space->offset(ElementId(e)) * nc;
    double* to = powers.data() + donor_space->offset(ElementId(e)) * nc;
    for (std::size_t n = 0; n < size; ++n) {
      for (std::size_t m = 0; m < size; ++m) {
        const double factor = matrix[n * size + m];
        for (std::size_t c = 0; c < nc; ++c) to[m * nc + c] += factor * from[c * size + n];
      }
    }
  }
}

Group::Group(const OverlayMesh& donor, const OverlayMesh& target,
             std::shared_ptr<const Space> donor_space_in,
             std::shared_ptr<const Space> target_space_in, DonorDegree degree, int threads)
    : donor_space(std::move(donor_space_in)),
      target_space(std::move(target_space_in)),
      components(bernstein::triangle_size(degree.highest)),
      donor_degree(degree),
      donor_mapped(donor_space->basis() == Basis::reference && donor.degree > 1),
      target_mapped(target_space->basis() == Basis::reference && target.degree > 1) {
  make_frames(donor, target);
  const auto nc = static_cast<std::size_t>(components);
  for (int d = 0; d <= donor_degree.highest; ++d) {
    scaled_offset_.push_back(scaled.size());
    const auto factors = multinomials(d);
    for (std::size_t c = 0; c < nc; ++c) {
      for (std::size_t n = 0; n < factors.size(); ++n) scaled.push_back(n == c ? factors[n] : 0.0);
    }
  }
  const std::vector<double> integrals = field_detail::basis_integrals(*donor_space, threads);
  donor_mass.assign(donor.element_count() * nc, 0.0);
  for (std::size_t e = 0; e < donor.element_count(); ++e) {
    const ElementId id(e);
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(donor_space->degree(id)));
    std::copy_n(integrals.begin() + static_cast<std::ptrdiff_t>(donor_space->offset(id)), size,
                donor_mass.begin() + static_cast<std::ptrdiff_t>(e * nc));
  }
}

void Group::make_frames(const OverlayMesh& donor, const OverlayMesh& target) {
  if (!donor_mapped) {
    donor_frame.resize(donor.element_count());
    for (std::size_t e = 0; e < donor_frame.size(); ++e) {
      donor_frame[e] = donor_space->basis() == Basis::physical
                           ? donor_space->frame(ElementId(e))
                           : affine_frame(donor.corners(static_cast<std::int32_t>(e)));
    }
  }
  if (target_space->basis() == Basis::physical && target.degree == 1) {
    other_frame.resize(target.element_count());
    for (std::size_t e = 0; e < other_frame.size(); ++e) {
      const bool same =
          target.degree == 1 &&
          is_frame(target_space->frame(ElementId(e)), target.corners(static_cast<std::int32_t>(e)));
      other_frame[e] = same ? 0 : 1;
    }
  }
  if (!target_mapped) {
    target_frame.resize(target.element_count());
    for (std::size_t e = 0; e < target_frame.size(); ++e) {
      const auto t = static_cast<std::int32_t>(e);
      target_frame[e] = target_space->basis() == Basis::reference || target.degree == 1
                            ? affine_frame(target.corners(t))
                            : target_space->frame(ElementId(e));
    }
  }
}

std::span<const double> Group::donor_scaled(std::int32_t e) const {
  const ElementId id(e);
  const auto nc = static_cast<std::size_t>(components);
  const int degree = donor_space->degree(id);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
  if (!scaled_offset_.empty())
    return {scaled.data() + scaled_offset_[static_cast<std::size_t>(degree)], size * nc};
  return {scaled.data() + donor_space->offset(id) * nc, size * nc};
}

std::span<double> Group::target_out(std::int32_t e) {
  const ElementId id(e);
  const auto nc = static_cast<std::size_t>(components);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(target_space->degree(id)));
  return {out.data() + target_space->offset(id) * nc, size * nc};
}

std::array<double, 2> donor_place(const Group& g, const OverlayMesh& donor, std::int32_t d,
                                  const Vec2& x, std::array<double, 3>& warm, bool& have_warm) {
  if (!g.donor_mapped) {
    const auto lambda = g.donor_frame[static_cast<std::size_t>(d)].lambda(x);
    return {lambda[1], lambda[2]};
  }
  std::array<double, 3> lambda = warm;
  if (invert_map(donor.degree, donor.element(d), x, lambda, have_warm)) {
    warm = lambda;
    have_warm = true;
    return {lambda[1], lambda[2]};
  }
  // Outside the reach of the map (a point far outside a curved element): the nearest corner
  // direction.
  have_warm = false;
  const auto corners = donor.corners(d);
  const auto guess = affine_frame(corners).lambda(x);
  const double low = std::min({guess[0], guess[1], guess[2], 0.0});
  const double total = 1.0 - 3.0 * low;
  return {(guess[1] - low) / total, (guess[2] - low) / total};
}

}  // namespace bezel::detail
