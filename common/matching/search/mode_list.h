#pragma once

#include <vector>

#include "voxlist/matching/search/search_result.h"

namespace voxlist::matching {

/// The modes of the poses that a search has met so far: the best pose, then the best one that is
/// distinct from it, and so on. The config must outlive it.
class ModeList {
 public:
  explicit ModeList(const SearchConfig& config) : config_(config) {}

  /// The overlap that a pose must have to change the list. It never falls.
  int least() const;

  void add(const OverlapMode& pose);

  /// The best overlap; 0 without modes.
  int best() const { return modes_.empty() ? 0 : modes_.front().overlap; }

  /// Best first; none with less than mode_ratio of the best.
  const std::vector<OverlapMode>& modes() const { return modes_; }

 private:
  int floor() const;
  bool full() const { return modes_.size() >= config_.max_modes; }
  bool hidden(const OverlapMode& pose) const;
  void choose_modes();

  const SearchConfig& config_;
  std::vector<OverlapMode> poses_, modes_;
};

}  // namespace voxlist::matching
