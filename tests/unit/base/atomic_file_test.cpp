#include "bezel/base/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"

namespace bezel {
namespace {

using test::message_of;

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  AtomicFileTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("bezel_base_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  ~AtomicFileTest() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

TEST_F(AtomicFileTest, AppearsOnlyOnCommit) {
  {
    AtomicFile file(path("a.txt"));
    file.write("one ");
    file.write("two");
    EXPECT_FALSE(fs::exists(path("a.txt")));
    file.commit();
    EXPECT_EQ(read_file(path("a.txt")), "one two");
  }
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, WithoutCommitNothingChanges) {
  write_file(path("a.txt"), "old");
  {
    AtomicFile file(path("a.txt"));
    file.write("new");
  }
  EXPECT_EQ(read_file(path("a.txt")), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, ReplacesAndKeepsTheMode) {
  write_file(path("a.txt"), "old");
  ASSERT_EQ(::chmod(path("a.txt").c_str(), 0640), 0);
  write_file(path("a.txt"), "new");
  EXPECT_EQ(read_file(path("a.txt")), "new");
  EXPECT_EQ(fs::status(path("a.txt")).permissions(), static_cast<fs::perms>(0640));
}

TEST_F(AtomicFileTest, ANewFileHasTheModeOfTheUmask) {
  const mode_t old = ::umask(0027);
  write_file(path("a.txt"), "x");
  ::umask(old);
  EXPECT_EQ(fs::status(path("a.txt")).permissions(), static_cast<fs::perms>(0640));
}

TEST_F(AtomicFileTest, FollowsASymbolicLink) {
  write_file(path("target"), "old");
  fs::create_symlink(path("target"), path("link"));
  write_file(path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_file(path("target")), "new");
}

TEST_F(AtomicFileTest, LargeAndBinaryContent) {
  std::string bytes;
  for (int i = 0; i < 3'000'000; ++i) bytes.push_back(static_cast<char>(i * 7 % 256));
  AtomicFile file(path("big"));
  file.write("ab");
  file.write(bytes);
  file.write(std::string_view("\0z", 2));
  file.commit();
  EXPECT_EQ(read_file(path("big")), "ab" + bytes + std::string("\0z", 2));
  write_file(path("empty"), "");
  EXPECT_EQ(read_file(path("empty")), "");
}

TEST_F(AtomicFileTest, TwoWritersDoNotMeet) {
  AtomicFile first(path("a")), second(path("a"));
  first.write("first");
  second.write("second");
  first.commit();
  second.commit();
  EXPECT_EQ(read_file(path("a")), "second");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, SaysWhyItCannotWrite) {
  const std::string missing = path("no/x.vtu");
  EXPECT_EQ(message_of([&] { AtomicFile file(missing); }),
            missing + ": cannot be written: no such directory");
  EXPECT_EQ(message_of([&] { AtomicFile file(folder_.string()); }),
            folder_.string() + ": cannot be written: is a directory");
  EXPECT_EQ(message_of([&] { AtomicFile file("/dev/null"); }),
            "/dev/null: cannot be written: is not a regular file");
  EXPECT_EQ(message_of([&] { AtomicFile file(""); }), "the output path is empty");
  write_file(path("file"), "");
  EXPECT_EQ(message_of([&] { AtomicFile file(path("file/x")); }),
            path("file/x") + ": cannot be written: no such directory");
  if (::geteuid() != 0) {
    ASSERT_EQ(::chmod(path("file").c_str(), 0444), 0);
    EXPECT_EQ(message_of([&] { AtomicFile file(path("file")); }),
              path("file") + ": cannot be written: permission denied");
  }
}

TEST_F(AtomicFileTest, AFailingRenameLeavesNothing) {
  // The folder disappears between opening and renaming: the rename fails.
  const std::string inner = path("inner");
  fs::create_directory(inner);
  AtomicFile file(inner + "/x");
  file.write("y");
  fs::remove_all(inner);
  EXPECT_EQ(message_of([&] { file.commit(); }),
            inner + "/x: cannot be written: no such file or directory");
  EXPECT_THROW(file.write("z"), InternalError);
  EXPECT_THROW(file.commit(), InternalError);
}

TEST_F(AtomicFileTest, ASealedFileAppearsOnCommit) {
  AtomicFile file(path("a"));
  file.write("one");
  file.seal();
  EXPECT_FALSE(fs::exists(path("a")));
  EXPECT_THROW(file.write("two"), InternalError);
  file.commit();
  EXPECT_EQ(read_file(path("a")), "one");
}

TEST_F(AtomicFileTest, ASetAppearsTogether) {
  write_file(path("b"), "old");
  {
    FileSet set;
    set.add(path("a"), "one");
    set.add(path("b")).write("two");
    EXPECT_FALSE(fs::exists(path("a")));
  }
  EXPECT_EQ(file_count(), 1U);
  EXPECT_EQ(read_file(path("b")), "old");
  FileSet set;
  for (int i = 0; i < 2000; ++i) set.add(path(std::to_string(i)), "x");  // more than open files
  set.add(path("b"), "two");
  set.commit();
  EXPECT_EQ(file_count(), 2001U);
  EXPECT_EQ(read_file(path("b")), "two");
}

TEST_F(AtomicFileTest, ASetWhoseRenamingFailsLeavesNothing) {
  FileSet set;
  set.add(path("a"), "one");
  set.add(path("b"), "two");
  fs::create_directories(path("b"));  // a file cannot be renamed over a folder
  EXPECT_THROW(set.commit(), InputError);
  EXPECT_FALSE(fs::exists(path("a")));
  EXPECT_TRUE(fs::is_directory(path("b")));
}

TEST_F(AtomicFileTest, SaysWhyItCannotRead) {
  EXPECT_EQ(message_of([&] { read_file(path("none")); }),
            path("none") + ": cannot be read: no such file or directory");
  EXPECT_EQ(message_of([&] { read_file(folder_.string()); }),
            folder_.string() + ": cannot be read: is a directory");
  try {
    read_file(path("none"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().file, path("none"));
  }
}

}  // namespace
}  // namespace bezel
