#include "services/voxlist/maps/ahead/look_ahead.h"

#include <gtest/gtest.h>

#include <vector>

#include "services/voxlist/maps/piece_closing.h"
#include "tests/temporary_folder.h"

namespace voxlist::desk {
namespace {

// Keyframes of a room, a step apart.
class LookAheadTest : public testing::Test {
 protected:
  LookAheadTest() {
    for (int i = 0; i < 5; ++i) {
      mapping::Keyframe keyframe;
      keyframe.T_map_base = to_pose3({0.4 * i, 0.0, 0.1});
      for (int k = 0; k < 4000; ++k) {
        const float y = 0.004F * float(k % 1000) - 2.0F, z = 0.6F * float(k / 1000);
        keyframe.cloud.points.emplace_back(3.0F - 0.4F * float(i), y, z);
        keyframe.cloud.points.emplace_back(y, 2.0F, z);
      }
      keyframes_.push_back({spool_.add(keyframe), keyframe.T_map_base});
    }
  }

  LookAhead::Looks looks(bool is_on, int pairs) {
    LookAhead ahead(spool_, config_, is_on);
    for (int i = 1; i <= pairs; ++i)
      ahead.add(keyframes_[std::size_t(i) - 1], keyframes_[std::size_t(i)]);
    ahead.wait();
    return ahead.finish();
  }

  const test::TemporaryFolder folder_;
  mapping::KeyframeSpool spool_{folder_.path()};
  const matching::MatcherConfig config_;
  std::vector<mapping::SpooledKeyframe> keyframes_;
};

TEST_F(LookAheadTest, TakesTheLooksThatClosingWouldTake) {
  const LookAhead::Looks taken = looks(true, 4);
  ASSERT_EQ(taken.size(), 4u);
  mapping::NeighbourLooker looker([&](std::size_t i) { return level_cloud(spool_, keyframes_[i]); },
                                  config_);
  for (std::size_t i = 1; i < keyframes_.size(); ++i) {
    const mapping::NeighbourLook& look = taken.at({i - 1, i});
    const mapping::NeighbourLook expected = looker.look(
        i - 1, i, to_pose2(keyframes_[i - 1].T_map_base), to_pose2(keyframes_[i].T_map_base));
    EXPECT_TRUE(are_alike(look, expected));
    ASSERT_EQ(look.there.has_value(), expected.there.has_value());
    ASSERT_EQ(look.back.has_value(), expected.back.has_value());
    EXPECT_TRUE(look.there || look.back);
    if (look.there) {
      EXPECT_EQ(look.there->pose.x_m, expected.there->pose.x_m);
      EXPECT_EQ(look.there->covariance, expected.there->covariance);
    }
  }
}

TEST_F(LookAheadTest, DoesNothingWhereItIsOff) { EXPECT_TRUE(looks(false, 4).empty()); }

TEST_F(LookAheadTest, EndsThoughPairsWait) {
  LookAhead ahead(spool_, config_, true);
  for (int i = 0; i < 1000; ++i) ahead.add(keyframes_[0], keyframes_[1]);
  EXPECT_LE(ahead.finish().size(), 1u);
}

}  // namespace
}  // namespace voxlist::desk
