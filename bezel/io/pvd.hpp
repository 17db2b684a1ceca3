#pragma once
// ParaView collections (.pvd): time steps and the files that hold them.

#include <string>
#include <string_view>
#include <vector>

namespace bezel {

struct TimeStep {
  double time = 0;
  std::string file;  ///< relative to the collection's folder, or absolute
  friend bool operator==(const TimeStep&, const TimeStep&) = default;
};

/// Reads a collection. The steps keep the order of the file.
///
/// @return at least one step; file names as they stand in the collection
/// @throws InputError with file and line for everything that is wrong with it: no XML, no
///         collection, no step, a time that is no finite number, a step without a file, two steps
///         of one time (parts of a distributed mesh are not supported)
std::vector<TimeStep> read_pvd(const std::string& path);
/// The same from bytes; `path` is for messages.
std::vector<TimeStep> parse_pvd(const std::string& path, std::string_view bytes);

/// The text of a collection.
/// @throws InputError for no step or a time that is not finite
std::string encode_pvd(const std::vector<TimeStep>& steps);

}  // namespace bezel
