#include "voxlist/io/files/keep_aside.h"

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

TEST(KeepAside, KeepsAFileThatIsReplacedAndNeverAnOlderOnesPlace) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("map", "first");
  EXPECT_EQ(keep_aside(file, ".damaged"), folder / "map.damaged");
  write_file_atomically(file, "second");
  EXPECT_EQ(keep_aside(file, ".damaged"), folder / "map.damaged-1");
  write_file_atomically(file, "third");
  EXPECT_EQ(keep_aside(file, ".damaged"), folder / "map.damaged-2");
  EXPECT_EQ(read_file(folder / "map.damaged"), "first");
  EXPECT_EQ(read_file(folder / "map.damaged-1"), "second");
  EXPECT_EQ(read_file(folder / "map.damaged-2"), "third");
}

TEST(KeepAside, ALinkThatLeadsNowhereHasItsName) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("nowhere", folder / "map.recovered-1");
  EXPECT_EQ(free_name(folder / "map", ".recovered"), folder / "map.recovered-2");
}

}  // namespace
}  // namespace voxlist::io
