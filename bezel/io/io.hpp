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
  std::shared_ptr<const TriangleMesh> mesh{};
  std::vector<Field> fields{};
  std::optional<double> time{};
  /// One sentence for each thing the file held that was not kept (empty: everything was). Filled by
  /// read(), ignored by write().
  std::vector<std::string> notes{};

  /// The field of that name; without a name, the only field.
  ///
  /// @throws InputError listing the names there are when there is no such field, or when no name
  ///         was given and there is not exactly one field
  const Field& field(const std::string& name = "") const;
};

enum class Format {
  msh22_ascii,  ///< Gmsh 2.2
  msh22_binary,
  msh41_ascii,  ///< Gmsh 4.1
  msh41_binary,
  vtu,    ///< VTK XML unstructured grid
  native  ///< .bzl: Bezel's exact text form (hex floats)
};

struct ReadOptions {
  std::optional<Format> format{};  ///< by extension when empty (.msh: by header)
};

/// Reads a mesh and its fields.
///
/// The four MSH formats name one family: which of them a file is in is always taken from its
/// header. Nodes keep the order of their numbers in the file, triangles too; both are renumbered
/// from 0.
///
/// @param path  a file; see docs/formats.md for what of each format is understood
/// @return      the mesh, its fields, and in `notes` what was not kept
/// @throws InputError with file, line (text) or byte (binary) and element for everything that is
///         wrong with the file: syntax, truncation, counts that cannot be, elements that are not
///         triangles of one degree 1..10, values that are not finite
/// @accuracy native files return the same bits. Files that hold nodal values are converted to
///           Bernstein form; positions and values written and read again agree to 1e-14 of the
///           largest (largest seen 1.2e-15), coefficients of degree 10 to 1e-13
/// @cost     reads the file into memory; a few times its size while reading
Dataset read(const std::string& path, const ReadOptions& options = {});

struct WriteOptions {
  std::optional<Format> format{};  ///< by extension when empty; .msh means msh41_binary
  bool bezier_cells = false;  ///< VTU: Bezier cells instead of Lagrange (many viewers misread them)
  bool compress = true;       ///< VTU: zlib blocks
};

/// Writes a mesh and its fields atomically (nothing is left on failure).
///
/// @return one sentence for each thing the format could not keep as it was (empty: lossless up to
///         rounding of conversions)
/// @throws InputError for no mesh, a field on another mesh, two fields of one name, a name the
///         format cannot hold, a physical-basis field that would need a degree above 10, or a file
///         that cannot be written
std::vector<std::string> write(const std::string& path, const Dataset& data,
                               const WriteOptions& options = {});

/// The bytes that write() would write to a path, and its return value.
struct Encoded {
  std::string bytes;
  std::vector<std::string> lost;
};
/// @throws InputError as write(), but for the writing
Encoded encode(const std::string& path, const Dataset& data, const WriteOptions& options = {});

/// The format a path's extension stands for. @throws InputError for an unknown extension, listing
/// the known ones.
Format format_of(const std::string& path);

/// "msh22_ascii", …: the enumerator's name.
std::string to_string(Format format);

}  // namespace bezel
