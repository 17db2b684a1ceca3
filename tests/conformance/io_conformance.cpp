// Our files against Gmsh and VTK. usage: conformance_io CASE PROGRAM [SCRIPT]; exits with 77 when
// the program is not there, with 1 after the first difference.

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "bezel/bernstein/triangle.hpp"
#include "tests/unit/io/datasets.hpp"

namespace bezel {
namespace {

using bernstein::Lambda;
using io_test::Folder;

constexpr int skipped = 77;
int failures = 0;

void expect(bool good, const std::string& what) {
  if (good) return;
  ++failures;
  fmt::print("FAILED: {}\n", what);
}

int run(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

std::string quoted(const std::string& text) {
  return fmt::format("'{}'", text);
}

std::vector<Lambda> lattice(int d) {
  std::vector<Lambda> points;
  for (int n = 0; n < bernstein::triangle_size(d); ++n) {
    const auto index = bernstein::triangle_multi_index(d, n);
    points.push_back({double(index[0]) / d, double(index[1]) / d, double(index[2]) / d});
  }
  return points;
}

Vec2 position(const TriangleMesh& mesh, std::size_t e, const Lambda& lambda) {
  const auto control = mesh.gather(ElementId(e));
  return bernstein::evaluate<Vec2>(mesh.degree(), control, lambda);
}

/// Largest distance of points of equal parameters, whatever the order of the elements.
double difference(const TriangleMesh& a, const TriangleMesh& b) {
  if (a.element_count() != b.element_count() || a.degree() != b.degree()) return 1e300;
  double worst = 0.0;
  for (std::size_t e = 0; e < a.element_count(); ++e) {
    double best = 1e300;
    for (std::size_t f = 0; f < b.element_count() && best > 1e-9; ++f) {
      double d = 0.0;
      for (const Lambda& l : lattice(7)) {
        d = std::max(d, norm(position(a, e, l) - position(b, f, l)));
        if (d > 1e-6) break;  // another element
      }
      best = std::min(best, d);
    }
    worst = std::max(worst, best);
  }
  return worst;
}

const std::array<Format, 4> msh_formats{Format::msh22_ascii, Format::msh22_binary,
                                        Format::msh41_ascii, Format::msh41_binary};

std::string gmsh_format(Format format) {
  const bool v2 = format == Format::msh22_ascii || format == Format::msh22_binary;
  const bool binary = format == Format::msh22_binary || format == Format::msh41_binary;
  return std::string(v2 ? " -format msh22" : " -format msh41") + (binary ? " -bin" : "");
}

/// Gmsh reads our files without a complaint and writes them again: the same mesh.
void gmsh_reads_ours(const std::string& gmsh) {
  for (int g = 1; g <= 10; ++g) {
    Dataset data;
    data.mesh = io_test::tagged_disc(g);
    for (std::size_t f = 0; f < msh_formats.size(); ++f) {
      const Folder folder;
      write(folder / "ours.msh", data, {msh_formats[f], false, true});
      // Another format on the way back, so that degree by degree all pairs are met.
      const Format other = msh_formats[(f + static_cast<std::size_t>(g)) % msh_formats.size()];
      const int status = run(gmsh + " " + quoted(folder / "ours.msh") + " -0 -save_all -o " +
                             quoted(folder / "theirs.msh") + gmsh_format(other) + " > " +
                             quoted(folder / "log") + " 2>&1");
      const std::string log = io_test::slurp(folder / "log");
      const std::string name =
          fmt::format("degree {}, {} to {}", g, to_string(msh_formats[f]), to_string(other));
      expect(status == 0 && log.find("Error") == std::string::npos &&
                 log.find("Warning") == std::string::npos,
             name + ": gmsh said\n" + log);
      const Dataset back = read(folder / "theirs.msh");
      const double d = difference(*data.mesh, *back.mesh);
      expect(d <= 1e-14, fmt::format("{}: positions differ by {}", name, d));
      expect(back.mesh->tags().edges.size() == data.mesh->tags().edges.size() &&
                 back.mesh->tags().points.size() == data.mesh->tags().points.size(),
             name + ": tagged edges or points are missing");
      expect(back.mesh->edge_count() == data.mesh->edge_count(), name + ": edges are not shared");
    }
  }
}

/// Gmsh refines our elements for display: positions and values at the lattice of its triangles.
void gmsh_shows_fields(const std::string& gmsh) {
  for (const int g : {1, 2, 3, 5})
    for (const int q : {0, 1, 2, 3, 4, 6, 10})
      for (const bool continuous : {false, true}) {
        if (q == 0 && (continuous || g == 1)) continue;  // nothing to refine
        const int components = q % 2 == 0 ? 1 : 2;
        Dataset data;
        data.mesh = io_test::disc(g, 1.5);
        const auto space =
            continuous ? Space::continuous(data.mesh, q) : Space::discontinuous(data.mesh, q);
        data.fields = {io_test::wavy("f", space, components)};
        const Folder folder;
        write(folder / "f.msh", data,
              {continuous ? Format::msh41_binary : Format::msh22_ascii, false, true});
        io_test::spill(folder / "show.geo",
                       "Merge \"f.msh\";\nView[0].AdaptVisualizationGrid = 1;\n"
                       "View[0].MaxRecursionLevel = 2;\nView[0].TargetError = 0;\n"
                       "Save View[0] \"f.pos\";\nExit;\n");
        run(fmt::format("cd {} && {} show.geo -0 > log 2>&1", quoted(folder.path().string()),
                        gmsh));
        const std::string text = io_test::slurp(folder / "f.pos");
        const std::string name = fmt::format("geometry {}, field {} {}", g, q,
                                             continuous ? "continuous" : "discontinuous");
        // What may be shown: per element the values at its lattice, by element and place.
        std::vector<Vec2> places;
        std::vector<std::array<double, 2>> values;
        std::vector<bool> found;
        for (std::size_t e = 0; e < data.mesh->element_count(); ++e)
          for (const Lambda& l : lattice(4)) {
            std::array<double, 2> value{};
            data.fields[0].evaluate(ElementId(e), l,
                                    std::span<double>(value).first(std::size_t(components)));
            places.push_back(position(*data.mesh, e, l));
            values.push_back(value);
          }
        found.assign(places.size(), false);
        std::size_t vertices = 0, wrong = 0;
        const auto width = static_cast<std::size_t>(components == 1 ? 1 : 3);
        for (std::size_t at = text.find('('); at != std::string::npos;
             at = text.find('(', at + 1)) {
          std::vector<double> numbers;  // 9 coordinates, then the values
          const std::size_t end = text.find(';', at);
          std::string item = text.substr(at, end - at);
          for (char& c : item)
            if (c == '(' || c == ')' || c == '{' || c == '}' || c == ',') c = ' ';
          std::istringstream in(item);
          for (double x = 0.0; in >> x;) numbers.push_back(x);
          if (numbers.size() != 9 + 3 * width) continue;
          for (std::size_t v = 0; v < 3; ++v, ++vertices) {
            const Vec2 p{numbers[3 * v], numbers[3 * v + 1]};
            bool good = false;
            for (std::size_t i = 0; i < places.size(); ++i) {
              // Gmsh evaluates monomials: degree 10 cancels up to 9 digits.
              const double tolerance = q > 6 ? 1e-7 : 1e-11;
              bool same = norm(places[i] - p) <= 1e-12;
              for (std::size_t c = 0; same && c < std::size_t(components); ++c)
                same = std::abs(values[i][c] - numbers[9 + v * width + c]) <= tolerance;
              if (same) found[i] = good = true;
            }
            wrong += good ? 0 : 1;
          }
        }
        std::size_t missing = 0;
        for (const bool f : found) missing += f ? 0 : 1;
        // Where the field is linear Gmsh does not refine.
        const bool refined = q > 1;
        expect(vertices > 0 && wrong == 0 && (missing == 0 || !refined),
               fmt::format("{}: {} vertices shown, {} wrong, {} not shown", name, vertices, wrong,
                           missing));
      }
}

/// Gmsh's own meshes of a disc with a hole, in every format and degree.
void we_read_gmsh(const std::string& gmsh) {
  const Folder folder;
  io_test::spill(
      folder / "ring.geo",
      "Point(1) = {0, 0, 0, 0.6}; Point(2) = {1, 0, 0, 0.6}; Point(3) = {-1, 0, 0, 0.6};\n"
      "Point(4) = {0.4, 0, 0, 0.4}; Point(5) = {-0.4, 0, 0, 0.4};\n"
      "Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 2};\n"
      "Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 4};\n"
      "Curve Loop(1) = {1, 2}; Curve Loop(2) = {3, 4}; Plane Surface(1) = {1, 2};\n"
      "Physical Curve(\"outer\", 5) = {1, 2}; Physical Curve(\"inner\", 6) = {3, 4};\n"
      "Physical Surface(\"ring\", 7) = {1}; Physical Point(\"p\", 8) = {2};\n");
  for (int g = 1; g <= 10; ++g) {
    std::shared_ptr<const TriangleMesh> first;
    for (const Format format : msh_formats) {
      const std::string name = fmt::format("degree {}, {}", g, to_string(format));
      const std::string out = folder / fmt::format("ring{}.msh", g);
      const int status = run(gmsh + " " + quoted(folder / "ring.geo") + " -2 -order " +
                             std::to_string(g) + gmsh_format(format) + " -o " + quoted(out) +
                             " > " + quoted(folder / "log") + " 2>&1");
      if (status != 0) {
        expect(false, name + ": gmsh failed\n" + io_test::slurp(folder / "log"));
        continue;
      }
      const Dataset data = read(out);
      const TriangleMesh& mesh = *data.mesh;
      expect(mesh.degree() == g, name + ": wrong degree");
      std::size_t boundary = 0;
      double off_circle = 0.0;
      for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
        if (!mesh.is_boundary(EdgeId(e))) continue;
        ++boundary;
        const ElementSide& side = mesh.adjacent(EdgeId(e))[0];
        for (int m = 0; m <= g; ++m) {  // the nodes that Gmsh put on the circles
          const int n = bernstein::triangle_side_index(g, side.side, m);
          const double r = norm(position(mesh, side.element.index(), lattice(g)[std::size_t(n)]));
          off_circle = std::max(off_circle, std::min(std::abs(r - 1.0), std::abs(r - 0.4)));
        }
      }
      expect(off_circle <= 1e-12,
             fmt::format("{}: boundary nodes are {} off the circles", name, off_circle));
      expect(boundary == mesh.tags().edges.size() && mesh.tags().points.size() == 1,
             fmt::format("{}: {} boundary edges, {} tagged", name, boundary,
                         mesh.tags().edges.size()));
      expect(mesh.tags().groups.size() == 4 &&
                 mesh.tags().element_entity.size() == mesh.element_count(),
             name + ": groups or entities are missing");
      std::size_t outer = 0;
      for (const TaggedEdge& edge : mesh.tags().edges) {
        for (const Entity& entity : mesh.tags().entities)
          if (entity.dim == 1 && entity.tag == edge.entity &&
              entity.physical == std::vector<int>{5})
            outer += norm(mesh.control(edge.nodes.front())) > 0.9 ? 1 : 0;
      }
      expect(outer > 0, name + ": no edge is in group 'outer'");
      if (!first) {
        first = data.mesh;
      } else {  // text files of Gmsh carry 16 digits
        const double d = difference(*first, mesh);
        expect(d <= 1e-13, fmt::format("{}: differs from the first format by {}", name, d));
      }
    }
  }
}

Dataset vtk_dataset(int g) {
  Dataset data;
  data.mesh = io_test::tagged_disc(g);
  data.time = 0.1;
  data.fields = {io_test::wavy("nodal", Space::continuous(data.mesh, g)),
                 io_test::wavy("velocity", Space::continuous(data.mesh, std::max(1, g - 1)), 2),
                 io_test::wavy("jumps", Space::discontinuous(data.mesh, std::min(10, g + 1)), 3),
                 io_test::wavy("cells", Space::discontinuous(data.mesh, 0))};
  return data;
}

void vtk_reads_ours(const std::string& python) {
  const Folder folder;
  std::string files;
  for (int g = 1; g <= 10; ++g)
    for (const bool bezier : {false, true})
      for (const bool shared : {false, true}) {
        Dataset data = vtk_dataset(g);
        if (shared) data.fields.erase(data.fields.begin() + 2);
        const std::string name =
            fmt::format("degree{}{}{}", g, bezier ? "-bezier" : "", shared ? "-shared" : "");
        write(folder / (name + ".vtu"), data, {Format::vtu, bezier, g % 2 == 0});
        std::string expected;
        for (std::size_t e = 0; e < data.mesh->element_count(); ++e)
          for (const Lambda& l : lattice(5)) {
            const Vec2 p = position(*data.mesh, e, l);
            expected += fmt::format("{} {} {} {} {}", e, l[1], l[2], p.x(), p.y());
            for (const Field& field : data.fields) {
              std::vector<double> values(std::size_t(field.components()));
              field.evaluate(ElementId(e), l, values);
              expected += fmt::format(" {} {}", field.name(), field.components());
              for (const double v : values) expected += fmt::format(" {}", v);
            }
            expected += '\n';
          }
        io_test::spill(folder / name, expected);
        files += fmt::format(" {} {}", quoted(folder / (name + ".vtu")), quoted(folder / name));
      }
  expect(run(python + " check" + files) == 0, "VTK evaluates something else");
}

void we_read_vtk(const std::string& python) {
  for (const int g : {1, 2, 4}) {
    const Dataset data = vtk_dataset(g);
    const Folder folder;
    write(folder / "ours.vtu", data, {Format::vtu, g == 4, true});
    expect(run(python + " copy " + quoted(folder / "ours.vtu") + " " +
               quoted(folder.path().string())) == 0,
           "VTK could not write its copies");
    for (int copy = 0; copy < 32; ++copy) {
      const Dataset back = read(folder / fmt::format("copy{}.vtu", copy));
      const std::string name = fmt::format("degree {}, copy {}", g, copy);
      // VTK's text has 11 or more digits.
      const double tolerance = copy < 8 ? 1e-9 : 1e-14;
      const double d = difference(*data.mesh, *back.mesh);
      expect(d <= tolerance, fmt::format("{}: positions differ by {}", name, d));
      expect(back.fields.size() == data.fields.size() && back.time == data.time,
             name + ": fields or the time are missing");
      for (const Field& field : data.fields) {
        const Field& other = back.field(field.name());
        double worst = field.coefficients().size() == other.coefficients().size() ? 0.0 : 1e300;
        for (std::size_t i = 0; worst < 1e300 && i < field.coefficients().size(); ++i)
          worst = std::max(worst, std::abs(field.coefficients()[i] - other.coefficients()[i]));
        expect(worst <= 10 * tolerance,
               fmt::format("{}: '{}' differs by {}", name, field.name(), worst));
      }
      expect(back.mesh->tags().entities == data.mesh->tags().entities &&
                 back.mesh->tags().edges.size() == data.mesh->tags().edges.size(),
             name + ": tags are missing");
    }
  }
}

int main_of(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::string test = argv[1];
  std::string program = quoted(argv[2]);
  const bool vtk = argc > 3;
  if (vtk) program += fmt::format(" {}", quoted(argv[3]));
  if (std::string(argv[2]) == "none" ||
      run(program + (vtk ? " available" : " --version") + " > /dev/null 2>&1") != 0) {
    fmt::print("skipped: {} is not installed\n", vtk ? "VTK for Python" : "gmsh");
    return skipped;
  }
  const std::map<std::string, void (*)(const std::string&)> tests{
      {"gmsh_reads_ours", gmsh_reads_ours},
      {"gmsh_shows_fields", gmsh_shows_fields},
      {"we_read_gmsh", we_read_gmsh},
      {"vtk_reads_ours", vtk_reads_ours},
      {"we_read_vtk", we_read_vtk}};
  tests.at(test)(program);
  return failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace bezel

int main(int argc, char** argv) {
  return bezel::main_of(argc, argv);
}
