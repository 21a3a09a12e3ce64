#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/services/localiser_and_mapper.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"

namespace voxlist::services {
namespace {

// A room as it is seen x_m ahead of its middle.
Cloud room(float x_m) {
  Cloud cloud;
  for (float s = -3.f; s < 3.f; s += 0.06f) {
    for (float z = 0.f; z < 2.f; z += 0.1f) {
      cloud.points.emplace_back(s - x_m, 2.5f, z);
      cloud.points.emplace_back(3.f - x_m, s, z);
      if (s < 1.f) cloud.points.emplace_back(-3.f - x_m, s, z);
      if (s < -1.f) cloud.points.emplace_back(s - x_m, -2.f, z);
      if (s > 0.f && s < 0.5f) cloud.points.emplace_back(s + 1.f - x_m, 1.5f, z);
    }
  }
  return cloud;
}

// A cloth over the scanner.
Cloud covered() {
  Cloud cloud;
  for (float a = 0.f; a < 6.28f; a += 0.05f)
    for (float z = 0.f; z < 0.6f; z += 0.02f) {
      const float r_m = 0.35f + 0.1f * std::sin(5.f * a) * std::cos(20.f * z);
      cloud.points.emplace_back(r_m * std::cos(a), r_m * std::sin(a), z);
    }
  return cloud;
}

class FirstCloud : public testing::Test {
 protected:
  std::int64_t send(Cloud cloud) { return live_.send(std::move(cloud)); }
  void start_localiser() { live_.start_localiser(); }

  const localisation_t* answer_to(std::int64_t utime_us) const {
    const localisation_t* found = nullptr;
    for (const localisation_t& answer : live_.answers) {
      if (answer.utime != utime_us) continue;
      EXPECT_EQ(found, nullptr) << "answered twice";
      found = &answer;
    }
    return found;
  }

  bool is_tracking(std::int64_t utime_us, double x_m) const {
    const localisation_t* answer = answer_to(utime_us);
    return answer != nullptr && answer->state == localisation_t::STATE_TRACKING &&
           std::abs(answer->modes.at(0).pose[0] - x_m) < 0.03;
  }

  bool is_lost(std::int64_t utime_us) const {
    const localisation_t* answer = answer_to(utime_us);
    return answer != nullptr && answer->state != localisation_t::STATE_TRACKING;
  }

  const test::TemporaryFolder folder_;
  LocaliserAndMapper live_{folder_.string()};
};

TEST_F(FirstCloud, IsGivenUpWhenTheNextTwoFitEachOtherAlone) {
  const auto lid = send(covered()), first = send(room(0.F));
  std::vector<std::int64_t> later;
  for (int i = 1; i <= 5; ++i) later.push_back(send(room(0.2F * static_cast<float>(i))));
  EXPECT_TRUE(is_tracking(lid, 0.0));
  EXPECT_TRUE(is_tracking(first, 0.0)) << "the origin now";
  for (int i = 1; i <= 5; ++i)
    EXPECT_TRUE(is_tracking(later[static_cast<std::size_t>(i - 1)], 0.2 * i)) << i;
  EXPECT_NE(answer_to(lid)->map_id, answer_to(first)->map_id);
  const test::StoredMap stored = test::load_map(folder_.string());
  ASSERT_GE(stored.keyframes.size(), 2u);
  EXPECT_EQ(stored.keyframes[0].cloud.utime_us, first);
}

TEST_F(FirstCloud, StaysWhenOnlyTheSecondIsBad) {
  const auto first = send(room(0.F)), bad = send(covered()), third = send(room(0.2F));
  EXPECT_TRUE(is_tracking(first, 0.0));
  EXPECT_TRUE(is_lost(bad));
  EXPECT_TRUE(is_tracking(third, 0.2));
  EXPECT_EQ(answer_to(first)->map_id, answer_to(third)->map_id);
}

TEST_F(FirstCloud, StaysOnceASecondHasFit) {
  const auto first = send(room(0.F)), second = send(room(0.1F));
  for (int i = 0; i < 15; ++i) EXPECT_TRUE(is_lost(send(covered()))) << i;
  const auto back = send(room(0.2F));
  EXPECT_TRUE(is_tracking(second, 0.1));
  EXPECT_EQ(answer_to(back)->map_id, answer_to(first)->map_id);
}

TEST_F(FirstCloud, OfAMapThatWasThereIsGivenUpAfterTenCloudsThatAreLost) {
  const auto lid = send(covered());
  start_localiser();
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(is_lost(send(room(0.F)))) << i;
  send(room(0.F));
  const auto last = send(room(0.1F));
  EXPECT_TRUE(is_tracking(last, 0.1));
  EXPECT_NE(answer_to(last)->map_id, answer_to(lid)->map_id);
}

}  // namespace
}  // namespace voxlist::services
