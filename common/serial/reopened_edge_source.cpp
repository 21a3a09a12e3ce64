#include "voxlist/serial/reopened_edge_source.h"

#include <algorithm>

#include "voxlist/serial/port.h"

namespace voxlist::serial {
namespace {

// Waits between attempts to open a lost device (us): soon at first, for a plug that was pulled by
// mistake, then ever more seldom, so that a device that never comes costs nothing.
constexpr std::int64_t kFirstWait_us = 500'000, kLongestWait_us = 10'000'000;

}  // namespace

std::vector<std::int64_t> ReopenedEdgeSource::read(std::int64_t now_us) try {
  if (!source_) {
    if (now_us < next_us_) return {};
    source_ = open_();
  }
  std::vector<std::int64_t> edges_us = source_->read(now_us);
  if (!edges_us.empty()) wait_us_ = 0;
  return edges_us;
} catch (const PortError& error) {
  give_up(now_us, error.what());
  return {};
}

void ReopenedEdgeSource::give_up(std::int64_t now_us, const char* why) {
  garbage_ = garbage();
  source_.reset();
  trouble_ = why;
  wait_us_ = std::clamp(2 * wait_us_, kFirstWait_us, kLongestWait_us);
  next_us_ = now_us + wait_us_;
}

}  // namespace voxlist::serial
