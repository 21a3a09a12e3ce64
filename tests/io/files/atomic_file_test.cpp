#include "voxlist/io/files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "tests/io/scans/scan_files.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

using test::TemporaryFolder;

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// Files of this process cannot grow past a size while it lives: write() fails as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST(AtomicFile, ReplacesTheOldContentAndLeavesNothingElse) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("map", "old and longer");
  write_file_atomically(path, "new");
  EXPECT_EQ(read_file(path), "new");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, AFullDiskLeavesTheOldFileAndNoTemporaryOne) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("map", "old");
  {
    const FileSizeLimit limit(4096);
    EXPECT_THROW(write_file_atomically(path, std::string(1 << 20, 'x')), FileError);
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, RefusesWhatIsNoRegularFile) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(write_file_atomically("/dev/full", "x"), FileError);
  EXPECT_THROW(write_file_atomically(folder.path(), "x"), FileError);
  EXPECT_THROW(write_file_atomically(folder / "no/such/folder", "x"), FileError);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  EXPECT_EQ(files_in(folder.path()), 0U);
}

}  // namespace
}  // namespace voxlist::io
