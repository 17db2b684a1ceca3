#pragma once
// Files that appear complete or not at all.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

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
  /// Brings what was written to the disk and closes the file, which does not appear yet; only
  /// commit() may follow. For many files that shall appear together.
  ///
  /// @throws InputError "path: cannot be written: <reason>"; the temporary file is gone then
  void seal();
  bool sealed() const { return fd_ < 0; }
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

/// Several files that appear together: all of them once all are complete, or none.
class FileSet {
 public:
  /// Adds a file to write to. @throws InputError as AtomicFile
  AtomicFile& add(const std::string& path);
  /// Adds a file with these bytes. @throws InputError as AtomicFile
  void add(const std::string& path, std::string_view bytes);
  /// Brings all to the disk, then makes them appear in the order in which they were added. Should a
  /// renaming fail after others succeeded, those are removed.
  ///
  /// @throws InputError "path: cannot be written: <reason>"
  void commit();

 private:
  std::vector<std::string> paths_;
  std::vector<std::unique_ptr<AtomicFile>> files_;
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
