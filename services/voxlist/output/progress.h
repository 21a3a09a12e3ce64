#pragma once

#include <chrono>
#include <string>

#include "services/voxlist/output/console.h"

namespace voxlist::desk {

/// Shows how far long work is: a bar on a terminal, elsewhere a line every few seconds.
class Progress {
 public:
  Progress(Console& console, std::string doing);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `share` of the work is done, 0..1. Cheap: shows something only now and then.
  void show(double share);

 private:
  using Clock = std::chrono::steady_clock;

  std::string line(double share, double elapsed_s) const;

  Console& console_;
  const std::string doing_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
};

}  // namespace voxlist::desk
