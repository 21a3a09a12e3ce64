#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/octomap_export/edit_follower.h"
#include "services/octomap_export/keyframe_queue.h"
#include "voxlist/bus/channels.h"
#include "voxlist/planning/octomap.h"
#include "voxlist/service/inputs/mapper_word.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Settings of the OctoMap export.
struct OctomapExportConfig {
  std::string folder;
  double save_period_s = 30.0;
  planning::OctomapConfig octomap;

  template <class Visitor>
  void visit(Visitor& v) {
    v("folder", folder,
      "for map.bt and map.ot, in the state folder if relative; made if it is not there; "
      "empty: no files");
    v("save_period_s", save_period_s,
      "files are written this often if something changed; 0: only on stop", 0.0, 86'400.0);
    octomap.visit(v);
  }
};

/// Inserts the mapper's keyframes into an OctoMap, in their order, and hands it on as OCTOMAP and
/// as files.
class OctomapExportService {
 public:
  OctomapExportService(bus::Bus& bus, bus::Health& health, const OctomapExportConfig& config);

  /// Inserts one keyframe at most, asks for what is missing, and publishes and saves what is due.
  void tick(std::int64_t now_us);

  /// Saves what has changed since it was last saved. Throws std::runtime_error when that fails.
  void stop();

 private:
  // Published and saved when something changed, but not more often than its period, and not for
  // more than a tenth of the time.
  struct Pending {
    bool changed = false;
    std::optional<std::int64_t> last_us;
    std::int64_t took_us = 0;

    bool due(std::int64_t now_us, std::int64_t period_us) const {
      return changed && (!last_us || now_us - *last_us >= std::max(period_us, 10 * took_us));
    }
  };

  void take(const keyframe_t& message);
  void take_word(const map_update_t& message);
  void follow_word();
  bool is_credible(const bus::PosedCloud& keyframe);
  bool is_contradicted_by(const bus::PosedCloud& keyframe);
  void settle_suspicion(std::int64_t now_us);
  void insert(const bus::PosedCloud& keyframe);
  void follow_edits(std::int64_t now_us);
  bool has_edits() const;
  void note_change();
  std::optional<std::int32_t> missing() const;
  void ask(std::int32_t first, std::int64_t now_us);
  void request(std::int32_t want, std::int32_t first, std::int64_t utime_us);
  void publish(std::int64_t now_us);
  void send(const std::vector<std::uint8_t>& bytes);
  void save(std::int64_t now_us);
  void write_files() const;
  void report();

  bus::Bus& bus_;
  bus::Health& health_;
  const OctomapExportConfig config_;
  const std::filesystem::path folder_;
  const planning::OctomapCut cut_;
  KeyframeQueue queue_;
  planning::OctomapBuilder builder_;
  // Map and time of the newest keyframe inserted.
  std::int64_t map_id_ = 0, utime_us_ = 0;
  std::int64_t keyframes_ = 0;
  Pending publishing_, saving_;
  std::vector<std::uint8_t> published_;  // the bytes of the last OCTOMAP
  std::int64_t published_map_id_ = 0;
  std::optional<std::int64_t> quiet_since_us_;  // last keyframe inserted, or asked for
  std::int32_t asked_up_to_ = -1;               // index after the last one that was asked for
  service::MapperWord word_;
  EditFollower edits_;
  std::int64_t moves_ = 0;  // how often the keyframes were moved, as the mapper says
  std::int64_t now_us_ = 0;
  // A keyframe that another one was handed out instead of: who is right, the mapper is asked.
  struct Suspicion {
    std::int32_t index;
    std::int64_t since_us;
    bool is_asked = false, is_repeated = false;
  };
  std::optional<Suspicion> suspicion_;
  std::string save_error_;
};

}  // namespace voxlist::services
