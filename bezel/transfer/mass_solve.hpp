#pragma once
// Internal: the mass matrix of a continuous space and the solution of systems with it.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bezel/field/space.hpp"

namespace bezel::detail {

/// Systems of at most this many degrees of freedom are solved by sparse Cholesky.
inline constexpr std::size_t direct_limit = 2000;

struct MassSolution {
  std::vector<double> dofs;
  int iterations = 0;            ///< of conjugate gradients; 0 when solved directly
  double relative_residual = 0;  ///< |A^T M (c - A x)| / |A^T M c|, over the dofs solved for
};

/// M = sum over elements of A_e^T M_e A_e for a continuous space in reference basis: kept as one
/// Cholesky factor M_e = L_e L_e^T per element, never assembled but for small spaces.
///
/// All sums run in an order that depends on the mesh alone: same bits for any number of threads.
/// Memory per element with n = triangle_size(degree) coefficients: 8 n (n + 1) / 2 bytes for L_e
/// (none on straight meshes, which share one), 28 n for the rest.
class ContinuousMass {
 public:
  /// @param space  continuous
  /// @param fixed  empty, or per dof whether solve() keeps its value instead of solving for it
  /// @param largest_direct  sparse Cholesky up to this many dofs, conjugate gradients above
  /// @throws NumericsError naming the triangle when a mass matrix is not positive definite
  ContinuousMass(std::shared_ptr<const Space> space, std::vector<char> fixed, int threads,
                 std::size_t largest_direct = direct_limit);
  ~ContinuousMass();
  ContinuousMass(const ContinuousMass&) = delete;
  ContinuousMass& operator=(const ContinuousMass&) = delete;

  const std::shared_ptr<const Space>& space() const { return space_; }
  bool direct() const { return direct_; }
  /// Element e's mass matrix, row major.
  void element_matrix(std::size_t e, std::span<double> out) const;
  /// Integrals of the elements' basis functions, as the factors have them: shape
  /// (coefficient_count).
  const std::vector<double>& integrals() const { return integrals_; }

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
  void factorise();
  void assemble();
  void multiply_block(std::size_t block, double* v) const;
  void mask(std::vector<double>& v) const;
  std::vector<double> residual(std::span<const double> c, std::span<const double> x);
  int conjugate_gradients(std::vector<double> r, double smallest, std::span<double> x);
  double dot(std::span<const double> a, std::span<const double> b);

  struct Direct;
  std::shared_ptr<const Space> space_;
  std::vector<char> fixed_;
  int threads_;
  std::size_t size_, elements_, blocks_;
  bool straight_, direct_;
  std::vector<double> lower_;    ///< per block of elements: packed factor, lane by lane
  std::vector<double> inverse_;  ///< reciprocals of the factor's diagonal, the same way
  std::vector<double> scale_;    ///< straight meshes: twice the area of each element
  std::vector<double> share_;    ///< W_e, in the order of local_
  std::vector<double> integrals_;
  std::vector<std::size_t> begin_;    ///< per dof, where its entries start
  std::vector<std::uint32_t> entry_;  ///< places in local_
  std::vector<double> local_, partial_;
  std::unique_ptr<Direct> solver_;
};

}  // namespace bezel::detail
