#include "voxlist/bus/event_log.h"

#include <gtest/gtest.h>
#include <lcm/eventlog.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/bus.h"

namespace voxlist::bus {
namespace {

namespace fs = std::filesystem;
using Buffer = std::vector<std::uint8_t>;

// Bytes of an event beside its channel's name and data.
constexpr std::size_t kHeaderBytes = 28;

std::string channel_name(int i) {
  std::string name = "C";
  name += std::to_string(i);
  return name;
}

class EventLog : public testing::Test {
 protected:
  EventLog() : folder_(fs::temp_directory_path() / "voxlist_event_log_XXXXXX") {
    std::string pattern = folder_.string();
    folder_ = mkdtemp(pattern.data());
  }
  ~EventLog() override { fs::remove_all(folder_); }

  std::string path() const { return folder_ / "a.lcmlog"; }

  // Events 0, 1, ... of 20 bytes each on channels "C0", "C1", ...
  Buffer write_events(int n) {
    EventLogWriter log(path());
    for (int i = 0; i < n; ++i) {
      log.write(channel_name(i), 1000 + i, Buffer(20, static_cast<std::uint8_t>(i)));
    }
    log.close();
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  void overwrite(const Buffer& bytes) {
    std::ofstream file(path(), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  }

  static std::vector<std::string> channels(EventLogReader& log) {
    std::vector<std::string> all;
    while (const auto event = log.next()) all.push_back(event->channel);
    return all;
  }

  fs::path folder_;
};

constexpr std::size_t kEventBytes = kHeaderBytes + 2 + 20;

TEST_F(EventLog, ReadsWhatWasWritten) {
  write_events(3);
  EventLogReader log(path());
  for (int i = 0; i < 3; ++i) {
    const auto event = log.next();
    ASSERT_TRUE(event);
    EXPECT_EQ(event->number, i);
    EXPECT_EQ(event->utime_us, 1000 + i);
    EXPECT_EQ(event->channel, channel_name(i));
    EXPECT_EQ(event->bytes, Buffer(20, static_cast<std::uint8_t>(i)));
  }
  EXPECT_FALSE(log.next());
  EXPECT_EQ(log.damaged_events(), 0);
  EXPECT_EQ(log.position_bytes(), log.size_bytes());
}

TEST_F(EventLog, IsReadByLcmItself) {
  write_events(2);
  lcm_eventlog_t* log = lcm_eventlog_create(path().c_str(), "r");
  ASSERT_NE(log, nullptr);
  for (int i = 0; i < 2; ++i) {
    lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log);
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->timestamp, 1000 + i);
    EXPECT_EQ(event->datalen, 20);
    EXPECT_EQ(std::string(event->channel), channel_name(i));
    lcm_eventlog_free_event(event);
  }
  lcm_eventlog_destroy(log);
}

TEST_F(EventLog, ReadsWhatLcmItselfWrote) {
  lcm_eventlog_t* out = lcm_eventlog_create(path().c_str(), "w");
  std::string channel = "POSE";
  std::string data = "twelve bytes";
  lcm_eventlog_event_t event{0, 1234, 4, 12, channel.data(), data.data()};
  ASSERT_EQ(lcm_eventlog_write_event(out, &event), 0);
  lcm_eventlog_destroy(out);
  EventLogReader log(path());
  const auto read = log.next();
  ASSERT_TRUE(read);
  EXPECT_EQ(read->utime_us, 1234);
  EXPECT_EQ(read->channel, "POSE");
  EXPECT_EQ(std::string(read->bytes.begin(), read->bytes.end()), data);
}

TEST_F(EventLog, ReadsAllWholeEventsOfALogTornAnywhere) {
  const Buffer whole = write_events(3);
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    overwrite(Buffer(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    EventLogReader log(path());
    EXPECT_EQ(channels(log).size(), size / kEventBytes) << size;
    EXPECT_EQ(log.damaged_events(), size % kEventBytes == 0 ? 0 : 1) << size;
    EXPECT_EQ(log.skipped_bytes(), static_cast<std::int64_t>(size % kEventBytes)) << size;
  }
}

TEST_F(EventLog, LosesOnlyTheDamagedEvent) {
  const Buffer whole = write_events(5);
  // Everything of event 2's header but its event number and timestamp, which may be anything.
  for (std::size_t at = 0; at < kHeaderBytes; ++at) {
    if (at >= 4 && at < 20) continue;
    Buffer bytes = whole;
    bytes[2 * kEventBytes + at] ^= 0x41;
    overwrite(bytes);
    EventLogReader log(path());
    EXPECT_EQ(channels(log), (std::vector<std::string>{"C0", "C1", "C3", "C4"})) << at;
    EXPECT_EQ(log.damaged_events(), 1) << at;
    EXPECT_EQ(log.skipped_bytes(), static_cast<std::int64_t>(kEventBytes)) << at;
  }
}

TEST_F(EventLog, GoesOnAfterGarbageBetweenEvents) {
  Buffer bytes = write_events(4);
  const Buffer garbage(100'000, 0);
  bytes.insert(bytes.begin() + 2 * kEventBytes, garbage.begin(), garbage.end());
  overwrite(bytes);
  EventLogReader log(path());
  EXPECT_EQ(channels(log).size(), 4U);
  EXPECT_EQ(log.skipped_bytes(), 100'000);
}

TEST_F(EventLog, SurvivesRandomDamageAndAccountsForEveryByte) {
  const Buffer whole = write_events(50);
  constexpr std::uint32_t kSeed = 11;
  std::mt19937 random(kSeed);
  for (int round = 0; round < 500; ++round) {
    Buffer bytes = whole;
    for (std::size_t n = 1 + random() % 10; n > 0; --n) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    bytes.resize(bytes.size() - random() % 100);
    overwrite(bytes);
    EventLogReader log(path());
    std::int64_t read = 0;
    while (const auto event = log.next()) {
      read += static_cast<std::int64_t>(kHeaderBytes + event->channel.size() + event->bytes.size());
    }
    EXPECT_EQ(read + log.skipped_bytes(), std::ssize(bytes))
        << "seed " << kSeed << " round " << round;
    EXPECT_GT(read, std::ssize(bytes) / 2);
  }
}

TEST_F(EventLog, IsDoneAtOnceWithAFileOfNothingButSyncWords) {
  Buffer bytes;
  for (int i = 0; i < 200'000; ++i) bytes.insert(bytes.end(), {0xED, 0xA1, 0xDA, 0x01});
  overwrite(bytes);
  EventLogReader log(path());
  EXPECT_TRUE(channels(log).empty());
  EXPECT_EQ(log.damaged_events(), 200'000);
}

TEST_F(EventLog, WithoutEventsIsALogToo) {
  overwrite({});
  EventLogReader log(path());
  EXPECT_FALSE(log.next());
  EXPECT_EQ(log.damaged_events(), 0);
}

TEST_F(EventLog, ThatIsMissingIsNamedInTheError) {
  try {
    EventLogReader log(path());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(path() + ": No such file"), std::string::npos);
  }
  EXPECT_THROW(EventLogReader(folder_.string()), std::runtime_error);
}

TEST_F(EventLog, ReportsAFullDisk) {
  EventLogWriter log("/dev/full");
  try {
    log.write("C", 1, Buffer(100));
    log.close();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full: No space left"), std::string::npos);
  }
}

TEST_F(EventLog, ReportsAPathThatCannotBeWritten) {
  EXPECT_THROW(EventLogWriter((folder_ / "no" / "such").string()), std::runtime_error);
}

TEST_F(EventLog, IsNotAPipe) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(EventLogReader{pipe}, std::runtime_error);
}

TEST_F(EventLog, InPartsIsReadAsOneByItsName) {
  const Buffer all = write_events(6);
  const auto part = [&](int number, std::size_t from, std::size_t to) {
    std::ofstream file(folder_ / ("run.lcm.0" + std::to_string(number)), std::ios::binary);
    file.write(reinterpret_cast<const char*>(all.data()) + from,
               static_cast<std::streamsize>(to - from));
  };
  const std::size_t event = all.size() / 6;
  part(0, 0, 2 * event);
  part(1, 2 * event, 3 * event);
  part(2, 3 * event, 3 * event);
  part(3, 3 * event, 6 * event);
  EventLogReader log(folder_ / "run.lcm");
  EXPECT_EQ(channels(log), (std::vector<std::string>{"C0", "C1", "C2", "C3", "C4", "C5"}));
  EXPECT_EQ(log.damaged_events(), 0);
  EXPECT_EQ(log.position_bytes(), std::ssize(all));
  EventLogReader one(folder_ / "run.lcm.01");
  EXPECT_EQ(channels(one), (std::vector<std::string>{"C2"}));
  part(0, 0, 2 * event - 3);  // torn: the first one's end is not the next one's start
  fs::remove(folder_ / "run.lcm.01");
  EventLogReader torn(folder_ / "run.lcm");
  EXPECT_EQ(channels(torn), (std::vector<std::string>{"C0", "C3", "C4", "C5"}));
  EXPECT_EQ(torn.damaged_events(), 1);
  EXPECT_EQ(torn.missing_parts(), (std::vector<std::string>{folder_ / "run.lcm.01"}));
}

TEST_F(EventLog, PutsAPrefixBeforeEachChannel) {
  EventLogWriter writer(path(), "robot/");
  writer.write(kOdometry, 1, pose_t{});
  writer.write("X", 2, Buffer(3, 0));
  writer.close();
  EventLogReader log(path());
  EXPECT_EQ(channels(log), (std::vector<std::string>{"robot/ODOMETRY", "robot/X"}));
}

TEST_F(EventLog, PlaysThroughABusOneEventACallAndThenEnds) {
  {
    EventLogWriter out(path());
    for (std::int64_t i = 0; i < 3; ++i) {
      pose_t pose{};
      pose.utime = i;
      out.write(kPose, 500 + i, pose);
      out.write("OTHER", 600, Buffer(3));
    }
    out.write("POSE", 700, Buffer(7));
    out.close();
  }
  Bus bus({.url = "file://" + path(), .prefix = ""});
  std::vector<std::int64_t> seen;
  const auto note = [&](const pose_t& pose) {
    seen.push_back(pose.utime);
    EXPECT_EQ(bus.arrival_utime_us(), 500 + pose.utime);
  };
  bus.subscribe(kPose, note, Delivery::kLatest);
  int calls = 1;
  while (bus.handle(std::chrono::milliseconds(0))) ++calls;
  EXPECT_EQ(seen, (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(calls, 5);
  EXPECT_EQ(bus.counters(),
            (Counters{{"POSE/handled", 3}, {"POSE/received", 4}, {"POSE/truncated", 1}}));
  bus.publish(kPose, pose_t{});
  EXPECT_EQ(bus.counters().at("POSE/unsent_refused"), 1);
}

}  // namespace
}  // namespace voxlist::bus
