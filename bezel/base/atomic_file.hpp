#pragma once
// Files that appear complete or not at all.

#include <string>
#include <string_view>

namespace bezel {

/// Writes to a temporary file in the destination's folder; commit() flushes it to the disk and
/// renames it over `path`. Without commit(), or when anything fails, the temporary file is removed
/// and `path` stays as it was. A symbolic link is followed: the file it names is replaced, not the
/// link. Not for concurrent use.
class AtomicFile {
 public:
  /// Opens the temporary file, so that an unwritable destination is known before the work starts.
  ///
  /// @throws InputError "path: cannot be written: <reason>"
  explicit AtomicFile(std::string path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();
  /// Appends bytes.
  ///
  /// @throws InputError "path: cannot be written: <reason>"; the temporary file is gone then
  void write(std::string_view bytes);
  /// Makes the file appear under its name. Call once, last.
  ///
  /// @throws InputError "path: cannot be written: <reason>"; the temporary file is gone then
  void commit();

 private:
  void flush();
  void discard() noexcept;
  [[noreturn]] void fail(int error);

  std::string path_, destination_, temporary_;
  int fd_ = -1;
  std::string buffer_;
};

/// Writes all of `bytes` atomically.
///
/// @throws InputError "path: cannot be written: <reason>"
void write_file(const std::string& path, std::string_view bytes);

/// Reads a whole file.
///
/// @throws InputError "path: cannot be read: <reason>"
std::string read_file(const std::string& path);

}  // namespace bezel
