#pragma once
// Transfer of the steps of a time series to one mesh.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "bezel/transfer/operator.hpp"

namespace bezel {

class Processes;

/// Moves the fields of one time step after the other; operators are kept as long as the donor mesh
/// stays the same, so that the geometry is done once.
class TransferSeries {
 public:
  /// Operators that would take more bytes than this are not made; each step is transferred anew.
  static constexpr std::size_t default_memory = std::size_t{2} << 30;

  /// @param options    as in transfer(). A weight or density means a transfer anew for each step
  /// @param processes  where given, they share the work on the target elements, here on rank 0
  explicit TransferSeries(std::shared_ptr<const TriangleMesh> target, TransferOptions options = {},
                          std::size_t memory = default_memory, Processes* processes = nullptr);

  /// transfer() for one step.
  /// @param comes_again  the next step has the same mesh, so an operator is worth making
  /// @throws as transfer()
  TransferResult step(std::span<const Field> donors, bool comes_again,
                      const Progress& progress = {});
  /// How many times the geometry was done.
  std::size_t geometries() const { return geometries_; }

 private:
  bool worth_keeping(const Field& field) const;

  std::shared_ptr<const TriangleMesh> target_;
  TransferOptions options_;
  std::size_t memory_;
  Processes* processes_;
  std::vector<TransferOperator> operators_;  // of one donor mesh
  std::size_t geometries_ = 0;
};

}  // namespace bezel
