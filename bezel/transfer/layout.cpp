#include "bezel/transfer/layout.hpp"

#include <algorithm>

namespace bezel::detail {

bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return &a == &b ||
         (a.degree() == b.degree() && std::ranges::equal(a.connectivity(), b.connectivity()) &&
          std::ranges::equal(a.control(), b.control()));
}

bool same_layout(const Space& a, const Space& b) {
  if (&a == &b) return true;
  if (a.basis() != b.basis() || !same_mesh(*a.mesh(), *b.mesh())) return false;
  for (std::size_t e = 0; e < a.mesh()->element_count(); ++e) {
    if (a.degree(ElementId(e)) != b.degree(ElementId(e))) return false;
  }
  return std::ranges::equal(a.frames(), b.frames());
}

}  // namespace bezel::detail
