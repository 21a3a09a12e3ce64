#include "voxlist/matching/counting/turned_points.h"

#include <gtest/gtest.h>

#include <utility>

#include "tests/matching/search/lattice_world.h"

namespace voxlist::matching {
namespace {

constexpr double kReach_m = 4.0;

// The first and last single angle of a part, as parts.
std::pair<std::int32_t, std::int32_t> singles(std::int32_t part) {
  std::int32_t first = part, last = part;
  while (first < TurnedPoints::kFirstSingle) first = 2 * first + 1, last = 2 * last + 2;
  return {first, last};
}

TEST(TurnedPoints, WindowsOfAPartHoldThoseOfItsAngles) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const LatticeWorld world = lattice_world(seed);
    const DilatedMap map(world.map, 0.04, kReach_m);
    TurnedPoints points(map, world.scan);
    std::int64_t more = 0;
    for (std::int32_t group = 0; group < points.groups(); ++group)
      for (std::int32_t part = 0; part < TurnedPoints::kFirstSingle; ++part)
        for (std::size_t i = 0; i < points.size(); ++i) {
          const auto window = [&](std::int32_t p) {
            return map.window(points.places(group, p)[i], map.moved(2, 1));
          };
          std::uint64_t any = 0;
          const auto [first, last] = singles(part);
          for (std::int32_t single = first; single <= last; ++single) any |= window(single);
          ASSERT_EQ(any & ~window(part), 0u) << group << ' ' << part << ' ' << i;
          more += window(part) != any;
        }
    EXPECT_GT(more, 0);
  }
}

TEST(TurnedPoints, WindowsOfSingleAnglesAreSharp) {
  const LatticeWorld world = lattice_world(7);
  const DilatedMap map(world.map, 0.04, kReach_m);
  const std::vector<Eigen::Vector3f> scan(world.scan.begin(), world.scan.begin() + 5);
  TurnedPoints points(map, scan);
  ASSERT_EQ(points.size(), scan.size());
  for (std::int32_t angle = 0; angle < points.angles(); ++angle) {
    const auto places = points.places(angle / TurnedPoints::kGroup,
                                      TurnedPoints::kFirstSingle + angle % TurnedPoints::kGroup);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Eigen::Vector3d p = Pose2{0, 0, points.yaw_rad(angle)} * scan[i].cast<double>();
      const auto cell = [&](double value) {
        return static_cast<std::int32_t>(std::floor(value / 0.04));
      };
      ASSERT_EQ(map.window(places[i], map.moved(1, 2)),
                map.window_anywhere(cell(p.x()) + 8, cell(p.y()) + 16, map.layer(p.z())))
          << angle << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace voxlist::matching
