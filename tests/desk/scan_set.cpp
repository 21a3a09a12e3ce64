#include "tests/desk/scan_set.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "services/voxlist/commands/desk.h"
#include "services/voxlist/output/console.h"
#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::test {
namespace {

namespace fs = std::filesystem;

// A table of poses in the making.
class PoseCsv {
 public:
  PoseCsv(const fs::path& path, const std::string& header) : file_(path) {
    file_.precision(17);
    file_ << header << '\n';
  }
  void add(const std::string& first_cells, const StampedPose2& stamped) {
    file_ << first_cells << stamped.utime_us << ',' << stamped.pose.x_m << ',' << stamped.pose.y_m
          << ',' << stamped.pose.yaw_rad << '\n';
  }

 private:
  std::ofstream file_;
};

// Writes each event of a run into its file.
class ScanSetWriter {
 public:
  explicit ScanSetWriter(const fs::path& folder)
      : folder_(folder),
        poses_(folder / "poses.csv", "index,utime_us,x_m,y_m,yaw_rad"),
        odometry_(folder / "odometry.csv", "utime_us,x_m,y_m,yaw_rad") {}

  void operator()(const simulation::SimulatedOdometry& event) { odometry_.add("", event.measured); }
  void operator()(const simulation::SimulatedTruth& event) {
    poses_.add(std::to_string(scans_) + ",", event.pose);
  }
  void operator()(const Cloud& cloud) {
    io::write_ply(folder_ / ("scan_" + std::to_string(scans_++) + ".ply"), cloud);
  }
  void operator()(const LaserLine&) {}  // none: the run yields clouds
  void operator()(const simulation::SimulatedClockEdge&) {}

 private:
  const fs::path folder_;
  PoseCsv poses_, odometry_;
  int scans_ = 0;
};

}  // namespace

WorkFolder::WorkFolder() {
  std::string name = (fs::temp_directory_path() / "voxlist_desk_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  path_ = name;
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void make_scan_set(const std::string& folder) {
  fs::create_directories(folder);
  simulation::SimulationConfig config;  // its seeds are fixed
  config.duration_s = kScans;
  simulation::SimulatedRun simulation(config);
  ScanSetWriter writer(folder);
  while (const auto event = simulation.next()) std::visit(writer, *event);
}

DeskRun run(std::vector<std::string> arguments) {
  std::ostringstream out, err;
  desk::Console console(out, err, false);
  const int exit_code = desk::run_desk(std::move(arguments), console);
  return {exit_code, out.str(), err.str()};
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::vector<std::string> read_lines(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

}  // namespace voxlist::test
