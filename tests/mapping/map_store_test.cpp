#include "voxlist/mapping/map_store.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/file_size_limit.h"
#include "tests/mapping/keyframe_samples.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_format.h"

namespace voxlist::mapping {
namespace {

using test::load_map;
using test::TemporaryFolder;
namespace fs = std::filesystem;

std::vector<int> numbers_in(const fs::path& map) { return numbers_of(load_map(map).keyframes); }

void flip_bit(const fs::path& map, std::size_t byte) {
  std::string bytes = io::read_file(map / kKeyframeFile);
  bytes.at(byte) = static_cast<char>(bytes.at(byte) ^ 1);
  std::ofstream(map / kKeyframeFile, std::ios::binary) << bytes;
}

TEST(MapStore, GoesOnWhereItStopped) {
  const TemporaryFolder folder;
  const auto map = make_map(folder, 2);
  std::vector<Keyframe> restored;
  {
    MapStore store(map, 7, [&](Keyframe k) { restored.push_back(std::move(k)); });
    EXPECT_EQ(store.map_id(), 42);
    EXPECT_EQ(store.notice(), "");
    store.append(keyframe(2));
  }
  EXPECT_EQ(numbers_of(restored), first_numbers(2));
  EXPECT_EQ(load_map(map).warning, "");
  EXPECT_EQ(numbers_in(map), first_numbers(3));
}

TEST(MapStore, KeepsADamagedFileAsideAndGoesOnWithWhatIsWhole) {
  const TemporaryFolder folder;
  const auto map = make_map(folder, 3);
  flip_bit(map, kFileHeaderBytes + 60);
  const std::string damaged = io::read_file(map / kKeyframeFile);
  std::ofstream(map / "keyframes.voxlist.damaged") << "older evidence";
  {
    MapStore store(map, 7, ignore);
    EXPECT_EQ(store.map_id(), 42);
    EXPECT_NE(store.notice().find("keyframes.voxlist.damaged-1"), std::string::npos);
    store.append(keyframe(3));
  }
  EXPECT_EQ(io::read_file(map / "keyframes.voxlist.damaged"), "older evidence");
  EXPECT_EQ(io::read_file(map / "keyframes.voxlist.damaged-1"), damaged);
  EXPECT_EQ(load_map(map).warning, "");
  EXPECT_EQ(numbers_in(map), (std::vector<int>{1, 2, 3}));
}

TEST(MapStore, KeepsAMapAsideThatIsGivenUp) {
  const TemporaryFolder folder;
  const auto map = make_map(folder, 1);
  const std::string before = io::read_file(map / kKeyframeFile);
  {
    MapStore store(map, 7, ignore);
    store.begin_anew(43);
    EXPECT_EQ(store.map_id(), 43);
    EXPECT_EQ(store.keyframes().size(), 0u);
    store.begin_anew(44);
    store.append(keyframe(5));
    EXPECT_TRUE(store.is_in_place());
  }
  EXPECT_EQ(io::read_file(map / "keyframes.voxlist.given-up"), before);
  EXPECT_FALSE(fs::exists(map / "keyframes.voxlist.given-up-1")) << "an empty file is no evidence";
  EXPECT_EQ(load_map(map).warning, "");
  EXPECT_EQ(numbers_in(map), (std::vector<int>{5}));
}

TEST(MapStore, LosesAtMostTheTornRecord) {
  const TemporaryFolder folder;
  const auto map = make_map(folder, 3);
  fs::resize_file(map / kKeyframeFile, fs::file_size(map / kKeyframeFile) - 7);
  MapStore(map, 7, ignore).append(keyframe(3));
  EXPECT_EQ(numbers_in(map), (std::vector<int>{0, 1, 3}));
}

TEST(MapStore, StartsOnAFullDiskBehindATornRecord) {
  const TemporaryFolder folder;
  const auto map = make_map(folder, 3);
  fs::resize_file(map / kKeyframeFile, fs::file_size(map / kKeyframeFile) - 7);
  const std::string torn = io::read_file(map / kKeyframeFile);
  std::optional<MapStore> store;
  {
    const test::FileSizeLimit full(40);
    store.emplace(map, 7, ignore);
    EXPECT_NE(store->notice().find("stays in use"), std::string::npos) << store->notice();
    EXPECT_THROW(store->append(keyframe(3)), io::FileError);
  }
  EXPECT_EQ(io::read_file(map / kKeyframeFile), torn);
  store->append(keyframe(3));
  EXPECT_EQ(numbers_in(map), (std::vector<int>{0, 1, 3}));
  EXPECT_TRUE(io::read_file(map / kKeyframeFile).starts_with(torn));
}

TEST(MapStore, AFullDiskLeavesTheFileAsItWasAndTheKeyframeIsTriedAgain) {
  const TemporaryFolder folder;
  const auto map = make_map(folder, 2);
  MapStore store(map, 7, ignore);
  const auto size = fs::file_size(map / kKeyframeFile);
  for (rlim_t room = 0; room < 150; room += 7) {
    const test::FileSizeLimit full(size + room);
    EXPECT_THROW(store.append(keyframe(2)), io::FileError);
    EXPECT_EQ(fs::file_size(map / kKeyframeFile), size);
  }
  store.append(keyframe(2));
  EXPECT_EQ(load_map(map).warning, "");
  EXPECT_EQ(numbers_in(map), first_numbers(3));
}

TEST(MapStore, AppendsToAFileOfTheFirstFormatAndLeavesWhatIsInIt) {
  const TemporaryFolder folder;
  const std::int64_t id = 42;
  const std::string record = encode_record(keyframe(0), 42, 0);
  const std::string bytes = "VOXKF001" +
                            std::string(reinterpret_cast<const char*>(&id), sizeof id) +
                            record.substr(8, 4) + record.substr(24, 4) + record.substr(32);
  folder.write(kKeyframeFile, bytes);
  MapStore(folder.path(), 7, ignore).append(keyframe(1));
  EXPECT_EQ(load_map(folder.path()).warning, "");
  EXPECT_EQ(numbers_in(folder.path()), first_numbers(2));
  EXPECT_TRUE(io::read_file(folder / kKeyframeFile).starts_with(bytes));
}

TEST(MapStore, BeginsANewMapWhereAFileWasCutToNothing) {
  const TemporaryFolder folder;
  folder.write(kKeyframeFile, "");
  MapStore store(folder.path(), 7, ignore);
  EXPECT_EQ(store.map_id(), 7);
  store.append(keyframe(0));
  EXPECT_EQ(load_map(folder.path()).map_id, 7);
  EXPECT_EQ(numbers_in(folder.path()), first_numbers(1));
}

TEST(MapStore, LeavesAloneWhatIsNotVoxlists) {
  const TemporaryFolder folder;
  const auto file = folder.write(kKeyframeFile, "somebody's notes, longer than a header");
  EXPECT_THROW(MapStore(folder.path(), 7, ignore), io::FileError);
  EXPECT_EQ(io::read_file(file), "somebody's notes, longer than a header");
}

TEST(MapStore, BelongsToOneMapper) {
  const TemporaryFolder folder;
  {
    const MapStore first(folder.path(), 7, ignore);
    try {
      MapStore(folder.path(), 8, ignore);
      ADD_FAILURE() << "two mappers in one folder";
    } catch (const io::FileError& error) {
      EXPECT_NE(std::string(error.what()).find("process " + std::to_string(getpid())),
                std::string::npos);
    }
    EXPECT_THROW(lock_folder(folder.path()), io::FileError);
  }
  EXPECT_NO_THROW(lock_folder(folder.path()));
  EXPECT_NO_THROW(MapStore(folder.path(), 7, ignore));
}

TEST(MapStore, NoticesThatItsFolderIsGoneReplacedOrItsFileCut) {
  const TemporaryFolder folder;
  const auto map = make_map(folder, 2);
  const auto away = folder / "away";
  const MapStore store(map, 7, ignore);
  EXPECT_TRUE(store.is_in_place());
  fs::rename(map, away);
  EXPECT_FALSE(store.is_in_place());
  fs::copy(away, map);
  EXPECT_FALSE(store.is_in_place());
  fs::remove_all(map);
  fs::rename(away, map);
  EXPECT_TRUE(store.is_in_place());
  fs::resize_file(map / kKeyframeFile, 30);
  EXPECT_FALSE(store.is_in_place());
}

}  // namespace
}  // namespace voxlist::mapping
