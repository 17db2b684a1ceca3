// Writing MSH files, versions 2.2 and 4.1, text and binary.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <set>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/io/cursor.hpp"
#include "bezel/io/field_map.hpp"
#include "bezel/io/msh.hpp"
#include "bezel/io/nodal.hpp"
#include "bezel/io/node_order.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::files {
namespace {

using bernstein::triangle_size;
using short_names::at;

using EntityKey = std::pair<int, int>;  // dim, tag

class MshWriter {
 public:
  MshWriter(const Dataset& data, Format format, std::vector<std::string>& lost)
      : data_(data),
        mesh_(*data.mesh),
        binary_(format == Format::msh22_binary || format == Format::msh41_binary),
        v4_(format == Format::msh41_ascii || format == Format::msh41_binary),
        lost_(lost) {}

  std::string write() {
    check();
    plan();
    header();
    if (v4_) {
      entities4();
      nodes4();
      elements4();
    } else {
      nodes2();
      elements2();
    }
    out_ += "$Bezel\n" + to_json(describe(data_)) + "\n$EndBezel\n";
    for (const Field& field : data_.fields) write_field(field);
    return std::move(out_);
  }

 private:
  struct Part {  // an element of any dimension, in the order of its number
    int dim;
    std::size_t index;
    EntityKey entity;
  };

  // Values, text or binary.
  void i32(std::int64_t value) {
    if (binary_) {
      const auto narrow = static_cast<std::int32_t>(value);
      raw(&narrow, sizeof narrow);
    } else {
      append_number(out_, value);
      out_ += ' ';
    }
  }
  void u64(std::size_t value) {
    if (binary_) {
      const auto wide = static_cast<std::uint64_t>(value);
      raw(&wide, sizeof wide);
    } else {
      append_number(out_, static_cast<std::int64_t>(value));
      out_ += ' ';
    }
  }
  void f64(double value) {
    if (binary_) {
      raw(&value, sizeof value);
    } else {
      append_number(out_, value);
      out_ += ' ';
    }
  }
  void raw(const void* bytes, std::size_t size) {
    out_.append(static_cast<const char*>(bytes), size);
  }
  void end_line() {
    if (binary_) return;
    if (!out_.empty() && out_.back() == ' ') out_.pop_back();
    out_ += '\n';
  }
  void end_section(const char* name) {
    if (binary_) out_ += '\n';
    out_ += name;
    out_ += '\n';
  }
  void node_tag(NodeId n) { v4_ ? u64(n.index() + 1) : i32(n.value + 1); }

  static void check_name(const std::string& what, const std::string& name) {
    for (const char c : name)
      if (c == '"' || static_cast<unsigned char>(c) < ' ')
        throw InputError(fmt::format(
            "{} '{}' has a character that MSH cannot hold, expected no quotes or line breaks", what,
            shown(name)));
  }

  void check() const {
    for (const PhysicalGroup& group : mesh_.tags().groups) check_name("physical group", group.name);
    for (const Field& field : data_.fields) {
      check_name("field", field.name());
      mapped_degree(field);
    }
  }

  void plan() {
    layout_ = node_layout(mesh_);
    const Tags& tags = mesh_.tags();
    // Elements without tags still need a surface in MSH.
    int untagged = 1;
    for (const Entity& entity : tags.entities) {
      groups_[{entity.dim, entity.tag}] = entity.physical;
      if (entity.dim == 2) untagged = std::max(untagged, entity.tag + 1);
    }
    const auto surface = [&](std::size_t e) {
      return tags.element_entity.empty() ? untagged : tags.element_entity[e];
    };
    in_entity_.assign(layout_.origin.size(), {2, 0});
    const auto size = at(mesh_.nodes_per_element());
    for (std::size_t i = 0; i < layout_.elements.size(); ++i)
      in_entity_[layout_.elements[i].index()] = {2, surface(i / size)};

    std::vector<bool> used(layout_.origin.size(), false);
    for (const NodeId n : layout_.elements) used[n.index()] = true;
    std::size_t dropped_points = 0, dropped_edges = 0;
    std::vector<Part> points, edges;
    if (!tags.edges.empty()) {
      const EdgeFinder finder(mesh_);
      for (const TaggedEdge& edge : tags.edges) {
        const auto found = finder.find(edge.nodes);
        if (!found) {
          ++dropped_edges;
          continue;
        }
        const ElementSide& side = mesh_.adjacent(found->edge).front();
        std::vector<NodeId> nodes;
        for (int m = 0; m <= mesh_.degree(); ++m)
          nodes.push_back(
              layout_.elements[side.element.index() * size +
                               at(bernstein::triangle_side_index(mesh_.degree(), side.side, m))]);
        if (side.reversed != found->reversed) std::reverse(nodes.begin(), nodes.end());
        for (const NodeId n : nodes) in_entity_[n.index()] = {1, edge.entity};
        edges.push_back({1, edges_.size(), {1, edge.entity}});
        edges_.push_back(std::move(nodes));
      }
    }
    for (const TaggedPoint& point : tags.points) {
      if (!used[point.node.index()]) {
        ++dropped_points;
        continue;
      }
      in_entity_[point.node.index()] = {0, point.entity};
      points.push_back({0, points_.size(), {0, point.entity}});
      points_.push_back(point.node);
    }
    if (dropped_edges > 0)
      lost_.push_back(
          fmt::format("{} of {} tagged edges are no edges of triangles and were dropped",
                      dropped_edges, tags.edges.size()));
    if (dropped_points > 0)
      lost_.push_back(
          fmt::format("{} of {} tagged points are no nodes of triangles and were dropped",
                      dropped_points, tags.points.size()));
    parts_ = std::move(points);
    parts_.insert(parts_.end(), edges.begin(), edges.end());
    first_triangle_ = parts_.size() + 1;
    for (std::size_t e = 0; e < mesh_.element_count(); ++e)
      parts_.push_back({2, e, {2, surface(e)}});
    for (const Part& part : parts_) groups_.try_emplace(part.entity);
    for (const EntityKey& key : in_entity_) groups_.try_emplace(key);
    std::size_t unused = 0;
    for (std::size_t n = 0; n < used.size(); ++n) unused += used[n] ? 0 : 1;
    if (unused > 0)
      lost_.push_back(
          fmt::format("{} nodes belong to no triangle; they are in the file, but readers "
                      "leave them out",
                      unused));

    positions_.resize(layout_.origin.size() * 2);
    for (std::size_t n = 0; n < layout_.origin.size(); ++n)
      for (int axis = 0; axis < 2; ++axis)
        positions_[2 * n + at(axis)] = mesh_.control(layout_.origin[n])[axis];
    positions_ = convert_nodes(mesh_, layout_, positions_, 2, Conversion::to_nodal);
  }

  void header() {
    out_ += fmt::format("$MeshFormat\n{} {} 8\n", v4_ ? "4.1" : "2.2", binary_ ? 1 : 0);
    if (binary_) {
      const std::int32_t one = 1;
      raw(&one, sizeof one);
      out_ += '\n';
    }
    out_ += "$EndMeshFormat\n";
    const auto& groups = mesh_.tags().groups;
    if (groups.empty()) return;
    out_ += fmt::format("$PhysicalNames\n{}\n", groups.size());
    for (const PhysicalGroup& group : groups)
      out_ += fmt::format("{} {} \"{}\"\n", group.dim, group.tag, group.name);
    out_ += "$EndPhysicalNames\n";
  }

  void entities4() {
    std::map<EntityKey, Box2> boxes;
    for (std::size_t n = 0; n < in_entity_.size(); ++n)
      boxes[in_entity_[n]].include(Vec2{positions_[2 * n], positions_[2 * n + 1]});
    for (const Part& part : parts_) {  // ends of curves may be classified on points
      if (part.dim == 1)
        for (const NodeId n : edges_[part.index])
          boxes[part.entity].include(
              Vec2{positions_[2 * n.index()], positions_[2 * n.index() + 1]});
      if (part.dim == 2)
        for (int corner = 0; corner < 3; ++corner) {
          const NodeId n = layout_.elements[part.index * at(mesh_.nodes_per_element()) +
                                            at(bernstein::triangle_corner(mesh_.degree(), corner))];
          boxes[part.entity].include(
              Vec2{positions_[2 * n.index()], positions_[2 * n.index() + 1]});
        }
    }
    out_ += "$Entities\n";
    std::array<std::size_t, 4> counts{};
    for (const auto& entity : groups_) ++counts[at(std::clamp(entity.first.first, 0, 3))];
    for (const std::size_t n : counts) u64(n);
    end_line();
    for (const auto& entity : groups_) {
      const int dim = entity.first.first;
      Box2 box = boxes[entity.first];
      if (box.empty()) box.include(Vec2{0.0, 0.0});
      i32(entity.first.second);
      for (const double value : {box.lo[0], box.lo[1], 0.0}) f64(value);
      if (dim > 0)
        for (const double value : {box.hi[0], box.hi[1], 0.0}) f64(value);
      u64(entity.second.size());
      for (const int physical : entity.second) i32(physical);
      if (dim > 0) u64(0);
      end_line();
    }
    end_section("$EndEntities");
  }

  void nodes4() {
    std::map<EntityKey, std::vector<NodeId>> blocks;
    for (std::size_t n = 0; n < in_entity_.size(); ++n) blocks[in_entity_[n]].push_back(NodeId(n));
    out_ += "$Nodes\n";
    u64(blocks.size());
    u64(in_entity_.size());
    u64(1);
    u64(in_entity_.size());
    end_line();
    for (const auto& block : blocks) {
      i32(block.first.first);
      i32(block.first.second);
      i32(0);
      u64(block.second.size());
      end_line();
      for (const NodeId n : block.second) {
        node_tag(n);
        end_line();
      }
      for (const NodeId n : block.second) {
        position(n);
        end_line();
      }
    }
    end_section("$EndNodes");
  }

  void position(NodeId n) {
    f64(positions_[2 * n.index()]);
    f64(positions_[2 * n.index() + 1]);
    f64(0.0);
  }

  int type_of(int dim) const {
    return dim == 0   ? 15
           : dim == 1 ? msh_line_type(mesh_.degree())
                      : msh_triangle_type(mesh_.degree());
  }

  void nodes_of(const Part& part) {
    if (part.dim == 0) {
      node_tag(points_[part.index]);
    } else if (part.dim == 1) {
      for (const int m : line_order_) node_tag(edges_[part.index][at(m)]);
    } else {
      const auto size = at(mesh_.nodes_per_element());
      for (const int i : triangle_order_) node_tag(layout_.elements[part.index * size + at(i)]);
    }
  }

  void elements4() {
    std::map<EntityKey, std::vector<std::size_t>> blocks;
    for (std::size_t p = 0; p < parts_.size(); ++p) blocks[parts_[p].entity].push_back(p);
    out_ += "$Elements\n";
    u64(blocks.size());
    u64(parts_.size());
    u64(1);
    u64(parts_.size());
    end_line();
    for (const auto& block : blocks) {
      i32(block.first.first);
      i32(block.first.second);
      i32(type_of(block.first.first));
      u64(block.second.size());
      end_line();
      for (const std::size_t p : block.second) {
        u64(p + 1);
        nodes_of(parts_[p]);
        end_line();
      }
    }
    end_section("$EndElements");
  }

  void nodes2() {
    out_ += fmt::format("$Nodes\n{}\n", in_entity_.size());
    for (std::size_t n = 0; n < in_entity_.size(); ++n) {
      node_tag(NodeId(n));
      position(NodeId(n));
      end_line();
    }
    end_section("$EndNodes");
  }

  void elements2() {
    std::size_t several = 0;
    for (const auto& entity : groups_) several += entity.second.size() > 1 ? 1 : 0;
    if (several > 0)
      lost_.push_back(
          fmt::format("MSH 2.2 names one physical group per element: of {} entities in "
                      "several groups others than bezel see the first only",
                      several));
    out_ += fmt::format("$Elements\n{}\n", parts_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const Part& part = parts_[p];
      if (binary_ && (p == 0 || parts_[p - 1].dim != part.dim)) {
        std::size_t following = 0;
        while (p + following < parts_.size() && parts_[p + following].dim == part.dim) ++following;
        i32(type_of(part.dim));
        i32(static_cast<std::int64_t>(following));
        i32(2);
      }
      i32(static_cast<std::int64_t>(p) + 1);
      if (!binary_) {
        i32(type_of(part.dim));
        i32(2);
      }
      const std::vector<int>& physical = groups_[part.entity];
      i32(physical.empty() ? 0 : physical[0]);
      i32(part.entity.second);
      nodes_of(part);
      end_line();
    }
    end_section("$EndElements");
  }

  // Fields.

  void data_header(const Field& field, const std::string& scheme, int components,
                   std::size_t count) {
    out_ += scheme.empty() ? fmt::format("1\n\"{}\"\n", field.name())
                           : fmt::format("2\n\"{}\"\n\"{}\"\n", field.name(), scheme);
    if (data_.time) {
      out_ += "1\n";
      append_number(out_, *data_.time);
      out_ += '\n';
    } else {
      out_ += "0\n";
    }
    out_ += fmt::format("3\n0\n{}\n{}\n", components, count);
  }

  void write_field(const Field& field) {
    const int q = mapped_degree(field);
    say_raised(field, q, lost_);
    const MappedField mapped = map_field(field, q);
    const int own = field.components();
    const int padded = own == 1 ? 1 : own <= 3 ? 3 : 9;
    if (own != padded && own != 2)
      lost_.push_back(
          fmt::format("field '{}': {} components, written as {} (the rest is 0); bezel "
                      "restores it",
                      field.name(), own, padded));
    const auto values = [&](const double* from) {
      for (int c = 0; c < padded; ++c) f64(c < own ? from[c] : 0.0);
    };
    const std::size_t elements = mesh_.element_count();
    if (q == 0) {
      out_ += "$ElementData\n";
      data_header(field, "", padded, elements);
      for (std::size_t e = 0; e < elements; ++e) {
        i32(static_cast<std::int64_t>(first_triangle_ + e));
        values(mapped.coefficients.data() + e * at(own));
        end_line();
      }
      end_section("$EndElementData");
    } else if (q == mesh_.degree() && field.space().continuity() == Continuity::continuous) {
      std::vector<double> nodal = per_node(mesh_, layout_.elements, layout_.origin.size(), mapped);
      nodal = convert_nodes(mesh_, layout_, nodal, own, Conversion::to_nodal);
      out_ += "$NodeData\n";
      data_header(field, "", padded, layout_.origin.size());
      for (std::size_t n = 0; n < layout_.origin.size(); ++n) {
        i32(static_cast<std::int64_t>(n) + 1);
        values(nodal.data() + n * at(own));
        end_line();
      }
      end_section("$EndNodeData");
    } else {
      const std::string scheme = q == mesh_.degree() ? "" : scheme_for(q);
      const auto size = at(triangle_size(q));
      const std::vector<int> order = triangle_order(q);
      out_ += "$ElementNodeData\n";
      data_header(field, scheme, padded, elements);
      std::vector<double> b(size), nodal(size * at(own));
      for (std::size_t e = 0; e < elements; ++e) {
        const double* const from = mapped.coefficients.data() + e * size * at(own);
        for (std::size_t c = 0; c < at(own); ++c) {
          for (std::size_t i = 0; i < size; ++i) b[i] = from[i * at(own) + c];
          const std::vector<double> converted = bernstein::to_lagrange<double>(q, b);
          for (std::size_t i = 0; i < size; ++i) nodal[i * at(own) + c] = converted[i];
        }
        i32(static_cast<std::int64_t>(first_triangle_ + e));
        i32(static_cast<std::int64_t>(size));
        for (const int i : order) values(nodal.data() + at(i) * at(own));
        end_line();
      }
      end_section("$EndElementNodeData");
    }
  }

  /// Writes the scheme of a degree once, before its first use.
  std::string scheme_for(int q) {
    std::string name = fmt::format("bezel nodes of degree {}", q);
    if (!schemes_.insert(q).second) return name;
    const InterpolationScheme scheme = nodal_scheme(q);
    out_ += fmt::format("$InterpolationScheme\n\"{}\"\n1\n3\n2\n", name);
    const auto matrix = [&](std::size_t rows, std::size_t columns, const std::vector<double>& m) {
      out_ += fmt::format("{} {}\n", rows, columns);
      for (std::size_t i = 0; i < rows * columns; ++i) {
        append_number(out_, m[i]);
        out_ += (i + 1) % columns == 0 ? '\n' : ' ';
      }
    };
    matrix(scheme.functions, scheme.monomials, scheme.coefficients);
    matrix(scheme.monomials, 3, scheme.exponents);
    out_ += "$EndInterpolationScheme\n";
    return name;
  }

  const Dataset& data_;
  const TriangleMesh& mesh_;
  bool binary_, v4_;
  std::vector<std::string>& lost_;
  std::string out_;
  NodeLayout layout_;
  std::vector<double> positions_;                 // nodal, two per node of the layout
  std::vector<EntityKey> in_entity_;              // per node
  std::map<EntityKey, std::vector<int>> groups_;  // every entity and its physical groups
  std::vector<NodeId> points_;
  std::vector<std::vector<NodeId>> edges_;
  std::vector<Part> parts_;
  std::size_t first_triangle_ = 1;
  std::set<int> schemes_;
  std::vector<int> triangle_order_ = triangle_order(mesh_.degree());
  std::vector<int> line_order_ = line_order(mesh_.degree());
};

}  // namespace

std::string write_msh(const Dataset& data, Format format, std::vector<std::string>& lost) {
  return MshWriter(data, format, lost).write();
}

}  // namespace bezel::files
