// The mapper's map when its loops are closed: in its folder, and for who listens.
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "services/mapper/mapper_service.h"
#include "tests/services/mapper/bent_drive.h"
#include "tests/stored_map.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::services {
namespace {

// The service, and a test that plays localiser and listener.
class Scene {
 public:
  explicit Scene(const std::string& folder) {
    MapperServiceConfig config;
    config.folder = folder;
    config.close_loops = LoopUse::kOnStop;
    config.last_loops_s = 600.0;  // however slow the machine is
    config.builder.min_news = 0.0;
    bus_.subscribe(bus::kMapUpdate, [this](const map_update_t& m) { take(m); });
    service.emplace(bus_, health_, config);
    map_request_t request{};
    request.want = map_request_t::WANT_MAP;
    bus_.publish(bus::kMapRequest, request);
    run();
  }

  void run() {
    for (int i = 0; i < 30; ++i) {  // large changes are sent in paces
      bus_.handle(std::chrono::milliseconds(0));
      service->tick(now_us_ += 20'000);
    }
    bus_.handle(std::chrono::milliseconds(0));
  }

  // A cloud, and what the localiser says of it.
  void drive(const mapping::Keyframe& keyframe) {
    bus_.publish(bus::kCloud, bus::to_message(keyframe.cloud, "base", 0));
    localisation_t message{};
    message.utime = keyframe.cloud.utime_us;
    message.map_id = assembler.held()->map_id;
    message.map_version = assembler.held()->version;
    message.state = localisation_t::STATE_TRACKING;
    message.n_modes = 1;
    message.modes.resize(1);
    const Pose2 pose = to_pose2(keyframe.T_map_base);
    message.modes[0].pose[0] = pose.x_m;
    message.modes[0].pose[1] = pose.y_m;
    message.modes[0].pose[2] = pose.yaw_rad;
    bus_.publish(bus::kLocalisation, message);
    run();
  }

  std::optional<MapperService> service;
  bus::MapAssembler assembler;
  OccupancyMap map;
  std::vector<bus::MapChange> changes;

 private:
  void take(const map_update_t& message) {
    for (bus::MapChange& change : assembler.add(message)) {
      bus::apply(change, map);
      changes.push_back(std::move(change));
    }
  }

  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"mapper"};
  std::int64_t now_us_ = 1'700'000'000'000'000;
};

// As the desk tool closes them.
mapping::MapBuilder closed_at_the_desk(const BentDrive& drive) {
  mapping::MapKeyframes keyframes;
  for (std::size_t i = 0; i < drive.size(); ++i)
    keyframes.push_back({drive.keyframe(i).cloud.utime_us, drive.bent[i]});
  const auto closing = mapping::close_sessions(
      keyframes, [&](std::size_t i) { return drive.keyframe(i).cloud; }, {});
  mapping::MapBuilder builder;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    mapping::Keyframe keyframe = drive.keyframe(i);
    mapping::stand_at(closing.poses[i], keyframe.T_map_base);
    builder.add(std::move(keyframe));
  }
  return builder;
}

TEST(ClosedMap, IsTheDesksForListenersAndInTheFolderAndAtTheNextStart) {
  const BentDrive drive;
  const test::TemporaryFolder folder;
  std::optional<Scene> live(std::in_place, folder.string());
  for (std::size_t i = 0; i < drive.size(); ++i) live->drive(drive.keyframe(i));
  const OccupancyMap before = live->map;
  live->service->stop();
  for (int i = 0; i < 10; ++i) live->run();

  const mapping::MapBuilder desk = closed_at_the_desk(drive);
  EXPECT_LT(mapping::rmse_m(planar(desk.poses()), drive.truth), 0.03);
  EXPECT_NE(before.occupied.hash(), desk.map().occupied.hash());
  EXPECT_EQ(live->map.occupied.hash(), desk.map().occupied.hash());
  EXPECT_EQ(live->map.passed.hash(), desk.map().passed.hash());
  const bus::MapChange& change = live->changes.back();
  EXPECT_EQ(change.moves, 1);
  EXPECT_EQ(change.version, static_cast<std::int64_t>(drive.size()) + 1);
  EXPECT_EQ(change.base_version, static_cast<std::int64_t>(drive.size()));
  EXPECT_LT(distance_m(change.T_new_old * drive.bent.back(), planar(desk.poses()).back()), 1e-6);
  const auto trajectory = test::load_map(folder.string()).keyframes;
  ASSERT_EQ(trajectory.size(), drive.size());
  live.reset();

  Scene again(folder.string());
  for (int i = 0; i < 10; ++i) again.run();
  ASSERT_TRUE(again.assembler.held());
  EXPECT_EQ(again.map.occupied.hash(), desk.map().occupied.hash());
  EXPECT_EQ(again.assembler.held()->version, static_cast<std::int64_t>(drive.size()) + 1);
  mapping::Keyframe more = drive.keyframe(1);
  more.cloud.utime_us += 1'000'000'000;
  again.drive(more);
  EXPECT_EQ(again.assembler.held()->version, static_cast<std::int64_t>(drive.size()) + 2);
}

}  // namespace
}  // namespace voxlist::services
