#include "voxlist/bus/maps/map_faults.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "voxlist/bus/maps/map_chunks.h"

namespace voxlist::bus {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The first of two chunks of a whole map, of both kinds of blocks.
map_update_t good() {
  MapChange change{1000, 1, 3, kWholeMap, {0.05, 0.2}, {}};
  change.blocks.occupied.resize(kBlocksPerChunk - 100);
  change.blocks.passed.resize(kBlocksPerChunk);
  return split_map(std::move(change))[0];
}

template <class Change>
MapFault fault_after(const Change& change) {
  map_update_t message = good();
  change(message);
  return fault_of(message);
}

TEST(MapFaults, FindsNoneInWhatTheMapperSends) {
  EXPECT_EQ(fault_of(good()), MapFault::kNone);
  MapChange nothing_new{1000, 1, 3, 3, {0.02, 0.08}, {}};
  EXPECT_EQ(fault_of(split_map(nothing_new)[0]), MapFault::kNone);
  MapChange empty{0, 1, 0, kWholeMap, {0.02, 0.08}, {}};
  EXPECT_EQ(fault_of(split_map(empty)[0]), MapFault::kNone);
}

TEST(MapFaults, RefusesVoxelsThatNobodyMakes) {
  for (const double edge_m : {kNan, kInfinity, 0.0, -0.05, 0.009, 1.1, 10.0}) {
    EXPECT_EQ(fault_after([&](map_update_t& m) { m.resolution_m = edge_m; }), MapFault::kResolution)
        << edge_m;
    EXPECT_EQ(fault_after([&](map_update_t& m) { m.passed_resolution_m = edge_m; }),
              MapFault::kResolution)
        << edge_m;
  }
  EXPECT_EQ(fault_after([](map_update_t& m) { m.passed_resolution_m = 0.04; }),
            MapFault::kResolution)
      << "finer than the voxels";
}

TEST(MapFaults, RefusesBlocksKilometresAway) {
  for (const std::int32_t far :
       {25'000, kMaxBlockCoordinate, std::numeric_limits<std::int32_t>::min()}) {
    EXPECT_EQ(fault_after([&](map_update_t& m) { m.blocks[7].y = far; }), MapFault::kFarBlock);
    EXPECT_EQ(fault_after([&](map_update_t& m) { m.passed_blocks[7].x = far; }),
              MapFault::kFarBlock);
  }
  EXPECT_EQ(fault_after([](map_update_t& m) { m.blocks[7].z = 5000; }), MapFault::kFarBlock)
      << "2 km up";
  EXPECT_EQ(fault_after([](map_update_t& m) { m.blocks[7].y = 20'000; }), MapFault::kNone);
}

TEST(MapFaults, RefusesNumbersOfChunksAndBlocksThatNobodyMakes) {
  const auto is_bad = [](const auto& change) { return fault_after(change) == MapFault::kChunk; };
  EXPECT_TRUE(is_bad([](map_update_t& m) { m.chunk = 2; }));
  EXPECT_TRUE(is_bad([](map_update_t& m) { m.chunk = -1; }));
  EXPECT_TRUE(is_bad([](map_update_t& m) { m.n_chunks = 0; }));
  EXPECT_TRUE(is_bad([](map_update_t& m) { m.n_chunks = kMaxChunks + 1; }));
  EXPECT_TRUE(is_bad([](map_update_t& m) { m.blocks.push_back(m.blocks[0]); }));
  EXPECT_TRUE(is_bad([](map_update_t& m) { m.passed_blocks.pop_back(); })) << "not the last one";
  EXPECT_TRUE(is_bad([](map_update_t& m) { m.base_version = 3; })) << "blocks without a change";
  EXPECT_TRUE(is_bad([](map_update_t& m) { m.version = 0; })) << "blocks in an empty map";
}

TEST(MapFaults, RefusesVersionsAndTimesThatNobodyMakes) {
  for (const auto& [version, base] : std::vector<std::pair<std::int64_t, std::int64_t>>{
           {-1, -1}, {3, 4}, {3, -2}, {3, 1}, {0, -5}}) {
    EXPECT_EQ(fault_after([&](map_update_t& m) { m.version = version, m.base_version = base; }),
              MapFault::kVersion)
        << version << " on " << base;
  }
  EXPECT_EQ(fault_after([](map_update_t& m) { m.utime = -5; }), MapFault::kTime);
}

TEST(MapFaults, RefusesAMapThatDoesNotFitTheMachine) {
  EXPECT_TRUE(fits_memory(1'000'000, 1'000'000'000));
  EXPECT_FALSE(fits_memory(2'000'000, 1'000'000'000));
}

TEST(MapFaults, EachHasANameAndASentence) {
  for (const MapFault fault : {MapFault::kTime, MapFault::kVersion, MapFault::kChunk,
                               MapFault::kResolution, MapFault::kFarBlock, MapFault::kTooLarge}) {
    EXPECT_NE(std::string(name(fault)), "");
    EXPECT_NE(std::string(sentence(fault)), "");
  }
}

}  // namespace
}  // namespace voxlist::bus
