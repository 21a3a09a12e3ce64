// What localiser and mapper make of a robot without odometry that leaves its map: it is covered
// between two rooms of a simulated floor, maps the second one, and comes back by its doors or
// covered again, or does not. Usage: bench_apart [FIRST_SEED [SEEDS]]
#include <fmt/core.h>

#include <cstdlib>
#include <map>
#include <string>

#include "services/mapper/apart/apart_file.h"
#include "tests/services/localiser_and_mapper.h"
#include "tests/simulation/room_drive.h"
#include "tests/temporary_folder.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::services {
namespace {

// Farther off (m) a pose is wrong.
constexpr double kWrong_m = 0.3;

enum class Return { kByDoors, kByAnotherRoom, kCovered };

struct Kind {
  const char* name;
  Return way;
  bool is_saved;  // the mapper was started anew before it left
};

constexpr Kind kKinds[] = {
    {"back by the doors", Return::kByDoors, false},
    {"back by a third room", Return::kByAnotherRoom, false},
    {"begins elsewhere, a saved map", Return::kByDoors, true},
    {"back covered", Return::kCovered, false},
};

struct Figures {
  int drives = 0, joined = 0, poses = 0, wrong_poses = 0, keyframes = 0, wrong_keyframes = 0;
};

class Drive {
 public:
  Drive(int seed, const Kind& kind)
      : kind_(kind), robot_(seed, [this](auto&... of) { take(of...); }) {
    const std::size_t rooms = robot_.rooms(), first = static_cast<std::size_t>(seed) % rooms;
    go(first, (first + 1 + static_cast<std::size_t>(seed) % 3) % rooms, (first + 4) % rooms);
  }

  void count(Figures& figures) const {
    ++figures.drives;
    bool joined = false;
    mapping::KeyframeReader reader(folder_.path() / mapping::kKeyframeFile);
    while (const auto keyframe = reader.next()) {
      const std::int64_t utime_us = keyframe->cloud.utime_us;
      ++figures.keyframes;
      figures.wrong_keyframes += is_wrong(utime_us, to_pose2(keyframe->T_map_base));
      joined = joined || (utime_us > left_us_ && utime_us < back_us_);
    }
    figures.joined += joined;
    for (const pose_t& pose : live_.poses) {
      ++figures.poses;
      figures.wrong_poses += is_wrong(pose.utime, {pose.pos[0], pose.pos[1], 0.0});
    }
  }

 private:
  void go(std::size_t first, std::size_t second, std::size_t third) {
    robot_.stand_in(first);
    robot_.look_round(first);
    if (kind_.is_saved) {
      live_.start_mapper();
      live_.start_localiser();
    }
    robot_.drive(first, second, true);
    left_us_ = truth_.rbegin()->first;
    robot_.look_round(second);
    back_us_ = truth_.rbegin()->first;
    if (kind_.way == Return::kByAnotherRoom) {
      robot_.drive(second, third, false);
      robot_.look_round(third);
      second = third;
    }
    robot_.drive(second, first, kind_.way == Return::kCovered);
    robot_.look_round(first);
    robot_.drive(first, first, false);
    robot_.look_round(first);
  }

  void take(const Cloud& cloud, const Pose2& truth) { truth_[live_.send(cloud)] = truth; }

  bool is_wrong(std::int64_t utime_us, const Pose2& told) const {
    const Pose2 truth = truth_.begin()->second.inverse() * truth_.at(utime_us);
    return distance_m(told, truth) > kWrong_m;
  }

  const Kind kind_;
  const test::TemporaryFolder folder_;
  LocaliserAndMapper live_{folder_.string()};
  std::map<std::int64_t, Pose2> truth_;
  simulation::RoomDrive robot_;
  std::int64_t left_us_ = 0, back_us_ = 0;
};

void run(int first, int seeds) {
  fmt::print("{:32}{:>8}{:>8}{:>8}{:>8}{:>11}{:>8}\n", "", "drives", "joined", "poses", "wrong",
             "keyframes", "wrong");
  for (const Kind& kind : kKinds) {
    Figures figures;
    for (int seed = first; seed < first + seeds; ++seed) Drive(seed, kind).count(figures);
    fmt::print("{:32}{:8}{:8}{:8}{:8}{:11}{:8}\n", kind.name, figures.drives, figures.joined,
               figures.poses, figures.wrong_poses, figures.keyframes, figures.wrong_keyframes);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace voxlist::services

int main(int argc, char** argv) {
  voxlist::services::run(argc > 1 ? std::atoi(argv[1]) : 1, argc > 2 ? std::atoi(argv[2]) : 3);
}
