#include "bezel/transfer/arrays.hpp"

#include "bezel/bernstein/triangle.hpp"

namespace bezel {
namespace {

std::shared_ptr<const TriangleMesh> make_mesh(const MeshArrays& arrays, const std::string& what) {
  const int g = arrays.degree;
  if (g < 1 || g > TriangleMesh::max_degree) {
    throw InputError(what + " mesh: degree " + std::to_string(g) +
                     " is not supported, expected 1 to " +
                     std::to_string(TriangleMesh::max_degree));
  }
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(g));
  if (arrays.coordinates.size() % 2 != 0) {
    throw InputError(what + " mesh: found " + std::to_string(arrays.coordinates.size()) +
                     " coordinates, expected two per node");
  }
  if (arrays.connectivity.size() % size != 0) {
    throw InputError(what + " mesh: found " + std::to_string(arrays.connectivity.size()) +
                     " node numbers, expected " + std::to_string(size) + " per triangle");
  }
  std::vector<Vec2> points(arrays.coordinates.size() / 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Vec2{{arrays.coordinates[2 * i], arrays.coordinates[2 * i + 1]}};
  }
  std::vector<NodeId> elements;
  elements.reserve(arrays.connectivity.size());
  for (const std::int32_t n : arrays.connectivity) elements.emplace_back(n);
  if (arrays.values == Values::bernstein || g == 1) {
    return std::make_shared<const TriangleMesh>(g, std::move(points), std::move(elements));
  }
  // Checks numbers and coordinates before they are used.
  const TriangleMesh nodal(g, points, elements);
  std::vector<char> done(points.size(), 0);
  std::vector<Vec2> control = points;
  for (std::size_t e = 0; e < nodal.element_count(); ++e) {
    // A node on an edge depends on that edge's nodes alone, so whichever element comes first
    // decides for both.
    const auto converted = bernstein::from_lagrange<Vec2>(g, nodal.gather(ElementId(e)));
    const auto nodes = nodal.nodes(ElementId(e));
    for (std::size_t i = 0; i < size; ++i) {
      if (!done[nodes[i].index()]) control[nodes[i].index()] = converted[i];
      done[nodes[i].index()] = 1;
    }
  }
  return std::make_shared<const TriangleMesh>(g, std::move(control), std::move(elements));
}

/// Converts element by element between nodal values and Bernstein coefficients, components
/// interleaved.
template <class Convert>
std::vector<double> convert(std::span<const double> values, std::size_t size,
                            std::size_t components, const Convert& change) {
  std::vector<double> out(values.size());
  std::vector<double> one(size);
  for (std::size_t begin = 0; begin < values.size(); begin += size * components) {
    for (std::size_t c = 0; c < components; ++c) {
      for (std::size_t i = 0; i < size; ++i) one[i] = values[begin + i * components + c];
      const std::vector<double> changed = change(one);
      for (std::size_t i = 0; i < size; ++i) out[begin + i * components + c] = changed[i];
    }
  }
  return out;
}

}  // namespace

ArraysResult transfer(const MeshArrays& donor, std::span<const FieldArrays> fields,
                      const MeshArrays& target, const TransferOptions& options,
                      const Progress& progress) {
  const auto donor_mesh = make_mesh(donor, "donor");
  const auto target_mesh = make_mesh(target, "target");
  std::vector<Field> donors;
  std::vector<std::shared_ptr<const Space>>
      spaces;  // one per (degree, basis), so that fields share a pass
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const FieldArrays& f = fields[i];
    if (f.values == Values::nodal && f.basis == Basis::physical) {
      throw InputError(
          "field " + std::to_string(i) +
          ": nodal values of a physical basis are not supported, expected Bernstein coefficients");
    }
    std::shared_ptr<const Space> space;
    for (const auto& known : spaces) {
      if (known->uniform_degree() == f.degree && known->basis() == f.basis) space = known;
    }
    if (!space) {
      space = Space::discontinuous(donor_mesh, f.degree, f.basis);
      spaces.push_back(space);
    }
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(f.degree));
    const auto components = static_cast<std::size_t>(f.components > 0 ? f.components : 1);
    const std::size_t expected = donor_mesh->element_count() * size * components;
    if (f.coefficients.size() != expected) {
      throw InputError("field " + std::to_string(i) + ": found " +
                       std::to_string(f.coefficients.size()) + " values, expected " +
                       std::to_string(expected));
    }
    std::vector<double> coefficients(f.coefficients.begin(), f.coefficients.end());
    if (f.values == Values::nodal) {
      coefficients = convert(coefficients, size, components, [&](std::span<const double> one) {
        return bernstein::from_lagrange<double>(f.degree, one);
      });
    }
    donors.emplace_back(std::to_string(i), space, std::move(coefficients), f.components);
  }
  TransferResult moved = transfer(donors, target_mesh, options, progress);
  ArraysResult result;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Field& f = moved.fields[i];
    const int degree = f.space().uniform_degree();
    if (fields[i].values == Values::nodal && f.space().basis() == Basis::reference) {
      result.coefficients.push_back(
          convert(f.coefficients(), static_cast<std::size_t>(bernstein::triangle_size(degree)),
                  static_cast<std::size_t>(f.components()), [&](std::span<const double> one) {
                    return bernstein::to_lagrange<double>(degree, one);
                  }));
    } else {
      result.coefficients.emplace_back(f.coefficients().begin(), f.coefficients().end());
    }
  }
  result.report = std::move(moved.report);
  return result;
}

}  // namespace bezel
