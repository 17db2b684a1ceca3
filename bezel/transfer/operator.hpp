#pragma once
// Transfer between two meshes as a linear operator: the geometry is done once, then applied.

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "bezel/transfer/transfer.hpp"

namespace bezel {

class AtomicFile;
namespace detail {
struct OperatorBy;
}

/// The transfer from one donor space to a target mesh, kept as one dense block per pair of elements
/// that overlap: block (T, D) takes the donor's Bernstein coefficients on D to their share of the
/// target's on T. Immutable; may be applied from several threads at once.
///
/// Identities, each tested:
/// (1) apply(f) equals transfer(f) up to rounding, and conserves mass as well;
/// (2) the L2 product of apply(f) with g over the target equals that of f with apply_adjoint(g)
///     over the donor;
/// (3) the matrix written by write_matrix_market() times the coefficients of f gives those of
///     apply(f).
class TransferOperator {
 public:
  /// @param donor    where the fields live; a continuous space is taken element by element
  /// @param target   mesh to go to
  /// @param options  as in transfer(); no weight, no density, no bounds (they go with apply())
  /// @throws InputError, UncoveredError, NumericsError as transfer()
  /// @cost     the geometry and integrals of about size/3 fields at once, size being the number of
  ///           coefficients of a donor element. Memory: 8 (n_T + 1) n_D bytes per pair of elements,
  ///           n coefficients on each (0.1 GB per million pairs at degree 1, 0.3 at 2, 0.9 at 3)
  TransferOperator(std::shared_ptr<const Space> donor, std::shared_ptr<const TriangleMesh> target,
                   const TransferOptions& options = {}, const Progress& progress = {});
  TransferOperator(TransferOperator&&) noexcept;
  TransferOperator& operator=(TransferOperator&&) noexcept;
  ~TransferOperator();

  const std::shared_ptr<const Space>& donor_space() const;
  const std::shared_ptr<const Space>& target_space() const;
  /// What the geometry found; no fields.
  const TransferReport& report() const;
  /// Pairs of elements with a block.
  std::size_t block_count() const;
  /// Memory of the blocks.
  std::size_t bytes() const;
  /// Whether fields on that space can be applied: the same mesh (compared by value), degrees, basis
  /// and frames as the donor's.
  bool accepts(const Space& space) const;

  /// The field on the target.
  /// @throws InputError when the field lives on another space (see accepts())
  /// @accuracy constants come back to rounding on elements that are covered; the mass received by
  ///           every element is closed to rounding
  /// @cost     2 n_T n_D operations per pair and component
  Field apply(const Field& donor, int threads = 0) const;
  /// apply(), then each component is moved into bounds without changing its mass, as transfer()
  /// does: no linear map any more, and neither the adjoint's nor the matrix's.
  /// @throws InputError also for bounds that are not ascending, or leave out 0 where uncovered
  ///         parts count as 0; NumericsError when they cannot hold the mass
  Field apply(const Field& donor, const Bounds& bounds, int threads = 0) const;
  /// apply() to several fields, with the report of transfer().
  TransferResult transfer(std::span<const Field> donors, int threads = 0) const;
  TransferResult transfer(std::span<const Field> donors, const Bounds& bounds,
                          int threads = 0) const;
  /// The adjoint in L2: the field a on the donor with (a, f) = (apply(f), g) for all f of the donor
  /// space (element by element also where that space is continuous).
  /// @throws InputError when the field does not live on the target space
  /// @cost   as apply(), and one small solve per donor element
  Field apply_adjoint(const Field& target, int threads = 0) const;

  /// Writes the matrix in Matrix Market form (coordinate, real, general), atomically: one row per
  /// target coefficient, one column per donor coefficient, numbered from 1 in the order of
  /// Field::coefficients() of one component. Entries that are exactly 0 are left out; numbers
  /// round-trip.
  /// @throws InputError when the file cannot be written
  void write_matrix_market(const std::string& path) const;
  /// The same into a file that the caller commits.
  void write_matrix_market(AtomicFile& file) const;

 private:
  friend struct detail::OperatorBy;
  struct Impl;
  explicit TransferOperator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace bezel
