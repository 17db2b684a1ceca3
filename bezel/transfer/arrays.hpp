#pragma once
// Transfer between meshes and fields that a solver holds in its own arrays: no files, no Bezel
// objects to build.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/transfer/transfer.hpp"

namespace bezel {

/// What the numbers of an array stand for.
enum class Values {
  bernstein,  ///< control points, Bernstein coefficients
  nodal  ///< points of the curved element, values of the field: at the equally spaced nodes (i, j,
         ///< k) / degree
};

/// A triangle mesh in arrays. The order of an element's nodes is bernstein/index.hpp's: rows of
/// constant third index from the side between corners 0 and 1; degree 2: 200 110 020 101 011 002.
struct MeshArrays {
  int degree = 1;                              ///< geometric degree g, 1..10
  std::span<const double> coordinates;         ///< shape (nodes, 2)
  std::span<const std::int32_t> connectivity;  ///< shape (elements, (g+1)(g+2)/2), zero-based
  Values values = Values::bernstein;
};

/// A discontinuous field in arrays: the same degree on every element.
struct FieldArrays {
  int degree = 1;      ///< 0..10
  int components = 1;  ///< 1..9
  Basis basis =
      Basis::reference;  ///< physical: coefficients on element_frame() of each element; not nodal
  std::span<const double> coefficients;  ///< shape (elements, (d+1)(d+2)/2, components)
  Values values = Values::bernstein;
};

struct ArraysResult {
  std::vector<std::vector<double>>
      coefficients;       ///< per field, shape (target elements, size, components), of the
                          ///< same kind (Bernstein or nodal) as the donor's
  TransferReport report;  ///< fields are named "0", "1", …
};

/// transfer() on arrays. The arrays are read during the call only.
/// @param options  as in transfer(); the result's degree and basis follow from it
/// @throws InputError as transfer() and the constructors of mesh and field, and for sizes that do
/// not fit
/// @cost   one copy of the arrays
ArraysResult transfer(const MeshArrays& donor, std::span<const FieldArrays> fields,
                      const MeshArrays& target, const TransferOptions& options = {},
                      const Progress& progress = {});

}  // namespace bezel
