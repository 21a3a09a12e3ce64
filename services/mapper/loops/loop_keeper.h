#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "services/mapper/loops/background.h"
#include "services/mapper/loops/return_watch.h"
#include "voxlist/mapping/loops/look_memory.h"
#include "voxlist/mapping/loops/session_closing.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::bus {
class Health;
}

namespace voxlist::services {

/// When a map's loops are closed.
enum class LoopUse {
  kNever,
  /// When the mapper stops: its map is then the one that the desk tool makes of the same recording.
  kOnStop,
  /// Also while the robot drives: POSE jumps when it comes round.
  kAlways,
};

inline constexpr std::array kLoopUseNames{"never", "on_stop", "always"};

/// A map whose loops are closed.
struct ClosedMap {
  /// Where each keyframe stands, and what holds it.
  mapping::MapKeyframes keyframes;
  std::vector<mapping::PoseEdge> edges;
  /// What a picture shows of its loops.
  drawing::ClosedLoops drawn;
  /// All keyframes, where they stand.
  mapping::MapBuilder builder;
  /// How the newest one was moved.
  Pose2 T_new_old;
};

/// Closes the loops of the mapper's map in a thread of its own, while the map goes on to grow. The
/// map that comes of it is whole before it is handed out. It is not handed out where nothing moves
/// by more than 1 cm or 0.1 deg.
class LoopKeeper {
 public:
  /// The keyframes on the disk, to be read in another thread.
  using Open = std::function<std::unique_ptr<mapping::StoredKeyframes>()>;

  LoopKeeper(bus::Health& health, LoopUse use, const mapping::MapBuilderConfig& builder);

  /// The map's next keyframe. `T_odom_keyframe`: odometry's pose at its time, if there is any.
  void add(const StampedPose3& T_map_keyframe, const std::optional<Pose2>& T_odom_keyframe);

  /// What a graph of before knows of the next keyframe.
  void restore(const mapping::StoredGraph::Keyframe& keyframe);

  /// Looks for loops are kept in that folder of a map from now on; those that are there, of the
  /// keyframes that were restored, are not taken again.
  void keep_looks(const std::filesystem::path& folder, std::int64_t map_id);

  /// Forgets all keyframes.
  void clear();

  /// What was handed out is the map now.
  void accept(mapping::MapKeyframes keyframes) { keyframes_ = std::move(keyframes); }

  /// Goes on with the work, never for long; what is ready. `open` is called where work begins; its
  /// keyframes must be all that there are.
  std::optional<ClosedMap> tick(std::int64_t now_us, const Open& open);

  /// Waits for the work at hand.
  void wait() { background_.wait(); }

  /// No keyframe comes any more: closes what is open, for so long at most (s).
  std::optional<ClosedMap> finish(const Open& open, double at_most_s);

 private:
  struct Work;

  bool is_worth_it(std::int64_t now_us) const;
  void begin(const Open& open);
  std::optional<ClosedMap> go_on(const Open& open);
  void write_looks(const mapping::MapKeyframes& keyframes);
  void tell(const mapping::SessionClosing& closing);
  bool prepare();
  bool reopen(const Open& open);
  void move_newer();
  std::optional<ClosedMap> taken();

  bus::Health& health_;
  const LoopUse use_;
  const mapping::MapBuilderConfig config_;
  mapping::MapKeyframes keyframes_;
  ReturnWatch watch_;
  std::optional<std::int64_t> next_us_;
  std::size_t newest_looked_at_ = 0;  // so many keyframes were there when a search began
  // What was looked at is not looked at again, whatever became of it.
  mapping::LookMemory memory_;
  // Where they are kept, and of which map.
  std::filesystem::path folder_;
  std::int64_t map_id_ = 0;
  std::shared_ptr<Work> work_;
  Background background_;
};

}  // namespace voxlist::services
