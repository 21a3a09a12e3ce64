#include "voxlist/fleet/relay_config.h"

#include <gtest/gtest.h>

namespace voxlist::fleet {
namespace {

RelayConfig named(const std::string& robot) {
  RelayConfig config;
  config.robot = robot;
  return config;
}

TEST(RelayConfig, IsGoodWithANameAlone) { EXPECT_EQ(why_invalid(named("robot_1")), ""); }

TEST(RelayConfig, NeedsANameThatIsNoPathAndNoPattern) {
  for (const char* name : {"", "a/b", "a*", "a b", "0123456789012345678901234567890123456789"})
    EXPECT_NE(why_invalid(named(name)), "") << name;
}

TEST(RelayConfig, NeedsANetwork) {
  for (const char* url : {"", "udpm://10.0.0.1:7667", "file:///tmp/log"}) {
    RelayConfig config = named("a");
    config.url = url;
    EXPECT_NE(why_invalid(config), "") << url;
  }
}

// A name with a slash could send out what came in.
TEST(RelayConfig, RefusesChannelsWithASlash) {
  RelayConfig config = named("a");
  for (const char* name : {"b/POSE", "*/POSE", "", "PO SE"}) {
    config.channels = {RelayChannel{.name = name}};
    EXPECT_NE(why_invalid(config), "") << name;
  }
}

TEST(RelayConfig, SendsNoCloudByDefault) {
  const std::vector<RelayChannel> rows = named("a").channels_in_use();
  ASSERT_FALSE(rows.empty());
  for (const RelayChannel& row : rows) EXPECT_FALSE(row.clouds) << row.name;
}

}  // namespace
}  // namespace voxlist::fleet
