#include "voxlist/io/files/file_kind.h"

#include <gmock/gmock.h>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

using namespace std::string_literals;
using testing::HasSubstr;

TEST(FileKind, IsToldByTheFirstBytes) {
  EXPECT_THAT(what_it_is("\x1f\x8b\x08..."), HasSubstr("gzip"));
  EXPECT_THAT(what_it_is("\xfd\x37zXZ\0"s), HasSubstr("xz"));
  EXPECT_THAT(what_it_is("PK\x03\x04"), HasSubstr("ZIP"));
  EXPECT_THAT(what_it_is("#ROSBAG V2.0\n"), HasSubstr("ROS bag"));
  EXPECT_THAT(what_it_is("\x89MCAP0\r\n"), HasSubstr("ROS bag"));
  EXPECT_THAT(what_it_is("version https://git-lfs.github.com/spec/v1\n"),
              HasSubstr("git lfs pull"));
  EXPECT_THAT(what_it_is("<!DOCTYPE html>"), HasSubstr("web page"));
  EXPECT_EQ(what_it_is("ply\nformat ascii 1.0\n"), "");
  EXPECT_EQ(what_it_is(""), "");
}

TEST(FileKind, OfATextIsLookedAt) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_text(folder.write("a.csv", "\xEF\xBB\xBFx,y\r\n1,2")), "x,y\r\n1,2\n");
  const auto utf16 = folder.write("b.csv", "\xff\xfex\0,\0"s);
  EXPECT_THROW(
      try { read_text(utf16); } catch (const FileError& error) {
        EXPECT_THAT(error.what(), HasSubstr("b.csv: is UTF-16 text"));
        throw;
      },
      FileError);
}

}  // namespace
}  // namespace voxlist::io
