#pragma once
// Internal to io: any field as a reference-basis field of one degree, and back.

#include <memory>
#include <string>
#include <vector>

#include "bezel/io/metadata.hpp"

namespace bezel::files {

/// Bernstein coefficients in reference coordinates, shape (elements, triangle_size(degree),
/// components).
struct MappedField {
  std::string name;
  int components = 1;
  int degree = 0;
  std::vector<double> coefficients;
};

/// Degree at which a field is a reference-basis polynomial on every element: its highest degree,
/// times the geometric degree in the physical basis.
/// @throws InputError when that is above 10
int mapped_degree(const Field& field);

/// The field raised to `degree` >= mapped_degree(field) in the reference basis: the same function.
MappedField map_field(const Field& field, int degree);

/// The sentence that says a field had to be raised, or nothing. `degree`: what it was raised to.
void say_raised(const Field& field, int degree, std::vector<std::string>& lost);

/// The same coefficients raised or reduced (L2 per element).
MappedField change_degree(const MappedField& field, int degree);

/// A field from what a file held. With metadata its basis, degrees and continuity come back;
/// metadata that does not describe the coefficients (to 1e-8 of the largest) is not believed, which
/// goes into notes. Without it the field is of one degree in the reference basis, continuous when
/// `continuous`.
Field restore_field(const std::shared_ptr<const TriangleMesh>& mesh, MappedField field,
                    const FieldMetadata* metadata, bool continuous,
                    std::vector<std::string>& notes);

/// Per-element coefficients -> values per node of the mesh (the first element that has the node).
std::vector<double> per_node(const TriangleMesh& mesh, std::span<const NodeId> connectivity,
                             std::size_t node_count, const MappedField& field);

}  // namespace bezel::files
