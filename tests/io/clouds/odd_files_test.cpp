#include <gtest/gtest.h>

#include <string>

#include "tests/temporary_folder.h"
#include "voxlist/io/clouds/cloud_file.h"

namespace voxlist::io {
namespace {

const std::string kPlyText = "format ascii 1.0\nelement vertex 2\n";
const std::string kPlyXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kPcdText = "SIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n";

class OddFiles : public testing::Test {
 protected:
  std::size_t points(const std::string& name, const std::string& bytes) {
    return read_cloud_file(folder_.write(name, bytes)).points.size();
  }

  std::string error(const std::string& name, const std::string& bytes) {
    try {
      points(name, bytes);
    } catch (const FileError& problem) {
      return problem.what();
    }
    return "no error";
  }

  void expect_error(const std::string& text, const std::string& name, const std::string& bytes) {
    EXPECT_NE(error(name, bytes).find(text), std::string::npos) << error(name, bytes);
  }

  const test::TemporaryFolder folder_;
};

TEST_F(OddFiles, WithALineOfAnotherLengthAreRefusedWithTheLine) {
  const std::string pcd = "FIELDS x y z\n" + kPcdText + "DATA ascii\n";
  expect_error("line 9 has 4 numbers instead of 3", "a.pcd", pcd + "1 2 3 4\n1 2 3\n");
  expect_error("line 10 has 2 numbers instead of 3", "a.pcd", pcd + "1 2 3\n1 2\n3\n");
  const std::string ply = "ply\n" + kPlyText + kPlyXyz + "end_header\n";
  expect_error("line 10 has 4 numbers instead of 3", "a.ply", ply + "1 2 3\n\n1 2 3 9\n");
  expect_error("line 9: \"oops\" is not a number", "a.ply", ply + "1 2 3\n1 oops 3\n");
  expect_error("line 8 has 1 numbers instead of 3", "a.ply", ply + "1\n2\n3\n4\n5\n6\n");
}

TEST_F(OddFiles, WhoseListsDisagreeWithTheirLinesAreRefusedWithTheLine) {
  const std::string ply = "ply\n" + kPlyText + kPlyXyz +
                          "element face 1\nproperty list uchar int vertices\nend_header\n1 2 3\n"
                          "4 5 6\n";
  EXPECT_EQ(points("a.ply", ply + "3 0 1 0\n"), 2U);
  expect_error("line 12 has 3 numbers", "a.ply", ply + "3 0 1\n");
  expect_error("line 12 has 5 numbers", "a.ply", ply + "3 0 1 0 1\n");
}

TEST_F(OddFiles, WithMoreThanTheyAnnounceAreRefused) {
  const std::string pcd = "FIELDS x y z\n" + kPcdText + "DATA ";
  expect_error("line 11 comes after the last row", "a.pcd", pcd + "ascii\n1 2 3\n4 5 6\n7 8 9\n");
  expect_error("12 bytes more", "a.pcd", pcd + "binary\n" + std::string(36, 'x'));
  EXPECT_EQ(points("a.pcd", pcd + "binary\n" + std::string(24, 'x') + "\n"), 2U);
  EXPECT_EQ(points("a.pcd", pcd + "binary\n" + std::string(24, 'x') + std::string(4096, 0)), 2U);
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\n" + kPlyXyz + "end_header\n";
  expect_error("1 bytes more", "a.ply", ply + std::string(25, 'x'));
  EXPECT_EQ(points("a.ply", ply + std::string(24, 'x')), 2U);
}

TEST_F(OddFiles, WithHeadersAsOthersWriteThemAreRead) {
  const std::string rows = "end_header\n1 2 3\n4 5 6\n";
  EXPECT_EQ(points("a.ply", "ply \n" + kPlyText + kPlyXyz + rows), 2U);
  EXPECT_EQ(points("a.ply", "PLY\t\r\n" + kPlyText +
                                "PROPERTY Float X\nproperty FLOAT y\n"
                                "property float z\n" +
                                rows),
            2U);
  EXPECT_EQ(points("a.pcd", "COLUMNS x y z\n" + kPcdText + "DATA ascii\n1 2 3\n4 5 6\n"), 2U);
  EXPECT_EQ(points("a.pcd",
                   "fields X Y Z\nsize 4 4 4\ntype F F F\nwidth 2\nheight 1\n"
                   "data ASCII\n1 2 3\n4 5 6\n"),
            2U);
}

TEST_F(OddFiles, WithAnUnusedBoolAreRead) {
  const std::string flag = "property bool is_ground\nend_header\n";
  EXPECT_EQ(points("a.ply", "ply\n" + kPlyText + kPlyXyz + flag + "1 2 3 1\n4 5 6 0\n"), 2U);
  EXPECT_EQ(points("a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 2\n" + kPlyXyz +
                                flag + std::string(26, 'x')),
            2U);
  EXPECT_EQ(points("a.pcd",
                   "FIELDS x y z f\nSIZE 4 4 4 1\nTYPE F F F B\nWIDTH 2\nHEIGHT 1\n"
                   "DATA binary\n" +
                       std::string(26, 'x')),
            2U);
}

TEST_F(OddFiles, SayNoReturnAsOldWindowsPrintsIt) {
  const std::string ply = "ply\n" + kPlyText + kPlyXyz + "end_header\n";
  EXPECT_EQ(points("a.ply", ply + "1 2 3\n1.#QNAN -1.#IND 1.#INF00\n"), 1U);
}

}  // namespace
}  // namespace voxlist::io
