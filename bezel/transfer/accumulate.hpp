#pragma once
// Internal: sums of w f phi over quadrature points, vectorised across points.

#include <cstddef>
#include <span>

#include "bezel/bernstein/multinomial.hpp"
#include "bezel/numeric/lanes.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::detail {

/// Structure of arrays of quadrature points; every array holds blocks * lanes values, padded with
/// weight 0.
struct PointBlock {
  const double* weight;
  const double *target_u, *target_v;  ///< barycentrics 1 and 2 in the target polynomial's triangle
  const double *donor_u, *donor_v;    ///< the same for the donor
  std::size_t blocks;
};

/// For the powers m_n = l0^i l1^j l2^k in index order (no multinomial factors):
///   product[n * components + c] += sum_q w f_c m_n(target point),  basis[n] += sum_q w m_n,
///   mass[c] += sum_q w f_c, with f_c = sum_n scaled[c * size + n] m_n(donor point).
/// The order of the additions does not depend on the machine's vector width: same bits everywhere.
void accumulate(int target_degree, int donor_degree, int components, const double* scaled,
                const PointBlock& points, double* product, double* basis, double* mass);

/// A map of the reference triangle at many points: x, y and its Jacobian determinant there. The
/// same bits on every machine.
/// @param control  triangle_size(degree) control points, 1 <= degree <= 10
/// @param u, v     with x, y, det arrays of blocks * lanes values
void map_points(int degree, const Vec2* control, std::size_t blocks, const double* u,
                const double* v, double* x, double* y, double* det);

/// values[c] = f_c at one point.
void evaluate_scaled(int degree, int components, const double* scaled, double u, double v,
                     double* values);

/// Values of the Bernstein basis of degree 0..10 at barycentrics (1-u-v, u, v).
void basis_at(int degree, double u, double v, double* values);

using bernstein::multinomials;

}  // namespace bezel::detail
