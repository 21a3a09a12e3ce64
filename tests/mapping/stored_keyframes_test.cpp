#include <gtest/gtest.h>

#include <fstream>

#include "tests/file_size_limit.h"
#include "tests/mapping/keyframe_samples.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_format.h"
#include "voxlist/mapping/keyframe_spool.h"

namespace voxlist::mapping {
namespace {

using test::TemporaryFolder;
namespace fs = std::filesystem;

// Read backwards: any order will do.
std::vector<int> read_back(StoredKeyframes& keyframes) {
  std::vector<Keyframe> read;
  for (std::size_t i = keyframes.size(); i-- > 0;)
    if (auto found = keyframes.read(i)) read.insert(read.begin(), std::move(*found));
  return numbers_of(read);
}

TEST(StoredKeyframes, AreThoseThatWereThereAndThoseThatCame) {
  const TemporaryFolder folder;
  MapStore store(make_map(folder, 3), 7, ignore);
  EXPECT_EQ(read_back(store.keyframes()), first_numbers(3));
  for (int i = 3; i < 8; ++i) {
    store.append(keyframe(i));
    EXPECT_EQ(read_back(store.keyframes()), first_numbers(i + 1));
  }
}

TEST(StoredKeyframes, AreReadAfterTheirFolderWasRemoved) {
  const TemporaryFolder folder;
  const fs::path map = make_map(folder, 2);
  MapStore store(map, 7, ignore);
  store.append(keyframe(2));
  fs::remove_all(map);
  EXPECT_EQ(read_back(store.keyframes()), first_numbers(3));
}

TEST(StoredKeyframes, AreThoseOfTheWholeFileThatADamagedOneBecame) {
  const TemporaryFolder folder;
  const fs::path map = make_map(folder, 4);
  std::string bytes = io::read_file(map / kKeyframeFile);
  bytes.at(kFileHeaderBytes + 60) = static_cast<char>(bytes.at(kFileHeaderBytes + 60) ^ 1);
  std::ofstream(map / kKeyframeFile, std::ios::binary) << bytes;
  MapStore store(map, 7, ignore);
  store.append(keyframe(4));
  EXPECT_EQ(read_back(store.keyframes()), (std::vector<int>{1, 2, 3, 4}));
}

TEST(StoredKeyframes, AreNoneWhereTheFileWasCut) {
  const TemporaryFolder folder;
  const fs::path file = make_map(folder, 3) / kKeyframeFile;
  std::vector<KeyframePlace> places;
  for (KeyframeReader reader(file); reader.next();) places.push_back(reader.place());
  fs::resize_file(file, fs::file_size(file) - 1);
  StoredKeyframes keyframes(file, places);
  EXPECT_FALSE(keyframes.read(2));
  EXPECT_TRUE(keyframes.read(1));
}

TEST(KeyframeSpool, WritesWhatItWasGivenAndLeavesNothingElse) {
  const TemporaryFolder folder;
  {
    KeyframeSpool spool(folder.path());
    std::vector<SpooledKeyframe> all;
    for (int i = 0; i < 5; ++i) all.push_back({spool.add(keyframe(i)), keyframe(i).T_map_base});
    spool.write(folder / kKeyframeFile, 42, all);
  }
  const test::StoredMap map = test::load_map(folder.path());
  EXPECT_EQ(numbers_of(map.keyframes), first_numbers(5));
  EXPECT_EQ(map.map_id, 42);
  EXPECT_EQ(map.warning, "");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(KeyframeSpool, GivesAndWritesKeyframesWhereTheyAreNow) {
  const TemporaryFolder folder;
  KeyframeSpool spool(folder.path());
  for (int i = 0; i < 3; ++i) spool.add(keyframe(i));
  const SpooledKeyframe moved{1, Pose3(Eigen::Translation3d(5.0, 6.0, 0.0))};
  const Keyframe found = spool.read(moved);
  EXPECT_EQ(found.cloud.points, keyframe(1).cloud.points);
  EXPECT_TRUE(found.T_map_base.isApprox(moved.T_map_base));
  spool.add(keyframe(3));
  spool.write(folder / kKeyframeFile, 42, {{3, keyframe(3).T_map_base}, moved});
  const test::StoredMap map = test::load_map(folder.path());
  ASSERT_EQ(map.keyframes.size(), 2u);
  EXPECT_EQ(numbers_of({map.keyframes.front()}), std::vector{3});
  EXPECT_EQ(map.keyframes.back().cloud.origins, keyframe(1).cloud.origins);
  EXPECT_TRUE(map.keyframes.back().T_map_base.isApprox(moved.T_map_base));
}

TEST(KeyframeSpool, SaysThatTheDiskIsFull) {
  const TemporaryFolder folder;
  KeyframeSpool spool(folder.path());
  const test::FileSizeLimit full(100);
  EXPECT_THROW(spool.add(keyframe(0)), io::FileError);
}

}  // namespace
}  // namespace voxlist::mapping
