#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <random>

#include "tests/mapping/keyframe_samples.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_format.h"
#include "voxlist/mapping/keyframe_reader.h"

namespace voxlist::mapping {
namespace {

using test::StoredMap;
using test::TemporaryFolder;

constexpr int kCount = 20;

// A file of 20 keyframes in memory, and where each ends.
struct Sample {
  Sample() {
    ends.push_back(bytes.size());
    for (int i = 0; i < kCount; ++i) {
      bytes += encode_record(keyframe(i), 42, static_cast<std::uint32_t>(i));
      ends.push_back(bytes.size());
    }
  }

  StoredMap read(const std::string& changed) const {
    folder.write(kKeyframeFile, changed);
    return test::load_map(folder.path());
  }

  // The keyframe whose record holds this byte; -1 in the file's header.
  int owner(std::size_t byte) const {
    return static_cast<int>(std::upper_bound(ends.begin(), ends.end(), byte) - ends.begin()) - 1;
  }

  TemporaryFolder folder;
  std::string bytes = file_header(42);
  std::vector<std::size_t> ends;
};

TEST(KeyframeFile, GivesBackWhatWasAppended) {
  const Sample sample;
  const StoredMap stored = sample.read(sample.bytes);
  EXPECT_EQ(stored.map_id, 42);
  EXPECT_EQ(stored.warning, "");
  EXPECT_EQ(numbers_of(stored.keyframes), first_numbers(kCount));
}

TEST(KeyframeFile, AFlippedBitCostsAtMostTheRecordThatItIsIn) {
  const Sample sample;
  for (std::size_t bit = 0; bit < 8 * sample.bytes.size(); ++bit) {
    std::string changed = sample.bytes;
    changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << (bit % 8)));
    const StoredMap stored = sample.read(changed);
    ASSERT_EQ(stored.map_id, 42) << bit;
    ASSERT_NE(stored.warning, "") << bit;
    ASSERT_EQ(numbers_of(stored.keyframes), first_numbers(kCount, sample.owner(bit / 8))) << bit;
  }
}

TEST(KeyframeFile, ACutCostsOnlyTheLastRecord) {
  Sample sample;
  for (std::size_t size = sample.ends[kCount - 2]; size < sample.bytes.size(); ++size) {
    const StoredMap stored = sample.read(sample.bytes.substr(0, size));
    const bool at_an_end = std::ranges::count(sample.ends, size) > 0;
    ASSERT_EQ(numbers_of(stored.keyframes), first_numbers(sample.owner(size))) << size;
    ASSERT_EQ(stored.warning.empty(), at_an_end) << size;
  }
}

TEST(KeyframeFile, ACutHeaderIsAnEmptyMap) {
  const Sample sample;
  for (std::size_t size = 0; size < kFileHeaderBytes; ++size) {
    const StoredMap stored = sample.read(sample.bytes.substr(0, size));
    EXPECT_TRUE(stored.keyframes.empty());
    EXPECT_FALSE(stored.map_id);
    EXPECT_FALSE(stored.warning.empty()) << size;
  }
}

TEST(KeyframeFile, KeepsWhatIsWholeAroundAnyDamageAndInventsNothing) {
  Sample sample;
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::string changed = sample.bytes;
    std::vector<int> lost;
    for (unsigned places = 1 + random() % 4; places > 0; --places) {
      const std::size_t from = random() % changed.size(), bytes = 1 + random() % 200;
      for (std::size_t byte = from; byte < std::min(from + bytes, changed.size()); ++byte) {
        changed[byte] = static_cast<char>(random());
        lost.push_back(sample.owner(byte));
      }
    }
    const std::vector<int> found = numbers_of(sample.read(changed).keyframes);
    for (int number = 0; number < kCount; ++number) {
      const bool damaged = std::ranges::count(lost, number) > 0;
      ASSERT_TRUE(damaged || std::ranges::count(found, number) == 1) << i << ", " << number;
    }
    ASSERT_TRUE(std::ranges::is_sorted(found, std::less_equal<>())) << i;
  }
}

TEST(KeyframeFile, GoesOnBehindATornRecord) {
  const Sample sample;
  const std::string torn = sample.bytes.substr(0, sample.ends[3] + 50);
  const StoredMap stored = sample.read(torn + sample.bytes.substr(sample.ends[3]));
  EXPECT_EQ(numbers_of(stored.keyframes), first_numbers(kCount));
  EXPECT_NE(stored.warning.find("1 place (50 bytes)"), std::string::npos) << stored.warning;
}

TEST(KeyframeFile, ARecordThatWasWrittenTwiceIsOneKeyframe) {
  const Sample sample;
  const StoredMap stored = sample.read(sample.bytes + sample.bytes.substr(sample.ends[kCount - 1]));
  EXPECT_EQ(numbers_of(stored.keyframes), first_numbers(kCount));
  EXPECT_EQ(stored.warning, "");
}

TEST(KeyframeFile, LeavesOutRecordsOfAnotherMap) {
  const Sample sample;
  const StoredMap stored = sample.read(sample.bytes + encode_record(keyframe(kCount), 43, kCount));
  EXPECT_EQ(numbers_of(stored.keyframes), first_numbers(kCount));
  EXPECT_NE(stored.warning, "");
}

TEST(KeyframeFile, StepsOverARecordOfAKindThatIsNotKnown) {
  const Sample sample;
  std::string other = encode_record(keyframe(0), 42, 0);
  other[4] = 9;
  const std::uint32_t checksum = checksum_of(other.substr(0, 28));
  other.replace(28, 4, reinterpret_cast<const char*>(&checksum), 4);
  const StoredMap stored =
      sample.read(sample.bytes.substr(0, sample.ends[1]) + other +
                  sample.bytes.substr(sample.ends[1], sample.ends[2] - sample.ends[1]));
  EXPECT_EQ(numbers_of(stored.keyframes), first_numbers(2));
  EXPECT_EQ(stored.warning, "");
}

TEST(KeyframeFile, SaysWhatIsNoMap) {
  const TemporaryFolder folder;
  EXPECT_THROW(KeyframeReader(folder / "none"), io::FileError);
  EXPECT_THROW(KeyframeReader(folder.path()), io::FileError);
  EXPECT_THROW(KeyframeReader(folder.write("a", "something else entirely, and much longer")),
               io::FileError);
}

// The first format: "VOXKF001", map id, records of length, checksum and payload.
class FirstFormat : public testing::Test {
 protected:
  FirstFormat() {
    const std::int64_t id = 42;
    bytes_.append(reinterpret_cast<const char*>(&id), sizeof id);
    for (int i = 0; i < kCount; ++i) {
      ends_.push_back(bytes_.size());
      const std::string record = encode_record(keyframe(i), 42, 0);
      bytes_ += record.substr(8, 4) + record.substr(24, 4) + record.substr(32);
    }
  }

  Sample sample_;
  std::string bytes_ = "VOXKF001";
  std::vector<std::size_t> ends_;
};

TEST_F(FirstFormat, IsRead) {
  const StoredMap stored = sample_.read(bytes_);
  EXPECT_EQ(stored.map_id, 42);
  EXPECT_EQ(stored.warning, "");
  EXPECT_EQ(numbers_of(stored.keyframes), first_numbers(kCount));
  // Its checksum is the one that files on disks have.
  EXPECT_EQ(bytes_.substr(16 + 8 + 112 + 5 * 12 + 4, 4), bytes_.substr(ends_[1] + 4, 4));
}

TEST_F(FirstFormat, AFlippedBitCostsAtMostTheRecordThatItIsIn) {
  for (std::size_t byte = 16; byte < bytes_.size(); ++byte) {
    std::string changed = bytes_;
    changed[byte] = static_cast<char>(changed[byte] ^ (1 << (byte % 8)));
    const int owner = static_cast<int>(std::ranges::upper_bound(ends_, byte) - ends_.begin()) - 1;
    ASSERT_EQ(numbers_of(sample_.read(changed).keyframes), first_numbers(kCount, owner)) << byte;
  }
}

TEST_F(FirstFormat, MayHaveADamagedMagic) {
  for (std::size_t bit = 0; bit < 64; ++bit) {
    std::string changed = bytes_;
    changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << (bit % 8)));
    const StoredMap stored = sample_.read(changed);
    ASSERT_EQ(stored.map_id, 42);
    ASSERT_NE(stored.warning, "");
    ASSERT_EQ(numbers_of(stored.keyframes), first_numbers(kCount));
  }
}

TEST_F(FirstFormat, GoesOnWithRecordsOfToday) {
  const StoredMap stored = sample_.read(bytes_ + encode_record(keyframe(kCount), 42, kCount));
  EXPECT_EQ(stored.warning, "");
  EXPECT_EQ(numbers_of(stored.keyframes), first_numbers(kCount + 1));
}

}  // namespace
}  // namespace voxlist::mapping
