// A second drive in a map closes the loops of both.
#include "services/voxlist/maps/sessions/extended_map.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/mapping/graph/block_drive.h"
#include "tests/mapping/loops/bent_block.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

using mapping::Keyframe;

// The first half of a bent drive round a block is there, the second is of another session, whose
// times are the same.
class ExtendedMapTest : public testing::Test {
 protected:
  ExtendedMapTest() {
    mapping::MapStore store(folder_, 7, [](const Keyframe&) {});
    for (std::size_t i = 0; i < kFirst; ++i) store.append(keyframe(i));
  }

  Keyframe keyframe(std::size_t i) const {
    Keyframe keyframe{to_pose3(bent_[i]), mapping::scan_block(truth_[i], i + 1)};
    keyframe.cloud.utime_us = static_cast<std::int64_t>(i % kFirst) * 1'000'000;
    return keyframe;
  }

  static constexpr std::size_t kFirst = 30;
  const test::TemporaryFolder work_;
  const std::filesystem::path folder_ = work_ / "map";
  const std::vector<Pose2> truth_ = mapping::way_round(12.0), bent_ = mapping::bent(truth_);
  std::ostringstream out_, err_;
  Console console_{out_, err_, false};
};

std::vector<Pose2> planar(const std::vector<StampedPose3>& poses) {
  std::vector<Pose2> planar;
  for (const StampedPose3& pose : poses) planar.push_back(to_pose2(pose.pose));
  return planar;
}

TEST_F(ExtendedMapTest, StandsWhereAllSessionsAgreeAndStaysThere) {
  std::uint64_t hash = 0;
  {
    ExtendedMap map(folder_, {}, console_);
    for (std::size_t i = kFirst; i < truth_.size(); ++i)
      map.append(keyframe(i),
                 i == kFirst ? std::optional<Pose2>(Pose2{1.0, 2.0, 3.0}) : std::nullopt);
    const auto closing = map.close({});
    EXPECT_TRUE(closing.moves);
    EXPECT_GE(closing.loops, 4U);
    EXPECT_EQ(map.were_there(), kFirst);
    EXPECT_EQ(map.added(), truth_.size() - kFirst);
    EXPECT_LT(mapping::rmse_m(planar(map.poses()), truth_), 0.03);
    hash = map.rebuilt().map().occupied.hash();
  }
  // Whoever reads the folder has the same map.
  ExtendedMap again(folder_, {}, console_);
  EXPECT_EQ(err_.str(), "");
  EXPECT_LT(mapping::rmse_m(planar(again.poses()), truth_), 0.03);
  EXPECT_EQ(again.take_builder().map().occupied.hash(), hash);
  EXPECT_EQ(test::load_map(folder_).keyframes.size(), truth_.size());
  const auto graph = mapping::find_graph(folder_, 7).graph;
  ASSERT_TRUE(graph);
  EXPECT_EQ(graph->moves, 1);
  EXPECT_GT(graph->edges.size(), truth_.size());
  EXPECT_TRUE(graph->keyframes[kFirst].begins_session);
  EXPECT_EQ(graph->keyframes[kFirst].T_odom_keyframe, (Pose2{1.0, 2.0, 3.0}));
  // It is closed.
  EXPECT_FALSE(again.close({}).moves);
  EXPECT_TRUE(mapping::find_graph(folder_, 7).graph->keyframes[kFirst].begins_session);
}

TEST_F(ExtendedMapTest, TheFileIsOnlyAppendedTo) {
  const auto bytes = [&] { return io::read_file(folder_ / mapping::kKeyframeFile); };
  const std::string before = bytes();
  ExtendedMap map(folder_, {}, console_);
  map.append(keyframe(kFirst), std::nullopt);
  map.close({});
  EXPECT_GT(bytes().size(), before.size());
  EXPECT_EQ(bytes().substr(0, before.size()), before);
}

}  // namespace
}  // namespace voxlist::desk
