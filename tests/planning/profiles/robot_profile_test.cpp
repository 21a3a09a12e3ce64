#include "voxlist/planning/profiles/robot_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "voxlist/config/config.h"
#include "voxlist/config/tables.h"

namespace voxlist::planning {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class RobotProfilesInAFile : public ::testing::Test {
 protected:
  std::vector<std::string> read(const std::string& text) {
    const auto file = folder_.write("robot.toml", text);
    return config::read_config(file, {config::root_section(robots_)}, config::kTables);
  }

  const test::TemporaryFolder folder_;
  RobotProfiles robots_;
};

RobotProfiles called(const std::vector<std::string>& names) {
  RobotProfiles robots;
  for (const std::string& name : names) {
    RobotProfile robot;
    robot.name = name;
    robots.listed.push_back(robot);
  }
  return robots;
}

TEST_F(RobotProfilesInAFile, AreAsManyAsAreListed) {
  EXPECT_THAT(read("[[robot]]\nname = 'low'\nheight_m = 0.4\n[mapper]\n[[robot]]\nname = 'tall'\n"),
              IsEmpty());
  ASSERT_THAT(robots_.listed, SizeIs(2));
  EXPECT_EQ(robots_.listed[0].name, "low");
  EXPECT_EQ(robots_.listed[0].height_m, 0.4);
  EXPECT_EQ(robots_.listed[1].name, "tall");
  EXPECT_EQ(robots_.listed[1].height_m, RobotProfile{}.height_m);
}

TEST_F(RobotProfilesInAFile, AreHeldAgainstTheirRanges) {
  EXPECT_THAT(read("[[robot]]\nheight_m = 0\nlength_m = 2\n"),
              ElementsAre(HasSubstr("robot.height_m is 0, must be 0.05 to 10"),
                          HasSubstr("no key robot.length_m")));
}

TEST_F(RobotProfilesInAFile, MustBeAList) {
  EXPECT_THAT(read("[robot]\n"), ElementsAre(HasSubstr("robot must be tables: [[robot]]")));
}

TEST(RobotProfiles, AreOneOfTheDefaultsWhereNoneIsListed) {
  const auto in_use = RobotProfiles{}.in_use();
  ASSERT_THAT(in_use, SizeIs(1));
  EXPECT_EQ(in_use[0].name, "robot");
  EXPECT_EQ(called({"low", "tall"}).in_use().size(), 2U);
}

TEST(RobotProfiles, HaveNamesThatTellThemApart) {
  EXPECT_EQ(why_invalid(called({"low_1", "Tall"})), "");
  EXPECT_THAT(why_invalid(called({"low", "tall", "low"})), HasSubstr("two robots"));
}

TEST(RobotProfiles, HaveNamesThatEndAChannelAndAFile) {
  for (const char* name : {"", "a b", "../x", "a.b", "a/b", "über"})
    EXPECT_NE(why_invalid(called({name})), "") << name;
  EXPECT_NE(why_invalid(called({std::string(33, 'a')})), "");
}

TEST(RobotProfiles, DoNotStepOverWhatIsAsHighAsThemselves) {
  RobotProfiles robots = called({"low"});
  robots.listed[0].height_m = 0.1;
  robots.listed[0].step_m = 0.2;
  EXPECT_THAT(why_invalid(robots), HasSubstr("step_m"));
}

}  // namespace
}  // namespace voxlist::planning
