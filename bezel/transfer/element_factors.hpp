#pragma once
// Internal: the mass matrices of all elements of a space as Cholesky factors, worked on eight at a
// time.

#include <cstddef>
#include <span>
#include <vector>

#include "bezel/field/field.hpp"

namespace bezel::detail {

/// M_e = L_e L_e^T for every element of a space in reference basis with one degree; the factor
/// serves to multiply and to divide. Elements are taken in blocks of `width`, one to a lane:
/// element e is lane e % width of block e / width, and arrays of a block have shape (size, width).
class ElementFactors {
 public:
  static constexpr std::size_t width = 8;

  /// @param weight  positive, of one component, on the same mesh: M_e holds integrals of weight phi
  ///                phi; null: 1
  /// @throws NumericsError naming the triangle whose matrix is not positive definite
  /// @cost   memory 8 n (n + 1) / 2 bytes per element of n coefficients; straight meshes without
  ///         weight share one factor
  ElementFactors(const Space& space, const Field* weight, int threads);

  std::size_t size() const { return size_; }  ///< coefficients per element
  std::size_t element_count() const { return elements_; }
  std::size_t block_count() const { return blocks_; }
  /// Place of coefficient i of element e in arrays of all blocks.
  std::size_t place(std::size_t e, std::size_t i) const {
    return (e / width * size_ + i) * width + e % width;
  }

  /// v = M v for the elements of a block.
  void multiply(std::size_t block, double* v) const;
  /// v = M^-1 v.
  void divide(std::size_t block, double* v) const;
  /// Element e's matrix, row major.
  void matrix(std::size_t e, std::span<double> out) const;
  /// Diagonals of the matrices, in the order of place().
  const std::vector<double>& diagonal() const { return diagonal_; }
  /// Integrals of the basis functions (times the weight), shape (elements, size).
  const std::vector<double>& integrals() const { return integrals_; }

 private:
  void factorise_straight(const Space& space);
  void factorise(const Space& space, const Field* weight, int threads);

  std::size_t size_, elements_, blocks_;
  bool straight_;
  std::vector<double> lower_;    ///< packed factors; one for all when straight
  std::vector<double> inverse_;  ///< reciprocals of their diagonals, the same way
  std::vector<double> scale_;    ///< straight: twice the area of each element
  std::vector<double> diagonal_, integrals_;
};

}  // namespace bezel::detail
