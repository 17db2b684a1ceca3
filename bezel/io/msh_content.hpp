#pragma once
// Internal to io: the sections of an MSH file as they stand in it.

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bezel/io/cursor.hpp"
#include "bezel/io/metadata.hpp"
#include "bezel/io/msh.hpp"

namespace bezel::files {

/// Elements of one dimension, in file order.
struct MshElements {
  int degree = 0;
  std::vector<std::int64_t> tags;
  std::vector<int> entities;        ///< 0: none
  std::vector<int> physicals;       ///< MSH 2 only; 0: none
  std::vector<std::size_t> places;  ///< bytes in the file, for messages
  std::vector<std::int64_t> nodes;  ///< node tags, in file order of the nodes
};

struct MshData {
  enum Kind { node, element, element_node };
  Kind kind = node;
  std::string name, scheme;
  std::optional<double> time{};
  int components = 1;
  std::vector<std::int64_t> tags{};
  std::vector<std::size_t> starts{};  ///< of each tag's values; one more at the end
  std::vector<double> values{};
};

struct MshContent {
  bool v4 = false;
  std::vector<PhysicalGroup> groups;
  std::vector<Entity> entities;
  std::map<std::pair<int, int>, std::pair<int, int>> partitioned;  ///< (dim, tag) -> parent
  std::vector<std::int64_t> node_tags;
  std::vector<Vec2> positions;
  std::vector<double> z;
  std::array<MshElements, 3> elements;  ///< by dimension
  std::vector<MshData> data;
  std::map<std::string, InterpolationScheme> schemes;
  std::optional<Metadata> metadata;
  bool reversed_groups = false;
  std::vector<std::string> notes;
};

Dataset assemble_msh(const std::string& path, std::string_view bytes, MshContent content);

}  // namespace bezel::files
