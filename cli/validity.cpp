#include "cli/validity.hpp"

#include "bezel/base/parallel.hpp"

namespace bezel::cli {

MeshValidity check_elements(const TriangleMesh& mesh, int threads) {
  MeshValidity result;
  result.elements.resize(mesh.element_count());
  constexpr std::size_t block = 256;
  const std::size_t blocks = (mesh.element_count() + block - 1) / block;
  parallel_for(
      blocks,
      [&](std::size_t b) {
        std::vector<Vec2> control(static_cast<std::size_t>(mesh.nodes_per_element()));
        const std::size_t end = std::min(mesh.element_count(), (b + 1) * block);
        for (std::size_t e = b * block; e < end; ++e) {
          mesh.gather(ElementId(e), control);
          result.elements[e] = check_validity(mesh.degree(), control);
        }
      },
      threads);
  for (std::size_t e = 0; e < result.elements.size(); ++e) {
    switch (result.elements[e].status) {
      case Validity::valid:
        ++result.valid;
        break;
      case Validity::inverted:
        result.inverted.push_back(e);
        break;
      case Validity::undecided:
        result.undecided.push_back(e);
        break;
    }
  }
  return result;
}

}  // namespace bezel::cli
