#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/io/field_map.hpp"
#include "bezel/io/nodal.hpp"
#include "bezel/io/node_order.hpp"
#include "bezel/io/vtu.hpp"
#include "bezel/io/vtu_data.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::files {
namespace {

using bernstein::triangle_size;
using short_names::at;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < ' ')
      throw InputError("a field name has a control character, which VTU cannot hold");
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

class VtuWriter {
 public:
  VtuWriter(const Dataset& data, const WriteOptions& options, std::vector<std::string>& lost)
      : data_(data), bezier_(options.bezier_cells), compress_(options.compress), lost_(lost) {}

  std::string write() {
    plan();
    std::string metadata = to_json(describe(data_));
    metadata += '\0';
    std::string xml = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"{}\" header_type=\"UInt64\"{}>\n<UnstructuredGrid>\n<FieldData>\n",
        std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian",
        compress_ ? " compressor=\"vtkZLibDataCompressor\"" : "");
    xml += fmt::format("<Array type=\"String\" Name=\"bezel:metadata\" NumberOfTuples=\"1\" {}/>\n",
                       append(metadata));
    if (data_.time)
      xml +=
          fmt::format("<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" {}/>\n",
                      append_values(std::vector<double>{*data_.time}));
    xml += fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                       points_.size() / 3, types_.size());
    xml += "<Points>\n" + array("Float64", "Points", 3, append_values(points_)) + "</Points>\n";
    xml += "<Cells>\n" + array("Int64", "connectivity", 1, append_values(connectivity_)) +
           array("Int64", "offsets", 1, append_values(offsets_)) +
           fmt::format("<DataArray type=\"UInt8\" Name=\"types\" {}/>\n", append(types_)) +
           "</Cells>\n";
    xml += "<PointData>\n" + point_data() + "</PointData>\n";
    xml += "<CellData>\n" + cell_data() + "</CellData>\n";
    xml += "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"base64\">\n_";
    xml += appended_;
    xml += "\n</AppendedData>\n</VTKFile>\n";
    return xml;
  }

 private:
  std::string append(std::string_view bytes) {
    std::string place = fmt::format("format=\"appended\" offset=\"{}\"", appended_.size());
    appended_ += encode_array(bytes, compress_);
    return place;
  }
  template <class T>
  std::string append_values(const std::vector<T>& values) {
    return append({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  }
  static std::string array(const char* type, const std::string& name, int components,
                           const std::string& place) {
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" {}/>\n", type,
                       escaped(name), components, place);
  }

  void plan() {
    int degree = data_.mesh->degree();
    std::size_t discontinuous = 0;
    for (const Field& field : data_.fields) {
      const int q = mapped_degree(field);
      degree = std::max(degree, q);
      discontinuous += q > 0 && field.space().continuity() == Continuity::discontinuous ? 1 : 0;
    }
    if (degree != data_.mesh->degree())
      lost_.push_back(fmt::format(
          "the geometry, degree {}, is written as degree {} like the highest field; bezel "
          "restores it",
          data_.mesh->degree(), degree));
    for (const Field& field : data_.fields)
      say_raised(field, mapped_degree(field) == 0 ? 0 : degree, lost_);
    mesh_ = std::make_unique<TriangleMesh>(change_degree(*data_.mesh, degree));
    layout_ = node_layout(*mesh_);
    split_ = discontinuous > 0;
    cells();
  }

  std::vector<double> node_values(std::vector<double> values, int components) const {
    return bezier_ ? values
                   : convert_nodes(*mesh_, layout_, values, components, Conversion::to_nodal);
  }

  void cells() {
    const int d = mesh_->degree();
    const auto size = at(triangle_size(d));
    const std::vector<int> order = triangle_order(d);
    std::vector<double> positions(layout_.origin.size() * 2);
    for (std::size_t n = 0; n < layout_.origin.size(); ++n)
      for (int axis = 0; axis < 2; ++axis)
        positions[2 * n + at(axis)] = mesh_->control(layout_.origin[n])[axis];
    positions = node_values(std::move(positions), 2);
    const auto add_point = [&](NodeId n) {
      points_.insert(points_.end(), {positions[2 * n.index()], positions[2 * n.index() + 1], 0.0});
    };
    // A file point is a node of the layout, or a place in an element (in index order).
    if (split_) {
      for (const NodeId n : layout_.elements) add_point(n);
    } else {
      for (std::size_t n = 0; n < layout_.origin.size(); ++n) add_point(NodeId(n));
    }
    const auto point = [&](std::size_t e, int i) {
      return static_cast<std::int64_t>(split_ ? e * size + at(i)
                                              : layout_.elements[e * size + at(i)].index());
    };
    const auto end_cell = [&](int type) {
      offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
      types_ += static_cast<char>(type);
    };
    for (std::size_t e = 0; e < mesh_->element_count(); ++e) {
      for (const int i : order) connectivity_.push_back(point(e, i));
      end_cell(bezier_ && d > 1 ? 76 : d == 1 ? 5 : d == 2 ? 22 : 69);
    }
    const Tags& tags = mesh_->tags();
    entities_ = tags.element_entity;
    entities_.resize(mesh_->element_count(), 0);
    dims_.assign(mesh_->element_count(), 2);

    if (!tags.edges.empty()) {
      const EdgeFinder finder(*mesh_);
      const std::vector<int> along = line_order(d);
      for (const TaggedEdge& edge : tags.edges) {
        const auto found = finder.find(edge.nodes);
        if (!found) continue;
        const ElementSide& side = mesh_->adjacent(found->edge).front();
        const bool against = side.reversed != found->reversed;
        for (const int m : along)
          connectivity_.push_back(
              point(side.element.index(),
                    bernstein::triangle_side_index(d, side.side, against ? d - m : m)));
        end_cell(bezier_ && d > 1 ? 75 : d == 1 ? 3 : d == 2 ? 21 : 68);
        entities_.push_back(edge.entity);
        dims_.push_back(1);
      }
    }
    if (!tags.points.empty()) {
      std::vector<std::int64_t> corner(mesh_->node_count(), -1);
      for (std::size_t e = 0; e < mesh_->element_count(); ++e)
        for (int c = 0; c < 3; ++c) {
          const int i = bernstein::triangle_corner(d, c);
          std::int64_t& known = corner[mesh_->nodes(ElementId(e))[at(i)].index()];
          if (known < 0) known = point(e, i);
        }
      for (const TaggedPoint& p : tags.points) {
        if (corner[p.node.index()] < 0) continue;
        connectivity_.push_back(corner[p.node.index()]);
        end_cell(1);
        entities_.push_back(p.entity);
        dims_.push_back(0);
      }
    }
    const Tags& all = data_.mesh->tags();
    const std::size_t kept = dims_.size() - mesh_->element_count();
    if (kept != all.edges.size() + all.points.size())
      lost_.push_back(fmt::format(
          "{} of {} tagged edges and points are no edges or corners of triangles and were dropped",
          all.edges.size() + all.points.size() - kept, all.edges.size() + all.points.size()));
  }

  std::string point_data() {
    std::string xml;
    const auto size = at(mesh_->nodes_per_element());
    if (split_) {
      std::vector<std::int64_t> node;
      for (const NodeId n : layout_.elements) node.push_back(layout_.origin[n.index()].value);
      xml += array("Int64", "bezel:node", 1, append_values(node));
    }
    for (const Field& field : data_.fields) {
      if (mapped_degree(field) == 0) continue;
      const MappedField mapped = map_field(field, mesh_->degree());
      const auto width = at(field.components());
      std::vector<double> values;
      if (field.space().continuity() == Continuity::continuous) {
        const std::vector<double> nodes = node_values(
            per_node(*mesh_, layout_.elements, layout_.origin.size(), mapped), field.components());
        if (split_) {
          for (const NodeId n : layout_.elements)
            for (std::size_t c = 0; c < width; ++c) values.push_back(nodes[n.index() * width + c]);
        } else {
          values = nodes;
        }
      } else {
        values = mapped.coefficients;
        std::vector<double> b(size);
        for (std::size_t e = 0; !bezier_ && e < mesh_->element_count(); ++e)
          for (std::size_t c = 0; c < width; ++c) {
            double* const own = values.data() + e * size * width + c;
            for (std::size_t i = 0; i < size; ++i) b[i] = own[i * width];
            const std::vector<double> nodal = bernstein::to_lagrange<double>(mesh_->degree(), b);
            for (std::size_t i = 0; i < size; ++i) own[i * width] = nodal[i];
          }
      }
      xml += array("Float64", field.name(), field.components(), append_values(values));
    }
    return xml;
  }

  std::string cell_data() {
    std::string xml;
    const Tags& tags = data_.mesh->tags();
    if (!(tags == Tags{})) {
      std::map<std::pair<int, int>, std::int64_t> primary;
      for (const Entity& entity : tags.entities)
        primary[{entity.dim, entity.tag}] = entity.physical.empty() ? 0 : entity.physical[0];
      std::vector<std::int64_t> physical, geometrical;
      for (std::size_t i = 0; i < dims_.size(); ++i) {
        const auto found = primary.find({dims_[i], entities_[i]});
        physical.push_back(found == primary.end() ? 0 : found->second);
        geometrical.push_back(entities_[i]);
      }
      xml += array("Int64", "gmsh:physical", 1, append_values(physical));
      xml += array("Int64", "gmsh:geometrical", 1, append_values(geometrical));
    }
    for (const Field& field : data_.fields) {
      if (mapped_degree(field) != 0) continue;
      std::vector<double> values = map_field(field, 0).coefficients;
      values.resize(dims_.size() * at(field.components()), 0.0);  // edges and points
      xml += array("Float64", field.name(), field.components(), append_values(values));
    }
    return xml;
  }

  const Dataset& data_;
  bool bezier_, compress_;
  std::vector<std::string>& lost_;
  std::unique_ptr<TriangleMesh> mesh_;  // raised to the degree of the cells
  NodeLayout layout_;
  bool split_ = false;  // every element has points of its own
  std::vector<double> points_;
  std::vector<std::int64_t> connectivity_, offsets_;
  std::string types_;
  std::vector<int> entities_, dims_;  // per cell
  std::string appended_;
};

}  // namespace

std::string write_vtu(const Dataset& data, const WriteOptions& options,
                      std::vector<std::string>& lost) {
  return VtuWriter(data, options, lost).write();
}

}  // namespace bezel::files
