#pragma once
// Internal: transfer operators whose elements are worked on elsewhere.

#include <memory>

#include "bezel/transfer/operator.hpp"
#include "bezel/transfer/sweep.hpp"

namespace bezel::detail {

/// TransferOperator's constructor with the target elements worked on by `sweeper`.
struct OperatorBy {
  static TransferOperator make(const Sweeper& sweeper, std::shared_ptr<const Space> donor,
                               std::shared_ptr<const TriangleMesh> target,
                               const TransferOptions& options, const Progress& progress);
};

}  // namespace bezel::detail
