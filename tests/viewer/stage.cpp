// Plays a robot and its services for the page's tests: says on the bus what it is told to on
// standard input, a line each, and writes what others ask.
// Lines: map ROOMS; track X Y YAW; lost; ambiguous; loop; others on, others off: two robots of the
// fleet, robot_b in the same map, robot_c in one of its own. Free space: the rooms up to 2 m, once
// somebody asks for it. Output: ready, then hint X Y YAW SIGMA_RAD; want N; edit ACTION ID X Y Z X
// Y Z.
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_edits_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_hint_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

#include "tests/stand_in_mapper.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/edit_convert.h"
#include "voxlist/bus/maps/map_convert.h"

namespace {

using namespace voxlist;

std::int64_t now_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

// Rooms of 6 x 4 m in a row along x: floor and walls of 2 m.
OccupancyMap building(int rooms) {
  OccupancyMap map{VoxelMap(0.05), VoxelMap(0.1)};
  for (std::int32_t x = 0; x < 120 * rooms; ++x)
    for (std::int32_t y = 0; y < 80; ++y) {
      const bool is_wall = y == 0 || y == 79 || x == 0 || x % 120 == 119;
      for (std::int32_t z = 0; z < (is_wall ? 40 : 1); ++z) map.occupied.insert({x, y, z});
    }
  return map;
}

// What rays have freed of it.
OccupancyMap free_space(int rooms) {
  OccupancyMap cells{VoxelMap(0.08), VoxelMap(0.08)};
  for (std::int32_t x = 0; x < 75 * rooms; ++x)
    for (std::int32_t y = 0; y < 50; ++y) {
      const bool is_wall = y == 0 || y == 49 || x == 0 || x % 75 == 74;
      for (std::int32_t z = 0; z < 25; ++z) {
        const bool is_occupied = is_wall || z == 0;
        (is_occupied ? cells.occupied : cells.passed).insert({x, y, z});
      }
    }
  return cells;
}

class Stage {
 public:
  explicit Stage(std::int64_t map_id) : map_id_(map_id) {
    edits_.map_id = map_id;
    bus_.subscribe(bus::kMapRequest, [this](const map_request_t& m) { take(m); });
    bus_.subscribe(bus::kMapEdit, [this](const map_edit_t& m) { take(m); });
    bus_.subscribe(bus::kPoseHint, [](const pose_hint_t& m) {
      std::printf("hint %.2f %.2f %.2f %.2f\n", m.pose[0], m.pose[1], m.pose[2], m.sigma_rad);
    });
  }

  void run() {
    std::puts("ready");
    while (bus_.handle(std::chrono::milliseconds(100), STDIN_FILENO)) {
      if (!read_lines()) return;
      if (now_us() - said_us_ >= 200'000) say();
      std::fflush(stdout);
    }
  }

 private:
  // Does what stands on standard input by now. False: it has ended.
  bool read_lines() {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, 0) <= 0) return true;
    char more[4096];
    const ssize_t got = read(STDIN_FILENO, more, sizeof more);
    if (got <= 0) return false;
    input_.append(more, static_cast<std::size_t>(got));
    for (auto end = input_.find('\n'); end != std::string::npos; end = input_.find('\n')) {
      obey(input_.substr(0, end));
      input_.erase(0, end + 1);
    }
    return true;
  }

  void obey(const std::string& line) {
    std::istringstream words(line);
    std::string what;
    words >> what;
    if (what == "map") show_map(words);
    if (what == "track") words >> pose_.x_m >> pose_.y_m >> pose_.yaw_rad;
    if (what == "loop") close_loop();
    if (what == "others") words >> others_;
    if (what == "track" || what == "lost" || what == "ambiguous") state_ = what;
  }

  void show_map(std::istringstream& words) {
    int rooms = 0;
    words >> rooms;
    OccupancyMap next = building(rooms);
    bus::MapChange change = whole(next);
    const ChangedBlocks changed = difference(map_, next);
    mapper_ = test::StandInMapper(change);
    change.blocks = bus::to_messages(next, changed);
    bus::MapChange free = change;
    const OccupancyMap cells = free_space(rooms);
    free.resolution = bus::resolution_of(cells);
    free.blocks = bus::to_messages(cells);
    free_ = test::StandInMapper(free);
    if (version_ > 1) change.base_version = version_ - 1;
    for (const auto& message : bus::split_map(change)) bus_.publish(bus::kMapUpdate, message);
    map_ = std::move(next);
  }

  bus::MapChange whole(const OccupancyMap& map) {
    bus::MapChange change;
    change.utime_us = now_us();
    change.map_id = map_id_;
    change.version = ++version_;
    change.resolution = bus::resolution_of(map);
    change.blocks = bus::to_messages(map);
    change.moves = moves_;
    change.T_new_old = {0.25, 0.0, 0.0};
    return change;
  }

  void close_loop() {
    ++moves_;
    bus::MapChange change = whole(map_);
    mapper_ = test::StandInMapper(change);
    change.blocks = {};
    change.base_version = version_ - 1;
    for (const auto& message : bus::split_map(change)) bus_.publish(bus::kMapUpdate, message);
  }

  void take(const map_request_t& request) {
    if (request.want == map_request_t::WANT_MAP || request.want == map_request_t::WANT_WORD) {
      for (const auto& message : mapper_.answer(request)) bus_.publish(bus::kMapUpdate, message);
    } else if (request.want == map_request_t::WANT_FREE_SPACE) {
      for (const auto& message : free_.answer(request)) bus_.publish(bus::kFreeSpace, message);
    } else if (request.want == map_request_t::WANT_EDITS) {
      bus_.publish(bus::kMapEdits, bus::to_message(edits_));
    } else {
      std::printf("want %d\n", request.want);
    }
  }

  void take(const map_edit_t& m) {
    std::printf("edit %d %d %.2f %.2f %.2f %.2f %.2f %.2f\n", m.action, static_cast<int>(m.id),
                m.lowest[0], m.lowest[1], m.lowest[2], m.highest[0], m.highest[1], m.highest[2]);
    edits_.utime_us = now_us();
    ++edits_.edits;
    if (m.action == map_edit_t::REMOVE) {
      edits_.ids.clear();
      edits_.boxes.clear();
    } else if (const auto wish = bus::from_message(m)) {
      edits_.ids.push_back(edits_.edits);
      edits_.boxes.push_back({*wish->kind, wish->box, {}});
    }
    bus_.publish(bus::kMapEdits, bus::to_message(edits_));
  }

  void say() {
    said_us_ = now_us();
    say_health("localiser");
    say_health("mapper");
    if (others_ == "on") {
      say_other("robot_b", map_id_, {5.0, 1.0, 0.0});
      say_other("robot_c", map_id_ + 100, {1.0, 1.0, 0.0});
    }
    if (state_.empty()) return;
    bus_.publish(bus::kCloud, cloud());
    bus_.publish(bus::kLocalisation, localisation());
    if (state_ != "track") return;
    const StampedPose2 pose{said_us_, pose_};
    bus_.publish(bus::kPose, bus::to_message(pose));
    uncertain_pose_t sure{};
    sure.utime = sure.cloud_utime = said_us_;
    sure.map_id = map_id_;
    sure.covariance[0] = sure.covariance[4] = 0.01;
    sure.covariance[8] = 0.001;
    bus_.publish(bus::kPoseCovariance, sure);
    bus_.publish(bus::kObstacles, obstacles());
  }

  // As a relay brings it.
  void say_other(const std::string& name, std::int64_t map_id, const Pose2& pose) {
    localisation_t state{};
    state.utime = said_us_;
    state.map_id = map_id;
    state.state = localisation_t::STATE_TRACKING;
    bus_.publish(bus::Channel<localisation_t>{(name + "/LOCALISATION").c_str()}, state);
    bus_.publish(bus::Channel<pose_t>{(name + "/POSE").c_str()},
                 bus::to_message(StampedPose2{said_us_, pose}));
  }

  void say_health(const char* service) {
    bus::Health health(service);
    health.add_latency_us(1500);
    bus_.publish(bus::kHealth, health.last(said_us_));
  }

  localisation_t localisation() const {
    localisation_t message{};
    message.utime = said_us_;
    message.map_id = map_id_;
    message.map_version = version_;
    message.state = localisation_t::STATE_LOST;
    if (state_ == "track") message.state = localisation_t::STATE_TRACKING;
    if (state_ == "track") message.modes.push_back(mode(pose_, 0.999));
    if (state_ == "ambiguous") message.state = localisation_t::STATE_AMBIGUOUS;
    if (state_ == "ambiguous")
      message.modes = {mode({2.0, 2.0, 0.0}, 0.6), mode({8.0, 2.0, 0.0}, 0.3)};
    message.n_modes = static_cast<std::int32_t>(message.modes.size());
    message.confidence = message.modes.empty() ? 0.0 : message.modes[0].probability;
    return message;
  }

  static pose_mode_t mode(const Pose2& pose, double probability) {
    pose_mode_t mode{};
    mode.pose[0] = pose.x_m;
    mode.pose[1] = pose.y_m;
    mode.pose[2] = pose.yaw_rad;
    mode.covariance[0] = mode.covariance[4] = mode.covariance[8] = 0.01;
    mode.probability = probability;
    return mode;
  }

  pointcloud_t cloud() {
    Cloud cloud;
    cloud.utime_us = said_us_;
    for (int i = 0; i < 200; ++i)
      cloud.points.emplace_back(1.0F, 0.01F * static_cast<float>(i), 0.5F);
    return bus::to_message(cloud, "base", seq_++);
  }

  obstacles_t obstacles() const {
    obstacles_t message{};
    message.utime = said_us_;
    message.n_bearings = 36;
    message.radstep = 0.1745F;
    message.nearest_m.assign(3, std::vector<float>(36, 1.5F));
    message.ground_seen_to_m.assign(36, 1.5F);
    return message;
  }

  bus::Bus bus_{[] {
    bus::BusOptions options;
    if (const char* url = std::getenv("LCM_DEFAULT_URL")) options.url = url;
    return options;
  }()};
  const std::int64_t map_id_;
  OccupancyMap map_{VoxelMap(0.05), VoxelMap(0.1)};
  test::StandInMapper mapper_, free_;
  bus::EditedBoxes edits_;
  std::string input_, state_, others_;
  Pose2 pose_;
  std::int64_t version_ = 0, moves_ = 0, said_us_ = 0;
  std::int32_t seq_ = 0;
};

}  // namespace

// The map's id is the first argument.
int main(int argc, char** argv) { Stage(argc > 1 ? std::atoll(argv[1]) : 1).run(); }
