#include "services/octomap_export/keyframe_queue.h"

#include <gtest/gtest.h>

namespace voxlist::services {
namespace {

using Verdict = KeyframeQueue::Verdict;
constexpr auto kCapacity = static_cast<std::int32_t>(KeyframeQueue::kCapacity);

bus::PosedCloud keyframe(std::int32_t index, std::int64_t map_id = 1) {
  bus::PosedCloud keyframe;
  keyframe.map_id = map_id;
  keyframe.index = index;
  keyframe.cloud.utime_us = 1000 * map_id + index;
  return keyframe;
}

// Takes everything that is next; -1 where there was nothing.
std::int32_t next_index(KeyframeQueue& queue) {
  const auto next = queue.next();
  return next ? next->index : -1;
}

TEST(KeyframeQueue, MissesTheFirstBeforeAnythingHasCome) {
  KeyframeQueue queue;
  EXPECT_EQ(queue.missing(), 0);
  EXPECT_FALSE(queue.is_done());
  EXPECT_FALSE(queue.next());
}

TEST(KeyframeQueue, PutsKeyframesInOrder) {
  KeyframeQueue queue;
  for (const std::int32_t index : {2, 0, 3, 1})
    EXPECT_EQ(queue.add(keyframe(index)), Verdict::kTaken);
  for (const std::int32_t index : {0, 1, 2, 3}) EXPECT_EQ(next_index(queue), index);
  EXPECT_FALSE(queue.next());
  EXPECT_FALSE(queue.missing());
  EXPECT_TRUE(queue.is_done());
}

TEST(KeyframeQueue, MissesWhatAGapLacksOnceTheRestWasTaken) {
  KeyframeQueue queue;
  queue.add(keyframe(0));
  queue.add(keyframe(2));
  EXPECT_FALSE(queue.missing());
  EXPECT_EQ(next_index(queue), 0);
  EXPECT_EQ(queue.missing(), 1);
  EXPECT_FALSE(queue.next());
  queue.add(keyframe(1));
  EXPECT_EQ(next_index(queue), 1);
  EXPECT_EQ(next_index(queue), 2);
}

TEST(KeyframeQueue, KnowsRepetitions) {
  KeyframeQueue queue;
  queue.add(keyframe(0));
  EXPECT_EQ(queue.add(keyframe(0)), Verdict::kRepeated);
  EXPECT_EQ(next_index(queue), 0);
  EXPECT_EQ(queue.add(keyframe(0)), Verdict::kRepeated);
  EXPECT_FALSE(queue.next());
}

TEST(KeyframeQueue, DropsWhatIsNeededLastWhenItIsFullAndMissesItLater) {
  KeyframeQueue queue;
  for (std::int32_t i = 1; i <= kCapacity; ++i) EXPECT_EQ(queue.add(keyframe(i)), Verdict::kTaken);
  EXPECT_EQ(queue.add(keyframe(0)), Verdict::kDroppedOne);
  for (std::int32_t i = 0; i < kCapacity; ++i) EXPECT_EQ(next_index(queue), i);
  EXPECT_EQ(queue.missing(), kCapacity);
}

TEST(KeyframeQueue, StartsOverWithAnotherMap) {
  KeyframeQueue queue;
  queue.add(keyframe(0, 1));
  queue.add(keyframe(1, 1));
  EXPECT_EQ(next_index(queue), 0);
  queue.add(keyframe(1, 2));
  EXPECT_FALSE(queue.next());
  EXPECT_EQ(queue.missing(), 0);
  queue.add(keyframe(0, 2));
  EXPECT_EQ(queue.next()->map_id, 2);
  EXPECT_EQ(queue.next()->map_id, 2);
}

TEST(KeyframeQueue, StartsOverWhenTheMapperLostItsNewestAndWentOn) {
  KeyframeQueue queue;
  for (const std::int32_t index : {0, 1}) {
    queue.add(keyframe(index));
    queue.next();
  }
  bus::PosedCloud other = keyframe(1);
  other.cloud.utime_us += 500;
  queue.add(other);
  EXPECT_EQ(queue.missing(), 0);
  queue.add(keyframe(0));
  EXPECT_EQ(next_index(queue), 0);
  EXPECT_EQ(queue.next()->cloud.utime_us, other.cloud.utime_us);
}

TEST(KeyframeQueue, MissesWhatTheMapperIsSaidToHave) {
  KeyframeQueue queue;
  queue.add(keyframe(0));
  const std::int64_t map_id = keyframe(0).map_id;
  queue.next();
  EXPECT_TRUE(queue.is_done());
  queue.know_of(map_id, 3);
  EXPECT_EQ(queue.missing(), 1);
  EXPECT_FALSE(queue.is_done());
  queue.add(keyframe(1));
  queue.next();
  EXPECT_EQ(queue.missing(), 2);
  queue.know_of(map_id, 1);
  EXPECT_EQ(queue.missing(), 0) << "the mapper has lost one that was handed out";
  queue.know_of(map_id + 1, 5);
  EXPECT_EQ(queue.missing(), 0) << "of another map";
  queue.know_of(map_id + 2, 0);
  EXPECT_EQ(queue.missing(), std::nullopt) << "an empty one";
}

TEST(KeyframeQueue, WaitsForNoKeyframeThatTheMapperDoesNotHave) {
  KeyframeQueue queue;
  queue.add(keyframe(0));
  queue.next();
  queue.add(keyframe(2'000'000'000));
  EXPECT_EQ(queue.missing(), 1);
  queue.know_of(keyframe(0).map_id, 1);
  EXPECT_TRUE(queue.is_done());
}

}  // namespace
}  // namespace voxlist::services
