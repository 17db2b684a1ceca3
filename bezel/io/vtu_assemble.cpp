// The arrays of a VTU file -> mesh, tags and fields.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/io/cursor.hpp"
#include "bezel/io/entity_groups.hpp"
#include "bezel/io/field_map.hpp"
#include "bezel/io/nodal.hpp"
#include "bezel/io/node_order.hpp"
#include "bezel/io/vtu_content.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::files {
namespace {

using bernstein::triangle_size;
using short_names::at;

constexpr double metadata_tolerance = 1e-8;  // of the mesh's size

struct CellKind {
  int type;
  int dim;     // -1: not supported
  int degree;  // 0: by the number of nodes
  bool bezier;
  const char* name;
};
// VTK 9.1, Common/DataModel/vtkCellType.h
constexpr std::array<CellKind, 22> kinds{{
    {1, 0, 0, false, "vertex"},
    {3, 1, 1, false, "line"},
    {5, 2, 1, false, "triangle"},
    {21, 1, 2, false, "quadratic edge"},
    {22, 2, 2, false, "quadratic triangle"},
    {68, 1, 0, false, "Lagrange curve"},
    {69, 2, 0, false, "Lagrange triangle"},
    {75, 1, 0, true, "Bezier curve"},
    {76, 2, 0, true, "Bezier triangle"},
    {2, -1, 0, false, "poly vertex"},
    {4, -1, 0, false, "poly line"},
    {6, -1, 0, false, "triangle strip"},
    {7, -1, 0, false, "polygon"},
    {9, -1, 0, false, "quadrilateral"},
    {10, -1, 0, false, "tetrahedron"},
    {12, -1, 0, false, "hexahedron"},
    {23, -1, 0, false, "quadratic quadrilateral"},
    {24, -1, 0, false, "quadratic tetrahedron"},
    {34, -1, 0, false, "biquadratic triangle"},
    {70, -1, 0, false, "Lagrange quadrilateral"},
    {71, -1, 0, false, "Lagrange tetrahedron"},
    {77, -1, 0, false, "Bezier quadrilateral"},
}};

const CellKind* kind_of(std::int64_t type) {
  for (const CellKind& kind : kinds)
    if (kind.type == type) return &kind;
  return nullptr;
}

class VtuAssembler {
 public:
  VtuAssembler(const std::string& path, VtuContent content)
      : path_(path), content_(std::move(content)) {}

  Dataset assemble() {
    sort_cells();
    share_points();
    build_mesh();
    Dataset data;
    data.mesh = mesh_;
    data.time = content_.time;
    fields(data);
    data.notes = std::move(content_.notes);
    return data;
  }

 private:
  struct Cell {
    std::size_t number, start;  // in the file; in the connectivity
    int size;
  };

  void say(std::string sentence) { content_.notes.push_back(std::move(sentence)); }
  [[noreturn]] void fail(const char* kind, std::size_t number, const std::string& message) const {
    InputPlace place;
    place.file = path_;
    place.element_kind = kind;
    place.element = static_cast<std::int64_t>(number);
    throw InputError(place, message);
  }
  std::size_t point_count() const { return content_.points.size() / 3; }

  void sort_cells() {
    std::size_t start = 0;
    bool lagrange = false;
    for (std::size_t c = 0; c < content_.types.size(); ++c) {
      const auto end = static_cast<std::size_t>(content_.offsets[c]);
      const Cell cell{c, start, static_cast<int>(std::min<std::size_t>(end - start, 1000))};
      start = end;
      const std::int64_t type = content_.types[c];
      const CellKind* kind = kind_of(type);
      if (!kind || kind->dim < 0)
        fail("cell", c,
             fmt::format("type {} ({}) is not supported, expected triangles (5, 22, 69, 76)", type,
                         kind ? kind->name : "unknown"));
      if (kind->dim == 2) {
        int degree = 1;
        while (degree < TriangleMesh::max_degree && triangle_size(degree) < cell.size) ++degree;
        if (triangle_size(degree) != cell.size || (kind->degree != 0 && kind->degree != degree))
          fail("cell", c,
               fmt::format("type {} ({}) with {} points, expected {}", type, kind->name, cell.size,
                           kind->degree != 0
                               ? std::to_string(triangle_size(kind->degree))
                               : std::string("those of a triangle of degree 1 to 10")));
        if (degree_ == 0) degree_ = degree;
        if (degree != degree_)
          fail("cell", c,
               fmt::format("degree {}, the triangles before have degree {}; expected one degree",
                           degree, degree_));
        if (degree > 1) {
          lagrange = lagrange || !kind->bezier;
          bezier_ = bezier_ || kind->bezier;
          if (lagrange && bezier_)
            fail("cell", c, "Lagrange and Bezier triangles are mixed, expected one kind");
        }
        triangles_.push_back(cell);
      } else if (kind->dim == 1) {
        lines_.push_back(cell);
      } else {
        if (cell.size != 1)
          fail("cell", c, fmt::format("a vertex with {} points, expected 1", cell.size));
        vertices_.push_back(cell);
      }
    }
    if (triangles_.empty()) {
      InputPlace place;
      place.file = path_;
      throw InputError(place, "the file has no triangles");
    }
  }

  std::size_t point(const Cell& cell, int i) const {
    return static_cast<std::size_t>(content_.connectivity[cell.start + at(i)]);
  }
  bool same_place(std::size_t p, std::size_t q) const {
    return content_.points[3 * p] == content_.points[3 * q] &&
           content_.points[3 * p + 1] == content_.points[3 * q + 1];
  }

  /// node_[p]: the node that point p stands for, numbered from 0 over the points of triangles.
  void share_points() {
    const std::size_t n = point_count();
    std::vector<int> uses(n, 0);
    bool shared = false;
    for (const Cell& t : triangles_)
      for (int i = 0; i < t.size; ++i) {
        const std::size_t p = point(t, i);
        if (uses[p] != 0) shared = true;
        uses[p] = 1;
      }
    std::vector<std::size_t> same(n);  // a representative, or the number in the file
    for (std::size_t p = 0; p < n; ++p) same[p] = p;
    if (!shared_by_array(same) && !shared) {
      std::unordered_map<std::uint64_t, std::vector<std::size_t>> places;
      for (std::size_t p = 0; p < n; ++p) {
        if (uses[p] == 0) continue;
        // + 0.0: both zeros are one place.
        const auto x = std::bit_cast<std::uint64_t>(content_.points[3 * p] + 0.0);
        const auto y = std::bit_cast<std::uint64_t>(content_.points[3 * p + 1] + 0.0);
        auto& here = places[x * 0x9e3779b97f4a7c15ULL ^ (y + (x >> 32))];
        const auto found =
            std::find_if(here.begin(), here.end(), [&](std::size_t q) { return same_place(p, q); });
        if (found == here.end()) {
          here.push_back(p);
        } else {
          same[p] = *found;
        }
      }
    }
    std::vector<std::size_t> numbers(n, 0);
    for (std::size_t p = 0; p < n; ++p)
      if (uses[p] != 0) numbers[same[p]] = 1;
    std::size_t next = 0;
    for (std::size_t& number : numbers) number = number != 0 ? next++ : ~std::size_t{0};
    node_.assign(n, NodeId());
    first_point_.assign(next, n);
    for (std::size_t p = 0; p < n; ++p) {
      const std::size_t number = numbers[same[p]];
      if (number == ~std::size_t{0} || uses[p] == 0) continue;
      node_[p] = NodeId(number);
      first_point_[number] = std::min(first_point_[number], p);
    }
  }

  /// The writer's own numbering, when it is there and fits the points.
  bool shared_by_array(std::vector<std::size_t>& same) {
    const auto found = std::find_if(content_.point_data.begin(), content_.point_data.end(),
                                    [](const VtuArray& a) { return a.name == "bezel:node"; });
    if (found == content_.point_data.end()) return false;
    const VtuArray array = std::move(*found);
    content_.point_data.erase(found);
    const std::size_t n = point_count();
    std::vector<std::size_t> first(n, n);
    bool fits = array.integer && array.components == 1;
    for (std::size_t p = 0; fits && p < n; ++p) {
      const std::int64_t node = array.integers[p];
      fits = node >= 0 && static_cast<std::size_t>(node) < n;
      if (!fits) break;
      std::size_t& known = first[static_cast<std::size_t>(node)];
      if (known == n) known = p;
      fits = same_place(p, known);
    }
    if (!fits) {
      say("array 'bezel:node' does not fit the points and was not used");
      return false;
    }
    for (std::size_t p = 0; p < n; ++p) same[p] = static_cast<std::size_t>(array.integers[p]);
    return true;
  }

  void build_mesh() {
    std::vector<Vec2> places;
    const double z = content_.points[3 * first_point_[0] + 2];
    for (std::size_t p = 0; p < point_count(); ++p)
      if (node_[p].valid() && content_.points[3 * p + 2] != z)
        fail("point", p,
             fmt::format("z is {}, expected a planar mesh (z = {} as at point {})",
                         content_.points[3 * p + 2], z, first_point_[0]));
    if (z != 0.0) say(fmt::format("the mesh lies in the plane z = {}, z was dropped", z));
    for (const std::size_t p : first_point_)
      places.push_back({content_.points[3 * p], content_.points[3 * p + 1]});
    const std::vector<int> order = triangle_order(degree_);
    const auto size = at(triangle_size(degree_));
    std::vector<NodeId> elements(triangles_.size() * size);
    for (std::size_t e = 0; e < triangles_.size(); ++e) {
      for (std::size_t i = 0; i < size; ++i)
        elements[e * size + at(order[i])] = node_[point(triangles_[e], static_cast<int>(i))];
      for (int c = 0; c < 3; ++c)
        if (node_[point(triangles_[e], c)] == node_[point(triangles_[e], (c + 1) % 3)])
          fail("cell", triangles_[e].number,
               fmt::format("two of its corners are point {}, expected different points",
                           point(triangles_[e], c)));
    }
    topology_ = std::make_shared<TriangleMesh>(degree_, places, elements);
    const TriangleMesh tagged(degree_, std::move(places), std::move(elements), tags());
    TriangleMesh curved = bezier_ ? tagged : convert_mesh(tagged, Conversion::to_bernstein);
    const int own = content_.metadata ? content_.metadata->degree : degree_;
    if (own < degree_) {
      TriangleMesh reduced = change_degree(curved, own);
      if (same_geometry(change_degree(reduced, degree_), curved)) {
        mesh_ = std::make_shared<TriangleMesh>(std::move(reduced));
        return;
      }
    }
    if (own != degree_)
      say(
          fmt::format("the metadata says geometric degree {}, which the cells are not; they were "
                      "read as degree {}",
                      own, degree_));
    mesh_ = std::make_shared<TriangleMesh>(std::move(curved));
  }

  static bool same_geometry(const TriangleMesh& a, const TriangleMesh& b) {
    const double tolerance = metadata_tolerance * b.box().diameter();
    for (std::size_t i = 0; i < b.connectivity().size(); ++i)
      if (!(norm(a.control(a.connectivity()[i]) - b.control(b.connectivity()[i])) <= tolerance))
        return false;
    return true;
  }

  std::vector<std::int64_t> take_tags(std::initializer_list<const char*> names) {
    for (const char* name : names)
      for (std::size_t i = 0; i < content_.cell_data.size(); ++i) {
        VtuArray& a = content_.cell_data[i];
        if (a.name != name || !a.integer || a.components != 1) continue;
        std::vector<std::int64_t> values = std::move(a.integers);
        content_.cell_data.erase(content_.cell_data.begin() + static_cast<std::ptrdiff_t>(i));
        return values;
      }
    return {};
  }

  Tags tags() {
    const std::vector<std::int64_t> physical = take_tags({"gmsh:physical"});
    const std::vector<std::int64_t> geometrical = take_tags({"gmsh:geometrical", "CellEntityIds"});
    const auto tag = [&](const std::vector<std::int64_t>& from, const Cell& cell) {
      if (from.empty()) return 0;
      const std::int64_t value = from[cell.number];
      if (value <= -std::numeric_limits<int>::max() || value >= std::numeric_limits<int>::max())
        fail("cell", cell.number, fmt::format("its tag {} is out of range", value));
      return static_cast<int>(value);
    };
    Tags tags;
    // By dimension: the entity of each cell.
    const auto entities = [&](int dim, const std::vector<Cell>& cells) {
      std::vector<int> numbers;
      std::vector<std::vector<int>> groups;
      for (const Cell& cell : cells) {
        const int group = tag(physical, cell);
        numbers.push_back(geometrical.empty() ? group : tag(geometrical, cell));
        groups.emplace_back();
        if (group != 0) groups.back().push_back(group);
      }
      if (!content_.metadata && entities_from_groups(dim, numbers, groups, tags.entities))
        say(fmt::format(
            "entities of dimension {} whose cells are in different physical groups were "
            "split",
            dim));
      return numbers;
    };
    std::vector<int> of_triangles = entities(2, triangles_);
    const std::vector<int> of_lines = entities(1, lines_);
    const std::vector<int> of_vertices = entities(0, vertices_);
    if (content_.metadata) {
      tags.groups = content_.metadata->tags.groups;
      tags.entities = content_.metadata->tags.entities;
      if (!content_.metadata->has_element_entity) of_triangles.clear();
    }
    if (std::any_of(of_triangles.begin(), of_triangles.end(), [](int e) { return e != 0; }))
      tags.element_entity = std::move(of_triangles);

    std::size_t dropped = 0;
    const EdgeFinder finder(*topology_);
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      TaggedEdge edge{{}, of_lines[i]};
      if (lines_[i].size == degree_ + 1) {
        edge.nodes.resize(at(degree_ + 1));
        const std::vector<int> order = line_order(degree_);
        for (int m = 0; m <= degree_; ++m)
          edge.nodes[at(order[at(m)])] = node_[point(lines_[i], m)];
      }
      if (!edge.nodes.empty() && finder.find(edge.nodes)) {
        tags.edges.push_back(std::move(edge));
      } else {
        ++dropped;
      }
    }
    if (dropped > 0)
      say(fmt::format("{} of {} lines are no edges of triangles and were dropped", dropped,
                      lines_.size()));
    dropped = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const NodeId node = node_[point(vertices_[i], 0)];
      if (node.valid()) {
        tags.points.push_back({node, of_vertices[i]});
      } else {
        ++dropped;
      }
    }
    if (dropped > 0)
      say(fmt::format("{} of {} vertices are no nodes of triangles and were dropped", dropped,
                      vertices_.size()));
    return tags;
  }

  // Fields.

  bool is_field(const VtuArray& a, const char* what) {
    if (a.integer) {
      say(fmt::format("array '{}' of {} holds integers and was skipped", shown(a.name), what));
      return false;
    }
    if (a.components > 9) {
      say(fmt::format("array '{}' of {} has {} components, at most 9 are read; it was skipped",
                      shown(a.name), what, a.components));
      return false;
    }
    return true;
  }

  void check_finite(const VtuArray& a, std::size_t tuple, const char* kind) const {
    const auto width = at(a.components);
    for (std::size_t c = 0; c < width; ++c)
      if (!std::isfinite(a.reals[tuple * width + c])) {
        InputPlace place{path_, a.line, kind, static_cast<std::int64_t>(tuple)};
        throw InputError(place, fmt::format("field '{}' is {}, expected a finite number",
                                            shown(a.name), a.reals[tuple * width + c]));
      }
  }

  void fields(Dataset& data) {
    std::vector<std::pair<MappedField, bool>> found;  // with: continuous
    layout_ = node_layout(*topology_);
    for (const VtuArray& a : content_.point_data)
      if (is_field(a, "points")) {
        bool continuous = false;
        MappedField field = point_field(a, continuous);
        found.emplace_back(std::move(field), continuous);
      }
    for (const VtuArray& a : content_.cell_data)
      if (is_field(a, "cells")) {
        MappedField field{a.name, a.components, 0, {}};
        for (const Cell& t : triangles_) {
          check_finite(a, t.number, "cell");
          for (std::size_t c = 0; c < at(a.components); ++c)
            field.coefficients.push_back(a.reals[t.number * at(a.components) + c]);
        }
        found.emplace_back(std::move(field), false);
      }
    if (content_.metadata) {  // the order they were written in
      const auto place = [&](const std::pair<MappedField, bool>& f) {
        const FieldMetadata* const m = content_.metadata->field(f.first.name);
        return m ? m - content_.metadata->fields.data()
                 : std::numeric_limits<std::ptrdiff_t>::max();
      };
      std::stable_sort(found.begin(), found.end(),
                       [&](const auto& a, const auto& b) { return place(a) < place(b); });
    }
    for (auto& f : found) {
      const FieldMetadata* const metadata =
          content_.metadata ? content_.metadata->field(f.first.name) : nullptr;
      data.fields.push_back(
          restore_field(mesh_, std::move(f.first), metadata, f.second, content_.notes));
    }
  }

  MappedField point_field(const VtuArray& a, bool& continuous) const {
    const auto width = at(a.components);
    const auto size = at(triangle_size(degree_));
    for (std::size_t p = 0; p < point_count(); ++p)
      if (node_[p].valid()) check_finite(a, p, "point");
    const auto value = [&](std::size_t p, std::size_t c) { return a.reals[p * width + c]; };
    continuous = true;
    for (std::size_t p = 0; p < point_count() && continuous; ++p)
      for (std::size_t c = 0; node_[p].valid() && c < width; ++c)
        continuous = continuous && value(p, c) == value(first_point_[node_[p].index()], c);
    MappedField field{a.name, a.components, degree_, {}};
    field.coefficients.resize(triangles_.size() * size * width);
    if (continuous) {
      std::vector<double> nodes(layout_.origin.size() * width);
      for (std::size_t n = 0; n < layout_.origin.size(); ++n)
        for (std::size_t c = 0; c < width; ++c)
          nodes[n * width + c] = value(first_point_[layout_.origin[n].index()], c);
      if (!bezier_)
        nodes = convert_nodes(*topology_, layout_, nodes, a.components, Conversion::to_bernstein);
      for (std::size_t i = 0; i < layout_.elements.size(); ++i)
        for (std::size_t c = 0; c < width; ++c)
          field.coefficients[i * width + c] = nodes[layout_.elements[i].index() * width + c];
      return field;
    }
    const std::vector<int> order = triangle_order(degree_);
    std::vector<double> b(size);
    for (std::size_t e = 0; e < triangles_.size(); ++e)
      for (std::size_t c = 0; c < width; ++c) {
        for (std::size_t i = 0; i < size; ++i)
          b[at(order[i])] = value(point(triangles_[e], static_cast<int>(i)), c);
        if (!bezier_) b = bernstein::from_lagrange<double>(degree_, std::span<const double>(b));
        for (std::size_t i = 0; i < size; ++i)
          field.coefficients[(e * size + i) * width + c] = b[i];
      }
    return field;
  }

  std::string path_;
  VtuContent content_;
  int degree_ = 0;
  bool bezier_ = false;
  std::vector<Cell> triangles_, lines_, vertices_;
  std::vector<NodeId> node_;              // by point
  std::vector<std::size_t> first_point_;  // by node
  std::shared_ptr<const TriangleMesh> topology_, mesh_;
  NodeLayout layout_;
};

}  // namespace

Dataset assemble_vtu(const std::string& path, VtuContent content) {
  return VtuAssembler(path, std::move(content)).assemble();
}

}  // namespace bezel::files
