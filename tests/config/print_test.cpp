#include <gtest/gtest.h>

#include "tests/config/sample_config.h"
#include "voxlist/config/config.h"

namespace voxlist::config {
namespace {

TEST(PrintConfig, WritesEachKeyUnderItsMeaningAndRange) {
  SampleConfig sample;
  EXPECT_EQ(to_toml({section("sample", sample)}),
            "[sample]\n"
            "# keep it all\n"
            "keep = true\n"
            "# how many (1 to 10)\n"
            "scans = 3\n"
            "# voxel edge (0.005 to 1.0)\n"
            "resolution_m = 0.05\n"
            "# where to\n"
            "folder = \"map\"\n"
            "# heights looked at (each 0.0 to 2.0)\n"
            "heights_m = [0.1, 1.8]\n"
            "# what they are called\n"
            "names = [\"low\", \"high\"]\n");
}

TEST(PrintConfig, WritesTheSectionsOneAfterTheOther) {
  struct One {
    int count = 1;
    void visit(SettingsVisitor& v) { v("count", count, "number", 0, 9); }
  } first, second;
  EXPECT_EQ(to_toml({section("first", first), section("second", second)}),
            "[first]\n# number (0 to 9)\ncount = 1\n\n[second]\n# number (0 to 9)\ncount = 1\n");
}

struct Sensor {
  int rate = 5;
  void visit(SettingsVisitor& v) { v("rate", rate, "a second", 0, 9); }
};
struct Sensors {
  bool keep = true;
  std::vector<Sensor> sensors;
  void visit(SettingsVisitor& v) {
    v("keep", keep, "keep it all");
    v("sensor", sensors, "one that looks");
  }
};

TEST(PrintConfig, WritesATableForEachOfAList) {
  Sensors two;
  two.sensors = {{3}, {4}};
  EXPECT_EQ(to_toml({section("robot", two)}),
            "[robot]\n# keep it all\nkeep = true\n"
            "\n# one that looks\n[[robot.sensor]]\n# a second (0 to 9)\nrate = 3\n"
            "\n# one that looks\n[[robot.sensor]]\n# a second (0 to 9)\nrate = 4\n");
}

TEST(PrintConfig, ShowsWhatATableOfAnEmptyListWouldHave) {
  Sensors none;
  EXPECT_EQ(to_toml({section("robot", none)}),
            "[robot]\n# keep it all\nkeep = true\n"
            "\n# one that looks\n# [[robot.sensor]]\n# # a second (0 to 9)\n# rate = 5\n");
}

TEST(MarkdownTable, HasTheKeysOfATableOfAList) {
  Sensors none;
  EXPECT_EQ(markdown_table(section("", none)),
            "| key | default | range | meaning |\n"
            "|---|---|---|---|\n"
            "| `keep` | `true` |  | keep it all |\n"
            "| `[[sensor]]` | none |  | one that looks |\n"
            "| `sensor.rate` | `5` | 0 to 9 | a second |\n");
}

TEST(MarkdownTable, HasARowForEachKey) {
  SampleConfig sample;
  EXPECT_EQ(markdown_table(section("sample", sample)),
            "| key | default | range | meaning |\n"
            "|---|---|---|---|\n"
            "| `keep` | `true` |  | keep it all |\n"
            "| `scans` | `3` | 1 to 10 | how many |\n"
            "| `resolution_m` | `0.05` | 0.005 to 1.0 | voxel edge |\n"
            "| `folder` | `\"map\"` |  | where to |\n"
            "| `heights_m` | `[0.1, 1.8]` | each 0.0 to 2.0 | heights looked at |\n"
            "| `names` | `[\"low\", \"high\"]` |  | what they are called |\n");
}

}  // namespace
}  // namespace voxlist::config
