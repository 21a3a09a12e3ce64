#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "tests/config/sample_config.h"
#include "voxlist/config/config.h"

namespace voxlist::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

class ReadConfig : public ::testing::Test {
 protected:
  ReadConfig() {
    std::string pattern = (std::filesystem::temp_directory_path() / "config_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~ReadConfig() override { std::filesystem::remove_all(folder_); }

  std::vector<std::string> read(const std::string& text) {
    std::ofstream(file()) << text;
    return read_config(file(), {section("sample", sample_)}, {"other"});
  }

  std::filesystem::path file() const { return folder_ / "robot.toml"; }

  std::filesystem::path folder_;
  SampleConfig sample_;
};

TEST_F(ReadConfig, TakesWhatTheFileSaysAndKeepsTheOtherDefaults) {
  EXPECT_THAT(read("[sample]\nkeep = false\nscans = 7\nfolder = 'hall'\nheights_m = [1, 0.5]\n"
                   "names = []\n"),
              IsEmpty());
  EXPECT_FALSE(sample_.keep);
  EXPECT_EQ(sample_.scans, 7);
  EXPECT_EQ(sample_.folder, "hall");
  EXPECT_THAT(sample_.heights_m, ElementsAre(1.0, 0.5));
  EXPECT_THAT(sample_.names, IsEmpty());
  EXPECT_EQ(sample_.resolution_m, 0.05);
}

TEST_F(ReadConfig, TakesAWholeNumberForAFloat) {
  EXPECT_THAT(read("[sample]\nresolution_m = 1\n"), IsEmpty());
  EXPECT_EQ(sample_.resolution_m, 1.0);
}

TEST_F(ReadConfig, LeavesUnknownKeysOfASharedTableToItsOtherReader) {
  std::ofstream(file()) << "[sample]\nscans = 7\nperiod_s = 2\n";
  EXPECT_THAT(read_config(file(), {shared_section("sample", sample_)}), IsEmpty());
  EXPECT_EQ(sample_.scans, 7);
  std::ofstream(file()) << "[sample]\nscans = 70\n";
  EXPECT_THAT(read_config(file(), {shared_section("sample", sample_)}),
              ElementsAre(HasSubstr("must be 1 to 10")));
}

TEST_F(ReadConfig, NamesFileLineAndKnownKeysForAnUnknownKey) {
  EXPECT_THAT(read("[sample]\nscans = 2\nresolution = 0.1\n"),
              ElementsAre(file().string() +
                          ":3: no key sample.resolution; known are folder, heights_m, keep, "
                          "names, resolution_m, scans"));
}

TEST_F(ReadConfig, ComplainsAboutEveryRepeatedKey) {
  EXPECT_THAT(read("[sample]\nscans = 2\nscans = 3\nkeep = true\nkeep = true\n"),
              ElementsAre(HasSubstr(":3: "), HasSubstr(":5: ")));
}

TEST_F(ReadConfig, ComplainsAboutARepeatedTable) {
  EXPECT_THAT(read("[sample]\nscans = 2\n[sample]\nkeep = true\n"), ElementsAre(HasSubstr(":3: ")));
}

TEST_F(ReadConfig, ComplainsAboutEveryWrongType) {
  EXPECT_THAT(read("[sample]\nkeep = 1\nscans = 2.0\nresolution_m = '1'\nfolder = 1\n"
                   "heights_m = 1.0\nnames = ['a', 1]\n"),
              ElementsAre(HasSubstr(":2: sample.keep must be true or false"),
                          HasSubstr(":3: sample.scans must be a whole number"),
                          HasSubstr(":4: sample.resolution_m must be a number"),
                          HasSubstr(":5: sample.folder must be a text in quotes"),
                          HasSubstr(":6: sample.heights_m must be a list, each a number"),
                          HasSubstr(":7: sample.names must hold only a text in quotes")));
}

TEST_F(ReadConfig, ComplainsAboutWhatIsOutOfRange) {
  EXPECT_THAT(read("[sample]\nscans = 11\nresolution_m = 0.001\nheights_m = [1.0, 2.5]\n"),
              ElementsAre(HasSubstr(":2: sample.scans is 11, must be 1 to 10"),
                          HasSubstr(":3: sample.resolution_m is 0.001, must be 0.005 to 1"),
                          HasSubstr(":4: sample.heights_m is 2.5, must be 0 to 2")));
}

TEST_F(ReadConfig, TakesNeitherNanNorNumbersBeyond32Bits) {
  EXPECT_THAT(read("[sample]\nscans = 4294967298\nresolution_m = nan\n"),
              ElementsAre(HasSubstr(":2: sample.scans must be"),
                          HasSubstr(":3: sample.resolution_m is nan")));
}

TEST_F(ReadConfig, ComplainsAboutATableThatNoProgramKnowsAndNotAboutOtherPrograms) {
  EXPECT_THAT(read("[other]\nanything = 1\n[smaple]\nscans = 2\n"),
              ElementsAre(HasSubstr(":3: no table [smaple]; known are other, sample")));
}

TEST_F(ReadConfig, ComplainsAboutAValueWhereATableShouldBe) {
  EXPECT_THAT(read("sample = 3\n"), ElementsAre(HasSubstr(":1: sample must be a table")));
}

TEST_F(ReadConfig, TellsAllComplaintsAtOnce) {
  EXPECT_THAT(read("[sample]\nkeep = 1\nscans = 3\nscans = 4\nresolution_m = 9.0\ncolour = 'red'\n"
                   "[nobody]\n"),
              UnorderedElementsAre(HasSubstr(":2: "), HasSubstr(":4: "), HasSubstr(":5: "),
                                   HasSubstr(":6: "), HasSubstr(":7: ")));
}

TEST_F(ReadConfig, NamesTheLineThatIsNoToml) {
  EXPECT_THAT(read("[sample]\nscans = \n"), ElementsAre(HasSubstr("robot.toml:2: ")));
}

TEST_F(ReadConfig, SaysThatAFileCannotBeRead) {
  EXPECT_THAT(read_config(folder_ / "none.toml", {}), ElementsAre(HasSubstr("cannot be read")));
  EXPECT_THAT(read_config(folder_, {}), ElementsAre(HasSubstr("cannot be read")));
}

TEST_F(ReadConfig, RefusesAStructThatNamesAKeyTwice) {
  struct Twice {
    int count = 1;
    void visit(SettingsVisitor& v) {
      v("count", count, "", 0, 9);
      v("count", count, "", 0, 9);
    }
  } twice;
  std::ofstream(file()) << "";
  EXPECT_THROW(read_config(file(), {section("twice", twice)}), std::logic_error);
}

TEST_F(ReadConfig, ReadsBackExactlyWhatIsPrinted) {
  sample_ = {false, 9, 0.1 + 0.2, "a \"b\" \\ \t\x01\n\xC3\xA9", {1.0, 1.0 / 3, 1e-300}, {"", "x"}};
  const SampleConfig before = sample_;
  const std::string printed = to_toml({section("sample", sample_)});
  sample_ = SampleConfig();
  EXPECT_THAT(read(printed), IsEmpty());
  EXPECT_EQ(sample_.keep, before.keep);
  EXPECT_EQ(sample_.scans, before.scans);
  EXPECT_EQ(sample_.resolution_m, before.resolution_m);
  EXPECT_EQ(sample_.folder, before.folder);
  EXPECT_EQ(sample_.heights_m, before.heights_m);
  EXPECT_EQ(sample_.names, before.names);
  EXPECT_EQ(to_toml({section("sample", sample_)}), printed);
}

enum class Way { kLeft, kRight };

struct WayConfig {
  Way way = Way::kLeft;
  void visit(SettingsVisitor& v) { v("way", way, std::array{"left", "right"}, "where to"); }
};

TEST_F(ReadConfig, TakesAnEnumByItsName) {
  WayConfig config;
  std::ofstream(file()) << "[go]\nway = 'right'\n";
  EXPECT_THAT(read_config(file(), {section("go", config)}), IsEmpty());
  EXPECT_EQ(config.way, Way::kRight);
  EXPECT_THAT(to_toml({section("go", config)}), HasSubstr("way = \"right\"\n"));
}

TEST_F(ReadConfig, RefusesANameThatAnEnumDoesNotHave) {
  WayConfig config;
  std::ofstream(file()) << "[go]\nway = 'up'\n";
  EXPECT_THAT(read_config(file(), {section("go", config)}),
              ElementsAre(HasSubstr("go.way is \"up\", must be left or right")));
  EXPECT_EQ(config.way, Way::kLeft);
}

struct Sensor {
  std::string channel;
  double height_m = 0.5;
  void visit(SettingsVisitor& v) {
    v("channel", channel, "where it speaks");
    v("height_m", height_m, "above the floor", 0.0, 3.0);
  }
};

struct Sensors {
  bool keep = true;
  std::vector<Sensor> sensors;
  void visit(SettingsVisitor& v) {
    v("keep", keep, "keep it all");
    v("sensor", sensors, "one that looks");
  }
};

class ReadTables : public ReadConfig {
 protected:
  std::vector<std::string> read(const std::string& text) {
    std::ofstream(file()) << text;
    return read_config(file(), {section("robot", robot_)});
  }
  Sensors robot_;
};

TEST_F(ReadTables, MakesAnElementOfEachTableOfAList) {
  EXPECT_THAT(read("[robot]\nkeep = false\n[[robot.sensor]]\nchannel = 'LEFT'\n"
                   "[[robot.sensor]]\nchannel = 'RIGHT'\nheight_m = 1.5\n"),
              IsEmpty());
  EXPECT_FALSE(robot_.keep);
  ASSERT_EQ(robot_.sensors.size(), 2u);
  EXPECT_EQ(robot_.sensors[0].channel, "LEFT");
  EXPECT_EQ(robot_.sensors[0].height_m, 0.5);
  EXPECT_EQ(robot_.sensors[1].channel, "RIGHT");
  EXPECT_EQ(robot_.sensors[1].height_m, 1.5);
}

TEST_F(ReadTables, ComplainsAboutWhatIsWrongInOneOfAList) {
  EXPECT_THAT(read("[[robot.sensor]]\n[[robot.sensor]]\nheight_m = 5\ncolour = 'red'\n"),
              ElementsAre(HasSubstr("robot.toml:3: robot.sensor.height_m is 5, must be 0 to 3"),
                          HasSubstr("robot.toml:4: no key robot.sensor.colour; known are channel, "
                                    "height_m")));
}

TEST_F(ReadTables, RefusesAnythingButTables) {
  for (const char* wrong : {"[robot.sensor]\n", "[robot]\nsensor = 1\n", "[robot]\nsensor = [1]\n"})
    EXPECT_THAT(read(wrong),
                ElementsAre(HasSubstr("robot.sensor must be tables: [[robot.sensor]]")));
  EXPECT_THAT(read("[robot]\nsensor = []\n"), IsEmpty());
}

TEST_F(ReadTables, ReadsBackWhatIsPrinted) {
  robot_.sensors = {{"LEFT", 0.1}, {"RIGHT", 0.2}};
  const std::string printed = to_toml({section("robot", robot_)});
  robot_ = {};
  EXPECT_THAT(read(printed), IsEmpty());
  EXPECT_EQ(to_toml({section("robot", robot_)}), printed);
  robot_ = {};
  EXPECT_THAT(read(to_toml({section("robot", robot_)})), IsEmpty());
  EXPECT_TRUE(robot_.sensors.empty());
}

class ReadRoot : public ReadConfig {
 protected:
  std::vector<std::string> read(const std::string& text) {
    std::ofstream(file()) << text;
    return read_config(file(), {section("sample", sample_), root_section(robot_)}, {"other"});
  }
  struct Lists {
    std::vector<Sensor> sensors;
    template <class Visitor>
    void visit(Visitor& v) {
      v("sensor", sensors, "one for each");
    }
  } robot_;
};

TEST_F(ReadRoot, MakesAnElementOfEachTableOfAList) {
  EXPECT_THAT(read("[[sensor]]\nchannel = 'LEFT'\n[sample]\nscans = 7\n[[sensor]]\n"), IsEmpty());
  ASSERT_EQ(robot_.sensors.size(), 2u);
  EXPECT_EQ(robot_.sensors[0].channel, "LEFT");
  EXPECT_EQ(sample_.scans, 7);
}

TEST_F(ReadRoot, ComplainsAboutWhatIsWrong) {
  EXPECT_THAT(read("[[sensor]]\nheight_m = 5\n[[sample]]\n[[other]]\n"),
              UnorderedElementsAre(HasSubstr(":2: sensor.height_m is 5, must be 0 to 3"),
                                   HasSubstr(":3: sample must be a table: [sample]")));
  EXPECT_THAT(read("sensor = 3\n"), ElementsAre(HasSubstr("sensor must be tables: [[sensor]]")));
  EXPECT_THAT(read("[lost]\n"), ElementsAre(HasSubstr("known are other, sample, sensor")));
}

TEST_F(ReadRoot, ReadsBackWhatIsPrinted) {
  robot_.sensors = {{"LEFT", 0.1}, {"RIGHT", 0.2}};
  const std::string printed = to_toml({section("sample", sample_), root_section(robot_)});
  robot_ = {};
  EXPECT_THAT(read(printed), IsEmpty());
  EXPECT_EQ(robot_.sensors.size(), 2u);
  EXPECT_EQ(to_toml({section("sample", sample_), root_section(robot_)}), printed);
}

}  // namespace
}  // namespace voxlist::config
