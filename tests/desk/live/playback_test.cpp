#include "services/voxlist/live/playback.h"

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace voxlist::desk {
namespace {

using test::TemporaryFolder;
using Times = std::vector<std::pair<std::string, std::int64_t>>;

std::filesystem::path write_log(const std::filesystem::path& file, const Times& events) {
  bus::EventLogWriter writer(file);
  const std::vector<std::uint8_t> bytes = {1, 2, 3};
  for (const auto& [channel, utime_us] : events) writer.write(channel, utime_us, bytes);
  writer.close();
  return file;
}

Times played(Playback playback) {
  Times all;
  while (const auto due = playback.next()) {
    all.emplace_back(due->event.channel, due->after_us);
    EXPECT_EQ(due->event.bytes.size(), 3U);
  }
  return all;
}

TEST(Playback, GivesAllPartsAtTheTimesOfTheRecording) {
  const TemporaryFolder folder;
  const auto first = write_log(folder.path() / "a.00", {{"CLOUD", 1'000'000}, {"POSE", 1'200'000}});
  const auto second = write_log(folder.path() / "a.01", {{"CLOUD", 1'300'000}});
  EXPECT_EQ(played(Playback({first, second}, ".*", 2.0)),
            (Times{{"CLOUD", 0}, {"POSE", 100'000}, {"CLOUD", 150'000}}));
}

TEST(Playback, LeavesOutOtherChannelsAndTheirTime) {
  const TemporaryFolder folder;
  const auto log = write_log(folder.path() / "log", {{"LASER", 0}, {"CLOUD", 50}, {"CLOUD", 90}});
  EXPECT_EQ(played(Playback({log}, "^CLOUD$", 1.0)), (Times{{"CLOUD", 0}, {"CLOUD", 40}}));
}

TEST(Playback, NeverGoesBackInTime) {
  const TemporaryFolder folder;
  const auto log = write_log(folder.path() / "log", {{"A", 100}, {"A", 300}, {"A", 200}});
  EXPECT_EQ(played(Playback({log}, ".*", 1.0)), (Times{{"A", 0}, {"A", 200}, {"A", 200}}));
}

TEST(Playback, RefusesWhatIsNoRegularExpression) {
  EXPECT_THROW(Playback({}, "(", 1.0), std::runtime_error);
}

}  // namespace
}  // namespace voxlist::desk
