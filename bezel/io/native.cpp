#include "bezel/io/native.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bezel/bernstein/index.hpp"
#include "bezel/io/cursor.hpp"

namespace bezel::files {
namespace {

constexpr int native_version = 1;

// Strings are quoted; \" \\ \n \r and \t are the only escapes.
std::string quote(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const char* const escaped = c == '"'    ? "\\\""
                                : c == '\\' ? "\\\\"
                                : c == '\n' ? "\\n"
                                : c == '\r' ? "\\r"
                                : c == '\t' ? "\\t"
                                            : nullptr;
    if (escaped) {
      out += escaped;
    } else {
      out += c;
    }
  }
  return out + '"';
}

class NativeWriter {
 public:
  std::string write(const Dataset& data) {
    const TriangleMesh& mesh = *data.mesh;
    out_ = fmt::format("bezel {}\nmesh triangle degree {} nodes {} elements {}\n", native_version,
                       mesh.degree(), mesh.node_count(), mesh.element_count());
    for (const Vec2& p : mesh.control()) reals({p.x(), p.y()});
    for (std::size_t e = 0; e < mesh.element_count(); ++e) nodes("", mesh.nodes(ElementId(e)));
    tags(mesh.tags());
    if (data.time) {
      out_ += "time ";
      reals({*data.time});
    }
    out_ += fmt::format("fields {}\n", data.fields.size());
    for (const Field& field : data.fields) write_field(field);
    out_ += "end\n";
    return std::move(out_);
  }

 private:
  void reals(std::initializer_list<double> values) {
    for (const double v : values) real(v);
    end_line();
  }
  void real(double v) {
    append_hex(out_, v);
    out_ += ' ';
  }
  void end_line() {
    if (out_.back() == ' ') out_.pop_back();
    out_ += '\n';
  }
  void nodes(const std::string& start, std::span<const NodeId> list) {
    out_ += start;
    for (const NodeId n : list) {
      append_number(out_, std::int64_t{n.value});
      out_ += ' ';
    }
    end_line();
  }

  void tags(const Tags& t) {
    out_ += fmt::format("groups {}\n", t.groups.size());
    for (const PhysicalGroup& g : t.groups)
      out_ += fmt::format("{} {} {}\n", g.dim, g.tag, quote(g.name));
    out_ += fmt::format("entities {}\n", t.entities.size());
    for (const Entity& e : t.entities) {
      out_ += fmt::format("{} {} {}", e.dim, e.tag, e.physical.size());
      for (const int p : e.physical) out_ += fmt::format(" {}", p);
      out_ += '\n';
    }
    out_ += fmt::format("element_entities {}\n", t.element_entity.size());
    for (const int e : t.element_entity) out_ += fmt::format("{}\n", e);
    out_ += fmt::format("edges {}\n", t.edges.size());
    for (const TaggedEdge& e : t.edges) nodes(fmt::format("{} ", e.entity), e.nodes);
    out_ += fmt::format("points {}\n", t.points.size());
    for (const TaggedPoint& p : t.points) out_ += fmt::format("{} {}\n", p.entity, p.node.value);
  }

  void write_field(const Field& field) {
    const Space& space = field.space();
    const std::size_t elements = field.mesh().element_count();
    const bool varies = space.uniform_degree() < 0;
    out_ += fmt::format(
        "field {} components {} basis {} continuity {} degree {}\n", quote(field.name()),
        field.components(), space.basis() == Basis::physical ? "physical" : "reference",
        space.continuity() == Continuity::continuous ? "continuous" : "discontinuous",
        varies ? "varies" : std::to_string(space.uniform_degree()));
    if (varies)
      for (std::size_t e = 0; e < elements; ++e)
        out_ += fmt::format("{}\n", space.degree(ElementId(e)));
    if (space.basis() == Basis::physical)
      for (const Frame& f : space.frames())
        reals({f.centre.x(), f.centre.y(), f.gradient[0].x(), f.gradient[0].y(), f.gradient[1].x(),
               f.gradient[1].y(), f.gradient[2].x(), f.gradient[2].y()});
    for (std::size_t e = 0; e < elements; ++e) {
      for (const double c : field.coefficients(ElementId(e))) real(c);
      end_line();
    }
  }

  std::string out_;
};

class NativeReader {
 public:
  NativeReader(const std::string& path, std::string_view bytes) : in_(bytes, path) {}

  Dataset read() {
    in_.expect("bezel");
    if (const std::int64_t v = in_.text_integer("the version"); v != native_version)
      in_.fail(fmt::format("version {} is not supported, expected {}", v, native_version));
    Dataset data;
    data.mesh = mesh();
    if (in_.peek() == "time") {
      in_.expect("time");
      data.time = in_.finite("the time");
    }
    const std::size_t n = count("fields", 10);
    for (std::size_t i = 0; i < n; ++i) data.fields.push_back(field(data.mesh));
    in_.expect("end");
    if (!in_.at_end()) {
      const std::string_view rest = in_.word("");
      in_.fail(fmt::format("'{}' after the end of the data", shown(rest)));
    }
    return data;
  }

 private:
  std::size_t count(const char* keyword, std::size_t bytes_each) {
    in_.expect(keyword);
    const std::string what = fmt::format("the number of {}", keyword);
    return in_.check_count(in_.text_integer(what.c_str()), what.c_str(), bytes_each);
  }
  int integer(const char* what, std::int64_t lowest, std::int64_t highest) {
    const std::int64_t value = in_.text_integer(what);
    if (value < lowest || value > highest)
      in_.fail(fmt::format("{} is {}, expected {} to {}", what, value, lowest, highest));
    return static_cast<int>(value);
  }
  int any(const char* what) { return integer(what, -most, most); }
  NodeId node(std::size_t node_count) {
    const std::int64_t value = in_.text_integer("a node");
    if (value < 0 || static_cast<std::uint64_t>(value) >= node_count)
      in_.fail(fmt::format("node {} does not exist, the mesh has {}", value, node_count));
    return NodeId(static_cast<std::size_t>(value));
  }
  std::string string(const char* what) {
    in_.skip_space();
    const std::string_view rest = in_.data().substr(in_.position());
    if (rest.empty() || rest[0] != '"') {
      const std::string_view found = in_.word(what);
      in_.fail(fmt::format("expected {} in double quotes, found '{}'", what, shown(found)));
    }
    std::string out;
    for (std::size_t i = 1; i < rest.size() && rest[i] != '\n'; ++i) {
      if (rest[i] == '"') {
        in_.seek(in_.position() + i + 1);
        return out;
      }
      if (rest[i] != '\\') {
        out += rest[i];
        continue;
      }
      const char c = ++i < rest.size() ? rest[i] : '\0';
      const char* const codes = "\"\\nrt";
      const char* const values = "\"\\\n\r\t";
      const char* const found = c == '\0' ? nullptr : std::char_traits<char>::find(codes, 5, c);
      if (!found) in_.fail(fmt::format("{} has an escape that is not \\\" \\\\ \\n \\r \\t", what));
      out += values[found - codes];
    }
    in_.fail(fmt::format("{} is not closed by a double quote", what));
  }

  std::shared_ptr<const TriangleMesh> mesh() {
    in_.expect("mesh");
    in_.expect("triangle");
    in_.expect("degree");
    const int degree = integer("the geometric degree", 1, TriangleMesh::max_degree);
    const std::size_t node_count = count("nodes", 4);
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
    const std::size_t element_count = count("elements", 2 * size);
    std::vector<Vec2> control;
    control.reserve(node_count);
    for (std::size_t n = 0; n < node_count; ++n) {
      const double x = in_.finite("a coordinate");
      control.push_back({x, in_.finite("a coordinate")});
    }
    std::vector<NodeId> elements;
    elements.reserve(element_count * size);
    for (std::size_t i = 0; i < element_count * size; ++i) elements.push_back(node(node_count));
    Tags t = tags(degree, node_count, element_count);
    return std::make_shared<TriangleMesh>(degree, std::move(control), std::move(elements),
                                          std::move(t));
  }

  Tags tags(int degree, std::size_t node_count, std::size_t element_count) {
    Tags t;
    for (std::size_t n = count("groups", 6), i = 0; i < n; ++i) {
      PhysicalGroup g;
      g.dim = integer("a dimension", 0, 3);
      g.tag = any("a physical tag");
      g.name = string("a physical name");
      t.groups.push_back(std::move(g));
    }
    for (std::size_t n = count("entities", 6), i = 0; i < n; ++i) {
      Entity e;
      e.dim = integer("a dimension", 0, 3);
      e.tag = any("an entity tag");
      const std::int64_t groups = in_.text_integer("a number of physical tags");
      const std::size_t physical = in_.check_count(groups, "a number of physical tags", 2);
      for (std::size_t p = 0; p < physical; ++p) e.physical.push_back(any("a physical tag"));
      t.entities.push_back(std::move(e));
    }
    const std::size_t tagged = count("element_entities", 2);
    if (tagged != 0 && tagged != element_count)
      in_.fail(fmt::format("{} element entities, expected 0 or {}", tagged, element_count));
    for (std::size_t i = 0; i < tagged; ++i) t.element_entity.push_back(any("an entity tag"));
    for (std::size_t n = count("edges", 6), i = 0; i < n; ++i) {
      TaggedEdge e;
      e.entity = any("an entity tag");
      for (int m = 0; m <= degree; ++m) e.nodes.push_back(node(node_count));
      t.edges.push_back(std::move(e));
    }
    for (std::size_t n = count("points", 4), i = 0; i < n; ++i) {
      TaggedPoint p;
      p.entity = any("an entity tag");
      p.node = node(node_count);
      t.points.push_back(p);
    }
    return t;
  }

  /// One of two words: 0 or 1.
  int either(const char* first, const char* second) {
    const std::string_view found = in_.word(first);
    if (found == first) return 0;
    if (found == second) return 1;
    in_.fail(fmt::format("expected '{}' or '{}', found '{}'", first, second, shown(found)));
  }

  Field field(const std::shared_ptr<const TriangleMesh>& mesh) {
    in_.expect("field");
    const std::string name = string("a field name");
    in_.expect("components");
    const int components = integer("the number of components", 1, 9);
    in_.expect("basis");
    const bool physical = either("reference", "physical") == 1;
    in_.expect("continuity");
    const bool continuous = either("discontinuous", "continuous") == 1;
    in_.expect("degree");
    const std::size_t elements = mesh->element_count();
    std::vector<int> degrees;
    if (in_.peek() == "varies") {
      in_.expect("varies");
      if (continuous) in_.fail("a continuous field whose degree varies, expected one degree");
      for (std::size_t e = 0; e < elements; ++e)
        degrees.push_back(integer("a degree", 0, Space::max_degree));
    } else {
      degrees.assign(elements, integer("a degree", continuous ? 1 : 0, Space::max_degree));
    }
    std::shared_ptr<const Space> space;
    if (physical) {
      if (continuous) in_.fail("a continuous field in the physical basis, expected discontinuous");
      std::vector<Frame> frames;
      for (std::size_t e = 0; e < elements; ++e) {
        Frame f;
        const auto vector = [&] {
          const double x = in_.finite("a number of a frame");
          return Vec2{x, in_.finite("a number of a frame")};
        };
        f.centre = vector();
        for (Vec2& g : f.gradient) g = vector();
        frames.push_back(f);
      }
      space = Space::discontinuous(mesh, std::move(degrees), std::move(frames));
    } else if (continuous) {
      const int degree = degrees.empty() ? 1 : degrees[0];
      space = shared(mesh, degree, true);
    } else if (std::all_of(degrees.begin(), degrees.end(),
                           [&](int d) { return d == degrees[0]; })) {
      space = shared(mesh, degrees.empty() ? 0 : degrees[0], false);
    } else {
      space = Space::discontinuous(mesh, std::move(degrees), Basis::reference);
    }
    const std::size_t n = space->coefficient_count() * static_cast<std::size_t>(components);
    in_.check_count(static_cast<std::int64_t>(n), "the number of coefficients", 2);
    std::vector<double> coefficients;
    coefficients.reserve(n);
    for (std::size_t i = 0; i < n; ++i) coefficients.push_back(in_.finite("a coefficient"));
    if (continuous) check_shared(*space, name, coefficients, static_cast<std::size_t>(components));
    return Field(name, space, std::move(coefficients), components);
  }

  /// Fields on the same uniform space share it.
  std::shared_ptr<const Space> shared(const std::shared_ptr<const TriangleMesh>& mesh, int degree,
                                      bool continuous) {
    auto& space = spaces_[static_cast<std::size_t>(degree)][continuous ? 1 : 0];
    if (!space)
      space = continuous ? Space::continuous(mesh, degree) : Space::discontinuous(mesh, degree);
    return space;
  }

  void check_shared(const Space& space, const std::string& name,
                    const std::vector<double>& coefficients, std::size_t width) {
    std::vector<std::size_t> first(space.dof_count(), ~std::size_t{0});
    std::size_t i = 0;
    for (std::size_t e = 0; e < space.mesh()->element_count(); ++e)
      for (const std::int32_t dof : space.dofs(ElementId(e))) {
        std::size_t& seen = first[static_cast<std::size_t>(dof)];
        if (seen == ~std::size_t{0}) seen = i;
        for (std::size_t c = 0; c < width; ++c)
          if (coefficients[seen * width + c] != coefficients[i * width + c]) {
            InputPlace place;
            place.file = in_.file();
            place.element_kind = "triangle";
            place.element = static_cast<std::int64_t>(e);
            throw InputError(place,
                             fmt::format("the continuous field '{}' differs from a neighbour's "
                                         "coefficient, expected the same",
                                         shown(name)));
          }
        ++i;
      }
  }

  static constexpr std::int64_t most = std::numeric_limits<int>::max();
  Cursor in_;
  std::array<std::array<std::shared_ptr<const Space>, 2>, Space::max_degree + 1> spaces_{};
};

}  // namespace

Dataset read_native(const std::string& path, std::string_view bytes) {
  return NativeReader(path, bytes).read();
}

std::string write_native(const Dataset& data) {
  return NativeWriter().write(data);
}

}  // namespace bezel::files
