#include "services/voxlist/maps/laser_drive.h"

#include <limits>
#include <utility>

#include "services/voxlist/output/stop.h"
#include "voxlist/bus/convert.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/matching/scan/floor.h"

namespace voxlist::desk {
namespace {

// Scans that come sooner after the last one are left out: they take time and tell no more.
constexpr std::int64_t kPeriod_us = 180'000;

// Takes records until it has seen so many scans.
class Watcher {
 public:
  explicit Watcher(std::size_t scans) : most_(scans) {}
  virtual ~Watcher() = default;

  SeenDrive watch(Recording& recording) {
    while (seen_.scans < most_ && !stop_requested()) {
      const auto record = recording.next();
      if (!record) break;
      std::visit(*this, *record);
    }
    return std::move(seen_);
  }

  void operator()(const CloudRecord& record) {
    if (record.message.utime - last_us_ < kPeriod_us) return;
    const auto received = bus::from_message(record.message);
    if (!received.cloud) return;
    last_us_ = record.message.utime;
    ++seen_.scans;
    if (const auto floor = matching::find_floor(*received.cloud))
      seen_.floors.push_back(floor->level);
    place(*received.cloud);
  }
  void operator()(const OdometryRecord& record) {
    const auto pose = bus::from_message(record.message);
    auto& odometry = seen_.drive.odometry;
    if (!pose || (!odometry.empty() && pose->utime_us <= odometry.back().utime_us)) return;
    odometry.push_back({pose->utime_us, to_pose2(pose->pose)});
  }
  void operator()(const TruthRecord&) {}
  void operator()(const RawRecord&) {}

 protected:
  virtual void place(const Cloud&) {}

  SeenDrive seen_;

 private:
  const std::size_t most_;
  std::int64_t last_us_ = 0;
};

class Mapper : public Watcher {
 public:
  explicit Mapper(const matching::LocaliserConfig& config)
      : Watcher(std::numeric_limits<std::size_t>::max()), localiser_(builder_.map(), config) {}

 private:
  void place(const Cloud& cloud) override {
    const matching::Localisation found = localiser_.localise(cloud);
    if (!found.tracking()) return;
    const Pose2& pose = found.modes.front().T_map_base;
    seen_.drive.scans.push_back({cloud.utime_us, pose});
    if (!builder_.wants(cloud, pose)) return;
    builder_.add({to_pose3(pose), cloud});
    localiser_.map_changed(builder_.changed_blocks());
  }

  mapping::MapBuilder builder_;
  matching::Localiser localiser_;
};

}  // namespace

SeenDrive see_floors(Recording& recording, std::size_t scans) {
  return Watcher(scans).watch(recording);
}

SeenDrive see_drive(Recording& recording, const matching::LocaliserConfig& localiser) {
  return Mapper(localiser).watch(recording);
}

}  // namespace voxlist::desk
