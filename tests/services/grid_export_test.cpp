#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <vector>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "services/grid_export/grid_export_service.h"
#include "tests/stand_in_mapper.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::services {
namespace {

using planning::CellType;
using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kSecond_us = 1'000'000;

// A floor of 4 x 4 m with free space above it, and a table over a part of it.
struct Scene {
  Scene() {
    for (std::int32_t y = -100; y < 100; ++y)
      for (std::int32_t x = -100; x < 100; ++x) {
        map.occupied.insert({x, y, -1});
        if (x >= 40 && x < 60 && y >= 40 && y < 60) map.occupied.insert({x, y, 35});
      }
    for (std::int32_t z = 0; z < 30; ++z)
      for (std::int32_t y = -25; y < 25; ++y)
        for (std::int32_t x = -25; x < 25; ++x) free.passed.insert({x, y, z});
  }

  bus::MapChange change(const OccupancyMap& of, std::int64_t version, std::int64_t map_id) const {
    bus::MapChange change;
    change.utime_us = version * kSecond_us;
    change.map_id = map_id;
    change.version = version;
    change.resolution = bus::resolution_of(of);
    change.blocks = bus::to_messages(of);
    return change;
  }

  OccupancyMap map, free{VoxelMap(kPassedResolution_m), VoxelMap(kPassedResolution_m)};
};

std::vector<std::uint8_t> unpacked(const std::vector<std::uint8_t>& bytes, std::size_t size) {
  std::vector<std::uint8_t> cells(size);
  uLongf length = size;
  EXPECT_EQ(uncompress(cells.data(), &length, bytes.data(), bytes.size()), Z_OK);
  EXPECT_EQ(length, size);
  return cells;
}

template <class Message>
std::size_t at(const Message& grid, double x_m, double y_m) {
  const auto x = static_cast<std::size_t>((x_m - grid.xy0[0]) / planning::kColumn_m);
  const auto y = static_cast<std::size_t>((y_m - grid.xy0[1]) / planning::kColumn_m);
  return y * static_cast<std::size_t>(grid.dimensions[0]) + x;
}

CellType type_at(const traversability_t& grid, double x_m, double y_m) {
  const auto size = static_cast<std::size_t>(grid.dimensions[0] * grid.dimensions[1]);
  return static_cast<CellType>(unpacked(grid.cells, size)[at(grid, x_m, y_m)]);
}

class GridExport : public ::testing::Test {
 protected:
  GridExport() {
    bus_.subscribe(bus::kMapRequest, [this](const map_request_t& m) { requests_.push_back(m); });
    bus_.subscribe(bus::Channel<traversability_t>{"TRAVERSABILITY_low"},
                   [this](const traversability_t& m) { low_.push_back(m); });
    bus_.subscribe(bus::Channel<traversability_t>{"TRAVERSABILITY_tall"},
                   [this](const traversability_t& m) { tall_.push_back(m); });
    bus_.subscribe(bus::Channel<pixel_map_t>{"GRID_tall"},
                   [this](const pixel_map_t& m) { pixels_.push_back(m); });
    config_.robots.listed.resize(2);
    config_.robots.listed[0].name = "low";
    config_.robots.listed[0].height_m = 0.4;
    config_.robots.listed[1].name = "tall";
    config_.robots.listed[1].height_m = 1.7;
    config_.folder = (folder_ / "grids").string();
    begin();
  }

  void begin() { service_ = std::make_unique<GridExportService>(bus_, health_, config_); }

  void handle() {
    while (bus_.handle(std::chrono::milliseconds(0)) && bus_.counters() != seen_)
      seen_ = bus_.counters();
  }

  // The mapper answers what it is asked for.
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      now_us_ += kSecond_us / 4;
      service_->tick(now_us_);
      handle();
      for (const map_request_t& request : std::exchange(requests_, {})) answer(request);
      handle();
    }
  }

  void answer(const map_request_t& request) {
    const bool wants_free = request.want == map_request_t::WANT_FREE_SPACE;
    const test::StandInMapper mapper(
        scene_.change(wants_free ? scene_.free : scene_.map, version_, map_id_));
    const bool wants_keyframes = request.want == map_request_t::WANT_KEYFRAMES;
    if (wants_keyframes) asked_keyframes_.push_back(request.first);
    for (const map_update_t& message :
         wants_keyframes ? mapper.word(request.utime) : mapper.answer(request))
      bus_.publish(wants_free ? bus::kFreeSpace : bus::kMapUpdate, message);
  }

  void send_version(std::int64_t version) {
    version_ = version;
    for (auto& m : bus::split_map(scene_.change(scene_.map, version, map_id_)))
      bus_.publish(bus::kMapUpdate, m);
    for (auto& m : bus::split_map(scene_.change(scene_.free, version, map_id_)))
      bus_.publish(bus::kFreeSpace, m);
  }

  test::TemporaryFolder folder_;
  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"grid_export"};
  GridExportConfig config_;
  Scene scene_;
  std::int64_t version_ = 1, map_id_ = 7;
  std::unique_ptr<GridExportService> service_;
  bus::Counters seen_;
  std::vector<map_request_t> requests_;
  std::vector<std::int32_t> asked_keyframes_;
  std::vector<traversability_t> low_, tall_;
  std::vector<pixel_map_t> pixels_;
  std::int64_t now_us_ = 1000 * kSecond_us;
};

TEST_F(GridExport, MakesOfEachCloudAScanForEachRobotWithoutAMap) {
  std::map<std::string, planar_lidar_t> scans;
  for (const char* channel : {"SCAN_low", "SCAN_tall", "SCAN_FAR_low", "SCAN_FAR_tall"})
    bus_.subscribe(bus::Channel<planar_lidar_t>{channel},
                   [&scans, channel](const planar_lidar_t& m) { scans[channel] = m; });
  // A table top, a wall behind it, and rays that come from 1 m above the floor.
  Cloud cloud{5 * kSecond_us, {{2.F, 0.F, 0.7F}, {4.F, 0.F, 0.3F}}, {}};
  cloud.origins.assign(2, {0.F, 0.F, 1.F});
  bus_.publish(bus::kCloud, bus::to_message(cloud, "base", 1));
  handle();
  ASSERT_THAT(scans, SizeIs(4));
  EXPECT_EQ(scans["SCAN_low"].utime, 5 * kSecond_us);
  EXPECT_FLOAT_EQ(scans["SCAN_low"].ranges.at(0), 4.F);
  EXPECT_FLOAT_EQ(scans["SCAN_tall"].ranges.at(0), 2.F);
  EXPECT_FLOAT_EQ(scans["SCAN_FAR_low"].ranges.at(0), 4.F);
  EXPECT_FLOAT_EQ(scans["SCAN_FAR_tall"].ranges.at(0), 4.F);
  EXPECT_TRUE(std::isnan(scans["SCAN_low"].ranges.at(1)));
  EXPECT_NEAR(scans["SCAN_low"].radstep * static_cast<float>(scans["SCAN_low"].nranges), 6.2832F,
              1e-4F);
}

TEST_F(GridExport, MakesAGridForEachRobotOfWhatTheMapperHas) {
  run(8);
  ASSERT_FALSE(low_.empty() || tall_.empty() || pixels_.empty());
  EXPECT_EQ(tall_.back().map_id, 7);
  EXPECT_EQ(tall_.back().version, 1);
  EXPECT_EQ(tall_.back().profile, "tall");
  EXPECT_EQ(tall_.back().utime, kSecond_us);
  EXPECT_EQ(type_at(low_.back(), 1.0, 1.0), CellType::kFree);
  EXPECT_EQ(type_at(tall_.back(), 1.0, 1.0), CellType::kOverhang);
  EXPECT_EQ(type_at(tall_.back(), 0.3, 0.3), CellType::kFree);
}

TEST_F(GridExport, TellsInPixelsWhereNoRobotMayDrive) {
  run(8);
  ASSERT_FALSE(pixels_.empty());
  const pixel_map_t& grid = pixels_.back();
  EXPECT_EQ(grid.data_type, pixel_map_t::DATA_TYPE_UINT8);
  EXPECT_NEAR(grid.xy1[0] - grid.xy0[0], grid.dimensions[0] * grid.mpp, 1e-9);
  const auto cells =
      unpacked(grid.mapData, static_cast<std::size_t>(grid.dimensions[0] * grid.dimensions[1]));
  EXPECT_EQ(cells[at(grid, 1.0, 1.0)], 255);
  EXPECT_EQ(cells[at(grid, 0.3, 0.3)], 0);
}

TEST_F(GridExport, SaysNothingBeforeBothHalvesOfTheMapAreOfOneVersion) {
  run(1);
  EXPECT_THAT(tall_, IsEmpty());
}

TEST_F(GridExport, FollowsTheMap) {
  run(8);
  const std::size_t before = tall_.size();
  run(8);
  EXPECT_EQ(tall_.size(), before) << "nothing has changed";
  for (std::int32_t z = 0; z < 50; ++z) scene_.map.occupied.insert({-40, -40, z});
  send_version(2);
  run(8);
  ASSERT_GT(tall_.size(), before);
  EXPECT_EQ(tall_.back().version, 2);
  EXPECT_EQ(type_at(tall_.back(), -0.79, -0.79), CellType::kObstacle);
}

TEST_F(GridExport, SendsTheGridsAgainForWhoStartsLater) {
  run(8);
  ASSERT_FALSE(tall_.empty() || pixels_.empty());
  const traversability_t last = tall_.back();
  tall_.clear();
  pixels_.clear();
  run(20);  // five seconds
  ASSERT_THAT(tall_, SizeIs(1));
  ASSERT_THAT(pixels_, SizeIs(1));
  EXPECT_EQ(tall_.back().cells, last.cells);
  EXPECT_EQ(tall_.back().version, last.version);
  run(20);
  EXPECT_THAT(tall_, SizeIs(2));
  now_us_ -= 1000 * kSecond_us;  // somebody sets the clock
  run(1);
  EXPECT_THAT(tall_, SizeIs(3));
}

TEST_F(GridExport, DoesNotRepeatTheGridsOfAMapThatIsNoMore) {
  run(8);
  ASSERT_FALSE(tall_.empty());
  map_id_ = 8;
  version_ = 0;  // and the mapper has nothing yet
  for (const map_update_t& message :
       test::StandInMapper(scene_.change(scene_.map, version_, map_id_)).word())
    bus_.publish(bus::kMapUpdate, message);
  handle();
  run(4);
  tall_.clear();
  run(40);
  EXPECT_THAT(tall_, IsEmpty());
}

TEST(GridOutput, DoesNotRepeatGridsWhereItIsNotTo) {
  bus::Bus bus({.url = "memq://", .prefix = ""});
  int heard = 0;
  bus.subscribe(bus::Channel<pixel_map_t>{"GRID_robot"}, [&](const pixel_map_t&) { ++heard; });
  GridOutput output(bus, planning::RobotProfiles().in_use(), 0);
  output.send({{{{0, 0}, {8, 8}}, std::vector<CellType>(64)}}, {}, kSecond_us);
  output.tick(1000 * kSecond_us);
  for (int i = 0; i < 10; ++i) bus.handle(std::chrono::milliseconds(0));
  EXPECT_EQ(heard, 1);
}

// Runs of values as grids have them.
std::vector<std::uint8_t> runs(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * i / 100'000 % 5);
  return bytes;
}

TEST(BandedZlib, IsInflatedByZlibItselfHoweverOftenTheBytesChange) {
  BandedZlib zlib;
  for (const std::size_t size : {0U, 1U, 65'535U, 65'536U, 65'537U, 400'000U, 70'000U}) {
    std::vector<std::uint8_t> bytes = runs(size);
    EXPECT_EQ(unpacked(zlib.compress(bytes), size), bytes) << size;
    for (std::size_t i = 0; i < size; i += 50'000) {
      bytes[i] = 200;
      EXPECT_EQ(unpacked(zlib.compress(bytes), size), bytes) << size << ' ' << i;
      EXPECT_EQ(zlib.compress(bytes), BandedZlib().compress(bytes));
    }
  }
}

TEST_F(GridExport, KeepsTheGridsAsFiles) {
  run(8);
  for (const char* file : {"low.pgm", "low.yaml", "low.png", "tall.pgm", "tall.yaml", "tall.png"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "grids" / file)) << file;
}

TEST_F(GridExport, SaysWhenFilesCannotBeWritten) {
  folder_.write("grids", "no folder");
  run(8);
  EXPECT_THROW(service_->stop(), std::runtime_error);
}

TEST_F(GridExport, AsksForTheKeyframesThatItMissed) {
  version_ = 40;
  run(8);
  ASSERT_FALSE(asked_keyframes_.empty());
  EXPECT_EQ(asked_keyframes_.front(), 0);
  for (std::int32_t i = 0; i < 32; ++i) {
    keyframe_t keyframe{};
    keyframe.map_id = 7;
    keyframe.index = i;
    bus_.publish(bus::kKeyframe, keyframe);
  }
  handle();
  run(8);
  EXPECT_EQ(asked_keyframes_.back(), 32);
}

TEST_F(GridExport, KnowsTheFloorWhereAKeyframeWasTakenBeyondWhatWasSeen) {
  for (std::int32_t z = 0; z < 30; ++z)
    for (std::int32_t i = 0; i < 100; ++i) scene_.free.passed.insert({50 + i % 10, i / 10, z});
  run(8);
  EXPECT_EQ(type_at(tall_.back(), 4.4, 0.4), CellType::kUnknown);
  keyframe_t keyframe{};
  keyframe.map_id = 7;
  keyframe.trans[0] = 4.4;
  keyframe.trans[1] = 0.4;
  bus_.publish(bus::kKeyframe, keyframe);
  handle();
  run(4);
  EXPECT_EQ(type_at(tall_.back(), 4.4, 0.4), CellType::kFree);
}

TEST_F(GridExport, RefusesRobotsOfOneName) {
  config_.robots.listed[1].name = "low";
  EXPECT_THROW(GridExportService::check(config_), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::services
