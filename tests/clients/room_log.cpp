// Writes event logs of a robot that maps a room, is covered on its way to another one and maps that
// (AWAY), and drives back by the doors (BACK): CLOUD, one a second; and where each was taken
// (TRUTH, a TUM file). Usage: room_log AWAY BACK TRUTH
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <voxlist/pointcloud_t.hpp>

#include "tests/simulation/room_drive.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"

namespace {

using namespace voxlist;

class RoomLog {
 public:
  explicit RoomLog(const char* truth) : truth_(std::fopen(truth, "we"), &std::fclose) {}

  void begin(const char* log) { log_ = std::make_unique<bus::EventLogWriter>(log); }

  void take(Cloud cloud, const Pose2& pose) {
    cloud.utime_us = utime_us_ += 1'000'000;
    log_->write(bus::kCloud, utime_us_, bus::to_message(cloud, "base", seq_++));
    std::fprintf(truth_.get(), "%.6f %.4f %.4f 0 0 0 %.6f %.6f\n",
                 static_cast<double>(utime_us_) * 1e-6, pose.x_m, pose.y_m,
                 std::sin(pose.yaw_rad / 2.0), std::cos(pose.yaw_rad / 2.0));
  }

  void end() { log_->close(); }

 private:
  std::unique_ptr<bus::EventLogWriter> log_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> truth_;
  std::int64_t utime_us_ = 1'700'000'000'000'000;
  std::int32_t seq_ = 0;
};

void write(const char* away, const char* back, const char* truth) {
  RoomLog log(truth);
  simulation::RoomDrive drive(1, [&](const Cloud& cloud, const Pose2& at) { log.take(cloud, at); });
  log.begin(away);
  drive.stand_in(0);
  drive.look_round(0);
  drive.drive(0, 1, true);
  drive.look_round(1);
  log.end();
  log.begin(back);
  drive.drive(1, 0, false);
  drive.look_round(0);
  drive.drive(0, 0, false);
  drive.look_round(0);
  log.end();
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) return 2;
  write(argv[1], argv[2], argv[3]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "room_log: %s\n", error.what());
  return 1;
}
