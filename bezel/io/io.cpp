#include "bezel/io/io.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <set>
#include <utility>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "bezel/io/cursor.hpp"
#include "bezel/io/msh.hpp"
#include "bezel/io/native.hpp"
#include "bezel/io/vtu.hpp"

namespace bezel {
namespace {

void check(const Dataset& data) {
  if (!data.mesh) throw InputError("found no mesh, expected one to write");
  if (data.mesh->element_count() == 0)
    throw InputError("the mesh has no triangles, expected at least one to write");
  std::set<std::string> names;
  for (const Field& field : data.fields) {
    if (&field.mesh() != data.mesh.get())
      throw InputError(fmt::format("field '{}' is on another mesh than the one to write",
                                   files::shown(field.name())));
    if (!names.insert(field.name()).second)
      throw InputError(fmt::format("two fields are named '{}', expected different names",
                                   files::shown(field.name())));
  }
}

}  // namespace

const Field& Dataset::field(const std::string& name) const {
  std::string known;
  for (const Field& f : fields) {
    if (f.name() == name) return f;
    known += (known.empty() ? "'" : ", '") + f.name() + "'";
  }
  if (fields.empty()) {
    throw InputError(name.empty()
                         ? std::string("there are no fields, expected one")
                         : fmt::format("there is no field '{}', there are no fields", name));
  }
  if (!name.empty())
    throw InputError(fmt::format("there is no field '{}', there are {}", name, known));
  if (fields.size() != 1)
    throw InputError(
        fmt::format("there are {} fields, expected the name of one: {}", fields.size(), known));
  return fields.front();
}

Dataset read(const std::string& path, const ReadOptions& options) {
  const Format format = options.format ? *options.format : format_of(path);
  const std::string bytes = read_file(path);
  try {
    switch (format) {
      case Format::vtu:
        return files::read_vtu(path, bytes);
      case Format::native:
        return files::read_native(path, bytes);
      default:
        return files::read_msh(path, bytes);
    }
  } catch (const InputError& error) {
    throw error.in_file(path);
  }
}

Encoded encode(const std::string& path, const Dataset& data, const WriteOptions& options) {
  const Format format = options.format ? *options.format : format_of(path);
  Encoded out;
  try {
    check(data);
    out.bytes = format == Format::native ? files::write_native(data)
                : format == Format::vtu  ? files::write_vtu(data, options, out.lost)
                                         : files::write_msh(data, format, out.lost);
  } catch (const InputError& error) {
    throw error.in_file(path);
  }
  return out;
}

std::vector<std::string> write(const std::string& path, const Dataset& data,
                               const WriteOptions& options) {
  Encoded encoded = encode(path, data, options);
  write_file(path, encoded.bytes);
  return std::move(encoded.lost);
}

Format format_of(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".msh") return Format::msh41_binary;
  if (extension == ".vtu") return Format::vtu;
  if (extension == ".bzl") return Format::native;
  throw InputError(
      {path, 0, "", -1},
      fmt::format("unknown extension '{}', expected .msh, .vtu or .bzl", files::shown(extension)));
}

std::string to_string(Format format) {
  constexpr std::array<const char*, 6> names{"msh22_ascii",  "msh22_binary", "msh41_ascii",
                                             "msh41_binary", "vtu",          "native"};
  return names.at(static_cast<std::size_t>(format));
}

}  // namespace bezel
