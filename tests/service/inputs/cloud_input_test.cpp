#include "voxlist/service/inputs/cloud_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <voxlist/health_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/service/inputs/cloud_findings.h"

namespace voxlist::service {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
constexpr std::int64_t kNow_us = 1'700'000'000'000'000;

// Points all round, so far away.
Cloud ring(float range_m, int points = 100) {
  Cloud cloud;
  cloud.utime_us = kNow_us;
  for (int i = 0; i < points; ++i) {
    const float angle_rad = static_cast<float>(i) * 0.1F;
    cloud.points.emplace_back(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad), 1.0F);
  }
  return cloud;
}

struct Door {
  bool takes(const Cloud& cloud, const std::string& frame_id = "base", std::int32_t seq = 0) {
    return input.take(bus::to_message(cloud, frame_id, seq)).has_value();
  }

  bus::Health health{"localiser"};
  CloudInput input{health};
};

TEST(CloudInput, LetsAGoodCloudIn) {
  Door door;
  const auto cloud = door.input.take(bus::to_message(ring(5.0F), "base", 0));
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->points.size(), 100u);
  EXPECT_EQ(cloud->utime_us, kNow_us);
  EXPECT_EQ(door.health.message(), "");
}

TEST(CloudInput, TellsAnotherFrameAndTakesTheCloud) {
  Door door;
  EXPECT_TRUE(door.takes(ring(5.0F), "velodyne"));
  EXPECT_THAT(door.health.message(), HasSubstr("in frame \"velodyne\""));
}

TEST(CloudInput, RefusesKilometresAndAsksForMillimetres) {
  Door door;
  EXPECT_FALSE(door.takes(ring(3000.0F)));
  EXPECT_THAT(door.health.message(), AllOf(HasSubstr("3.0 km"), HasSubstr("millimetres?")));
  EXPECT_EQ(door.health.due(0)->counters.at(0).name, "CLOUD/too_far");
}

TEST(CloudInput, AFewFarPointsAreNoKilometres) {
  Door door;
  Cloud cloud = ring(5.0F);
  for (int i = 0; i < 40; ++i) cloud.points.emplace_back(3000.0F, 0.0F, 0.0F);
  EXPECT_TRUE(door.takes(cloud));
  EXPECT_EQ(door.health.message(), "");
}

TEST(CloudInput, TellsThatThereAreTooFewPoints) {
  for (const int points : {0, 1, 49}) {
    Door door;
    EXPECT_TRUE(door.takes(ring(5.0F, points)));
    EXPECT_THAT(door.health.message(), HasSubstr("only " + std::to_string(points) + " points"));
  }
}

TEST(CloudInput, TellsOfPointsThatAreAllTooFar) {
  Door door;
  EXPECT_TRUE(door.takes(ring(20'000.0F)));
  EXPECT_THAT(door.health.message(), HasSubstr("100 more are not finite or beyond 10 km"));
}

TEST(CloudInput, RefusesATimeInNanoseconds) {
  Door door;
  Cloud cloud = ring(5.0F);
  cloud.utime_us *= 1000;
  EXPECT_FALSE(door.takes(cloud));
  EXPECT_THAT(door.health.message(), HasSubstr("nanoseconds?"));
}

TEST(CloudInput, GapsInTheNumbersMeanNothingWhereMessagesAreSkipped) {
  bus::Health health("obstacle_detector");
  CloudInput newest(health, CloudInput::Sees::kTheNewest);
  Door every;
  Cloud cloud = ring(5.0F);
  for (const int seq : {0, 5}) {
    cloud.utime_us += 100'000;
    newest.take(bus::to_message(cloud, "base", seq));
    every.takes(cloud, "base", seq);
  }
  EXPECT_EQ(health.message(), "");
  EXPECT_THAT(every.health.message(), HasSubstr("gaps in seq"));
}

TEST(CloudFindings, LookAtAThousandPointsOfMillions) {
  Cloud cloud = ring(600.0F, 2'000'000);
  ASSERT_EQ(cloud_findings("base", cloud, 0).size(), 1u);
  EXPECT_TRUE(cloud_findings("base", cloud, 0)[0].refuses);
}

}  // namespace
}  // namespace voxlist::service
