// Looks for loops beside a keyframe file: none is taken again after a restart.
#include "voxlist/mapping/loops/stored_looks.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/loops/session_closing.h"

namespace voxlist::mapping {
namespace {

StoredGraph::Keyframe keyframe_at(std::int64_t utime_us) {
  StoredGraph::Keyframe keyframe;
  keyframe.utime_us = utime_us;
  return keyframe;
}

MapKeyframes keyframes_of(int count) {
  MapKeyframes keyframes;
  for (int i = 0; i < count; ++i) keyframes.push_back(keyframe_at(100 * i));
  return keyframes;
}

LoopLook loop_look(const UncertainPose& predicted) {
  LoopLook look;
  look.keyframe = 7;
  look.reach_m = 12.5;
  look.from = 2;
  look.predicted = predicted;
  look.round.emplace_back(2, Pose2{});
  look.round.emplace_back(3, Pose2{0.0, 1.0, 0.0});
  return look;
}

SpatialLook spatial_look() {
  SpatialLook look;
  look.keyframe = 7;
  look.tilt = {0.1, 0.0, 0.2};
  look.expected = {1.0, 1.0, 1.0};
  look.off_m = 0.3;
  look.others.emplace_back().keyframe = 2;
  return look;
}

void fill(LookMemory& memory) {
  const UncertainPose pose{{1.0, 2.0, 0.3}, Eigen::Matrix3d::Identity()};
  memory.keep(3, 4, NeighbourLook{{1.0, 0.0, 0.1}, {-1.0, 0.0, -0.1}, pose, std::nullopt});
  TakenLook taken;
  taken.look = loop_look(pose);
  for (const std::size_t from : {2U, 3U}) {
    Loop& place = taken.places.emplace_back();
    place.edge.from = from;
    place.edge.to = place.look = 7;
    place.edge.T_from_to = pose;
    place.probability = 0.25 / static_cast<double>(from);
  }
  memory.keep(taken);
  TakenLook nothing;
  nothing.look.keyframe = 9;
  memory.keep(nothing);
  TakenSpatialLook spatial;
  spatial.look = spatial_look();
  spatial.found = UncertainPose3{to_pose3({3.0, 2.0, 1.0}), Six2::Identity()};
  memory.keep(spatial);
}

class StoredLooks : public testing::Test {
 protected:
  StoredLooks() {
    fill(memory_);
    write_looks(folder_.path(), 42, keyframes_of(10), memory_);
  }

  std::filesystem::path file() const { return folder_.path() / kLooksFile; }
  bool is_empty() const { return read_.all().neighbours.empty() && read_.all().loops.empty(); }

  const test::TemporaryFolder folder_;
  LookMemory memory_, read_;
};

TEST_F(StoredLooks, AreReadAsTheyWereWrittenWhereMoreKeyframesCame) {
  EXPECT_EQ(read_looks(folder_.path(), 42, keyframes_of(12), read_), "");
  const auto look = no_look_yet({}, {});
  EXPECT_FALSE(read_.neighbours(3, 4, look));
  const auto taken = read_.neighbours(3, 4, {{1.0, 0.0, 0.1}, {-1.0, 0.0, -0.1}, {}, {}});
  ASSERT_TRUE(taken && taken->there);
  EXPECT_EQ(taken->there->pose, (Pose2{1.0, 2.0, 0.3}));
  EXPECT_FALSE(taken->back);
  const auto loop = read_.loop_look(7), was = memory_.loop_look(7);
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->look, was->look);
  ASSERT_EQ(loop->places.size(), 2U);
  EXPECT_EQ(loop->places[1].edge.from, 3U);
  EXPECT_EQ(loop->places[0].probability, 0.125);
  ASSERT_TRUE(read_.loop_look(9));
  EXPECT_TRUE(read_.loop_look(9)->places.empty());
  const auto space = read_.in_space(spatial_look());
  ASSERT_TRUE(space && space->found);
  EXPECT_EQ(space->found->pose.matrix(), to_pose3({3.0, 2.0, 1.0}).matrix());
}

TEST_F(StoredLooks, OfAnotherMapOrOfOtherKeyframesAreNotTaken) {
  EXPECT_EQ(read_looks(folder_.path(), 43, keyframes_of(10), read_), "");
  EXPECT_TRUE(is_empty());
  EXPECT_EQ(read_looks(folder_.path(), 42, keyframes_of(9), read_), "");
  MapKeyframes others = keyframes_of(10);
  others.erase(others.begin() + 4);
  others.push_back(keyframe_at(1000));
  EXPECT_EQ(read_looks(folder_.path(), 42, others, read_), "");
  EXPECT_TRUE(is_empty());
}

TEST_F(StoredLooks, ThatAreTornOrFlippedAreNotTakenAndThatIsTold) {
  const std::string whole = io::read_file(file());
  const auto expect_told = [&](const std::string& bytes, std::size_t at) {
    std::ofstream(file(), std::ios::trunc | std::ios::binary) << bytes;
    EXPECT_NE(read_looks(folder_.path(), 42, keyframes_of(10), read_), "") << at;
    EXPECT_TRUE(is_empty()) << at;
  };
  for (std::size_t at = 0; at < whole.size(); ++at) {
    expect_told(whole.substr(0, at), at);
    std::string flipped = whole;
    flipped[at] ^= 4;
    expect_told(flipped, at);
  }
}

TEST_F(StoredLooks, ThatAreNotThereAreNoFault) {
  std::filesystem::remove(file());
  EXPECT_EQ(read_looks(folder_.path(), 42, keyframes_of(10), read_), "");
  EXPECT_TRUE(is_empty());
}

}  // namespace
}  // namespace voxlist::mapping
