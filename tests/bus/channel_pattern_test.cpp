#include "voxlist/bus/channel_pattern.h"

#include <gtest/gtest.h>

#include <random>
#include <regex>

namespace voxlist::bus {
namespace {

TEST(ChannelPattern, WithoutAStarIsTheNameItself) {
  EXPECT_TRUE(matches("POSE", "POSE"));
  for (const char* other : {"POSE_COVARIANCE", "POS", "a/POSE", ""})
    EXPECT_FALSE(matches("POSE", other)) << other;
}

TEST(ChannelPattern, HasStarsForAnyLettersButASlash) {
  EXPECT_TRUE(matches("GRID_*", "GRID_low"));
  EXPECT_TRUE(matches("GRID_*", "GRID_"));
  EXPECT_TRUE(matches("*/POSE", "robot_1/POSE"));
  EXPECT_FALSE(matches("*", "robot_1/POSE"));
  EXPECT_FALSE(matches("*/POSE", "a/b/POSE"));
}

TEST(ChannelPattern, IsAWordOfPlainLettersAndStars) {
  EXPECT_TRUE(is_channel_pattern("*/GRID_*"));
  for (const char* text : {"", "a.*", "a|b", "a b", "[a]"}) EXPECT_FALSE(is_channel_pattern(text));
}

TEST(ChannelPattern, MatchesWhatItsRegularExpressionMatches) {
  std::mt19937 random(7);
  const auto word = [&](const std::string& letters) {
    std::string made;
    for (auto n = random() % 7; n > 0; --n) made += letters[random() % letters.size()];
    return made;
  };
  int matched = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::vector<std::string> patterns = {word("ab*/"), word("a*")};
    const std::string name = word("ab/");
    const bool expected = std::regex_match(name, std::regex(regular_expression(patterns)));
    ASSERT_EQ(matches_any(patterns, name), expected)
        << patterns[0] << ' ' << patterns[1] << ' ' << name;
    if (expected) ++matched;
  }
  EXPECT_GT(matched, 1000);
}

}  // namespace
}  // namespace voxlist::bus
