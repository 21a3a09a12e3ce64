// Loops that are closed while the map goes on to grow.
#include "services/mapper/loops/loop_keeper.h"

#include <gtest/gtest.h>

#include "tests/services/mapper/bent_drive.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

constexpr std::int64_t kNow_us = 1'700'000'000'000'000;

class LoopKeeperTest : public testing::Test {
 protected:
  // The drive's next keyframe, as the map has it.
  void drive(const Pose2& T_map_keyframe) {
    mapping::Keyframe keyframe = drive_.keyframe(next_++);
    keyframe.T_map_base = to_pose3(T_map_keyframe);
    store_.append(keyframe);
    keeper_.add({keyframe.cloud.utime_us, to_pose3(T_map_keyframe)}, std::nullopt);
  }

  std::optional<ClosedMap> tick() {
    auto closed = keeper_.tick(now_us_ += 1'000'000'000, [&] {
      ++opened_;
      return std::make_unique<mapping::StoredKeyframes>(folder_ / mapping::kKeyframeFile,
                                                        store_.keyframes().places());
    });
    keeper_.wait();
    return closed;
  }

  const BentDrive drive_;
  const test::TemporaryFolder work_;
  const std::filesystem::path folder_ = work_ / "map";
  mapping::MapStore store_{folder_, 7, [](const mapping::Keyframe&) {}};
  bus::Health health_{"mapper"};
  LoopKeeper keeper_{health_, LoopUse::kAlways, {}};
  std::size_t next_ = 0;
  std::int64_t now_us_ = kNow_us;
  int opened_ = 0;
};

TEST_F(LoopKeeperTest, HandsOutTheWholeMapWithKeyframesThatCameMeanwhile) {
  const std::size_t known = drive_.size() - 6;
  while (next_ < known) drive(drive_.bent[next_]);
  EXPECT_FALSE(tick()) << "it begins";
  EXPECT_EQ(opened_, 1);
  while (next_ < known + 4) drive(drive_.bent[next_]);
  EXPECT_FALSE(tick()) << "the map is made";
  drive(drive_.bent[next_]);
  const auto closed = tick();
  ASSERT_TRUE(closed);
  ASSERT_EQ(closed->keyframes.size(), next_);
  ASSERT_EQ(closed->builder.poses().size(), next_);
  const std::vector<Pose2> poses = planar(closed->builder.poses());
  const std::vector<Pose2> truth(drive_.truth.begin(),
                                 drive_.truth.begin() + static_cast<std::ptrdiff_t>(next_));
  EXPECT_LT(mapping::rmse_m(poses, truth), 0.05);
  EXPECT_LT(distance_m(closed->T_new_old * drive_.bent[next_ - 1], poses.back()), 1e-9);
  EXPECT_GE(closed->drawn.loops.size(), 4u);
  for (const auto& [from, to] : closed->drawn.loops) EXPECT_LT((from - to).norm(), 25.0);
  ASSERT_GE(closed->drawn.before.size(), 40u);
  EXPECT_EQ(closed->drawn.before[40].x(), drive_.bent[40].x_m);
  mapping::MapBuilder fresh;
  for (std::size_t i = 0; i < next_; ++i) {
    mapping::Keyframe keyframe = drive_.keyframe(i);
    keyframe.T_map_base = closed->builder.poses()[i].pose;
    fresh.add(std::move(keyframe));
  }
  EXPECT_EQ(closed->builder.map().occupied.hash(), fresh.map().occupied.hash());
  EXPECT_EQ(closed->builder.map().passed.hash(), fresh.map().passed.hash());
  // Where it is closed, nothing is handed out.
  keeper_.accept(closed->keyframes);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(tick());
}

TEST_F(LoopKeeperTest, LeavesAMapThatIsRightAsItIs) {
  while (next_ < drive_.size()) drive(drive_.truth[next_]);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(tick());
  EXPECT_EQ(opened_, 1) << "without new keyframes it does not look again";
}

TEST_F(LoopKeeperTest, DoesNotLookWhereTheDriveDoesNotComeBack) {
  while (next_ < 14) drive(drive_.bent[next_]);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(tick());
  EXPECT_EQ(opened_, 0);
}

TEST_F(LoopKeeperTest, EndsInTheMiddleOfItsWork) {
  while (next_ < drive_.size()) drive(drive_.bent[next_]);
  keeper_.tick(now_us_, [&] {
    return std::make_unique<mapping::StoredKeyframes>(folder_ / mapping::kKeyframeFile,
                                                      store_.keyframes().places());
  });
  keeper_.clear();
  EXPECT_FALSE(tick());
}

}  // namespace
}  // namespace voxlist::services
