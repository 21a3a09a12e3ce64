#include "voxlist/drawing/map_picture.h"

#include <gtest/gtest.h>

#include "tests/drawing/pixels.h"
#include "voxlist/drawing/map_columns.h"

namespace voxlist::drawing {
namespace {

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
  const test::Pixels pixels = test::pixels_of(lying);
  const io::Rgb wall = pixels.at(78, 400), floor = pixels.at(900, 600);
  EXPECT_GT(wall.r + wall.g + wall.b, floor.r + floor.g + floor.b + 100);
}

TEST(MapPicture, ShowsPathScaleAndHeights) {
  const test::Pixels without = test::pixels_of(draw_map(room(), {}, 0.1));
  const test::Pixels with =
      test::pixels_of(draw_map(room(), {{1.0, 1.0, 0.0}, {5.0, 3.0, 0.0}}, 0.1));
  constexpr io::Rgb kPath{255, 92, 72}, kInk{226, 230, 236};
  EXPECT_EQ(without.count(kPath), 0U);
  EXPECT_GT(with.count(kPath), 2000U);
  EXPECT_GT(without.count(kInk), 400U);
  EXPECT_GT(with.count(kInk), without.count(kInk) + 40U);
}

// A ramp that rises by 1 m over 10 m.
TEST(MapPicture, ShowsFromTheSideThatTheFloorRises) {
  std::vector<Eigen::Vector3f> ramp;
  std::vector<Eigen::Vector3d> path;
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 40; ++y)
      ramp.emplace_back(0.1F * static_cast<float>(x), 0.1F * static_cast<float>(y),
                        0.01F * static_cast<float>(x));
  const test::Pixels pixels = test::pixels_of(draw_map(ramp, path, 0.1));
  const auto brightest_row = [&](int column) {
    int best = 0, most = -1;
    for (int row = pixels.height - 84 - 170; row < pixels.height - 84; ++row) {
      const io::Rgb colour = pixels.at(column, row);
      if (colour.r + colour.g + colour.b > most) {
        most = colour.r + colour.g + colour.b;
        best = row;
      }
    }
    return best;
  };
  const int at_start = brightest_row(150), at_end = brightest_row(1390);
  EXPECT_NEAR(at_start - at_end, 0.085 * 1460.0, 30.0) << "140 pixels are 1 m, nearly";
}

TEST(MapPicture, DrawsEvenAnEmptyMap) {
  EXPECT_EQ(draw_map({}, {}, 0.05).width(), 1540);
  EXPECT_EQ(draw_map({{1.0F, 1.0F, 1.0F}}, {}, 0.05).width(), 1540);
}

}  // namespace
}  // namespace voxlist::drawing
