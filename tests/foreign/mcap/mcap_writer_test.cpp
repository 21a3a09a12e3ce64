#include "voxlist/foreign/mcap/mcap_writer.h"

#include <gmock/gmock.h>

#include <random>

#include "tests/file_size_limit.h"
#include "tests/foreign/mcap/mcap_checker.h"
#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::foreign {
namespace {

using testing::IsEmpty;
using testing::Not;

class Mcap : public testing::Test {
 protected:
  test::McapFile checked() const { return test::check_mcap(io::read_file(file_)); }

  // Messages of random lengths on three channels, the last without a schema. Returns their data.
  std::vector<std::string> write_some(std::size_t chunk_bytes, int messages) const {
    McapWriter writer(file_, chunk_bytes);
    const std::uint16_t a = writer.add(McapSchema{"type.A", "protobuf", "what A is"});
    const std::uint16_t b = writer.add(McapSchema{"type.B", "x-lcm", "what B is"});
    const std::uint16_t channels[] = {writer.add(McapChannel{a, "/a", "protobuf"}),
                                      writer.add(McapChannel{b, "/b", "x-lcm"}),
                                      writer.add(McapChannel{0, "/c", "x-other"})};
    std::mt19937 random(5);
    std::vector<std::string> written;
    for (int i = 0; i < messages; ++i) {
      std::string data(random() % 2000, '\0');
      for (char& byte : data) byte = static_cast<char>(random() % 7);
      // Times go back and forth, as a recording's may.
      const std::int64_t log_us = 1'000'000 + i * 1000 - (i % 3) * 5000;
      writer.write(channels[random() % 3], log_us, log_us - 500, data);
      written.push_back(data);
    }
    writer.close();
    return written;
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "run.mcap";
};

TEST_F(Mcap, HoldsWhatWasWrittenInChunksThatAreIndexed) {
  const std::vector<std::string> written = write_some(50'000, 500);
  const test::McapFile read = checked();
  EXPECT_THAT(read.wrong, IsEmpty());
  EXPECT_GT(read.chunks, 5U);
  ASSERT_EQ(read.messages.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    const test::McapMessage& message = read.messages[i];
    EXPECT_EQ(message.data, written[i]);
    const auto number = static_cast<std::int64_t>(i);
    EXPECT_EQ(message.log_ns,
              static_cast<std::uint64_t>(1'000'000 + number * 1000 - (number % 3) * 5000) * 1000);
    EXPECT_EQ(message.publish_ns, message.log_ns - 500'000);
    const bool has_schema = message.topic != "/c";
    EXPECT_EQ(message.schema, has_schema ? message.topic == "/a" ? "type.A" : "type.B" : "");
  }
}

TEST_F(Mcap, IsSmallerThanItsMessages) {
  std::size_t bytes = 0;
  for (const std::string& data : write_some(McapWriter::kChunkBytes, 500)) bytes += data.size();
  EXPECT_LT(std::filesystem::file_size(file_), bytes / 2);
}

TEST_F(Mcap, WithoutAMessageIsStillWhole) {
  McapWriter(file_).close();
  EXPECT_THAT(checked().wrong, IsEmpty());
}

TEST_F(Mcap, HasChecksumsThatTellDamageAnywhere) {
  write_some(20'000, 100);
  const std::string whole = io::read_file(file_);
  ASSERT_THAT(test::check_mcap(whole).wrong, IsEmpty());
  std::mt19937 random(8);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = whole;
    const std::size_t at = random() % damaged.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << random() % 8));
    EXPECT_THAT(test::check_mcap(damaged).wrong, Not(IsEmpty())) << "byte " << at;
  }
}

TEST_F(Mcap, IsNotThereUntilItIsWhole) {
  folder_.write("run.mcap", "an older file");
  {
    McapWriter writer(file_, 100);
    const std::uint16_t channel = writer.add(McapChannel{0, "/a", "x-other"});
    writer.write(channel, 1, 1, std::string(1000, 'x'));
    EXPECT_EQ(io::read_file(file_), "an older file");
  }
  EXPECT_EQ(io::read_file(file_), "an older file");
}

TEST_F(Mcap, LeavesTheOlderFileWhereTheDiskIsFull) {
  folder_.write("run.mcap", "an older file");
  const auto write_too_much = [&] {
    const test::FileSizeLimit limit(10'000);
    write_some(10'000, 500);
  };
  EXPECT_THROW(write_too_much(), io::FileError);
  EXPECT_EQ(io::read_file(file_), "an older file");
}

}  // namespace
}  // namespace voxlist::foreign
