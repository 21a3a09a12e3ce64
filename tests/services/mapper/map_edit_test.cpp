// Boxes that are edited by hand while the mapper runs: in its map, on its channels, and in the
// OctoMap of octomap_export.
#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_edits_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "services/mapper/mapper_service.h"
#include "services/octomap_export/octomap_export_service.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/edit_convert.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::services {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecond_us = 1'000'000;

// A wall along y, at x = 2 m in the map, wherever it is seen from.
Cloud wall_from(double x_m, std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  for (int i = 0; i < 600; ++i)
    cloud.points.emplace_back(float(2.01 - x_m), 0.01F * float(i), 0.1F + 0.05F * float(i % 10));
  return cloud;
}

const Eigen::AlignedBox3d kGhost(Eigen::Vector3d(1.5, 1.0, 0.0), Eigen::Vector3d(2.5, 2.0, 1.0));
const Eigen::AlignedBox3d kNowhereSeen(Eigen::Vector3d(3.0, 3.0, 0.0),
                                       Eigen::Vector3d(4.0, 4.0, 1.0));

// Mapper and octomap_export on one bus, and a test that plays localiser, listener and person.
class MapEdit : public testing::Test {
 protected:
  // A new bus, on which nobody listens but the test.
  void open_bus() {
    bus_ = std::make_unique<bus::Bus>(bus::BusOptions{.url = "memq://", .prefix = ""});
    bus_->subscribe(bus::kMapUpdate, [this](const map_update_t& m) {
      for (const bus::MapChange& change : assembler_.add(m)) bus::apply(change, map_);
      if (export_) export_bus_.publish(bus::kMapUpdate, m);
    });
    bus_->subscribe(bus::kFreeSpace, [this](const map_update_t& m) {
      for (const bus::MapChange& change : free_assembler_.add(m)) bus::apply(change, free_);
    });
    bus_->subscribe(bus::kMapEdits, [this](const map_edits_t& m) {
      told_.push_back(m);
      if (export_) export_bus_.publish(bus::kMapEdits, m);
    });
    bus_->subscribe(bus::kKeyframe, [this](const keyframe_t& m) {
      if (export_) export_bus_.publish(bus::kKeyframe, m);
    });
  }

  void start(bool extend = true) {
    MapperServiceConfig config;
    config.folder = (folder_ / "map").string();
    config.extend = extend;
    mapper_.reset();  // without stop(): as after kill -9
    open_bus();
    mapper_.emplace(*bus_, health_, config);
    assembler_.forget();
    request(map_request_t::WANT_MAP);
  }

  // On a bus of its own, which is joined to the mapper's.
  void start_export() {
    export_bus_.subscribe(bus::kMapRequest,
                          [this](const map_request_t& m) { bus_->publish(bus::kMapRequest, m); });
    export_bus_.subscribe(bus::kOctomap, [this](const map_octree_t& m) { octomap_ = m; });
    export_.emplace(export_bus_, export_health_, OctomapExportConfig{});
  }

  void run(int ticks = 4) {
    for (int i = 0; i < ticks; ++i) {
      bus_->handle(std::chrono::milliseconds(0));
      mapper_->tick(now_us_ += 20'000);
      if (!export_) continue;
      export_bus_.handle(std::chrono::milliseconds(0));
      export_->tick(now_us_);
    }
    bus_->handle(std::chrono::milliseconds(0));
  }

  void request(std::int32_t want) {
    map_request_t message{};
    message.utime = now_us_;
    message.want = want;
    bus_->publish(bus::kMapRequest, message);
    run();
  }

  void drive(int seconds, double x_m) {
    const std::int64_t utime_us = seconds * kSecond_us;
    bus_->publish(bus::kCloud, bus::to_message(wall_from(x_m, utime_us), "base", 0));
    localisation_t message{};
    message.utime = utime_us;
    message.map_id = assembler_.held()->map_id;
    message.map_version = assembler_.held()->version;
    message.state = localisation_t::STATE_TRACKING;
    message.n_modes = 1;
    message.modes.resize(1);
    message.modes[0].pose[0] = x_m;
    bus_->publish(bus::kLocalisation, message);
    run();
  }

  void drive_twice() {
    drive(1, 0.0);
    drive(2, -1.5);
    ASSERT_EQ(version(), 2);
  }

  void start_and_drive() {
    start();
    drive_twice();
  }

  map_edit_t wish(std::optional<EditKind> kind, const Eigen::AlignedBox3d& box = kGhost,
                  std::int64_t id = 0) {
    return bus::to_message(bus::EditWish{++wishes_, assembler_.held()->map_id, kind, id, box});
  }

  void send(const map_edit_t& message) {
    bus_->publish(bus::kMapEdit, message);
    run();
  }

  std::int64_t version() const { return assembler_.held()->version; }

  static std::size_t cells_in(const VoxelMap& map, const Eigen::AlignedBox3d& box) {
    std::size_t count = 0;
    map.for_each_voxel(
        [&](const Voxel& v) { count += box.contains(center(v, map.resolution_m())); });
    return count;
  }

  // The map as it is told to who has none.
  OccupancyMap told_anew() {
    assembler_.forget();
    request(map_request_t::WANT_MAP);
    return map_;
  }

  // What planners read at a point of OCTOMAP: nothing, free (false) or occupied.
  std::optional<bool> in_octomap(const Eigen::Vector3d& point) const {
    octomap::OcTree tree(0.5);
    std::istringstream in(std::string(octomap_.data.begin(), octomap_.data.end()));
    EXPECT_TRUE(tree.readBinary(in));
    const auto* node = tree.search(point.x(), point.y(), point.z());
    return node ? std::optional(tree.isNodeOccupied(node)) : std::nullopt;
  }

  const test::TemporaryFolder folder_;
  std::unique_ptr<bus::Bus> bus_;
  bus::Bus export_bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"mapper"}, export_health_{"octomap_export"};
  std::optional<MapperService> mapper_;
  std::optional<OctomapExportService> export_;
  std::int64_t now_us_ = 1'700'000'000 * kSecond_us;
  std::int64_t wishes_ = 0;
  bus::MapAssembler assembler_, free_assembler_;
  OccupancyMap map_, free_;
  std::vector<map_edits_t> told_;
  map_octree_t octomap_{};
};

TEST_F(MapEdit, LastsWhateverIsSeenAfterwards) {
  start_and_drive();
  ASSERT_GT(cells_in(map_.occupied, kGhost), 0U);
  send(wish(EditKind::kErase));
  EXPECT_EQ(version(), 3);
  EXPECT_EQ(cells_in(map_.occupied, kGhost), 0U);
  EXPECT_GT(map_.occupied.size(), 0U);
  drive(3, -3.0);
  EXPECT_EQ(version(), 4);
  EXPECT_EQ(cells_in(map_.occupied, kGhost), 0U) << "it came back with the next keyframe";
  const OccupancyMap followed = map_;
  EXPECT_EQ(told_anew().occupied.hash(), followed.occupied.hash());
  EXPECT_EQ(map_.passed.hash(), followed.passed.hash());
}

TEST_F(MapEdit, IsTakenBackById) {
  start_and_drive();
  const std::uint64_t before = map_.occupied.hash();
  send(wish(EditKind::kKeepFree));
  ASSERT_EQ(told_.back().n_boxes, 1);
  ASSERT_NE(map_.occupied.hash(), before);
  send(wish(std::nullopt, kGhost, told_.back().boxes[0].id));
  EXPECT_EQ(map_.occupied.hash(), before);
  EXPECT_EQ(told_.back().n_boxes, 0);
  EXPECT_EQ(version(), 4);
}

TEST_F(MapEdit, IsDoneOnceAndAnsweredHoweverOftenItIsAskedFor) {
  start_and_drive();
  const map_edit_t message = wish(EditKind::kErase);
  for (int i = 0; i < 3; ++i) send(message);
  EXPECT_EQ(version(), 3);
  ASSERT_EQ(told_.size(), 3U);
  for (const map_edits_t& told : told_) {
    EXPECT_EQ(told.answers, message.utime);
    EXPECT_EQ(told.n_boxes, 1);
    EXPECT_EQ(told.edits, 1);
  }
}

TEST_F(MapEdit, IsThereAgainAtTheMappersNextStart) {
  start_and_drive();
  send(wish(EditKind::kErase));
  const std::uint64_t before = map_.occupied.hash();
  start();
  EXPECT_EQ(version(), 3);
  EXPECT_EQ(map_.occupied.hash(), before);
  EXPECT_EQ(cells_in(map_.occupied, kGhost), 0U);
}

TEST_F(MapEdit, ThatMakesNoSenseIsRefusedWithALineInHealth) {
  start_and_drive();
  const auto expect_refusal = [&](const map_edit_t& message, const std::string& why) {
    told_.clear();
    send(message);
    EXPECT_THAT(health_.message(), HasSubstr("a MAP_EDIT was refused: "));
    EXPECT_EQ(version(), 2);
    ASSERT_EQ(told_.size(), why.empty() ? 0U : 1U);
    if (why.empty()) return;
    EXPECT_THAT(told_[0].refusal, HasSubstr(why));
    EXPECT_EQ(told_[0].n_boxes, 0);
  };
  map_edit_t other_map = wish(EditKind::kErase);
  other_map.map_id += 1;
  expect_refusal(other_map, "another map");
  map_edit_t huge = wish(EditKind::kErase);
  huge.highest[0] = 1e9;
  expect_refusal(huge, "beyond 10 km");
  map_edit_t no_number = wish(EditKind::kKeepBlocked);
  no_number.lowest[2] = std::numeric_limits<double>::quiet_NaN();
  expect_refusal(no_number, "nowhere");
  expect_refusal(wish(std::nullopt, kGhost, 99), "no edit 99");
  map_edit_t unknown = wish(EditKind::kErase);
  unknown.action = 17;
  expect_refusal(unknown, "");
  map_edit_t timeless = wish(EditKind::kErase);
  timeless.utime = -1;
  expect_refusal(timeless, "");
}

TEST_F(MapEdit, IsRefusedByAMapperThatOnlyServesItsMap) {
  start_and_drive();
  start(false);
  send(wish(EditKind::kErase));
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_THAT(told_[0].refusal, HasSubstr("extend = false"));
  EXPECT_EQ(version(), 2);
}

TEST_F(MapEdit, TellsPlannersWhatIsBlockedAndFree) {
  start_and_drive();
  request(map_request_t::WANT_FREE_SPACE);
  ASSERT_EQ(cells_in(free_.occupied, kNowhereSeen), 0U);
  const std::uint64_t matched = map_.occupied.hash();
  send(wish(EditKind::kKeepBlocked, kNowhereSeen));
  send(wish(EditKind::kKeepFree, kGhost));
  EXPECT_GT(cells_in(free_.occupied, kNowhereSeen), 1500U);
  EXPECT_EQ(cells_in(free_.passed, kNowhereSeen), 0U);
  EXPECT_EQ(cells_in(free_.occupied, kGhost), 0U);
  EXPECT_GT(cells_in(free_.passed, kGhost), 1500U);
  EXPECT_NE(map_.occupied.hash(), matched);
  EXPECT_EQ(cells_in(map_.occupied, kNowhereSeen), 0U) << "no laser sees it";
}

TEST_F(MapEdit, IsInTheOctomap) {
  start();
  start_export();
  drive_twice();
  run(100);
  const Eigen::Vector3d hit(2.01, 1.5, 0.35);
  ASSERT_EQ(in_octomap(hit), true);
  send(wish(EditKind::kErase));
  send(wish(EditKind::kKeepBlocked, kNowhereSeen));
  run(100);
  EXPECT_NE(in_octomap(hit), true);
  EXPECT_EQ(in_octomap(kNowhereSeen.center()), true);
  drive(3, -3.0);
  run(100);
  EXPECT_NE(in_octomap(hit), true);
}

TEST_F(MapEdit, IsAskedForByAnOctomapThatMissedIt) {
  start_and_drive();
  send(wish(EditKind::kErase));
  send(wish(EditKind::kKeepBlocked, kNowhereSeen));
  start_export();
  run(200);
  EXPECT_NE(in_octomap({2.01, 1.5, 0.35}), true);
  EXPECT_EQ(in_octomap({2.01, 4.5, 0.35}), true);
  EXPECT_EQ(in_octomap(kNowhereSeen.center()), true);
}

// Made up, or of another state of the map.
TEST_F(MapEdit, IsLeftOutOfTheOctomapWhereTheMapperKnowsNothingOfIt) {
  start();
  start_export();
  drive_twice();
  bus::EditedBoxes boxes;
  boxes.map_id = assembler_.held()->map_id;
  boxes.edits = 1;
  boxes.ids = {1};
  boxes.boxes = {{EditKind::kErase, kGhost}};
  export_bus_.publish(bus::kMapEdits, bus::to_message(boxes));
  run(100);
  EXPECT_EQ(in_octomap({2.01, 1.5, 0.35}), true);
}

}  // namespace
}  // namespace voxlist::services
