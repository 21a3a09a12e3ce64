#include "voxlist/bus/multicast/paced_sender.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace voxlist::bus {
namespace {

constexpr PacedSender::Options kSlow{
    .bytes_per_ms = 1000, .burst_bytes = 2000, .max_queued_bytes = 100'000};

TEST(PacedSender, SendsInOrderAndNoFasterThanItsRate) {
  PacedSender sender(kSlow);
  std::vector<int> sent;
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(sender.push(500, [&sent, i] { sent.push_back(i); }));
  sender.run(0);
  EXPECT_EQ(sent.size(), 4U) << "a burst";
  sender.run(0);
  EXPECT_EQ(sent.size(), 4U);
  sender.run(1000);
  EXPECT_EQ(sent.size(), 6U) << "one millisecond more";
  sender.run(1'000'000);
  EXPECT_EQ(sent.size(), 10U) << "never more than a burst";
  for (std::int64_t now_us = 1'001'000; !sender.idle(); now_us += 1000) sender.run(now_us);
  std::vector<int> all(20);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sent, all);
  EXPECT_EQ(sender.queued_bytes(), 0);
}

TEST(PacedSender, SendsFirstWhatSomebodyWaitsFor) {
  PacedSender sender(kSlow);
  std::vector<int> sent;
  for (const int i : {3, 4}) sender.push(2000, [&sent, i] { sent.push_back(i); });
  for (const int i : {1, 2}) sender.push_first(2000, [&sent, i] { sent.push_back(i); });
  EXPECT_EQ(sender.queued_bytes(), 8000);
  for (std::int64_t now_us = 0; !sender.idle(); now_us += 1000) sender.run(now_us);
  EXPECT_EQ(sent, (std::vector<int>{1, 2, 3, 4}));
}

TEST(PacedSender, PaysForALargeMessageAfterwards) {
  PacedSender sender(kSlow);
  int sent = 0;
  for (int i = 0; i < 2; ++i) sender.push(10'000, [&] { ++sent; });
  sender.run(0);
  EXPECT_EQ(sent, 1);
  sender.run(8'000);
  EXPECT_EQ(sent, 1);
  sender.run(8'001);
  sender.run(9'000);
  EXPECT_EQ(sent, 2);
}

TEST(PacedSender, EarnsNothingWhenTimeGoesBack) {
  PacedSender sender(kSlow);
  int sent = 0;
  for (int i = 0; i < 5; ++i) sender.push(2000, [&] { ++sent; });
  sender.run(5'000'000);
  sender.run(0);
  EXPECT_EQ(sent, 1);
  sender.run(2000);
  EXPECT_EQ(sent, 2);
}

TEST(PacedSender, RefusesMoreThanItsQueueHolds) {
  PacedSender sender(kSlow);
  EXPECT_TRUE(sender.push(100'000, [] {}));
  EXPECT_FALSE(sender.push(1, [] {}));
  sender.clear();
  EXPECT_TRUE(sender.idle());
  EXPECT_TRUE(sender.push(1, [] {}));
}

}  // namespace
}  // namespace voxlist::bus
