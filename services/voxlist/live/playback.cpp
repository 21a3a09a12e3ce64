#include "services/voxlist/live/playback.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace voxlist::desk {
namespace {

std::regex read_pattern(const std::string& pattern) try {
  return std::regex(pattern);
} catch (const std::regex_error&) {
  throw std::runtime_error(fmt::format("\"{}\" is no regular expression", pattern));
}

}  // namespace

Playback::Playback(std::vector<std::filesystem::path> parts, const std::string& only, double speed)
    : parts_(std::move(parts)), only_(read_pattern(only)), speed_(speed) {}

std::optional<bus::Event> Playback::next_event() {
  while (true) {
    if (reader_)
      if (auto event = reader_->next()) return event;
    if (next_part_ == parts_.size()) return std::nullopt;
    reader_ = std::make_unique<bus::EventLogReader>(parts_[next_part_++].string());
  }
}

std::optional<Playback::Due> Playback::next() {
  while (auto event = next_event()) {
    if (!std::regex_search(event->channel, only_)) continue;
    if (!first_utime_us_) first_utime_us_ = event->utime_us;
    const auto recorded_us = static_cast<double>(event->utime_us - *first_utime_us_);
    after_us_ = std::max(after_us_, static_cast<std::int64_t>(recorded_us / speed_));
    return Due{after_us_, std::move(*event)};
  }
  return std::nullopt;
}

}  // namespace voxlist::desk
