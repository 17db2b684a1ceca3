#pragma once
// Meshes and fields for the tests of files.

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bezel/field/field.hpp"
#include "bezel/io/io.hpp"
#include "bezel/mesh/generate.hpp"

namespace bezel::io_test {

/// A folder of its own that goes away with the object.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "bezel-io-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}
inline void spill(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::shared_ptr<const TriangleMesh> disc(int degree, double size = 0.9) {
  GenerateOptions options;
  options.degree = degree;
  options.size = size;
  options.centre = {1.0 / 3.0, -1.0 / 7.0};
  return std::make_shared<TriangleMesh>(generate_disc(1.1, options));
}

/// The disc with a surface in two groups, another named group, and tagged points.
inline std::shared_ptr<const TriangleMesh> tagged_disc(int degree, double size = 0.9) {
  const auto mesh = disc(degree, size);
  Tags tags = mesh->tags();
  tags.groups = {{1, 7, "rim"}, {2, 3, "inside"}, {2, 9, ""}, {0, 4, "corner points"}};
  tags.entities = {{0, 5, {4}}, {1, 2, {7}}, {1, 6, {}}, {2, 8, {3, 9}}, {2, 11, {9}}};
  for (std::size_t e = 0; e < mesh->element_count(); ++e)
    tags.element_entity.resize(mesh->element_count());
  for (std::size_t e = 0; e < mesh->element_count(); ++e)
    tags.element_entity[e] = e % 3 == 0 ? 11 : 8;
  for (std::size_t i = 0; i < tags.edges.size(); ++i) tags.edges[i].entity = i % 2 == 0 ? 2 : 6;
  tags.points = {{mesh->nodes(ElementId(0))[0], 5}};
  return std::make_shared<TriangleMesh>(
      degree, std::vector<Vec2>(mesh->control().begin(), mesh->control().end()),
      std::vector<NodeId>(mesh->connectivity().begin(), mesh->connectivity().end()), tags);
}

/// Polynomials with coefficients that have infinite decimals: element e, coefficient i, component
/// c.
inline Field wavy(const std::string& name, std::shared_ptr<const Space> space, int components = 1) {
  const std::size_t n =
      (space->continuity() == Continuity::continuous ? space->dof_count()
                                                     : space->coefficient_count());
  std::vector<double> dofs;
  for (std::size_t i = 0; i < n * static_cast<std::size_t>(components); ++i)
    dofs.push_back(std::sin(1.0 + 0.37 * static_cast<double>(i)) / 3.0);
  std::vector<double> coefficients = space->expand(dofs, components);
  return Field(name, std::move(space), std::move(coefficients), components);
}

inline std::vector<int> varying_degrees(std::size_t elements, int lowest, int highest) {
  std::vector<int> degrees;
  for (std::size_t e = 0; e < elements; ++e)
    degrees.push_back(lowest + static_cast<int>(e) % (highest - lowest + 1));
  return degrees;
}

}  // namespace bezel::io_test
