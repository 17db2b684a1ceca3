#include "bezel/base/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "bezel/base/error.hpp"

namespace bezel {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 20;

std::string reason(int error) {
  std::string text = std::generic_category().message(error);
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

InputError cannot(const std::string& path, const char* what, const std::string& why) {
  return InputError(InputPlace{path, 0, {}, -1}, std::string("cannot be ") + what + ": " + why);
}

std::string folder_of(const std::string& path) {
  const auto slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// The file behind a symbolic link; the path itself when there is nothing yet.
std::string resolve(const std::string& path) {
  char resolved[PATH_MAX];
  return ::realpath(path.c_str(), resolved) != nullptr ? std::string(resolved) : path;
}

// Write the whole span, through interruptions and short writes. 0 or errno.
int write_all(int fd, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(fd, data, size);
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return 0;
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), destination_(resolve(path_)) {
  if (path_.empty()) throw InputError("the output path is empty");
  mode_t mode = 0666;
  struct stat status {};
  const bool exists = ::stat(destination_.c_str(), &status) == 0;
  if (exists) {
    if (S_ISDIR(status.st_mode)) throw cannot(path_, "written", "is a directory");
    if (!S_ISREG(status.st_mode)) throw cannot(path_, "written", "is not a regular file");
    if (::access(destination_.c_str(), W_OK) != 0) throw cannot(path_, "written", reason(errno));
    mode = status.st_mode & 0777;
  }
  const std::string folder = folder_of(destination_);
  const auto slash = destination_.rfind('/');
  const std::string name =
      slash == std::string::npos ? destination_ : destination_.substr(slash + 1);
  for (int attempt = 0; fd_ < 0; ++attempt) {
    temporary_ = folder + "/." + name + "." + std::to_string(::getpid()) + "-" +
                 std::to_string(attempt) + ".tmp";
    fd_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (fd_ >= 0 || (errno == EEXIST && attempt < 10000)) continue;
    const int error = errno;
    temporary_.clear();
    throw cannot(path_, "written",
                 error == ENOENT || error == ENOTDIR ? "no such directory" : reason(error));
  }
  if (exists) static_cast<void>(::fchmod(fd_, mode));
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() noexcept {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::fail(int error) {
  discard();
  throw cannot(path_, "written", reason(error));
}

void AtomicFile::flush() {
  const int error = write_all(fd_, buffer_.data(), buffer_.size());
  buffer_.clear();
  if (error != 0) fail(error);
}

void AtomicFile::write(std::string_view bytes) {
  if (fd_ < 0) throw InternalError("AtomicFile::write after commit or failure");
  if (buffer_.size() + bytes.size() > buffer_size) flush();
  if (bytes.size() <= buffer_size) {
    buffer_.append(bytes);
  } else if (const int error = write_all(fd_, bytes.data(), bytes.size()); error != 0) {
    fail(error);
  }
}

void AtomicFile::seal() {
  if (fd_ < 0) throw InternalError("AtomicFile::seal after commit or failure");
  flush();
  // EINVAL: a file system that cannot sync; the rename still makes the file appear whole.
  if (::fsync(fd_) != 0 && errno != EINVAL) fail(errno);
  const int fd = std::exchange(fd_, -1);
  if (::close(fd) != 0) fail(errno);
}

void AtomicFile::commit() {
  if (temporary_.empty()) throw InternalError("AtomicFile::commit after commit or failure");
  if (fd_ >= 0) seal();
  if (::rename(temporary_.c_str(), destination_.c_str()) != 0) fail(errno);
  temporary_.clear();
  // The rename itself reaches the disk with the folder; a failure here cannot undo it.
  const int folder = ::open(folder_of(destination_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    static_cast<void>(::fsync(folder));
    ::close(folder);
  }
}

AtomicFile& FileSet::add(const std::string& path) {
  files_.push_back(std::make_unique<AtomicFile>(path));
  paths_.push_back(path);
  return *files_.back();
}

void FileSet::add(const std::string& path, std::string_view bytes) {
  AtomicFile& file = add(path);
  file.write(bytes);
  file.seal();
}

void FileSet::commit() {
  for (const auto& file : files_) {
    if (!file->sealed()) file->seal();
  }
  std::size_t done = 0;
  try {
    for (; done < files_.size(); ++done) files_[done]->commit();
  } catch (...) {
    for (std::size_t i = 0; i < done; ++i) ::unlink(paths_[i].c_str());
    throw;
  }
}

void write_file(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

std::string read_file(const std::string& path) {
  struct Descriptor {
    int fd;
    ~Descriptor() {
      if (fd >= 0) ::close(fd);
    }
  } file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.fd < 0) throw cannot(path, "read", reason(errno));
  struct stat status {};
  if (::fstat(file.fd, &status) != 0) throw cannot(path, "read", reason(errno));
  if (S_ISDIR(status.st_mode)) throw cannot(path, "read", "is a directory");
  // One byte more than the size told, so that a read that leaves it empty is followed by the end.
  std::string bytes(S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + 1 : 0,
                    '\0');
  std::size_t size = 0;
  for (;;) {
    if (bytes.size() == size) bytes.resize(size + (size < 65536 ? 65536 : size));
    const ssize_t got = ::read(file.fd, bytes.data() + size, bytes.size() - size);
    if (got < 0) {
      if (errno == EINTR) continue;
      throw cannot(path, "read", reason(errno));
    }
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace bezel
