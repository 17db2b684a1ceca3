// Reading MSH files: the sections as they stand; msh_assemble.cpp makes a Dataset of them.

#include <fmt/format.h>

#include <cmath>

#include "bezel/io/msh_content.hpp"

namespace bezel::files {
namespace {

class MshReader {
 public:
  MshReader(const std::string& path, std::string_view bytes) : in_(bytes, path) {}

  MshContent read() {
    format();
    while (!in_.at_end()) section();
    in_.set_binary(false, false);
    if (!seen_nodes_) in_.fail("the file has no $Nodes section");
    if (!seen_elements_) in_.fail("the file has no $Elements section");
    return std::move(content_);
  }

 private:
  void format() {
    in_.expect("$MeshFormat");
    const std::string version(in_.word("the MSH version"));
    v4_ = version == "4.1";
    if (!v4_ && version != "2" && version != "2.0" && version != "2.1" && version != "2.2")
      in_.fail(fmt::format("MSH version {} is not supported, expected 2.2 or 4.1", shown(version)));
    const std::int64_t type = in_.text_integer("the file type");
    if (type != 0 && type != 1)
      in_.fail(fmt::format("file type {} is not 0 (text) or 1 (binary)", type));
    const std::int64_t size = in_.text_integer("the data size");
    if (size != 8) in_.fail(fmt::format("data size {} is not supported, expected 8", size));
    if (type == 1) {
      in_.line();
      in_.set_binary(true, false);
      const std::int32_t one = in_.i32("the number 1 that tells the byte order");
      if (one == 0x01000000) {
        in_.set_binary(true, true);
      } else if (one != 1) {
        in_.fail(fmt::format("the byte order mark is {}, expected 1 in either byte order", one));
      }
    }
    in_.expect("$EndMeshFormat");
    content_.v4 = v4_;
  }

  void section() {
    const std::string_view name = in_.word("a section");
    if (name.size() < 2 || name[0] != '$' || name.substr(0, 4) == "$End")
      in_.fail(fmt::format("expected a section such as $Nodes, found '{}'", shown(name)));
    const std::string end = "$End" + std::string(name.substr(1));
    const std::size_t start = in_.position();
    in_.line();
    if (name == "$PhysicalNames") {
      physical_names();
    } else if (name == "$Entities" && v4_) {
      entities();
    } else if (name == "$PartitionedEntities" && v4_) {
      partitioned_entities();
    } else if (name == "$Nodes") {
      once(seen_nodes_, "$Nodes");
      v4_ ? nodes4() : nodes2();
    } else if (name == "$Elements") {
      once(seen_elements_, "$Elements");
      v4_ ? elements4() : elements2();
    } else if (name == "$NodeData") {
      data(MshData::node);
    } else if (name == "$ElementData") {
      data(MshData::element);
    } else if (name == "$ElementNodeData") {
      data(MshData::element_node);
    } else if (name == "$InterpolationScheme") {
      interpolation_scheme();
    } else if (name == "$Bezel") {
      in_.skip_space();
      const std::string_view text = in_.line();
      try {
        content_.metadata = metadata_from_json(text);
      } catch (const InputError& error) {
        in_.fail(error.message());
      }
    } else {
      skip(name, end, start);
      return;
    }
    in_.expect(end);
  }

  void once(bool& seen, const char* name) {
    if (seen) in_.fail(fmt::format("a second {} section, expected one", name));
    seen = true;
  }

  void skip(std::string_view name, const std::string& end, std::size_t start) {
    const std::size_t found = in_.data().find("\n" + end, start);
    if (found == std::string_view::npos)
      in_.fail(fmt::format("section {} is not closed, expected {}", shown(name), shown(end)));
    if (name == "$Periodic") {
      content_.notes.push_back("the links between periodic entities were dropped");
    } else if (name == "$GhostElements") {
      content_.notes.push_back("the ghost elements of partitions were dropped");
    } else if (name != "$Comments") {
      content_.notes.push_back(fmt::format("section {} was skipped", shown(name)));
    }
    in_.seek(found + 1 + end.size());
  }

  void physical_names() {
    const std::size_t n = in_.check_count(in_.text_integer("the number of physical names"),
                                          "the number of physical names", 6);
    for (std::size_t i = 0; i < n; ++i) {
      PhysicalGroup group;
      group.dim = small(in_.text_integer("a dimension"), 0, 3, "a dimension");
      group.tag = small(in_.text_integer("a physical tag"), min_tag, max_tag, "a physical tag");
      group.name = in_.quoted("a physical name");
      content_.groups.push_back(std::move(group));
    }
  }

  int small(std::int64_t value, std::int64_t lowest, std::int64_t highest, const char* what) {
    if (value < lowest || value > highest)
      in_.fail(fmt::format("{} is {}, expected {} to {}", what, value, lowest, highest));
    return static_cast<int>(value);
  }

  std::vector<int> physical_tags() {
    const std::size_t n = in_.count("the number of physical tags", in_.binary() ? 4 : 2, true);
    std::vector<int> tags;
    for (std::size_t i = 0; i < n; ++i) {
      const std::int32_t tag = in_.i32("a physical tag");
      if (tag < min_tag) in_.fail(fmt::format("physical tag {} is out of range", tag));
      if (tag < 0) content_.reversed_groups = true;
      tags.push_back(std::abs(tag));
    }
    return tags;
  }

  /// What follows the tags of an entity in both entity sections: box, groups, boundary.
  Entity entity_tail(int dim, int tag) {
    for (int i = 0; i < (dim == 0 ? 3 : 6); ++i) in_.f64("a coordinate of an entity");
    Entity entity{dim, tag, physical_tags()};
    if (dim > 0) {
      const std::size_t n =
          in_.count("the number of bounding entities", in_.binary() ? 4 : 2, true);
      for (std::size_t i = 0; i < n; ++i) in_.i32("a bounding entity");
    }
    return entity;
  }

  void entities() {
    std::array<std::size_t, 4> counts{};
    for (std::size_t& n : counts)
      n = in_.count("the number of entities", in_.binary() ? 36 : 8, true);
    for (int dim = 0; dim < 4; ++dim)
      for (std::size_t i = 0; i < counts[static_cast<std::size_t>(dim)]; ++i) {
        const std::int32_t tag = in_.i32("an entity tag");
        content_.entities.push_back(entity_tail(dim, tag));
      }
  }

  void partitioned_entities() {
    content_.notes.push_back("the partitions of the mesh were dropped");
    in_.i64("the number of partitions");
    const std::size_t ghosts =
        in_.count("the number of ghost entities", in_.binary() ? 8 : 4, true);
    for (std::size_t i = 0; i < 2 * ghosts; ++i) in_.i32("a ghost entity");
    std::array<std::size_t, 4> counts{};
    for (std::size_t& n : counts)
      n = in_.count("the number of partitioned entities", in_.binary() ? 40 : 10, true);
    for (int dim = 0; dim < 4; ++dim)
      for (std::size_t i = 0; i < counts[static_cast<std::size_t>(dim)]; ++i) {
        const std::int32_t tag = in_.i32("an entity tag");
        const std::int32_t parent_dim = in_.i32("a parent dimension");
        const std::int32_t parent_tag = in_.i32("a parent tag");
        const std::size_t n = in_.count("the number of partitions", in_.binary() ? 4 : 2, true);
        for (std::size_t p = 0; p < n; ++p) in_.i32("a partition");
        entity_tail(dim, tag);
        content_.partitioned[{dim, tag}] = {parent_dim, parent_tag};
      }
  }

  double coordinate(std::int64_t node, const char* what) {
    const double value = in_.f64(what);
    if (!std::isfinite(value))
      in_.fail("node", node, fmt::format("{} is {}, expected a finite number", what, value));
    return value;
  }

  void point(std::int64_t tag) {
    content_.node_tags.push_back(tag);
    const double x = coordinate(tag, "x"), y = coordinate(tag, "y"), z = coordinate(tag, "z");
    content_.positions.push_back({x, y});
    content_.z.push_back(z);
  }

  std::size_t text_count(const char* what, std::size_t text_bytes, std::size_t binary_bytes) {
    const std::int64_t n = in_.text_integer(what);
    const std::size_t count = in_.check_count(n, what, in_.binary() ? binary_bytes : text_bytes);
    if (in_.binary()) in_.line();
    return count;
  }

  void nodes2() {
    const std::size_t n = text_count("the number of nodes", 8, 28);
    for (std::size_t i = 0; i < n; ++i) point(in_.i32("a node number"));
  }

  void nodes4() {
    const std::size_t blocks = in_.count("the number of node blocks", in_.binary() ? 20 : 8, true);
    const std::size_t n = in_.count("the number of nodes", in_.binary() ? 32 : 8, true);
    in_.i64("the smallest node tag");
    in_.i64("the largest node tag");
    std::vector<std::int64_t> tags;
    for (std::size_t b = 0; b < blocks; ++b) {
      const int dim = small(in_.i32("an entity dimension"), 0, 3, "an entity dimension");
      in_.i32("an entity tag");
      const bool parametric =
          small(in_.i32("the parametric flag"), 0, 1, "the parametric flag") != 0;
      const std::size_t m =
          in_.count("the number of nodes of a block", in_.binary() ? 32 : 8, true);
      if (m > n - content_.node_tags.size())
        in_.fail(fmt::format("the node blocks hold more than the {} nodes announced", n));
      tags.clear();
      for (std::size_t i = 0; i < m; ++i) tags.push_back(in_.i64("a node tag"));
      for (const std::int64_t tag : tags) {
        point(tag);
        for (int p = 0; parametric && p < dim; ++p) in_.f64("a parametric coordinate");
      }
    }
    if (content_.node_tags.size() != n)
      in_.fail(fmt::format("the node blocks hold {} nodes, {} were announced",
                           content_.node_tags.size(), n));
  }

  const MshType& supported(int type, std::int64_t element) {
    const MshType* found = msh_type(type);
    if (!found)
      in_.fail("element", element,
               fmt::format("type {} ({}) is not supported, expected triangles of degree 1 to 10",
                           type, msh_type_name(type)));
    return *found;
  }

  void element(const MshType& type, std::int64_t tag, int entity, int physical) {
    MshElements& to = content_.elements[static_cast<std::size_t>(type.dim)];
    if (type.dim > 0) {
      if (to.degree == 0) to.degree = type.degree;
      if (to.degree != type.degree)
        in_.fail("element", tag,
                 fmt::format("type {} ({}) has degree {}, the {} before it degree {}; expected one "
                             "degree",
                             type.type, msh_type_name(type.type), type.degree,
                             type.dim == 1 ? "lines" : "triangles", to.degree));
    }
    to.tags.push_back(tag);
    to.entities.push_back(entity);
    to.physicals.push_back(physical);
    to.places.push_back(in_.position());
    for (int i = 0; i < type.nodes; ++i)
      to.nodes.push_back(v4_ ? in_.i64("a node of an element") : in_.i32("a node of an element"));
  }

  void elements2() {
    const std::size_t n = text_count("the number of elements", 6, 8);
    std::size_t done = 0;
    while (done < n) {
      std::int32_t tag = 0, type = 0;
      std::size_t following = 1, tag_count = 0;
      if (in_.binary()) {
        type = in_.i32("an element type");
        following = in_.count("the number of elements of a block", 8, false);
        if (following == 0 || following > n - done)
          in_.fail(fmt::format("a block of {} elements, expected 1 to {}", following, n - done));
        tag_count = in_.count("the number of tags", 4, false);
      } else {
        tag = in_.i32("an element number");
        type = in_.i32("an element type");
        if (!msh_type(type)) supported(type, tag);
        tag_count = in_.count("the number of tags", 2, false);
      }
      for (std::size_t i = 0; i < following; ++i) {
        if (in_.binary()) tag = in_.i32("an element number");
        const MshType& kind = supported(type, tag);
        std::array<int, 2> tags{};
        for (std::size_t t = 0; t < tag_count; ++t) {
          const std::int32_t value = in_.i32("an element tag");
          if (t < 2) tags[t] = value;
        }
        if (tag_count == 1) tags[1] = tags[0];
        if (tag_count > 3 && !partitions_said_) {
          partitions_said_ = true;
          content_.notes.push_back("the partitions of the mesh were dropped");
        }
        if (tags[0] < min_tag) in_.fail("element", tag, "its physical tag is out of range");
        if (tags[0] < 0) content_.reversed_groups = true;
        element(kind, tag, tags[1], std::abs(tags[0]));
      }
      done += following;
    }
  }

  void elements4() {
    const std::size_t blocks =
        in_.count("the number of element blocks", in_.binary() ? 20 : 8, true);
    const std::size_t n = in_.count("the number of elements", in_.binary() ? 16 : 4, true);
    in_.i64("the smallest element tag");
    in_.i64("the largest element tag");
    std::size_t done = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const int dim = small(in_.i32("an entity dimension"), 0, 3, "an entity dimension");
      const std::int32_t entity_tag = in_.i32("an entity tag");
      const std::int32_t type = in_.i32("an element type");
      const std::size_t m =
          in_.count("the number of elements of a block", in_.binary() ? 16 : 4, true);
      if (m > n - done)
        in_.fail(fmt::format("the element blocks hold more than the {} elements announced", n));
      for (std::size_t i = 0; i < m; ++i) {
        const std::int64_t tag = in_.i64("an element tag");
        const MshType& kind = supported(type, tag);
        if (kind.dim != dim)
          in_.fail("element", tag,
                   fmt::format("type {} ({}) in an entity of dimension {}, expected dimension {}",
                               type, msh_type_name(type), dim, kind.dim));
        element(kind, tag, entity_tag, 0);
      }
      done += m;
    }
    if (done != n)
      in_.fail(fmt::format("the element blocks hold {} elements, {} were announced", done, n));
  }

  void data(MshData::Kind kind) {
    MshData out;
    out.kind = kind;
    const std::size_t strings = in_.check_count(in_.text_integer("the number of string tags"),
                                                "the number of string tags", 3);
    for (std::size_t i = 0; i < strings; ++i) {
      const std::string text = in_.quoted("a string tag");
      if (i == 0) out.name = text;
      if (i == 1) out.scheme = text;
    }
    if (out.name.empty()) in_.fail("the field has no name, expected one in the string tags");
    const std::size_t reals =
        in_.check_count(in_.text_integer("the number of real tags"), "the number of real tags", 2);
    for (std::size_t i = 0; i < reals; ++i) {
      const double value = in_.text_real("a real tag");
      if (i == 0) {
        if (!std::isfinite(value))
          in_.fail("field", -1, fmt::format("its time is {}, expected a finite number", value));
        out.time = value;
      }
    }
    const std::size_t integers = in_.check_count(in_.text_integer("the number of integer tags"),
                                                 "the number of integer tags", 2);
    if (integers < 3)
      in_.fail(fmt::format("field '{}': {} integer tags, expected at least 3", shown(out.name),
                           integers));
    std::int64_t announced = 0;
    for (std::size_t i = 0; i < integers; ++i) {
      const std::int64_t value = in_.text_integer("an integer tag");
      if (i == 1) out.components = small(value, 1, 9, "the number of components");
      if (i == 2) announced = value;
    }
    const bool per_node = kind == MshData::element_node;
    const std::size_t text_each = 4;
    const std::size_t binary_each = per_node ? 8 : 4 + 8 * static_cast<std::size_t>(out.components);
    const std::size_t n =
        in_.check_count(announced, "the number of values", in_.binary() ? binary_each : text_each);
    if (in_.binary()) in_.line();
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t tag = in_.i32(kind == MshData::node ? "a node tag" : "an element tag");
      out.tags.push_back(tag);
      std::size_t values = 1;
      if (per_node)
        values = in_.count("the number of nodes of an element", in_.binary() ? 8 : 2, false);
      out.starts.push_back(out.values.size());
      for (std::size_t v = 0; v < values * static_cast<std::size_t>(out.components); ++v) {
        const double value = in_.f64("a value");
        if (!std::isfinite(value))
          in_.fail(
              kind == MshData::node ? "node" : "element", tag,
              fmt::format("field '{}' is {}, expected a finite number", shown(out.name), value));
        out.values.push_back(value);
      }
    }
    out.starts.push_back(out.values.size());
    content_.data.push_back(std::move(out));
  }

  void interpolation_scheme() {
    const bool binary = in_.binary(), swap = in_.swapped();
    in_.set_binary(false, false);  // the scheme is text in binary files, too
    const std::string name = in_.quoted("the name of an interpolation scheme");
    const std::size_t topologies =
        in_.check_count(in_.text_integer("the number of element topologies"),
                        "the number of element topologies", 8);
    for (std::size_t t = 0; t < topologies; ++t) {
      const std::int64_t topology = in_.text_integer("an element topology");
      const std::size_t matrices =
          in_.check_count(in_.text_integer("the number of interpolation matrices"),
                          "the number of interpolation matrices", 4);
      InterpolationScheme scheme;
      for (std::size_t m = 0; m < matrices; ++m) {
        const auto rows =
            in_.check_count(in_.text_integer("a number of rows"), "a number of rows", 2);
        const auto columns =
            in_.check_count(in_.text_integer("a number of columns"), "a number of columns", 2);
        if (rows > 1000 || columns > 1000)
          in_.fail(fmt::format("an interpolation matrix of {} x {}, expected at most 1000 x 1000",
                               rows, columns));
        std::vector<double> matrix;
        for (std::size_t i = 0; i < rows * columns; ++i) {
          const double value = in_.text_real("an entry of an interpolation matrix");
          if (!std::isfinite(value))
            in_.fail("an interpolation matrix has an entry that is not finite");
          matrix.push_back(value);
        }
        if (m == 0) {
          scheme.functions = rows;
          scheme.monomials = columns;
          scheme.coefficients = std::move(matrix);
        } else if (m == 1) {
          if (rows != scheme.monomials || columns != 3)
            in_.fail(fmt::format("exponents of shape {} x {}, expected {} x 3", rows, columns,
                                 scheme.monomials));
          scheme.exponents = std::move(matrix);
        }
      }
      if (topology == 3) {  // triangles
        if (matrices < 2)
          in_.fail(fmt::format("{} interpolation matrices, expected at least 2", matrices));
        content_.schemes[name] = std::move(scheme);
      }
    }
    in_.set_binary(binary, swap);
  }

  static constexpr std::int32_t max_tag = std::numeric_limits<std::int32_t>::max();
  static constexpr std::int32_t min_tag = -max_tag;

  Cursor in_;
  MshContent content_;
  bool v4_ = false;
  bool seen_nodes_ = false, seen_elements_ = false, partitions_said_ = false;
};

}  // namespace

Dataset read_msh(const std::string& path, std::string_view bytes) {
  MshContent content = MshReader(path, bytes).read();
  return assemble_msh(path, bytes, std::move(content));
}

}  // namespace bezel::files
