#include "voxlist/io/files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/file_size_limit.h"
#include "tests/io/scans/scan_files.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

using test::TemporaryFolder;

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

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
    const test::FileSizeLimit limit(4096);
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

TEST(AtomicFile, WhatADeadProcessLeftIsRemovedAndNothingElse) {
  const test::TemporaryFolder folder;
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  folder.write("map.ply.tmp-" + std::to_string(child) + "-0", "half");
  folder.write("map.ply.tmp-" + std::to_string(::getpid()) + "-9", "in the making");
  folder.write("notes.tmp-today", "somebody's");
  folder.write("a.tmp-" + std::to_string(child), "somebody's");
  remove_stale_temporaries(folder.path());
  EXPECT_EQ(files_in(folder.path()), 3U);
  EXPECT_FALSE(std::filesystem::exists(folder / ("map.ply.tmp-" + std::to_string(child) + "-0")));
  remove_stale_temporaries(folder / "none");
}

}  // namespace
}  // namespace voxlist::io
