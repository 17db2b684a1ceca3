#pragma once
// Files in and out: a mesh and the fields on it.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bezel/field/field.hpp"

namespace bezel {

/// What a file holds.
struct Dataset {
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<Field> fields;
  std::optional<double> time;
  /// The field of that name. @throws InputError listing the names there are; without a name, the only field.
  const Field& field(const std::string& name = "") const;
};

enum class Format {
  msh22_ascii,  ///< Gmsh 2.2
  msh22_binary,
  msh41_ascii,  ///< Gmsh 4.1
  msh41_binary,
  vtu,          ///< VTK XML unstructured grid
  native        ///< .bzl: Bezel's exact text form (hex floats)
};

struct ReadOptions {
  std::optional<Format> format;  ///< by extension when empty (.msh: by header)
};
/// Reads a mesh and its fields.
/// @throws InputError with file, line and element for everything that is wrong with the file
Dataset read(const std::string& path, const ReadOptions& options = {});

struct WriteOptions {
  std::optional<Format> format;  ///< by extension when empty; .msh means msh41_binary
  bool bezier_cells = false;     ///< VTU: Bezier cells instead of Lagrange (many viewers misread them)
  bool compress = true;          ///< VTU: zlib blocks
};
/// Writes a mesh and its fields atomically (nothing is left on failure).
/// @return one sentence for each thing the format could not keep (empty: lossless up to rounding of conversions)
std::vector<std::string> write(const std::string& path, const Dataset& data, const WriteOptions& options = {});

/// The format a path's extension stands for. @throws InputError for an unknown extension, listing the known ones.
Format format_of(const std::string& path);
std::string to_string(Format format);

}  // namespace bezel
