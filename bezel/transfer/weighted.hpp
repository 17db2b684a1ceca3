#pragma once
// Internal: transfer in a weighted inner product, and of densities with what they carry.

#include <memory>
#include <span>

#include "bezel/transfer/sweep.hpp"

namespace bezel::detail {

/// transfer_by() with a weight or a density: the products of the fields with them are transferred,
/// and the fields recovered element by element.
TransferResult transfer_weighted(const Crew& crew, std::span<const Field> donors,
                                 const std::shared_ptr<const TriangleMesh>& target,
                                 const TransferOptions& options, const Progress& progress);

}  // namespace bezel::detail
