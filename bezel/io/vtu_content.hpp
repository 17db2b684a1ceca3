#pragma once
// Internal to io: what a VTU file holds, before it is made a mesh and fields.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bezel/io/metadata.hpp"

namespace bezel::files {

struct VtuArray {
  std::string name;
  std::int64_t line = 0;
  int components = 1;
  bool integer = false;
  std::vector<double> reals{};           ///< filled unless integer
  std::vector<std::int64_t> integers{};  ///< filled when integer
  std::size_t size() const { return integer ? integers.size() : reals.size(); }
};

/// The pieces of a file one after the other.
struct VtuContent {
  std::vector<double> points;  ///< three per point
  std::vector<std::int64_t> connectivity, offsets, types;
  std::vector<VtuArray> point_data, cell_data;
  std::optional<Metadata> metadata;
  std::optional<double> time;
  std::vector<std::string> notes;
};

Dataset assemble_vtu(const std::string& path, VtuContent content);

}  // namespace bezel::files
