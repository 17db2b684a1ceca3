#pragma once
// Internal: polynomial weights and products of fields.

#include <memory>
#include <string>

#include "bezel/field/field.hpp"

namespace bezel::detail {

inline constexpr int max_weight_degree = 4;

/// The smallest degree at which the formula is a polynomial in x and y on the mesh.
/// @param what  "donor" or "target", for messages
/// @throws InputError when there is none up to max_weight_degree, or the formula is not finite
int weight_degree(const Formula& weight, const std::shared_ptr<const TriangleMesh>& mesh,
                  const std::string& what, int threads);

/// The weight as a field of that degree, in physical basis on the default frames.
/// @throws InputError naming a triangle where it is negative, or zero everywhere
Field weight_field(const Formula& weight, int degree,
                   const std::shared_ptr<const TriangleMesh>& mesh, const std::string& what,
                   int threads);

/// A physical-basis field of one component as polynomials in the coordinates of another space: the
/// reference ones (degree times the mesh's), or the frames of that space.
Field in_coordinates_of(const Space& space, const Field& physical);

/// The product of a scalar with each component of f, both in the coordinates of `into`, whose
/// degree is at least the sum of theirs; with shift (shape (elements, components)), of f - shift.
Field product(const Field& scalar, const Field& f, std::span<const double> shift,
              const std::shared_ptr<const Space>& into);

}  // namespace bezel::detail
