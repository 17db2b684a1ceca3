#pragma once
// Internal: the mass matrix of a continuous space and the solution of systems with it.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bezel/field/field.hpp"
#include "bezel/transfer/element_factors.hpp"
#include "bezel/transfer/mass_system.hpp"
#include "bezel/transfer/transfer.hpp"

namespace bezel::detail {

/// MassMethod::automatic: sparse Cholesky up to this many degrees of freedom, conjugate gradients
/// above.
inline constexpr std::size_t direct_limit = 2000;

struct MassSolution {
  std::vector<double> dofs;
  int iterations = 0;            ///< 0 when solved directly
  double relative_residual = 0;  ///< |A^T M (c - A x)| / |A^T M c|, over the dofs solved for
};

/// M = sum over elements of A_e^T M_e A_e for a continuous space in reference basis: kept as one
/// Cholesky factor M_e = L_e L_e^T per element, never assembled but for small spaces.
///
/// All sums run in an order that depends on the mesh alone: same bits for any number of threads.
/// Memory per element of n coefficients: that of ElementFactors, and 28 n bytes.
class ContinuousMass {
 public:
  /// @param space  continuous
  /// @param fixed  empty, or per dof whether solve() keeps its value instead of solving for it
  /// @param weight  positive, of one component, on the same mesh: M_e holds integrals of weight phi
  ///                phi; null: 1
  /// @param make_system  of MassMethod::petsc; empty: PETSc in this process
  /// @throws NumericsError naming the triangle when a mass matrix is not positive definite;
  ///         InputError for petsc in a build without it
  ContinuousMass(std::shared_ptr<const Space> space, std::vector<char> fixed, int threads,
                 MassMethod method = MassMethod::automatic, const Field* weight = nullptr,
                 const MassSystemMaker& make_system = {});
  ~ContinuousMass();
  ContinuousMass(const ContinuousMass&) = delete;
  ContinuousMass& operator=(const ContinuousMass&) = delete;

  const std::shared_ptr<const Space>& space() const { return space_; }
  MassMethod method() const { return method_; }  ///< the one used, not automatic
  /// Element e's mass matrix, row major.
  void element_matrix(std::size_t e, std::span<double> out) const { factors_.matrix(e, out); }
  /// Integrals of the elements' basis functions (times the weight), as the factors have them: shape
  /// (coefficient_count).
  const std::vector<double>& integrals() const { return factors_.integrals(); }

  /// y = A^T M c for coefficients c of the elements.
  void load(std::span<const double> c, std::span<double> y);
  /// y = M x.
  void apply(std::span<const double> x, std::span<double> y);
  /// z = sum over elements of A_e^T W_e M_e^-1 W_e A_e r, W_e the element's share of each dof: an
  /// additive Schwarz method whose condition does not depend on the mesh.
  void precondition(std::span<const double> r, std::span<double> z);
  /// The mean of the elements' coefficients for each dof, weighted by their shares.
  void average(std::span<const double> c, std::span<double> x);

  /// The continuous field nearest in L2 to element coefficients c: A^T M A x = A^T M c.
  /// @param given  per dof, the values of the fixed ones; empty without any
  /// @throws NumericsError when the relative residual stays above 1e-12
  MassSolution solve(std::span<const double> c, std::span<const double> given = {});

 private:
  template <class Source, class Work>
  void by_elements(const Source& source, const Work& work, std::span<double> y);
  void assemble_cholesky();
  void assemble_elsewhere(const MassSystemMaker& make_system);
  void mask(std::vector<double>& v) const;
  std::vector<double> residual(std::span<const double> c, std::span<const double> x);
  int conjugate_gradients(std::vector<double> r, double smallest, std::span<double> x);
  double dot(std::span<const double> a, std::span<const double> b);

  struct Direct;
  std::shared_ptr<const Space> space_;
  std::vector<char> fixed_;
  int threads_;
  ElementFactors factors_;
  std::size_t size_, elements_;
  MassMethod method_;
  std::vector<double> share_;         ///< W_e, in the order of local_
  std::vector<std::size_t> begin_;    ///< per dof, where its entries start
  std::vector<std::uint32_t> entry_;  ///< places in local_
  std::vector<double> local_, partial_;
  std::unique_ptr<Direct> solver_;
  std::unique_ptr<MassSystem> elsewhere_;
};

}  // namespace bezel::detail
