#include "voxlist/viewing/commands.h"

#include <gtest/gtest.h>

namespace voxlist::viewing {
namespace {

TEST(ParseCommand, ReadsAHint) {
  const auto command = parse_command(
      "hint", R"({"x_m": 1, "y_m": -2.5, "yaw_rad": 0.5, "sigma_m": 2, "sigma_rad": 0.3})");
  ASSERT_TRUE(command && std::holds_alternative<HintCommand>(*command));
  EXPECT_EQ(std::get<HintCommand>(*command).pose, (Pose2{1.0, -2.5, 0.5}));
  EXPECT_EQ(std::get<HintCommand>(*command).sigma_m, 2.0);
}

TEST(ParseCommand, ReadsAnEdit) {
  const auto command =
      parse_command("edit", R"({"kind": "free", "lowest": [0, 0, 0], "highest": [1, 2, 3]})");
  ASSERT_TRUE(command && std::holds_alternative<EditCommand>(*command));
  EXPECT_EQ(std::get<EditCommand>(*command).kind, EditKind::kKeepFree);
  EXPECT_EQ(std::get<EditCommand>(*command).box.max(), Eigen::Vector3d(1, 2, 3));
}

TEST(ParseCommand, ReadsSwitches) {
  const auto command = parse_command("localise_only", R"({"on": false})");
  ASSERT_TRUE(command && std::holds_alternative<LocaliseOnlyCommand>(*command));
  EXPECT_FALSE(std::get<LocaliseOnlyCommand>(*command).on);
  EXPECT_TRUE(parse_command("save", "{}"));
}

TEST(ParseCommand, TakesNothingThatDoesNotSayWhatItNeeds) {
  const std::pair<const char*, const char*> wrong[] = {
      {"nothing", "{}"},
      {"save", ""},
      {"save", "{"},
      {"hint", "{}"},
      {"hint", R"({"x_m": 1, "y_m": 2, "yaw_rad": 0, "sigma_m": 0, "sigma_rad": 1})"},
      {"hint", R"({"x_m": 1e9, "y_m": 2, "yaw_rad": 0, "sigma_m": 1, "sigma_rad": 1})"},
      {"hint", R"({"x_m": "1", "y_m": 2, "yaw_rad": 0, "sigma_m": 1, "sigma_rad": 1})"},
      {"edit", R"({"kind": "burn", "lowest": [0, 0, 0], "highest": [1, 1, 1]})"},
      {"edit", R"({"kind": "free", "lowest": [0, 0], "highest": [1, 1, 1]})"},
      {"edit", R"({"kind": "free", "lowest": [2, 0, 0], "highest": [1, 1, 1]})"},
      {"localise_only", R"({"on": "yes"})"},
      {"record", "[]"},
      {"play", R"({"speed": -1})"},
      {"seek", R"({"utime_us": "now"})"},
  };
  for (const auto& [name, json] : wrong) EXPECT_FALSE(parse_command(name, json)) << name << json;
}

}  // namespace
}  // namespace voxlist::viewing
