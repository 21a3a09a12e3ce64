#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace voxlist::foreign {

/// When something that grows is told as a whole again.
struct RetellingConfig {
  /// As soon as so large a share of it is new: with 0.05, all that is told while it grows is some
  /// twenty times as much as it is at the end, not its square. 0: whatever is new.
  double share = 0.05;
  /// But no sooner than this after the last time (data's time, us).
  std::int64_t after_us = 1'000'000;
};

class Retelling {
 public:
  explicit Retelling(const RetellingConfig& config) : config_(config) {}

  /// `changed`: parts that are new, added up until told().
  void add(std::size_t changed) { changed_ += changed; }

  bool is_new() const { return changed_ > 0; }

  bool is_due(std::size_t size, std::int64_t utime_us) const {
    const auto wanted = config_.share * static_cast<double>(size);
    // Now is a little later than the data's time: both ways it rests.
    const bool rests = last_us_ && std::abs(utime_us - *last_us_) < config_.after_us;
    return is_new() && static_cast<double>(changed_) >= wanted && !rests;
  }

  void told(std::int64_t utime_us) {
    changed_ = 0;
    last_us_ = utime_us;
  }

 private:
  RetellingConfig config_;
  std::size_t changed_ = 0;
  std::optional<std::int64_t> last_us_;
};

}  // namespace voxlist::foreign
