// Drives between two floors by a ramp: what is mapped of them in six degrees of freedom, what
// single scans are found, and what is claimed of a robot that a lift carries to the other floor.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "services/voxlist/maps/map_run.h"
#include "tests/bench/ramps/ramp_drive.h"
#include "tests/bench/ramps/two_floors.h"
#include "tests/bench/report.h"
#include "tests/temporary_folder.h"
#include "voxlist/geometry/angle.h"
#include "voxlist/mapping/keyframe_spool.h"

namespace voxlist::bench {
namespace {

using matching::Localisation;
using matching::LocaliserConfig;

constexpr std::int64_t kStep_us = 300'000;
constexpr double kStep_m = 0.3;
// A pose is wrong where it is off by more (m, rad).
constexpr double kWrong_m = 0.3, kWrong_rad = 3.0 * kRadPerDeg;

struct Kind {
  const char* name;
  TiltUse tilt;
  bool odometry;
  RoundLaser laser;
};

constexpr RoundLaser kRings{7200, 16}, kSphere{5000, 0};
constexpr Kind kKinds[] = {{"16 rings, refine, odometry", TiltUse::kRefine, true, kRings},
                           {"16 rings, refine, no odometry", TiltUse::kRefine, false, kRings},
                           {"16 rings, odometry's tilt", TiltUse::kOdometry, true, kRings},
                           {"all round, refine, odometry", TiltUse::kRefine, true, kSphere},
                           {"16 rings, planar, odometry", TiltUse::kPlanar, true, kRings}};

class Errors {
 public:
  explicit Errors(bool lists = false) : lists_(lists) {}

  void add(const Pose3& found, const Pose3& truth, std::int64_t number) {
    const Pose3 off = truth.inverse() * found;
    const double m = off.translation().norm(), rad = Eigen::AngleAxisd(off.linear()).angle();
    ++n_;
    squares_m2_ += m * m;
    squares_rad2_ += rad * rad;
    worst_m_ = std::max(worst_m_, m);
    wrong_ += m > kWrong_m || rad > kWrong_rad ? 1 : 0;
    if (lists_) list(number, off, truth);
  }

  std::vector<Figure> figures(const std::string& scene, const std::string& of) const {
    const double n = std::max(1, n_);
    return {{scene, "ramps", of, static_cast<double>(n_)},
            {scene, "ramps", of + "_wrong", static_cast<double>(wrong_)},
            {scene, "ramps", of + "_rmse_m", std::sqrt(squares_m2_ / n)},
            {scene, "ramps", of + "_rmse_deg", std::sqrt(squares_rad2_ / n) / kRadPerDeg},
            {scene, "ramps", of + "_worst_m", worst_m_}};
  }

 private:
  static void list(std::int64_t number, const Pose3& off, const Pose3& truth) {
    const Eigen::Vector3d p = truth.translation(), t = off.translation();
    std::printf("  %lld at %.1f %.1f %.2f off %.3f %.3f %.3f, %.2f deg\n",
                static_cast<long long>(number), p.x(), p.y(), p.z(), t.x(), t.y(), t.z(),
                Eigen::AngleAxisd(off.linear()).angle() / kRadPerDeg);
  }

  bool lists_;
  int n_ = 0, wrong_ = 0;
  double squares_m2_ = 0.0, squares_rad2_ = 0.0, worst_m_ = 0.0;
};

Pose3 pose_of(const Localisation& found) {
  return to_pose3(found.modes.front().T_map_base, found.modes.front().tilt);
}

class Run {
 public:
  Run(const TwoFloors& floors, const Kind& kind, std::uint64_t seed, bool lists)
      : lists_(lists),
        floors_(floors),
        kind_(kind),
        seed_(seed),
        drive_(ramp_drive(floors.drive(kStep_m), seed)),
        run_(config(), {}, spool_) {}

  std::vector<Figure> measure(const std::string& scene) {
    const double start_ms = cpu_ms();
    map_drive();
    const double scans = static_cast<double>(drive_.truth.size());
    std::vector<Figure> figures{{scene, "ramps", "scans", scans},
                                {scene, "ramps", "scan_ms", (cpu_ms() - start_ms) / scans}};
    for (const auto& [of, errors] : {std::pair("placed", placed()), std::pair("single", singles()),
                                     std::pair("lift", lifts())}) {
      const auto more = errors.figures(scene, of);
      figures.insert(figures.end(), more.begin(), more.end());
    }
    return figures;
  }

 private:
  LocaliserConfig config() const {
    LocaliserConfig config;
    config.tilt = kind_.tilt;
    return config;
  }

  Cloud scan(const Pose3& pose, std::uint64_t noise, std::int64_t utime_us) const {
    Cloud cloud = floors_.world().scan(pose, kind_.laser, seed_ * 100'000 + noise);
    cloud.utime_us = utime_us;
    return cloud;
  }

  void map_drive() {
    for (std::size_t i = 0; i < drive_.truth.size(); ++i) {
      const auto number = static_cast<std::int64_t>(i);
      desk::Scan scan{number, this->scan(drive_.truth[i], i, kStep_us * number), {}, {}};
      if (kind_.odometry) scan.T_odom_base = drive_.T_odom_base[i];
      if (kind_.odometry) scan.odometry_tilt = drive_.odometry_tilt[i];
      run_.localise(scan);
    }
    run_.finish();
    const StampedPose3 first = run_.trajectory().front();
    T_world_map_ = truth_at(first.utime_us) * first.pose.inverse();
  }

  const Pose3& truth_at(std::int64_t utime_us) const {
    return drive_.truth[static_cast<std::size_t>(utime_us / kStep_us)];
  }

  Errors placed() const {
    Errors errors(lists_);
    for (const StampedPose3& pose : run_.trajectory())
      errors.add(T_world_map_ * pose.pose, truth_at(pose.utime_us), pose.utime_us / kStep_us);
    return errors;
  }

  // Claims of single scans on the way, each searched for in the whole map.
  Errors singles() const {
    matching::Localiser localiser(run_.builder().map(), config());
    Errors errors(lists_);
    for (std::size_t i = 3; i < drive_.truth.size(); i += 9) {
      const Localisation found = localiser.locate(scan(drive_.truth[i], 50'000 + i, 0));
      if (found.tracking())
        errors.add(T_world_map_ * pose_of(found), drive_.truth[i], static_cast<std::int64_t>(i));
    }
    return errors;
  }

  // Claims after ten scans on one floor and a ride to the same place on the other one.
  Errors lifts() const {
    Errors errors(lists_);
    for (const double from_m : {0.0, floors_.upper_m()}) {
      matching::Localiser localiser(run_.builder().map(), config());
      for (int i = 0; i < 24; ++i) {
        const double floor_m = i < 10 ? from_m : floors_.upper_m() - from_m;
        const Pose3 truth = floors_.standing({-2.0 + 0.2 * i, 0.3, 0.2}, floor_m + 1.2);
        const Cloud cloud = scan(truth, 90'000 + static_cast<std::uint64_t>(i), kStep_us * (i + 1));
        const auto T_odom_base =
            kind_.odometry ? std::optional(Pose2{0.2 * i, 0.0, 0.0}) : std::nullopt;
        const auto tilt = kind_.odometry ? std::optional(Tilt{}) : std::nullopt;
        const Localisation found = localiser.localise(cloud, T_odom_base, tilt);
        if (i >= 10 && found.tracking()) errors.add(T_world_map_ * pose_of(found), truth, i);
      }
    }
    return errors;
  }

  const bool lists_;
  const TwoFloors& floors_;
  const Kind kind_;
  const std::uint64_t seed_;
  const RampDrive drive_;
  const test::TemporaryFolder folder_;
  mapping::KeyframeSpool spool_{folder_.path()};
  desk::MapRun run_;
  Pose3 T_world_map_ = Pose3::Identity();
};

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist;
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  const double slope_deg = argc > 1 ? std::atof(argv[1]) : 8.0;
  const auto first = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 1),
             last = argc > 3 ? static_cast<std::uint64_t>(std::atoi(argv[3])) : first;
  const std::string only = argc > 4 ? argv[4] : "";
  const bool lists = argc > 5 && std::string(argv[5]) == "list";
  std::vector<Figure> figures;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const TwoFloors floors({slope_deg * kRadPerDeg, seed});
    for (const Kind& kind : kKinds) {
      const std::string scene = std::string(kind.name) + ", seed " + std::to_string(seed);
      if (scene.find(only) == std::string::npos) continue;
      const auto measured = bench::Run(floors, kind, seed, lists).measure(scene);
      print(scene, measured);
      std::fflush(stdout);
      figures.insert(figures.end(), measured.begin(), measured.end());
    }
  }
  if (csv) append_csv(*csv, "bench_ramps", figures);
}
