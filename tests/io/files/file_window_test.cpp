#include "voxlist/io/files/file_window.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <random>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

TEST(FileWindow, GivesTheSameBytesWhateverTheOrder) {
  std::mt19937 random(3);
  std::string bytes(3'000'000, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  const test::TemporaryFolder folder;
  FileWindow window(folder.write("a", bytes));
  EXPECT_EQ(window.size(), bytes.size());
  for (int i = 0; i < 300; ++i) {
    const std::size_t offset = random() % bytes.size(), count = random() % 1'500'000;
    ASSERT_EQ(window.at(offset, count), std::string_view(bytes).substr(offset, count)) << i;
  }
  EXPECT_EQ(window.at(bytes.size() + 5, 10), "");
}

TEST(FileWindow, EndsWhereAFileWasCutMeanwhile) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("a", std::string(100, 'x'));
  FileWindow window(path);
  std::filesystem::resize_file(path, 40);
  EXPECT_EQ(window.at(10, 90), std::string(30, 'x'));
  EXPECT_EQ(window.at(60, 10), "");
}

TEST(FileWindow, OpensOnlyRegularFiles) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(FileWindow(folder.path()), FileError);
  EXPECT_THROW(FileWindow(folder / "none"), FileError);
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(FileWindow(folder / "pipe"), FileError);
}

}  // namespace
}  // namespace voxlist::io
