#pragma once
// Files that appear complete or not at all.

#include <string>
#include <string_view>

namespace bezel {

/// Writes to a temporary file in the destination's folder; commit() flushes and renames it over `path`.
/// Without commit() the destructor removes the temporary file and `path` stays as it was.
class AtomicFile {
 public:
  /// @throws InputError "path: cannot be written: <reason>"
  explicit AtomicFile(std::string path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();
  void write(std::string_view bytes);
  void commit();

 private:
  std::string path_, temporary_;
  int fd_ = -1;
  std::string buffer_;
};

/// Writes all of `bytes` atomically.
void write_file(const std::string& path, std::string_view bytes);
/// Reads a whole file. @throws InputError "path: cannot be read: <reason>"
std::string read_file(const std::string& path);

}  // namespace bezel
