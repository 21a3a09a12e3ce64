#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <map>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/voxlist/output/stop.h"
#include "tests/desk/scan_set.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;

template <class M>
M decoded(const bus::Event& event) {
  M message;
  EXPECT_EQ(bus::decode(event.bytes, message), bus::Fault::kNone);
  return message;
}

struct Simulate : testing::Test {
  // What a run with these settings wrote.
  std::vector<bus::Event> simulated(const std::string& settings, const std::string& seconds) {
    test::write_text(work / "robot.toml", settings);
    const auto done = test::run({"simulate", "-o", work / "run.lcmlog", "--config",
                                 work / "robot.toml", "--seconds", seconds});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    std::vector<bus::Event> events;
    bus::EventLogReader reader(work / "run.lcmlog");
    while (auto event = reader.next()) events.push_back(std::move(*event));
    return events;
  }

  test::WorkFolder work;
};

std::map<std::string, int> counts(const std::vector<bus::Event>& events) {
  std::map<std::string, int> counts;
  for (const bus::Event& event : events) ++counts[event.channel];
  return counts;
}

TEST_F(Simulate, WritesWhatTheScannersServicesWouldSendInTheOrderOfTime) {
  const auto events = simulated("", "10");
  auto found = counts(events);
  EXPECT_EQ(found["LASER"], 751);
  EXPECT_EQ(found["MIRROR"], 751);
  EXPECT_EQ(found["ODOMETRY"], 501);
  EXPECT_EQ(found["TRUTH"], 501);
  EXPECT_GE(found["CLOUD"], 5);
  EXPECT_GE(found["CLOUD_SLICE"], 14 * found["CLOUD"]);
  for (std::size_t i = 1; i < events.size(); ++i)
    ASSERT_GE(events[i].utime_us, events[i - 1].utime_us);
  for (const bus::Event& event : events) {
    if (event.channel != "LASER") continue;
    EXPECT_EQ(decoded<planar_lidar_t>(event).utime + 21'307, event.utime_us);
  }
}

TEST_F(Simulate, GivesTheSameBytesForTheSameSettings) {
  const std::string settings = "[simulator]\npeople = 1\nstairs = 1\n";
  simulated(settings, "3");
  const std::string first = test::read_text(work / "run.lcmlog");
  simulated(settings, "3");
  EXPECT_EQ(first, test::read_text(work / "run.lcmlog"));
  simulated(settings + "seed = 2\n", "3");
  EXPECT_NE(first, test::read_text(work / "run.lcmlog"));
}

// Root mean square of a log's cloud points from the building's surfaces, for clouds after a time.
double rms_m(const std::vector<bus::Event>& events, const simulation::SimulationConfig& config,
             double from_s) {
  const simulation::SimulatedRun run(config);
  double squares = 0.0, points = 0.0;
  for (const bus::Event& event : events) {
    if (event.channel != "CLOUD") continue;
    const Cloud cloud = *bus::from_message(decoded<pointcloud_t>(event)).cloud;
    const double t_s = static_cast<double>(cloud.utime_us - 1'700'000'000'000'000) * 1e-6;
    if (t_s < from_s) continue;
    const Pose2 T_map_base = run.truth().at(t_s);
    for (const Eigen::Vector3f& point : cloud.points) {
      double nearest = 1.0;
      for (const simulation::Box& box : run.building().solid.boxes())
        nearest = std::min(nearest, box.surface_distance_m(T_map_base * point.cast<double>()));
      squares += nearest * nearest;
      ++points;
    }
  }
  EXPECT_GT(points, 10'000);
  return std::sqrt(squares / points);
}

TEST_F(Simulate, MakesCloudsThatLieOnTheBuildingsSurfaces) {
  const std::string exact = "[simulator]\nrange_sd_m = 0.0\nodometry_errors = 0.0\n";
  simulation::SimulationConfig config;
  config.odometry_errors = 0.0;
  const double driving = rms_m(simulated(exact, "30"), config, 25.0);
  config.stand_in_room = 1;
  const double standing = rms_m(simulated(exact + "stand_in_room = 1\n", "30"), config, 25.0);
  std::cout << "RMS from the surfaces: standing " << standing << " m, driving " << driving
            << " m\n";
  EXPECT_LT(standing, 0.001);
  EXPECT_LT(driving, 0.005);
}

// A simulation with Ctrl-C pressed at its start, and seen: from then on it may take its time.
test::DeskRun interrupted(const std::string& log) {
  stop_on_interrupt();
  std::raise(SIGINT);
  EXPECT_TRUE(stop_requested());
  const test::DeskRun done = test::run({"simulate", "-o", log, "--seconds", "3"});
  stop_on_interrupt();
  EXPECT_EQ(done.exit_code, kInterrupted);
  return done;
}

TEST_F(Simulate, LeavesAnOlderLogAloneWhenInterrupted) {
  simulated("", "1");
  const std::string older = test::read_text(work / "run.lcmlog");
  const auto done = interrupted(work / "run.lcmlog");
  EXPECT_THAT(done.err, HasSubstr((work / "run.lcmlog") + " stays as it was"));
  EXPECT_EQ(done.out, "");
  EXPECT_GT(older.size(), 0u);
  EXPECT_EQ(test::read_text(work / "run.lcmlog"), older);
}

TEST_F(Simulate, WritesTheStartOfALogWhereThereIsNoneWhenInterrupted) {
  const auto done = interrupted(work / "run.lcmlog");
  EXPECT_THAT(done.err, HasSubstr((work / "run.lcmlog") + " ends there"));
  EXPECT_TRUE(std::filesystem::exists(work / "run.lcmlog"));
}

TEST_F(Simulate, TellsAllThatIsWrongWithTheSettingsAndWritesNothing) {
  test::write_text(work / "robot.toml",
                   "[simulator]\npeople = -1\n[cloud_assembler]\nmirror_sides = 3\n");
  const auto done =
      test::run({"simulate", "-o", work / "run.lcmlog", "--config", work / "robot.toml"});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("people"));
  EXPECT_THAT(done.err, HasSubstr("mirror_sides"));
  EXPECT_EQ(test::read_text(work / "run.lcmlog"), "");
}

}  // namespace
}  // namespace voxlist::desk
