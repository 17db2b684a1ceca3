// An MSH file's sections -> mesh, tags and fields.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/io/entity_groups.hpp"
#include "bezel/io/field_map.hpp"
#include "bezel/io/msh_content.hpp"
#include "bezel/io/nodal.hpp"
#include "bezel/io/node_order.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::files {
namespace {

using bernstein::triangle_size;
using short_names::at;

constexpr std::size_t none = ~std::size_t{0};

/// Position of a number in a list of distinct numbers.
class Lookup {
 public:
  explicit Lookup(const std::vector<std::int64_t>& tags) : order_(tags.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
    sorted_.reserve(tags.size());
    for (const std::size_t i : order_) sorted_.push_back(tags[i]);
    contiguous_ = !sorted_.empty() &&
                  sorted_.back() - sorted_.front() == static_cast<std::int64_t>(sorted_.size()) - 1;
  }
  /// Positions in ascending order of their numbers.
  const std::vector<std::size_t>& order() const { return order_; }
  /// A number that occurs twice, if any.
  std::optional<std::int64_t> repeated() const {
    const auto found = std::adjacent_find(sorted_.begin(), sorted_.end());
    return found == sorted_.end() ? std::nullopt : std::optional<std::int64_t>(*found);
  }
  std::size_t find(std::int64_t tag) const {
    if (sorted_.empty() || tag < sorted_.front() || tag > sorted_.back()) return none;
    if (contiguous_) return order_[static_cast<std::size_t>(tag - sorted_.front())];
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), tag);
    return *found == tag ? order_[static_cast<std::size_t>(found - sorted_.begin())] : none;
  }

 private:
  std::vector<std::size_t> order_;
  std::vector<std::int64_t> sorted_;
  bool contiguous_ = false;
};

template <class T>
void keep(std::vector<T>& values, const std::vector<std::size_t>& which, std::size_t width = 1) {
  std::vector<T> kept;
  kept.reserve(which.size() * width);
  for (const std::size_t i : which)
    for (std::size_t w = 0; w < width; ++w) kept.push_back(values[i * width + w]);
  values = std::move(kept);
}

class MshAssembler {
 public:
  MshAssembler(const std::string& path, std::string_view bytes, MshContent content)
      : at_(bytes, path), content_(std::move(content)), nodes_(content_.node_tags) {}

  Dataset assemble() {
    if (content_.reversed_groups)
      say("the signs of physical tags (reversed orientation) were dropped");
    if (const auto twice = nodes_.repeated()) fail("node", *twice, "it is given twice");
    resolve_partitions();
    if (!content_.v4) physical_groups_of_elements();
    for (MshElements& elements : content_.elements) sort(elements);
    build_mesh();
    Dataset data;
    data.mesh = mesh_;
    fields(data);
    if (content_.metadata && content_.metadata->time) data.time = content_.metadata->time;
    data.notes = std::move(content_.notes);
    return data;
  }

 private:
  [[noreturn]] void fail(const char* kind, std::int64_t number, const std::string& message) const {
    InputPlace place;
    place.file = at_.file();
    place.element_kind = kind;
    place.element = number;
    throw InputError(place, message);
  }
  void say(std::string sentence) { content_.notes.push_back(std::move(sentence)); }
  MshElements& triangles() { return content_.elements[2]; }

  static std::size_t width(const MshElements& elements) {
    return elements.tags.empty() ? 1 : elements.nodes.size() / elements.tags.size();
  }
  static void keep_elements(MshElements& elements, const std::vector<std::size_t>& which) {
    const std::size_t w = width(elements);
    keep(elements.nodes, which, w);
    keep(elements.tags, which);
    keep(elements.entities, which);
    keep(elements.physicals, which);
    keep(elements.places, which);
  }

  /// Elements of partitioned entities belong to the entity that was partitioned; those on the
  /// interfaces between partitions, which no entity of their dimension had, go.
  void resolve_partitions() {
    if (content_.partitioned.empty()) return;
    for (int dim = 0; dim < 3; ++dim) {
      MshElements& elements = content_.elements[at(dim)];
      std::vector<std::size_t> kept;
      for (std::size_t i = 0; i < elements.tags.size(); ++i) {
        const auto parent = content_.partitioned.find({dim, elements.entities[i]});
        if (parent != content_.partitioned.end()) {
          if (parent->second.first != dim) continue;
          elements.entities[i] = parent->second.second;
        }
        kept.push_back(i);
      }
      if (kept.size() != elements.tags.size()) keep_elements(elements, kept);
    }
  }

  /// MSH 2 names one physical group per element and repeats the elements of entities in several.
  void physical_groups_of_elements() {
    for (int dim = 0; dim < 3; ++dim) {
      MshElements& elements = content_.elements[at(dim)];
      const std::size_t n = elements.tags.size(), w = width(elements);
      std::map<int, std::set<int>> groups_of;  // by entity
      for (std::size_t i = 0; i < n; ++i)
        groups_of[elements.entities[i]].insert(elements.physicals[i]);
      std::vector<std::vector<int>> groups(n);
      std::map<std::vector<std::int64_t>, std::size_t> first;
      std::vector<std::size_t> kept;
      for (std::size_t i = 0; i < n; ++i) {
        if (groups_of[elements.entities[i]].size() > 1) {
          std::vector<std::int64_t> key(
              elements.nodes.begin() + static_cast<std::ptrdiff_t>(i * w),
              elements.nodes.begin() + static_cast<std::ptrdiff_t>((i + 1) * w));
          key.push_back(elements.entities[i]);
          const auto [found, added] = first.try_emplace(std::move(key), i);
          auto& known = groups[found->second];
          if (!added &&
              std::find(known.begin(), known.end(), elements.physicals[i]) == known.end()) {
            known.push_back(elements.physicals[i]);
            continue;
          }
        }
        if (elements.physicals[i] != 0) groups[i].push_back(elements.physicals[i]);
        kept.push_back(i);
      }
      if (kept.size() != n) {
        keep_elements(elements, kept);
        keep(groups, kept);
      }
      if (entities_from_groups(dim, elements.entities, groups, content_.entities))
        say(
            fmt::format("entities of dimension {} whose elements are in different physical groups "
                        "were split",
                        dim));
    }
  }

  void sort(MshElements& elements) {
    const Lookup lookup(elements.tags);
    if (const auto twice = lookup.repeated()) fail("element", *twice, "it is given twice");
    if (!std::is_sorted(elements.tags.begin(), elements.tags.end()))
      keep_elements(elements, lookup.order());
  }

  std::size_t node_of(const MshElements& elements, std::size_t i, std::int64_t tag) const {
    const std::size_t found = nodes_.find(tag);
    if (found == none) {
      InputPlace place;
      place.file = at_.file();
      place.element_kind = "element";
      place.element = elements.tags[i];
      const bool text = !binary();
      if (text) place.line = line_of(at_.data(), elements.places[i]);
      throw InputError(
          place,
          fmt::format("node {} does not exist, the file has {}{}", tag, content_.node_tags.size(),
                      text ? "" : fmt::format(" (at byte {})", elements.places[i])));
    }
    return found;
  }
  bool binary() const {
    Cursor header = at_;
    header.seek(0);
    header.line();
    header.word("");
    return header.word("") == "1";
  }

  void build_mesh() {
    MshElements& t = triangles();
    if (t.tags.empty()) {
      InputPlace place;
      place.file = at_.file();
      throw InputError(place, "the file has no triangles");
    }
    const int g = t.degree;
    // NodeIds: the nodes that triangles use, by ascending tag.
    std::vector<std::size_t> positions;
    positions.reserve(t.nodes.size());
    const std::size_t w = width(t);
    std::vector<bool> used(content_.node_tags.size(), false);
    for (std::size_t i = 0; i < t.nodes.size(); ++i) {
      positions.push_back(node_of(t, i / w, t.nodes[i]));
      used[positions.back()] = true;
    }
    id_.assign(content_.node_tags.size(), NodeId());
    std::vector<Vec2> points;
    double z = 0.0;
    for (const std::size_t n : nodes_.order()) {
      if (!used[n]) continue;
      if (points.empty()) z = content_.z[n];
      if (content_.z[n] != z)
        fail("node", content_.node_tags[n],
             fmt::format("z is {}, expected a planar mesh (z = {} as at node {})", content_.z[n], z,
                         content_.node_tags[file_node_[0]]));
      id_[n] = NodeId(points.size());
      points.push_back(content_.positions[n]);
      file_node_.push_back(n);
    }
    if (z != 0.0) say(fmt::format("the mesh lies in the plane z = {}, z was dropped", z));

    const std::vector<int> order = triangle_order(g);
    std::vector<NodeId> elements(t.nodes.size());
    for (std::size_t e = 0; e < t.tags.size(); ++e)
      for (std::size_t i = 0; i < w; ++i)
        elements[e * w + at(order[i])] = id_[positions[e * w + i]];
    check_corners(elements);
    topology_ = std::make_shared<TriangleMesh>(g, points, elements);
    Tags tags = read_tags();
    mesh_ = std::make_shared<TriangleMesh>(
        convert_mesh(TriangleMesh(g, std::move(points), std::move(elements), std::move(tags)),
                     Conversion::to_bernstein));
  }

  void check_corners(const std::vector<NodeId>& elements) {
    const MshElements& t = triangles();
    const int g = t.degree;
    const std::size_t w = width(t);
    for (std::size_t e = 0; e < t.tags.size(); ++e) {
      const auto corner = [&](int c) {
        return elements[e * w + at(bernstein::triangle_corner(g, c))];
      };
      for (int c = 0; c < 3; ++c)
        if (corner(c) == corner((c + 1) % 3))
          fail("element", t.tags[e],
               fmt::format("two of its corners are node {}, expected different nodes",
                           content_.node_tags[file_node_[corner(c).index()]]));
    }
  }

  Tags read_tags() {
    Tags tags;
    tags.groups = std::move(content_.groups);
    tags.entities = std::move(content_.entities);
    const MshElements& t = triangles();
    if (std::any_of(t.entities.begin(), t.entities.end(), [](int e) { return e != 0; }))
      tags.element_entity = t.entities;
    if (content_.metadata) {
      tags.groups = content_.metadata->tags.groups;
      tags.entities = content_.metadata->tags.entities;
      if (!content_.metadata->has_element_entity) tags.element_entity.clear();
    }
    const MshElements& lines = content_.elements[1];
    if (!lines.tags.empty() && lines.degree != triangles().degree)
      fail("element", lines.tags[0],
           fmt::format("a line of degree {}, the triangles have degree {}; expected one degree",
                       lines.degree, triangles().degree));
    std::size_t dropped_lines = 0, dropped_points = 0;
    if (!lines.tags.empty()) {
      const EdgeFinder finder(*topology_);
      const std::size_t w = width(lines);
      const std::vector<int> order = line_order(lines.degree);
      for (std::size_t i = 0; i < lines.tags.size(); ++i) {
        TaggedEdge edge{std::vector<NodeId>(w), lines.entities[i]};
        for (std::size_t m = 0; m < w; ++m)
          edge.nodes[at(order[m])] = id_[node_of(lines, i, lines.nodes[i * w + m])];
        if (finder.find(edge.nodes)) {
          tags.edges.push_back(std::move(edge));
        } else {
          ++dropped_lines;
        }
      }
    }
    const MshElements& points = content_.elements[0];
    for (std::size_t i = 0; i < points.tags.size(); ++i) {
      const NodeId node = id_[node_of(points, i, points.nodes[i])];
      if (node.valid()) {
        tags.points.push_back({node, points.entities[i]});
      } else {
        ++dropped_points;
      }
    }
    if (dropped_lines > 0)
      say(fmt::format("{} of {} lines are no edges of triangles and were dropped", dropped_lines,
                      lines.tags.size()));
    if (dropped_points > 0)
      say(fmt::format("{} of {} points are no nodes of triangles and were dropped", dropped_points,
                      points.tags.size()));
    return tags;
  }

  // Fields.

  void fields(Dataset& data) {
    // Several steps of one field: the last one in the file is kept.
    std::map<std::string, std::vector<const MshData*>> steps;
    std::vector<std::string> names;
    for (const MshData& d : content_.data) {
      if (steps[d.name].empty()) names.push_back(d.name);
      steps[d.name].push_back(&d);
    }
    if (names.empty()) return;
    layout_ = node_layout(*topology_);
    element_of_ = std::make_unique<Lookup>(triangles().tags);
    for (const std::string& name : names) {
      const MshData& d = *steps[name].back();
      if (steps[name].size() > 1)
        say(fmt::format("field '{}' has {} time steps, the last one{} was kept", name,
                        steps[name].size(), d.time ? fmt::format(" (t = {})", *d.time) : ""));
      if (d.time && data.time && *d.time != *data.time)
        say(fmt::format("field '{}' is for t = {}, others for t = {}; the last one's time was kept",
                        name, *d.time, *data.time));
      if (d.time) data.time = d.time;
      bool continuous = false;
      MappedField field = read_field(d, continuous);
      const FieldMetadata* metadata = content_.metadata ? content_.metadata->field(name) : nullptr;
      if (!metadata && field.components == 3) flatten(field);
      data.fields.push_back(
          restore_field(mesh_, std::move(field), metadata, continuous, content_.notes));
    }
  }

  /// Gmsh's vectors have three components; in the plane the third is zero.
  void flatten(MappedField& field) {
    for (std::size_t i = 2; i < field.coefficients.size(); i += 3)
      if (field.coefficients[i] != 0.0) return;
    std::vector<double> two;
    two.reserve(field.coefficients.size() / 3 * 2);
    for (std::size_t i = 0; i < field.coefficients.size(); ++i)
      if (i % 3 != 2) two.push_back(field.coefficients[i]);
    field.coefficients = std::move(two);
    field.components = 2;
    say(fmt::format("field '{}': its third component is 0 everywhere and was dropped", field.name));
  }

  [[noreturn]] void fail_field(const std::string& name, const std::string& message) const {
    fail("", -1, fmt::format("field '{}': {}", name, message));
  }

  MappedField read_field(const MshData& d, bool& continuous) {
    switch (d.kind) {
      case MshData::node:
        continuous = true;
        return node_data(d);
      case MshData::element:
        return element_data(d);
      default:
        return element_node_data(d);
    }
  }

  /// Where the values of each element or node are; none: not given.
  std::vector<std::size_t> rows(const MshData& d, const Lookup& lookup, std::size_t count,
                                const char* kind) {
    std::vector<std::size_t> row(count, none);
    for (std::size_t i = 0; i < d.tags.size(); ++i) {
      const std::size_t found = lookup.find(d.tags[i]);
      if (found == none) {
        if (kind[0] == 'n')
          fail_field(d.name, fmt::format("node {} does not exist, the file has {}", d.tags[i],
                                         content_.node_tags.size()));
        continue;  // an element that is no triangle
      }
      if (row[found] != none)
        fail_field(d.name, fmt::format("{} {} has two values, expected one", kind, d.tags[i]));
      row[found] = i;
    }
    return row;
  }

  MappedField node_data(const MshData& d) {
    const int g = topology_->degree();
    const std::vector<std::size_t> row = rows(d, nodes_, content_.node_tags.size(), "node");
    const auto w = at(d.components);
    std::vector<double> values(layout_.origin.size() * w);
    for (std::size_t n = 0; n < layout_.origin.size(); ++n) {
      const std::size_t file_node = file_node_[layout_.origin[n].index()];
      if (row[file_node] == none)
        fail_field(d.name, fmt::format("node {} has no value", content_.node_tags[file_node]));
      const std::size_t start = d.starts[row[file_node]];
      for (std::size_t c = 0; c < w; ++c) values[n * w + c] = d.values[start + c];
    }
    values = convert_nodes(*topology_, layout_, values, d.components, Conversion::to_bernstein);
    MappedField field{d.name, d.components, g, {}};
    field.coefficients.reserve(layout_.elements.size() * w);
    for (const NodeId n : layout_.elements)
      for (std::size_t c = 0; c < w; ++c) field.coefficients.push_back(values[n.index() * w + c]);
    return field;
  }

  MappedField element_data(const MshData& d) {
    const std::size_t count = triangles().tags.size();
    const std::vector<std::size_t> row = rows(d, *element_of_, count, "element");
    const auto w = at(d.components);
    MappedField field{d.name, d.components, 0, {}};
    for (std::size_t e = 0; e < count; ++e) {
      if (row[e] == none)
        fail_field(d.name, fmt::format("element {} has no value", triangles().tags[e]));
      const auto start = d.values.begin() + static_cast<std::ptrdiff_t>(d.starts[row[e]]);
      field.coefficients.insert(field.coefficients.end(), start,
                                start + static_cast<std::ptrdiff_t>(w));
    }
    return field;
  }

  /// Rows: the nodes of the lattice of the scheme's degree in index order; columns: its functions.
  struct Sampling {
    int degree = 0;
    std::vector<double> matrix;
  };

  Sampling sampling(const MshData& d, const InterpolationScheme& scheme) const {
    Sampling s;
    for (std::size_t j = 0; j < scheme.monomials; ++j) {
      int total = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double power = scheme.exponents[3 * j + axis];
        if (!(power >= 0.0 && power <= Space::max_degree && power == std::floor(power)) ||
            (axis == 2 && power != 0.0))
          fail_field(d.name,
                     fmt::format("exponent {} in interpolation scheme '{}', expected 0 to {}{}",
                                 power, shown(d.scheme), axis == 2 ? 0 : Space::max_degree,
                                 axis == 2 ? " for the third variable" : ""));
        total += static_cast<int>(power);
      }
      s.degree = std::max(s.degree, total);
    }
    if (s.degree > Space::max_degree)
      fail_field(d.name, fmt::format("interpolation scheme '{}' has degree {}, expected at most {}",
                                     shown(d.scheme), s.degree, Space::max_degree));
    const int points = triangle_size(s.degree);
    const double step = s.degree == 0 ? 0.0 : 1.0 / s.degree;
    for (int n = 0; n < points; ++n) {
      const auto index = bernstein::triangle_multi_index(s.degree, n);
      const double u = s.degree == 0 ? 1.0 / 3.0 : step * index[1];
      const double v = s.degree == 0 ? 1.0 / 3.0 : step * index[2];
      for (std::size_t i = 0; i < scheme.functions; ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < scheme.monomials; ++j)
          sum += scheme.coefficients[i * scheme.monomials + j] *
                 std::pow(u, scheme.exponents[3 * j]) * std::pow(v, scheme.exponents[3 * j + 1]);
        s.matrix.push_back(sum);
      }
    }
    return s;
  }

  /// The degree whose equally spaced nodes a scheme interpolates, or -1.
  static int nodal_degree(const InterpolationScheme& scheme) {
    for (int q = 0; q <= Space::max_degree; ++q) {
      if (scheme.functions != at(triangle_size(q)) || scheme.monomials != scheme.functions)
        continue;
      const InterpolationScheme nodal = nodal_scheme(q);
      if (nodal.coefficients == scheme.coefficients && nodal.exponents == scheme.exponents)
        return q;
    }
    return -1;
  }

  MappedField element_node_data(const MshData& d) {
    const std::size_t count = triangles().tags.size();
    const std::vector<std::size_t> row = rows(d, *element_of_, count, "element");
    const auto w = at(d.components);
    const int g = topology_->degree();
    MappedField field{d.name, d.components, -1, {}};
    Sampling general;
    std::size_t functions = 0;
    if (!d.scheme.empty()) {
      const auto found = content_.schemes.find(d.scheme);
      if (found == content_.schemes.end())
        fail_field(d.name,
                   fmt::format("interpolation scheme '{}' is not in the file (for triangles)",
                               shown(d.scheme)));
      functions = found->second.functions;
      field.degree = nodal_degree(found->second);
      if (field.degree < 0) general = sampling(d, found->second);
    }
    std::vector<double> nodal, b;
    std::vector<int> order;
    for (std::size_t e = 0; e < count; ++e) {
      if (row[e] == none)
        fail_field(d.name, fmt::format("element {} has no values", triangles().tags[e]));
      const std::size_t start = d.starts[row[e]];
      const std::size_t values = (d.starts[row[e] + 1] - start) / w;
      if (functions == 0) {
        const std::size_t own = at(triangle_size(g));
        if (values != 3 && values != own)
          fail_field(
              d.name,
              fmt::format("element {} has {} values without an interpolation scheme, "
                          "expected 3{}",
                          triangles().tags[e], values, own == 3 ? "" : fmt::format(" or {}", own)));
        functions = values;
        field.degree = values == 3 ? 1 : g;
      }
      if (values != functions)
        fail_field(d.name, fmt::format("element {} has {} values, expected {}", triangles().tags[e],
                                       values, functions));
      const bool direct = field.degree >= 0;
      const int q = direct ? field.degree : general.degree;
      if (order.empty()) {
        order = q == 0 ? std::vector<int>{0} : triangle_order(q);
        nodal.resize(at(triangle_size(q)));
        field.coefficients.reserve(count * nodal.size() * w);
      }
      const std::size_t offset = field.coefficients.size();
      field.coefficients.resize(offset + nodal.size() * w);
      for (std::size_t c = 0; c < w; ++c) {
        if (direct) {
          for (std::size_t i = 0; i < order.size(); ++i)
            nodal[at(order[i])] = d.values[start + i * w + c];
        } else {
          for (std::size_t r = 0; r < nodal.size(); ++r) {
            nodal[r] = 0.0;
            for (std::size_t i = 0; i < functions; ++i)
              nodal[r] += general.matrix[r * functions + i] * d.values[start + i * w + c];
          }
        }
        b = bernstein::from_lagrange<double>(q, nodal);
        for (std::size_t i = 0; i < b.size(); ++i) field.coefficients[offset + i * w + c] = b[i];
      }
    }
    if (field.degree < 0) field.degree = general.degree;
    return field;
  }

  Cursor at_;
  MshContent content_;
  Lookup nodes_;
  std::vector<NodeId> id_;              // by position in the file
  std::vector<std::size_t> file_node_;  // by NodeId
  std::shared_ptr<const TriangleMesh> topology_, mesh_;
  NodeLayout layout_;
  std::unique_ptr<Lookup> element_of_;
};

}  // namespace

Dataset assemble_msh(const std::string& path, std::string_view bytes, MshContent content) {
  return MshAssembler(path, bytes, std::move(content)).assemble();
}

}  // namespace bezel::files
