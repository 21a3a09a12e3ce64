#include "voxlist/matching/paper/particle_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>

#include "tests/matching/synthetic_room.h"

namespace voxlist::matching {
namespace {

using std::numbers::pi;

std::set<PoseKey> keys(const ParticleSet& particles) {
  std::set<PoseKey> result;
  for (const auto& p : particles) result.insert(p.key);
  return result;
}

bool sorted_and_unique(const ParticleSet& particles) {
  return std::adjacent_find(particles.begin(), particles.end(), [](const auto& a, const auto& b) {
           return !(a.key < b.key);
         }) == particles.end();
}

// Equation 2 without any of the library's counting: each turned point's voxel, moved, in a plain
// set.
int slow_weight(const std::set<Voxel>& map, const std::vector<Eigen::Vector3f>& points,
                const PoseLattice& lattice, const PoseKey& key) {
  const double yaw = 2.0 * pi * key.itheta / lattice.headings(), e = lattice.resolution_m();
  std::set<Voxel> scan;
  for (const auto& p : points) {
    scan.insert(
        {static_cast<int>(std::floor((std::cos(yaw) * p.x() - std::sin(yaw) * p.y()) / e)) + key.ix,
         static_cast<int>(std::floor((std::sin(yaw) * p.x() + std::cos(yaw) * p.y()) / e)) + key.iy,
         static_cast<int>(std::floor(p.z() / e))});
  }
  return static_cast<int>(
      std::count_if(scan.begin(), scan.end(), [&](const Voxel& v) { return map.contains(v); }));
}

SyntheticRoom small_room() { return synthetic_room(6.0, 4.5, {2.2, 1.9, 0.7}, 1500, 7); }
PoseWindow whole_room() { return {{3.0, 2.25, 0.0}, 3.0, 2.25, pi}; }

TEST(PoseLattice, HasTheHeadingsOfEquationOneRoundedUp) {
  const double expected[] = {40, 79, 158, 315, 629, 1257, 2514};
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(PoseLattice(1.28 / (1 << i), 8.0).headings(), expected[i]);
  }
  EXPECT_EQ(PoseLattice(1.28, 0.0).headings(), 1);
}

TEST(PoseLattice, NestsByDoubling) {
  PoseLattice lattice(1.28, 8.0);
  for (int i = 0; i < 6; ++i) {
    const Pose2 coarse = pose_at(lattice, {7, -3, 5});
    const double step = lattice.heading_step_rad();
    lattice = lattice.finer();
    const Pose2 fine = pose_at(lattice, {14, -6, 10});
    EXPECT_NEAR(distance_m(coarse, fine), 0.0, 1e-12);
    EXPECT_NEAR(turn_rad(coarse, fine), 0.0, 1e-12);
    EXPECT_NEAR(lattice.heading_step_rad(), step / 2.0, 1e-15);
    EXPECT_LE(lattice.heading_step_rad(), lattice.resolution_m() / 8.0);
  }
  EXPECT_NEAR(lattice.resolution_m(), 0.02, 1e-15);
}

TEST(UniformPoses, CoverAWindowWithinHalfAStep) {
  const PoseLattice lattice(0.32, 5.0);
  const PoseWindow window{{10.1, -3.3, 3.0}, 0.7, 0.4, 0.5};
  const ParticleSet particles = uniform_poses(lattice, window);
  EXPECT_EQ(static_cast<double>(particles.size()), count_uniform_poses(lattice, window));
  EXPECT_TRUE(sorted_and_unique(particles));
  for (double x = 9.4; x <= 10.8; x += 0.1) {
    for (double yaw = 2.5; yaw <= 3.5; yaw += 0.02) {
      const Pose2 pose{x, -3.3, yaw};
      EXPECT_TRUE(std::any_of(particles.begin(), particles.end(),
                              [&](const WeightedKey& p) {
                                const Pose2 at = pose_at(lattice, p.key);
                                return std::abs(at.x_m - pose.x_m) <= 0.16 + 1e-9 &&
                                       std::abs(at.y_m - pose.y_m) <= 0.16 + 1e-9 &&
                                       turn_rad(at, pose) <= lattice.heading_step_rad() / 2 + 1e-9;
                              }))
          << x << ' ' << yaw;
    }
  }
}

TEST(UniformPoses, GoRoundTheWholeCircleOnce) {
  const PoseLattice lattice(1.28, 8.0);
  EXPECT_EQ(uniform_poses(lattice, {{0, 0, 1.0}, 0.0, 0.0, pi}).size(), 40u);
  EXPECT_EQ(keys(uniform_poses(lattice, {{0, 0, 1.0}, 0.0, 0.0, pi - 0.01})).size(), 40u);
}

TEST(UniformPoses, RefuseAWindowThatIsNotFinite) {
  const PoseLattice lattice(1.28, 8.0);
  EXPECT_THROW(uniform_poses(lattice, {{NAN, 0, 0}, 1, 1, pi}), std::invalid_argument);
  EXPECT_THROW(uniform_poses(lattice, {{0, 0, 0}, INFINITY, 1, pi}), std::invalid_argument);
  EXPECT_THROW(uniform_poses(lattice, {{0, 0, 0}, 1, -1, pi}), std::invalid_argument);
}

TEST(UpdateWeights, EqualsASlowCount) {
  const SyntheticRoom room = small_room();
  const PoseLattice lattice(0.02, horizontal_radius_m(room.scan));
  std::set<Voxel> map;
  room.map.for_each_voxel([&](const Voxel& v) { map.insert(v); });
  ParticleSet particles = uniform_poses(lattice, {room.truth, 0.02, 0.02, 0.002});
  ASSERT_GE(particles.size(), 18u);
  int best = 0;
  const Weighing weighing = update_weights(particles, lattice, room.map, room.scan);
  for (const WeightedKey& p : particles) {
    EXPECT_EQ(p.weight, slow_weight(map, room.scan, lattice, p.key));
    best = std::max(best, p.weight);
  }
  EXPECT_GT(best, 500);
  EXPECT_EQ(weighing.max_weight, best);
}

TEST(UpdateWeights, TurnsTheScanOnceForEachHeading) {
  const SyntheticRoom room = small_room();
  const PoseLattice lattice(0.02, 8.0);
  ParticleSet particles = uniform_poses(lattice, {room.truth, 0.1, 0.1, 0.01});
  std::set<std::int32_t> headings;
  for (const auto& p : particles) headings.insert(p.key.itheta);
  ASSERT_GT(headings.size(), 3u);
  EXPECT_EQ(update_weights(particles, lattice, room.map, room.scan).rotations, headings.size());
}

TEST(Prune, KeepsFourFifthsOfTheMaximumAndMore) {
  ParticleSet particles{
      {{0, 0, 0}, 100}, {{0, 0, 1}, 79}, {{0, 0, 2}, 80}, {{0, 0, 3}, 0}, {{0, 0, 4}, 81}};
  prune(particles, 0.8, 100);
  EXPECT_EQ(keys(particles), (std::set<PoseKey>{{0, 0, 0}, {0, 0, 2}, {0, 0, 4}}));
}

TEST(Prune, RemovesWhatDoesNotOverlapAtAll) {
  ParticleSet particles{{{0, 0, 0}, 0}, {{0, 0, 1}, 0}};
  prune(particles, 0.8, 0);
  EXPECT_TRUE(particles.empty());
}

TEST(KeepHeaviest, DropsTheLightestAndKeepsTheOrder) {
  ParticleSet particles{{{0, 0, 0}, 5}, {{0, 0, 1}, 9}, {{0, 0, 2}, 5}, {{0, 0, 3}, 7}};
  EXPECT_FALSE(keep_heaviest(particles, 4));
  EXPECT_TRUE(keep_heaviest(particles, 3));
  EXPECT_EQ(keys(particles), (std::set<PoseKey>{{0, 0, 0}, {0, 0, 1}, {0, 0, 3}}));
  EXPECT_TRUE(sorted_and_unique(particles));
}

TEST(Resample, MakesTwentySevenChildrenOneStepApart) {
  const PoseLattice coarse(1.28, 8.0), fine = coarse.finer();
  const PoseKey parent{5, -4, 3};
  const ParticleSet children = resample({{parent, 10}}, fine);
  EXPECT_EQ(children.size(), 27u);
  EXPECT_TRUE(sorted_and_unique(children));
  for (const auto& child : children) {
    EXPECT_EQ(child.weight, 0);
    const Pose2 from = pose_at(coarse, parent), to = pose_at(fine, child.key);
    EXPECT_LE(std::abs(to.x_m - from.x_m), 0.64 + 1e-9);
    EXPECT_LE(std::abs(to.y_m - from.y_m), 0.64 + 1e-9);
    EXPECT_LE(turn_rad(to, from), fine.heading_step_rad() + 1e-9);
  }
  EXPECT_TRUE(keys(children).contains({10, -8, 6}));
  EXPECT_TRUE(keys(children).contains({11, -9, 7}));
}

TEST(Resample, MakesSharedChildrenOnce) {
  const PoseLattice fine = PoseLattice(1.28, 8.0).finer();
  EXPECT_EQ(resample({{{5, 0, 0}, 1}, {{5, 0, 1}, 1}}, fine).size(), 45u);
  EXPECT_EQ(resample({{{5, 0, 0}, 1}, {{6, 0, 0}, 1}}, fine).size(), 45u);
  EXPECT_EQ(resample({{{5, 0, 0}, 1}, {{7, 0, 0}, 1}}, fine).size(), 54u);
}

TEST(Resample, TakesHeadingsModuloTheCircle) {
  const PoseLattice fine = PoseLattice(1.28, 8.0).finer();
  const auto children = keys(resample({{{0, 0, 0}, 1}, {{39, 0, 0}, 1}}, fine));
  EXPECT_EQ(children.size(), 45u);  // 77, 78, 79, 0, 1: the two parents are neighbours
  EXPECT_EQ(children.begin()->itheta, 0);
  EXPECT_EQ(children.rbegin()->itheta, 79);
}

TEST(ParticleFilter, FindsTheScanInTheWholeRoom) {
  const SyntheticRoom room = small_room();
  const auto result = ParticleFilter(room.map).localise(room.scan, whole_room());
  ASSERT_FALSE(result.particles.empty());
  EXPECT_FALSE(result.truncated);
  EXPECT_LE(distance_m(result.particles[0].pose, room.truth), 0.03);
  EXPECT_LE(turn_rad(result.particles[0].pose, room.truth), 0.01);
  ASSERT_EQ(result.levels.size(), 7u);
  EXPECT_NEAR(result.levels.front().resolution_m, 1.28, 1e-12);
  EXPECT_NEAR(result.levels.back().resolution_m, 0.02, 1e-12);
}

TEST(ParticleFilter, FindsTheScanNearALastPose) {
  for (int i = 0; i < 4; ++i) {
    const Pose2 truth{2.0 + 0.313 * i, 1.7 + 0.171 * i, -2.9 + 1.57 * i};
    const SyntheticRoom room = synthetic_room(6.0, 4.5, truth, 800, 11);
    const PoseWindow window{
        {truth.x_m + 0.3, truth.y_m - 0.2, truth.yaw_rad + 0.15}, 0.5, 0.5, 0.26};
    const auto result = ParticleFilter(room.map).localise(room.scan, window);
    ASSERT_FALSE(result.particles.empty());
    EXPECT_LE(distance_m(result.particles[0].pose, truth), 0.03) << i;
    EXPECT_LE(turn_rad(result.particles[0].pose, truth), 0.01) << i;
  }
}

TEST(ParticleFilter, GivesItsParticlesBestFirstAndPruned) {
  const SyntheticRoom room = small_room();
  const auto particles =
      ParticleFilter(room.map).localise(room.scan, {room.truth, 0.3, 0.3, 0.1}).particles;
  ASSERT_GT(particles.size(), 1u);
  EXPECT_TRUE(std::is_sorted(particles.begin(), particles.end(),
                             [](const auto& a, const auto& b) { return a.weight > b.weight; }));
  EXPECT_GE(particles.back().weight, 0.8 * particles.front().weight);
}

TEST(ParticleFilter, StopsAtTheLevelThatIsAskedFor) {
  const SyntheticRoom room = small_room();
  const ParticleFilter filter(room.map, {.coarsest_factor = 16, .final_factor = 4});
  const auto result = filter.localise(room.scan, {room.truth, 0.5, 0.5, 0.3});
  ASSERT_EQ(result.levels.size(), 3u);
  EXPECT_NEAR(result.levels[0].resolution_m, 0.32, 1e-12);
  EXPECT_NEAR(result.levels[2].resolution_m, 0.08, 1e-12);
  ASSERT_FALSE(result.particles.empty());
  EXPECT_LE(distance_m(result.particles[0].pose, room.truth), 0.12);
}

TEST(ParticleFilter, DoesNotDependOnTheOrderOfThePoints) {
  SyntheticRoom room = small_room();
  const ParticleFilter filter(room.map, {.final_factor = 2});
  const auto once = filter.localise(room.scan, {room.truth, 0.5, 0.5, 0.3}).particles;
  std::mt19937 random(3);
  for (std::size_t i = room.scan.size(); i > 1; --i)
    std::swap(room.scan[i - 1], room.scan[random() % i]);
  room.scan.push_back(room.scan.front());
  const auto again = filter.localise(room.scan, {room.truth, 0.5, 0.5, 0.3}).particles;
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].pose, again[i].pose);
    EXPECT_EQ(once[i].weight, again[i].weight);
  }
}

TEST(ParticleFilter, SaysWhenItDroppedParticles) {
  const SyntheticRoom room = small_room();
  const PoseWindow window{room.truth, 0.5, 0.5, 0.3};
  const auto bounded = ParticleFilter(room.map, {.max_particles = 100}).localise(room.scan, window);
  EXPECT_TRUE(bounded.truncated);
  EXPECT_FALSE(bounded.particles.empty());
  for (const auto& level : bounded.levels) EXPECT_LE(level.particles, 100u);
  EXPECT_FALSE(ParticleFilter(room.map).localise(room.scan, window).truncated);
}

TEST(ParticleFilter, SearchesNothingWhenTheWindowIsTooLarge) {
  const SyntheticRoom room = small_room();
  const auto result = ParticleFilter(room.map).localise(room.scan, {{}, 1e7, 1e7, pi});
  EXPECT_TRUE(result.truncated);
  EXPECT_TRUE(result.particles.empty());
  EXPECT_TRUE(result.levels.empty());
}

TEST(ParticleFilter, HasNoAnswerWithoutScanOrMap) {
  const SyntheticRoom room = small_room();
  EXPECT_TRUE(ParticleFilter(room.map).localise({}, whole_room()).particles.empty());
  EXPECT_TRUE(ParticleFilter(VoxelMap()).localise(room.scan, whole_room()).particles.empty());
  EXPECT_TRUE(
      ParticleFilter(room.map).localise(room.scan, {{500, 500, 0}, 1, 1, pi}).particles.empty());
}

TEST(ParticleFilter, IgnoresPointsThatAreNotFinite) {
  SyntheticRoom room = small_room();
  const ParticleFilter filter(room.map, {.final_factor = 4});
  const auto clean = filter.localise(room.scan, {room.truth, 0.3, 0.3, 0.1});
  room.scan.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  room.scan.emplace_back(0.0F, std::numeric_limits<float>::infinity(), 0.0F);
  const auto dirty = filter.localise(room.scan, {room.truth, 0.3, 0.3, 0.1});
  ASSERT_EQ(clean.particles.size(), dirty.particles.size());
  EXPECT_EQ(clean.particles[0].pose, dirty.particles[0].pose);
}

TEST(ParticleFilter, RefusesLevelsThatDoNotNest) {
  const VoxelMap map;
  EXPECT_THROW(ParticleFilter(map, {.coarsest_factor = 48}), std::invalid_argument);
  EXPECT_THROW(ParticleFilter(map, {.coarsest_factor = 2, .final_factor = 4}),
               std::invalid_argument);
  EXPECT_THROW(ParticleFilter(map, {.final_factor = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::matching
