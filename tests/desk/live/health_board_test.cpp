#include "services/voxlist/live/health_board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <voxlist/health_t.hpp>

namespace voxlist::desk {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

health_t health(const std::string& service, std::int32_t state, const std::string& message) {
  health_t result{};
  result.service = service;
  result.state = state;
  result.message = message;
  result.latency_p99_ms = 12.34F;
  return result;
}

TEST(HealthBoard, ShowsStateLatencyAgeAndReason) {
  HealthBoard board;
  board.take(health("mapper", health_t::STATE_ERROR, "the disk is full"), 10.0);
  board.take(health("localiser", health_t::STATE_OK, ""), 11.0);
  const auto table = board.table(12.0);
  ASSERT_THAT(table, SizeIs(3));
  EXPECT_EQ(table[0], "SERVICE              STATE          P99   MEMORY     AGE  REASON");
  EXPECT_EQ(table[1], "localiser            OK         12.3 ms        -     1 s");
  EXPECT_EQ(table[2], "mapper               ERROR      12.3 ms        -     2 s  the disk is full");
}

TEST(HealthBoard, ShowsMemoryAndWhatElseIsMeasured) {
  HealthBoard board;
  health_t message = health("mapper", health_t::STATE_OK, "");
  message.gauges = {{"memory_MB", 41.6}, {"map_voxels", 51'234}, {"send_queue_MB", 0.0}};
  message.n_gauges = 3;
  board.take(message, 10.0);
  EXPECT_EQ(board.table(10.0)[1],
            "mapper               OK         12.3 ms    42 MB     0 s   [map_voxels 51234]");
}

TEST(HealthBoard, MarksWhatIsStaleAndSaysHowItWas) {
  HealthBoard board;
  board.take(health("mapper", health_t::STATE_WARNING, "no CLOUD yet"), 10.0);
  EXPECT_TRUE(board.is_well(13.0));
  EXPECT_FALSE(board.is_well(13.1));
  EXPECT_THAT(
      board.table(30.0)[1],
      HasSubstr("SILENT     12.3 ms        -    20 s  nothing heard for 20 s; it was WARNING: no "
                "CLOUD yet"));
}

TEST(HealthBoard, MissesServicesThatNeverSpoke) {
  HealthBoard board({"mapper", "localiser"});
  board.take(health("mapper", health_t::STATE_OK, ""), 0.0);
  EXPECT_FALSE(board.all_heard());
  EXPECT_FALSE(board.is_well(0.0));
  EXPECT_THAT(board.troubles(0.0),
              ElementsAre("localiser: SILENT: no HEALTH heard: does it run on this bus?"));
  board.take(health("localiser", health_t::STATE_WARNING, "LOST"), 0.0);
  EXPECT_TRUE(board.all_heard());
  EXPECT_TRUE(board.is_well(0.0));
}

TEST(HealthBoard, IsNotWellWithAnErrorOrNobody) {
  HealthBoard board;
  EXPECT_FALSE(board.is_well(0.0));
  EXPECT_THAT(board.troubles(0.0), IsEmpty());
  board.take(health("mapper", health_t::STATE_ERROR, "x"), 0.0);
  EXPECT_FALSE(board.is_well(0.0));
  board.take(health("mapper", health_t::STATE_OK, ""), 1.0);
  EXPECT_TRUE(board.is_well(1.0));
}

TEST(HealthBoard, LetsNobodySteerTheTerminalOrFillTheMemory) {
  HealthBoard board;
  board.take(health("a\x1b[2J", health_t::STATE_ERROR, "b\x1b[2J\n"), 0.0);
  EXPECT_THAT(board.troubles(0.0), ElementsAre("a?[2J: ERROR: b?[2J?"));
  for (int i = 0; i < 1000; ++i) board.take(health(std::to_string(i), 0, ""), 0.0);
  EXPECT_THAT(board.table(0.0), SizeIs(65));
}

}  // namespace
}  // namespace voxlist::desk
