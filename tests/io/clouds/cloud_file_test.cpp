#include "voxlist/io/clouds/cloud_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/scans/scan_files.h"
#include "tests/temporary_folder.h"

namespace voxlist::io {
namespace {

using test::TemporaryFolder;

std::string error_of(const std::filesystem::path& path) {
  try {
    read_cloud_file(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CloudFile, ReadsEveryFormatAsOthersWriteIt) {
  const TemporaryFolder folder;
  const auto expected = test::sample_points();
  for (const auto& sample : test::scan_samples()) {
    SCOPED_TRACE(sample.extension + " " + sample.encoding);
    const Cloud cloud = read_cloud_file(folder.write("a" + sample.extension, sample.bytes));
    ASSERT_EQ(cloud.points.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_TRUE(cloud.points[i].isApprox(expected[i], 1e-6F)) << i;
    }
    EXPECT_TRUE(cloud.origins.empty());
  }
}

TEST(CloudFile, ExtensionMayBeUpperCase) {
  const TemporaryFolder folder;
  const auto sample = test::scan_samples().front();
  EXPECT_EQ(read_cloud_file(folder.write("A.PLY", sample.bytes)).points.size(), 20U);
}

TEST(CloudFile, ContentGoesBeforeTheExtension) {
  const TemporaryFolder folder;
  for (const auto& sample : test::scan_samples()) {
    const std::string other = sample.extension == ".ply" ? "a.pcd" : "a.ply";
    if (sample.extension == ".pcd" && !sample.bytes.starts_with("# .PCD")) continue;
    EXPECT_EQ(read_cloud_file(folder.write(other, sample.bytes)).points.size(), 20U) << other;
    EXPECT_EQ(read_cloud_file(folder.write(other, "\xEF\xBB\xBF" + sample.bytes)).points.size(),
              20U);
  }
}

TEST(CloudFile, SaysWhatAFileIsThatIsNone) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of(folder.write("a.ply", "\x1f\x8b\x08 packed")),
            (folder / "a.ply").string() + ": is compressed (gzip), unpack it first");
}

TEST(CloudFile, DropsPointsThatAreNotFinite) {
  const TemporaryFolder folder;
  const auto ply = folder.write("a.ply",
                                "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\n"
                                "property double y\nproperty double z\nend_header\n"
                                "1 2 3\nnan 0 0\n0 -inf 0\n0 0 1e300\n4 5 6\n");
  EXPECT_EQ(read_cloud_file(ply).points,
            (std::vector<Eigen::Vector3f>{{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}}));
  const auto organised = folder.write("a.pcd",
                                      "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\n"
                                      "COUNT 1 1 1 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\n"
                                      "POINTS 4\nDATA ascii\n1 2 3 4.2e+06\nnan nan nan 0\n"
                                      "-nan -nan -nan 0\n4 5 6 0\n");
  EXPECT_EQ(read_cloud_file(organised).points.size(), 2U);
}

TEST(CloudFile, WritesAndReadsOriginsBack) {
  const TemporaryFolder folder;
  Cloud cloud;
  cloud.points = {{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}};
  cloud.origins = {{0.0F, 0.1F, 0.2F}, {0.3F, 0.4F, 0.5F}};
  write_ply(folder / "a.ply", cloud);
  const Cloud back = read_cloud_file(folder / "a.ply");
  EXPECT_EQ(back.points, cloud.points);
  EXPECT_EQ(back.origins, cloud.origins);
}

TEST(CloudFile, WritesColoursThatDoNotDisturbPoints) {
  const TemporaryFolder folder;
  const auto points = test::sample_points();
  write_ply(folder / "a.ply", points, colours_by_height(points));
  EXPECT_EQ(read_cloud_file(folder / "a.ply").points, points);
  const std::string bytes = read_file(folder / "a.ply");
  EXPECT_EQ(bytes.substr(bytes.size() - 3), std::string({68, 1, 84}));  // the lowest point is last
  const auto colours = colours_by_height(points);
  EXPECT_EQ(colours.front(), io::viridis(1.0));
  EXPECT_EQ(colours.back(), io::viridis(0.0));
}

TEST(CloudFile, RefusesCountsThatTheFileCannotHold) {
  const TemporaryFolder folder;
  const std::string properties =
      "property float x\nproperty float y\nproperty float z\nend_header\n";
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    const auto path = folder.write("a.ply", "ply\nformat " + format +
                                                " 1.0\nelement vertex 4000000000000000000\n" +
                                                properties + "1 2 3\n");
    EXPECT_NE(error_of(path).find("announces more data"), std::string::npos) << error_of(path);
  }
  const auto pcd = folder.write("a.pcd",
                                "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 4294967296\n"
                                "HEIGHT 4294967296\nPOINTS 0\nDATA binary\n");
  EXPECT_NE(error_of(pcd).find("WIDTH times HEIGHT"), std::string::npos) << error_of(pcd);
}

TEST(CloudFile, ErrorsNameTheFileAndSayWhatToDo) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of(folder / "none.ply").find("none.ply: no such file"), std::string::npos);
  EXPECT_NE(error_of(folder.write("a.xyz", "1 2 3")).find("convert"), std::string::npos);
  const auto cut = folder.write("cut.ply", test::scan_samples()[1].bytes.substr(0, 700));
  EXPECT_NE(error_of(cut).find("copy or export the scan again"), std::string::npos);
  const auto flat = folder.write("flat.ply",
                                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                 "property float y\nend_header\n1 2\n");
  EXPECT_NE(error_of(flat).find("no x, y and z"), std::string::npos);
}

// 4 bytes as they are (the float 1.0), then 8 bytes from 4 back, which overlap what they write.
const std::string kPackedOnes("\x03\x00\x00\x80\x3F\xC0\x03", 7);

TEST(CompressedPcd, RepeatsWhatReferencesPointTo) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.pcd", test::compressed_pcd(1, kPackedOnes, 12));
  EXPECT_EQ(read_cloud_file(path).points, std::vector<Eigen::Vector3f>{Eigen::Vector3f::Ones()});
}

TEST(CompressedPcd, OfNothingHasNoPoints) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.pcd", test::compressed_pcd(0, "", 0));
  EXPECT_TRUE(read_cloud_file(path).points.empty());
}

TEST(CompressedPcd, RefusesReferencesBeforeTheStartAndWrongSizes) {
  const TemporaryFolder folder;
  const std::string before_the_start = std::string("\x03\x00\x00\x80\x3F\xC0\x04", 7);
  const std::string too_short = kPackedOnes.substr(0, 5), too_long = kPackedOnes + kPackedOnes;
  for (const std::string& packed :
       {before_the_start, too_short, too_long, kPackedOnes.substr(0, 6), std::string()}) {
    const auto path = folder.write("a.pcd", test::compressed_pcd(1, packed, 12));
    EXPECT_NE(error_of(path).find("damaged compressed data"), std::string::npos) << error_of(path);
  }
  const auto empty = folder.write("a.pcd", test::compressed_pcd(0, kPackedOnes, 0));
  EXPECT_NE(error_of(empty).find("damaged compressed data"), std::string::npos) << error_of(empty);
}

TEST(CompressedPcd, AllocatesOnlyWhatItsDataCanUnpackTo) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.pcd", test::compressed_pcd(357913941, kPackedOnes, 4294967292));
  EXPECT_NE(error_of(path).find("damaged compressed data"), std::string::npos) << error_of(path);
}

}  // namespace
}  // namespace voxlist::io
