#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "voxlist/mapping/keyframe_spool.h"
#include "voxlist/mapping/loops/neighbour_look.h"

namespace voxlist::desk {

/// Matches keyframes with the ones before them on a thread of its own while the map still grows:
/// what closing its loops begins with. It changes when that is done, and no result.
class LookAhead {
 public:
  /// By the indices of two keyframes in the spool.
  using Looks = std::map<std::pair<std::size_t, std::size_t>, mapping::NeighbourLook>;

  /// The spool must outlive it. Without `is_on` it does nothing.
  LookAhead(mapping::KeyframeSpool& spool, const matching::MatcherConfig& config, bool is_on);
  ~LookAhead();
  LookAhead(const LookAhead&) = delete;
  LookAhead& operator=(const LookAhead&) = delete;

  /// Has a look at two keyframes soon; not where many wait.
  void add(const mapping::SpooledKeyframe& from, const mapping::SpooledKeyframe& to);

  /// Waits until no pair waits.
  void wait();

  /// Waits for the look at hand, and hands out those that were taken. Nothing is added any more.
  const Looks& finish();

 private:
  struct Pair {
    mapping::SpooledKeyframe from, to;
  };

  void work();
  std::optional<Pair> next();
  std::optional<mapping::NeighbourLook> look(const Pair& pair);

  mapping::KeyframeSpool& spool_;
  mapping::NeighbourLooker looker_;
  const bool is_on_;
  std::map<std::size_t, mapping::SpooledKeyframe> at_hand_;  // what the looker may read
  Looks looks_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<Pair> waiting_;
  bool is_over_ = false, is_looking_ = false;
  std::thread thread_;
};

}  // namespace voxlist::desk
