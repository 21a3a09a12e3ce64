#include "voxlist/config/tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "voxlist/config/config.h"

namespace voxlist::config {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;

const std::filesystem::path kServices = VOXLIST_SOURCE_DIR "/services";

bool reads_settings(const std::filesystem::path& service) {
  std::ifstream stream(service / "main.cpp");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return text.find("run_service<") != std::string::npos;
}

TEST(Tables, NameEveryService) {
  for (const auto& entry : std::filesystem::directory_iterator(kServices)) {
    if (!reads_settings(entry.path())) continue;
    EXPECT_THAT(kTables, Contains(entry.path().filename().string()));
  }
}

TEST(Tables, AreAllThatTheShippedSettingsFileHas) {
  EXPECT_THAT(read_config(kServices / "robot.toml", {}, kTables), IsEmpty());
}

}  // namespace
}  // namespace voxlist::config
