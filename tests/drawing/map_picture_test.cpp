#include "voxlist/drawing/map_picture.h"

#include <gtest/gtest.h>

#include "tests/drawing/pixels.h"
#include "voxlist/drawing/map_columns.h"
#include "voxlist/drawing/map_marks.h"

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

MapView view_of(std::vector<Eigen::Vector3f> occupied, std::vector<Eigen::Vector3d> path = {},
                double resolution_m = 0.1) {
  MapView view;
  view.occupied = std::move(occupied);
  view.path = std::move(path);
  view.resolution_m = resolution_m;
  return view;
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
  const Picture lying = draw_map(view_of(room(), {{1.0, 1.0, 0.0}, {5.0, 3.0, 0.0}}));
  EXPECT_EQ(lying.width(), 1540);
  EXPECT_LT(lying.height(), lying.width());
  auto turned_room = room();
  for (auto& p : turned_room) {
    p = {p.y(), p.x(), p.z()};
  }
  const Picture turned = draw_map(view_of(turned_room));
  EXPECT_EQ(turned.height(), lying.height());
  const test::Pixels pixels = test::pixels_of(lying);
  const io::Rgb wall = pixels.at(78, 400), floor = pixels.at(900, 600);
  EXPECT_GT(wall.r + wall.g + wall.b, floor.r + floor.g + floor.b + 100);
}

TEST(MapPicture, ShowsPathScaleAndHeights) {
  const test::Pixels without = test::pixels_of(draw_map(view_of(room())));
  const test::Pixels with =
      test::pixels_of(draw_map(view_of(room(), {{1.0, 1.0, 0.0}, {5.0, 3.0, 0.0}})));
  EXPECT_EQ(without.count(kPath), 0U);
  EXPECT_GT(with.count(kPath), 2000U);
  EXPECT_GT(without.count(kInk), 400U);
  EXPECT_GT(with.count(kInk), without.count(kInk) + 40U);
}

TEST(MapPicture, ShowsLoopsAndThePathBeforeTheyWereClosed) {
  MapView view = view_of(room(), {{1.0, 1.0, 0.0}, {5.0, 3.0, 0.0}});
  const test::Pixels without = test::pixels_of(draw_map(view));
  view.closed = {{{Eigen::Vector2d(1.0, 1.0), Eigen::Vector2d(1.0, 3.0)}},
                 {{1.0, 1.2}, {3.0, 1.2}, {5.0, 2.0}}};
  const test::Pixels with = test::pixels_of(draw_map(view));
  constexpr io::Rgb kLoop{255, 214, 64}, kBefore{120, 126, 136};
  EXPECT_EQ(without.count(kLoop), 0U);
  EXPECT_EQ(without.count(kBefore), 0U);
  EXPECT_GT(with.count(kLoop), 300U);
  EXPECT_GT(with.count(kBefore), 300U);
}

// A ramp that rises by 1 m over 10 m.
TEST(MapPicture, ShowsFromTheSideThatTheFloorRises) {
  std::vector<Eigen::Vector3f> ramp;
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 40; ++y)
      ramp.emplace_back(0.1F * static_cast<float>(x), 0.1F * static_cast<float>(y),
                        0.01F * static_cast<float>(x));
  const test::Pixels pixels = test::pixels_of(draw_map(view_of(ramp)));
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

TEST(MapPicture, TellsFreeFromUnknownWhereNoVoxelIs) {
  MapView view = view_of(room());
  // A hole in the floor, half of which was seen to be free.
  std::erase_if(view.occupied, [](const Eigen::Vector3f& p) {
    return p.x() > 2.0F && p.x() < 4.0F && p.y() > 1.0F && p.y() < 3.0F;
  });
  view.free_m = 0.1;
  for (int x = 20; x < 30; ++x)
    for (int y = 10; y < 30; ++y)
      view.free.emplace_back(0.1F * (static_cast<float>(x) + 0.5F),
                             0.1F * (static_cast<float>(y) + 0.5F));
  const test::Pixels pixels = test::pixels_of(draw_map(view));
  EXPECT_EQ(pixels.at(650, 500), kFree);
  EXPECT_EQ(pixels.at(880, 500), kUnknown);
}

TEST(MapPicture, DrawsEvenAnEmptyMap) {
  EXPECT_EQ(draw_map({}).width(), 1540);
  EXPECT_EQ(draw_map(view_of({{1.0F, 1.0F, 1.0F}}, {}, 0.05)).width(), 1540);
}

}  // namespace
}  // namespace voxlist::drawing
