#pragma once
// Internal to io: what MSH and VTU cannot say about a mesh and its fields, kept beside them as
// JSON.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bezel/io/io.hpp"

namespace bezel::files {

struct FieldMetadata {
  std::string name;
  int components = 1;
  std::vector<int> degrees;  ///< one for all elements, or one per element
  Basis basis = Basis::reference;
  Continuity continuity = Continuity::discontinuous;
};

struct Metadata {
  int degree = 1;  ///< geometric
  std::optional<double> time{};
  /// Groups and entities; the other members of Tags stay empty.
  Tags tags{};
  bool has_element_entity = false;
  std::vector<FieldMetadata> fields{};

  const FieldMetadata* field(const std::string& name) const;
};

Metadata describe(const Dataset& data);

/// ASCII JSON on one line, without '$'.
std::string to_json(const Metadata& metadata);

/// @throws InputError (without a file) for anything that to_json() does not write
Metadata metadata_from_json(std::string_view text);

}  // namespace bezel::files
