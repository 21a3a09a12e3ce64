// A drive round a block by two ramps: how far off its poses are as they were tracked, and when its
// loops are closed.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "services/voxlist/maps/map_run.h"
#include "tests/bench/ramps/ramp_drive.h"
#include "tests/bench/ramps/ramp_ring.h"
#include "tests/bench/report.h"
#include "tests/temporary_folder.h"
#include "voxlist/geometry/angle.h"
#include "voxlist/mapping/keyframe_spool.h"

namespace voxlist::bench {
namespace {

constexpr std::int64_t kStep_us = 300'000;
constexpr double kStep_m = 0.3;

struct Kind {
  const char* name;
  bool odometry;
  RoundLaser laser;
};

constexpr Kind kKinds[] = {{"16 rings, odometry", true, {7200, 16}},
                           {"16 rings, no odometry", false, {7200, 16}},
                           {"all round, odometry", true, {5000, 0}},
                           {"all round, no odometry", false, {5000, 0}}};

// Root mean squares by axis: the first pose is right.
std::vector<Figure> errors(const std::string& scene, const std::string& when,
                           const std::vector<StampedPose3>& found,
                           const std::vector<Pose3>& truth) {
  const auto at = [&](const StampedPose3& pose) -> const Pose3& {
    return truth[static_cast<std::size_t>(pose.utime_us / kStep_us)];
  };
  const Pose3 T_world_map = at(found.front()) * found.front().pose.inverse();
  Eigen::Array4d squares = Eigen::Array4d::Zero();
  for (const StampedPose3& pose : found) {
    const Pose3 is = T_world_map * pose.pose;
    const Eigen::Vector3d off = is.translation() - at(pose).translation();
    const double lean = std::acos(std::min(1.0, is.linear().col(2).dot(at(pose).linear().col(2))));
    squares += Eigen::Array4d(off.x(), off.y(), off.z(), lean).square();
  }
  const Eigen::Array4d rmse = (squares / static_cast<double>(found.size())).sqrt();
  return {{scene, "ramp_ring", when + "_placed", static_cast<double>(found.size())},
          {scene, "ramp_ring", when + "_rmse_x_m", rmse[0]},
          {scene, "ramp_ring", when + "_rmse_y_m", rmse[1]},
          {scene, "ramp_ring", when + "_rmse_z_m", rmse[2]},
          {scene, "ramp_ring", when + "_rmse_tilt_deg", rmse[3] / kRadPerDeg}};
}

std::vector<Figure> measure(const std::string& scene, const RampRing& ring, const Kind& kind,
                            std::uint64_t seed) {
  const RampDrive drive = ramp_drive(ring.drive(kStep_m), seed);
  const test::TemporaryFolder folder;
  mapping::KeyframeSpool spool(folder.path());
  matching::LocaliserConfig config;
  config.tilt = TiltUse::kRefine;
  desk::MapRun run(config, {}, spool);
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i);
    desk::Scan scan{
        number, ring.world().scan(drive.truth[i], kind.laser, seed * 100'000 + i), {}, {}};
    scan.cloud.utime_us = kStep_us * number;
    if (kind.odometry) scan.T_odom_base = drive.T_odom_base[i];
    run.localise(scan);
  }
  std::vector<Figure> figures = errors(scene, "tracked", run.trajectory(), drive.truth);
  const double start_ms = cpu_ms();
  run.finish();
  const auto closed = errors(scene, "closed", run.trajectory(), drive.truth);
  figures.insert(figures.end(), closed.begin(), closed.end());
  figures.push_back({scene, "ramp_ring", "loops", static_cast<double>(run.figures().loops)});
  figures.push_back({scene, "ramp_ring", "closing_cpu_s", (cpu_ms() - start_ms) / 1000.0});
  return figures;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist;
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  const auto first = static_cast<std::uint64_t>(argc > 1 ? std::atoi(argv[1]) : 1),
             last = argc > 2 ? static_cast<std::uint64_t>(std::atoi(argv[2])) : first;
  const std::string only = argc > 3 ? argv[3] : "";
  std::vector<Figure> figures;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const RampRing ring({8.0 * kRadPerDeg, seed});
    for (const Kind& kind : kKinds) {
      const std::string scene = std::string(kind.name) + ", seed " + std::to_string(seed);
      if (scene.find(only) == std::string::npos) continue;
      const auto measured = measure(scene, ring, kind, seed);
      print(scene, measured);
      std::fflush(stdout);
      figures.insert(figures.end(), measured.begin(), measured.end());
    }
  }
  if (csv) append_csv(*csv, "bench_ramp_ring", figures);
}
