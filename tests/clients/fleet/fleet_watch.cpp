// What a robot of a simulated fleet says, beside the truth. Listens on the robot's own bus until it
// is ended, or for SECONDS. Usage: fleet_watch FILE [SECONDS]
//
// It writes where the robot is first, as soon as it knows: start X Y YAW.
//
// FILE gets the true pose at each cloud, a line each: UTIME X Y YAW. At the end it writes a line
// for each answer of the localiser, then what there was, and of each other robot whose TRUTH a
// relay brings, in how many clouds there are points on its body, and how often something moved
// there:
//   UTIME STATE ERROR_M
//   sum ANSWERS tracking N wrong N
//   seen NAME N moving N
// Wrong: more than 0.3 m or 6 degrees off, in the map whose frame its first TRACKING pose tells.
// The bus is LCM_DEFAULT_URL's.
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <voxlist/localisation_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"

namespace {

using namespace voxlist;

constexpr double kWrong_m = 0.3, kWrong_rad = 0.1;

// What is so near to a robot's middle (m) and so high above the floor belongs to its body; what
// moves so near to it is that robot.
constexpr double kBody_m = 0.35, kLowest_m = 0.1, kHighest_m = 1.0, kSameThing_m = 0.5;

constexpr std::array kOthers = {bus::Channel<pose_t>{"robot_0/TRUTH"},
                                bus::Channel<pose_t>{"robot_1/TRUTH"},
                                bus::Channel<pose_t>{"robot_2/TRUTH"}};

constexpr std::int64_t kApart_us = 50'000;

volatile std::sig_atomic_t ended = 0;

// Poses by time; the later one of the two that a time is between, 20 ms apart. None where some got
// lost.
class Track {
 public:
  void add(const pose_t& message) {
    if (const auto pose = bus::from_message(message)) poses_[pose->utime_us] = to_pose2(pose->pose);
  }

  std::optional<Pose2> at(std::int64_t utime_us) const {
    const auto found = poses_.lower_bound(utime_us);
    if (found == poses_.end() || found->first > utime_us + kApart_us) return std::nullopt;
    return found->second;
  }

  bool empty() const { return poses_.empty(); }

 private:
  std::map<std::int64_t, Pose2> poses_;
};

struct Other {
  Track truth;
  int clouds = 0, moving = 0;
};

class Watch {
 public:
  explicit Watch(const char* file) : file_(file) {
    file_.precision(9);
    bus_.subscribe(bus::kTruth, [this](const pose_t& m) { take_truth(m); });
    bus_.subscribe(bus::kLocalisation, [this](const localisation_t& m) { answers_.push_back(m); });
    bus_.subscribe(bus::kCloud, [this](const pointcloud_t& m) { clouds_.push_back(m); });
    bus_.subscribe(bus::kObstacles, [this](const obstacles_t& m) { obstacles_.push_back(m); });
    for (std::size_t i = 0; i < kOthers.size(); ++i)
      bus_.subscribe(kOthers[i], [this, i](const pose_t& m) { others_[i].truth.add(m); });
  }

  void run(std::chrono::seconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (ended == 0 && std::chrono::steady_clock::now() < end)
      bus_.handle(std::chrono::milliseconds(20));
    for (const localisation_t& answer : answers_) judge(answer);
    for (const pointcloud_t& cloud : clouds_) look_at(cloud);
    for (const obstacles_t& obstacles : obstacles_) look_at(obstacles);
    std::printf("sum %zu tracking %d wrong %d\n", answers_.size(), tracking_, wrong_);
    for (std::size_t i = 0; i < kOthers.size(); ++i)
      if (!others_[i].truth.empty())
        std::printf("seen robot_%zu %d moving %d\n", i, others_[i].clouds, others_[i].moving);
  }

 private:
  void take_truth(const pose_t& message) {
    const bool is_first = truth_.empty();
    truth_.add(message);
    const auto start = truth_.at(message.utime);
    if (!is_first || !start) return;
    std::printf("start %.4f %.4f %.5f\n", start->x_m, start->y_m, start->yaw_rad);
    std::fflush(stdout);
  }

  void judge(const localisation_t& m) {
    const auto truth = truth_.at(m.utime);
    if (!truth) return;
    if (m.state != localisation_t::STATE_TRACKING || m.modes.empty())
      return void(std::printf("%lld doubtful 0\n", static_cast<long long>(m.utime)));
    const double* p = m.modes.front().pose;
    const Pose2 pose{p[0], p[1], p[2]};
    const Pose2 frame = frames_.try_emplace(m.map_id, *truth * pose.inverse()).first->second;
    const Pose2 found = frame * pose;
    const double off_m = distance_m(found, *truth);
    ++tracking_;
    if (off_m > kWrong_m || turn_rad(found, *truth) > kWrong_rad) ++wrong_;
    std::printf("%lld TRACKING %.3f\n", static_cast<long long>(m.utime), off_m);
  }

  void look_at(const pointcloud_t& message) {
    const auto truth = truth_.at(message.utime);
    const auto cloud = bus::from_message(message).cloud;
    if (!truth || !cloud) return;
    file_ << message.utime << ' ' << truth->x_m << ' ' << truth->y_m << ' ' << truth->yaw_rad
          << '\n';
    for (Other& other : others_) {
      const auto there = other.truth.at(message.utime);
      if (there && has_points_on(*cloud, truth->inverse() * *there)) ++other.clouds;
    }
  }

  static bool has_points_on(const Cloud& cloud, const Pose2& T_base_other) {
    return std::ranges::any_of(cloud.points, [&](const Eigen::Vector3f& p) {
      return p.z() > kLowest_m && p.z() < kHighest_m &&
             std::hypot(p.x() - T_base_other.x_m, p.y() - T_base_other.y_m) < kBody_m;
    });
  }

  void look_at(const obstacles_t& message) {
    const auto truth = truth_.at(message.utime);
    if (!truth) return;
    for (Other& other : others_) {
      const auto there = other.truth.at(message.utime);
      if (!there) continue;
      const Pose2 T_base_other = truth->inverse() * *there;
      for (const moving_obstacle_t& thing : message.moving)
        if (std::hypot(thing.position[0] - T_base_other.x_m, thing.position[1] - T_base_other.y_m) <
            kSameThing_m)
          ++other.moving;
    }
  }

  bus::Bus bus_{{.url = std::getenv("LCM_DEFAULT_URL"), .prefix = ""}};
  std::ofstream file_;
  Track truth_;
  std::array<Other, kOthers.size()> others_;
  std::vector<localisation_t> answers_;
  std::vector<pointcloud_t> clouds_;
  std::vector<obstacles_t> obstacles_;
  std::map<std::int64_t, Pose2> frames_;
  int tracking_ = 0, wrong_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::getenv("LCM_DEFAULT_URL") == nullptr) return 2;
  std::signal(SIGTERM, [](int) { ended = 1; });
  Watch(argv[1]).run(std::chrono::seconds(argc > 2 ? std::atoi(argv[2]) : 600));
  return 0;
}
