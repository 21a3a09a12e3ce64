#include "voxlist/drawing/picture.h"

#include <gtest/gtest.h>
#include <png.h>

#include <set>

#include "tests/io/scans/scan_files.h"
#include "tests/temporary_folder.h"
#include "voxlist/drawing/map_columns.h"
#include "voxlist/drawing/map_picture.h"
#include "voxlist/drawing/plot.h"
#include "voxlist/drawing/stroke_font.h"
#include "voxlist/io/files/file.h"

namespace voxlist::drawing {
namespace {

using test::TemporaryFolder;

constexpr io::Rgb kBlack{0, 0, 0};
constexpr io::Rgb kWhite{255, 255, 255};
constexpr io::Rgb kRed{255, 0, 0};

std::size_t count(const Picture& picture, io::Rgb colour) {
  return static_cast<std::size_t>(
      std::count(picture.pixels().begin(), picture.pixels().end(), colour));
}

TEST(Picture, DrawsDiscsOfTheRightAreaAndLinesWhereTheyBelong) {
  Picture picture(100, 100, kBlack);
  picture.disc({50.0, 50.0}, 40.0, kWhite);
  EXPECT_NEAR(static_cast<double>(count(picture, kWhite)), 3.14159 * 19.5 * 19.5, 60.0);
  picture.line({0.0, 10.0}, {99.0, 10.0}, 1.0, kRed);
  EXPECT_EQ(picture.at(0, 10), kRed);
  EXPECT_EQ(picture.at(99, 10), kRed);
  EXPECT_EQ(picture.at(50, 12), kBlack);
}

TEST(Picture, LeavesOutWhatLiesOutside) {
  Picture picture(10, 10, kBlack);
  picture.set(-1, 3, kRed);
  picture.disc({1e12, -1e12}, 5.0, kRed);
  picture.line({-50.0, 5.0}, {HUGE_VAL, 5.0}, 1.0, kRed);
  picture.fill(-5, -5, 0, 20, kRed);
  EXPECT_EQ(count(picture, kBlack), 100U);
  EXPECT_THROW(Picture(0, 10, kBlack), std::invalid_argument);
}

TEST(Picture, WritesTextAsWideAsItSays) {
  Picture picture(200, 40, kBlack);
  picture.text({100.0, 30.0}, "10 m", 20.0, kWhite, TextAnchor::kCentre);
  int left = 200, right = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (picture.at(x, y) != kBlack) {
        left = std::min(left, x);
        right = std::max(right, x);
      }
    }
  }
  EXPECT_NEAR(left + right, 200, 8);
  EXPECT_NEAR(right - left, text_width("10 m", 20.0), 8.0);
}

TEST(StrokeFont, HasAllThatLabelsNeed) {
  for (const char c : std::string("abcdefghijklmnopqrstuvwxyz0123456789.,:-+=/()%_")) {
    ASSERT_FALSE(glyph(c).empty()) << c;
    for (const GlyphStroke& stroke : glyph(c)) {
      EXPECT_GE(stroke.from.minCoeff(), 0.0) << c;
      EXPECT_LE(stroke.to.x(), kGlyphWidth) << c;
      EXPECT_LE(stroke.to.y(), 8.0) << c;
    }
  }
  EXPECT_TRUE(glyph('~').empty());
}

TEST(Picture, IsWrittenAsPngThatLibpngReadsBack) {
  const test::TemporaryFolder folder;
  Picture picture(30, 20, kBlack);
  picture.set(29, 19, kRed);
  write_png(folder / "a.png", picture);
  const std::string bytes = io::read_file(folder / "a.png");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  image.format = PNG_FORMAT_RGB;
  std::vector<io::Rgb> pixels(image.width * image.height);
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));
  EXPECT_EQ(image.width, 30U);
  EXPECT_EQ(pixels, picture.pixels());
}

TEST(Colour, RunsThroughViridis) {
  EXPECT_EQ(io::viridis(0.0), (io::Rgb{68, 1, 84}));
  EXPECT_EQ(io::viridis(0.5), (io::Rgb{33, 144, 141}));
  EXPECT_EQ(io::viridis(7.0), (io::Rgb{253, 231, 37}));
  EXPECT_EQ(io::mix(kBlack, kWhite, 0.5), (io::Rgb{128, 128, 128}));
}

/// A room of 6 x 4 m with floor, ceiling at 3 m and one wall of that height along x = 0, as voxels
/// of 0.1 m.
std::vector<Eigen::Vector3f> room() {
  std::vector<Eigen::Vector3f> points;
  for (int x = 0; x < 60; ++x) {
    for (int y = 0; y < 40; ++y) {
      const auto at = [&](int z) {
        return Eigen::Vector3f((static_cast<float>(x) + 0.5F) * 0.1F,
                               (static_cast<float>(y) + 0.5F) * 0.1F,
                               (static_cast<float>(z) + 0.5F) * 0.1F);
      };
      for (int z = 0; z <= 30; ++z) {
        if (z == 0 || z == 30 || x == 0) {
          points.push_back(at(z));
        }
      }
    }
  }
  return points;
}

TEST(MapColumns, LeaveTheCeilingOutAndKeepTheWall) {
  const auto columns = map_columns(room(), 0.1, 0.1);
  ASSERT_EQ(columns.size(), 2400U);
  for (const MapColumn& column : columns) {
    // The ceiling in the wall's block of 0.4 m stands on the wall.
    if (column.cell.x() == 0) {
      EXPECT_NEAR(column.solid_m, 3.1F, 0.01F);
    } else if (column.cell.x() >= 4) {
      EXPECT_NEAR(column.top_m, 0.05F, 1e-5F);
      EXPECT_NEAR(column.solid_m, 0.1F, 1e-5F);
    }
  }
}

TEST(MapPicture, PutsTheLongSideAcrossAndWallsInBright) {
  const Picture lying = draw_map(room(), {{1.0, 1.0, 0.0}, {5.0, 3.0, 0.0}}, 0.1);
  EXPECT_EQ(lying.width(), 1540);
  EXPECT_LT(lying.height(), lying.width());
  auto turned_room = room();
  for (auto& p : turned_room) {
    p = {p.y(), p.x(), p.z()};
  }
  const Picture turned = draw_map(turned_room, {}, 0.1);
  EXPECT_EQ(turned.height(), lying.height());
  const io::Rgb wall = lying.at(78, 400), floor = lying.at(900, 600);
  EXPECT_GT(wall.r + wall.g + wall.b, floor.r + floor.g + floor.b + 100);
}

TEST(MapPicture, DrawsEvenAnEmptyMap) {
  EXPECT_EQ(draw_map({}, {}, 0.05).width(), 1540);
  EXPECT_EQ(draw_map({{1.0F, 1.0F, 1.0F}}, {}, 0.05).width(), 1540);
}

TEST(Plot, PutsRoundNumbersOnAxes) {
  const auto ticks = plot_ticks(-0.31, 1.07, 6);
  ASSERT_EQ(ticks.size(), 3U);
  EXPECT_NEAR(ticks[0], 0.0, 1e-12);
  EXPECT_NEAR(ticks[1], 0.5, 1e-12);
  EXPECT_TRUE(plot_ticks(1.0, 1.0, 5).empty());
  EXPECT_TRUE(plot_ticks(0.0, NAN, 5).empty());
}

TEST(Plot, DrawsLinesAndSurvivesHavingNone) {
  const Picture some = draw_plot({"t", "x", "y", 400, 300, true}, {{"a", kRed, {{0, 0}, {2, 5}}}});
  EXPECT_GT(count(some, kRed), 100U);
  const Picture none = draw_plot({"t", "x", "y", 400, 300, false}, {{"a", kRed, {}}});
  EXPECT_EQ(none.width(), 400);
  draw_plot({"t", "x", "y", 400, 300, false}, {{"a", kRed, {{NAN, 1}, {3, 3}}}});
}

}  // namespace
}  // namespace voxlist::drawing
