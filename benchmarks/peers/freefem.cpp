#include "peers/freefem.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace peers {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that goes away again.
struct Workplace {
  fs::path path;
  Workplace() {
    std::string name = (fs::temp_directory_path() / "freefem-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for FreeFEM's files");
    path = name;
  }
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

/// FreeFEM's own format: numbers of vertices, triangles and boundary edges, then these.
void write_mesh(const fs::path& path, const bezel::TriangleMesh& mesh) {
  std::ofstream out(path);
  out.precision(17);
  std::size_t boundary = 0;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e)
    if (mesh.adjacent(bezel::EdgeId(e)).size() == 1) ++boundary;
  out << mesh.node_count() << ' ' << mesh.element_count() << ' ' << boundary << '\n';
  for (const bezel::Vec2& p : mesh.control()) out << p.x() << ' ' << p.y() << " 0\n";
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    for (const bezel::NodeId n : mesh.nodes(bezel::ElementId(e))) out << n.value + 1 << ' ';
    out << "0\n";
  }
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    if (mesh.adjacent(bezel::EdgeId(e)).size() != 1) continue;
    for (const bezel::NodeId n : mesh.edge_nodes(bezel::EdgeId(e))) out << n.value + 1 << ' ';
    out << "1\n";
  }
}

}  // namespace

std::array<Transferred, 2> freefem_transfer(const bezel::TriangleMesh& donor,
                                            const bezel::TriangleMesh& target, int degree,
                                            int rounds) {
  const Workplace place;
  write_mesh(place.path / "donor.msh", donor);
  write_mesh(place.path / "target.msh", target);
  std::ofstream script(place.path / "run.edp");
  if (degree == 3) script << "load \"Element_P3dc\"\n";
  script << "macro Element() P" << degree << "dc // EOM\n"
         << "int degree = " << degree << ", rounds = " << rounds << ";\n"
         << "string donorFile = \"donor.msh\", targetFile = \"target.msh\", "
         << "resultFile = \"result\";\n"
         << "include \"" << BEZEL_FREEFEM_SCRIPT << "\"\n";
  script.close();
  const std::string command = "cd '" + place.path.string() +
                              "' && FF_LOADPATH=" BEZEL_FREEFEM_PLUGINS " " BEZEL_FREEFEM
                              " -nw -v 0 -ne run.edp > log 2>&1";
  std::array<Transferred, 2> found{};
  std::ifstream result;
  if (std::system(command.c_str()) == 0) result.open(place.path / "result");
  for (Transferred& t : found) result >> t.seconds >> t.l2_relative >> t.mass_defect;
  if (!result) throw std::runtime_error("FreeFEM failed");
  return found;
}

}  // namespace peers
