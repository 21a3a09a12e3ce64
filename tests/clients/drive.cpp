// Drives a simulated robot past the live services, a cloud every 50 ms (PERIOD_MS), but each cloud
// only when the one before is answered (or the patience, 1500 ms, is over), and compares what the
// localiser says with the truth. Usage: drive FIRST COUNT [PATIENCE_MS [PERIOD_MS]]: the tour's
// clouds FIRST .. FIRST + COUNT - 1, numbered from 0. Writes a line for each answer, and a last
// one:
//   CLOUD STATE MAP_ID VERSION ERROR_M DELAY_MS
//   sum CLOUDS tracking N wrong N unanswered N delay_max_ms N
// Usage: drive check FOLDER: compares a map folder's keyframes with the truth:
//   sum KEYFRAMES wrong N
// Wrong: more than 0.3 m or 6 degrees off. The frame of a map is where its first pose was; the
// frames are kept in drive_frames.txt, for the next drive. The bus is LCM_DEFAULT_URL's, if that is
// set.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <map>
#include <optional>
#include <string>
#include <voxlist/localisation_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "tests/simulation/sphere_scan.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/simulation/run/simulated_run.h"

namespace {

using namespace voxlist;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kBegin_us = 1'700'000'000'000'000;
constexpr double kWrong_m = 0.3, kWrong_rad = 0.1;

// A laser that sees all round, on a robot that takes its time: what is shown here is not how little
// a scan may be. Two packets hold a cloud.
constexpr simulation::SphereScanConfig kLaser{.rays = 5200};

simulation::SimulationConfig tour() {
  simulation::SimulationConfig config;
  config.drive.wait_s = 1.5;
  config.drive.speed_max_mps = 0.3;
  config.drive.turn_rate_max_dps = 25.0;
  return config;
}

// In poses that mislead (the program beside this one) has made up.
constexpr double kMadeUp = -77.0;

std::string url_in_use() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  return url != nullptr ? url : bus::BusOptions{}.url;
}

constexpr const char* kFrames = "drive_frames.txt";

bool is_wrong(const Pose2& pose, const Pose2& truth) {
  return distance_m(pose, truth) > kWrong_m || turn_rad(pose, truth) > kWrong_rad;
}

class Drive {
 public:
  Drive(int first, int count, int patience_ms, int period_ms)
      : first_(first), end_(first + count), patience_(patience_ms), period_(period_ms) {
    bus_.subscribe(bus::kLocalisation, [this](const localisation_t& m) { take(m); });
    std::ifstream file(kFrames);
    Pose2 frame;
    for (std::int64_t id = 0; file >> id >> frame.x_m >> frame.y_m >> frame.yaw_rad;)
      T_truth_map_[id] = frame;
  }

  void run() {
    for (auto event = run_.next(); event && cloud_ < end_; event = run_.next()) {
      if (const auto* odometry = std::get_if<simulation::SimulatedOdometry>(&*event))
        publish(odometry->measured);
      if (const auto* cloud = std::get_if<Cloud>(&*event)) publish(cloud->utime_us);
    }
    std::printf("sum %d tracking %d wrong %d unanswered %d delay_max_ms %d\n", cloud_ - first_,
                tracking_, wrong_, unanswered_, delay_max_ms_);
  }

 private:
  void publish(StampedPose2 odometry) {
    if (cloud_ < first_ - 1) return;
    odometry.utime_us += kBegin_us;
    bus_.publish(bus::kOdometry, bus::to_message(odometry));
  }

  void publish(std::int64_t utime_us) {
    if (cloud_ >= first_) {
      truth_ = run_.truth().at(static_cast<double>(utime_us) * 1e-6);
      const auto seed = static_cast<std::uint64_t>(cloud_);
      Cloud cloud = simulation::scan_sphere(run_.world(), truth_, kLaser, seed);
      asked_us_ = cloud.utime_us = kBegin_us + utime_us;
      const pointcloud_t message = bus::to_message(cloud, "base", cloud_);
      asked_at_ = Clock::now();
      bus_.publish(bus::kCloud, message);
      const auto now = [] { return Clock::now(); };
      is_answered_ = false;
      while ((!is_answered_ && now() < asked_at_ + patience_) || now() < asked_at_ + period_)
        bus_.handle(std::chrono::milliseconds(5));
      if (!is_answered_) ++unanswered_;
      if (!is_answered_) std::printf("%d unanswered\n", cloud_);
      std::fflush(stdout);
    }
    ++cloud_;
  }

  void take(const localisation_t& m) {
    if (m.utime != asked_us_ || m.significance_log10 == kMadeUp) return;
    is_answered_ = true;
    const auto delay =
        std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - asked_at_);
    const int delay_ms = static_cast<int>(delay.count());
    delay_max_ms_ = std::max(delay_max_ms_, delay_ms);
    double error_m = 0.0;
    const bool is_tracking = m.state == localisation_t::STATE_TRACKING;
    if (is_tracking) error_m = judge(m);
    std::printf("%d %s %lld %lld %.3f %d\n", cloud_, is_tracking ? "TRACKING" : "doubtful",
                static_cast<long long>(m.map_id), static_cast<long long>(m.map_version), error_m,
                delay_ms);
  }

  double judge(const localisation_t& m) {
    const double* p = m.modes.at(0).pose;
    const Pose2 pose{p[0], p[1], p[2]};
    const Pose2 found = T_truth_map(m.map_id, pose) * pose;
    ++tracking_;
    if (is_wrong(found, truth_)) ++wrong_;
    return distance_m(found, truth_);
  }

  Pose2 T_truth_map(std::int64_t map_id, const Pose2& first_pose) {
    const Pose2 frame = truth_ * first_pose.inverse();
    const auto [known, is_new] = T_truth_map_.try_emplace(map_id, frame);
    if (is_new)
      std::ofstream(kFrames, std::ios::app) << std::setprecision(17) << map_id << ' ' << frame.x_m
                                            << ' ' << frame.y_m << ' ' << frame.yaw_rad << '\n';
    return known->second;
  }

  bus::Bus bus_{{.url = url_in_use(), .prefix = ""}};
  simulation::SimulatedRun run_{tour()};
  const int first_, end_;
  int cloud_ = 0, tracking_ = 0, wrong_ = 0, unanswered_ = 0, delay_max_ms_ = 0;
  const std::chrono::milliseconds patience_, period_;
  std::int64_t asked_us_ = 0;
  bool is_answered_ = false;
  Clock::time_point asked_at_;
  Pose2 truth_;
  std::map<std::int64_t, Pose2> T_truth_map_;
};

void check(const std::string& folder) {
  const simulation::SimulatedRun run(tour());
  mapping::KeyframeReader reader(std::filesystem::path(folder) / mapping::kKeyframeFile);
  std::optional<Pose2> T_truth_map;
  int keyframes = 0, wrong = 0;
  while (const auto keyframe = reader.next()) {
    const Pose2 pose = to_pose2(keyframe->T_map_base);
    const double t_s = static_cast<double>(keyframe->cloud.utime_us - kBegin_us) * 1e-6;
    const Pose2 truth = run.truth().at(t_s);
    if (!T_truth_map) T_truth_map = truth * pose.inverse();
    ++keyframes;
    if (is_wrong(*T_truth_map * pose, truth)) ++wrong;
  }
  std::printf("sum %d wrong %d\n", keyframes, wrong);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  if (std::string(argv[1]) == "check")
    check(argv[2]);
  else
    Drive(number(1, 0), number(2, 0), number(3, 1500), number(4, 50)).run();
  return 0;
}
