#include "voxlist/config/edit.h"

#include <gtest/gtest.h>

namespace voxlist::config {
namespace {

TEST(Edit, ReplacesANumberInItsPlaceAndKeepsTheRest) {
  const std::string text =
      "# my robot\n"
      "[bus]\n"
      "height_m = 3 # not this one\n"
      "\n"
      "[cloud_assembler] # the scanner\n"
      "  height_m =  0.1# measured\n"
      "# height_m = 0.2\n"
      "boxes = [\n"
      "  1, # [cloud_assembler]\n"
      "]\n"
      "\n"
      "[mapper]\n"
      "x = 1\n";
  const std::string expected =
      "# my robot\n"
      "[bus]\n"
      "height_m = 3 # not this one\n"
      "\n"
      "[cloud_assembler] # the scanner\n"
      "  height_m =  0.10512# measured\n"
      "# height_m = 0.2\n"
      "boxes = [\n"
      "  1, # [cloud_assembler]\n"
      "]\n"
      "yaw_deg = -0.3000\n"
      "\n"
      "[mapper]\n"
      "x = 1\n";
  EXPECT_EQ(
      with_numbers(text, "cloud_assembler", {{"height_m", "0.10512"}, {"yaw_deg", "-0.3000"}}),
      expected);
}

TEST(Edit, SetsNumbersOfOneOfSeveralTables) {
  const std::string text =
      "[a]\nx = 1\n[[a.b]]\nname = \"first\"\nz = 1\n\n[[a.b]] # second\nz = 2 # m\nend = "
      "0\n\n[c]\n";
  EXPECT_EQ(with_numbers_of_entry(text, "a", "b", 1, {{"z", "2.5"}, {"yaw", "3"}}),
            "[a]\nx = 1\n[[a.b]]\nname = \"first\"\nz = 1\n\n[[a.b]] # second\nz = 2.5 # m\nend = "
            "0\nyaw = 3\n\n[c]\n");
  EXPECT_THROW(with_numbers_of_entry(text, "a", "b", 2, {}), std::runtime_error);
  EXPECT_THROW(with_numbers_of_entry("a = {b = [{z = 1}]}", "a", "b", 0, {}), std::runtime_error);
}

TEST(Edit, AddsATableAtTheEnd) {
  EXPECT_EQ(with_numbers("", "a", {{"x", "1.5"}}), "[a]\nx = 1.5\n");
  EXPECT_EQ(with_numbers("[b]\ny = 1", "a", {{"x", "1.5"}}), "[b]\ny = 1\n\n[a]\nx = 1.5\n");
}

TEST(Edit, FillsAnEmptyTable) {
  EXPECT_EQ(with_numbers("[a]\n# none\n[b]\n", "a", {{"x", "2"}}), "[a]\nx = 2\n# none\n[b]\n");
  EXPECT_EQ(with_numbers("[a]", "a", {{"x", "2"}}), "[a]\nx = 2\n");
}

TEST(Edit, KeepsTheLineEndsOfWindows) {
  EXPECT_EQ(with_numbers("[a]\r\nx = 1\r\n", "a", {{"x", "2"}, {"y", "3"}}),
            "[a]\r\nx = 2\r\ny = 3\r\n");
}

TEST(Edit, RefusesWhatItCannotKeepAsItIs) {
  for (const char* text : {"a = {x = 1}\n", "a.x = 1\n", "a = 1\n", "[a\n"})
    EXPECT_THROW(with_numbers(text, "a", {{"x", "2"}}), std::runtime_error) << text;
}

}  // namespace
}  // namespace voxlist::config
