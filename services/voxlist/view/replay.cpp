#include "services/voxlist/view/replay.h"

#include <chrono>
#include <utility>
#include <voxlist/map_update_t.hpp>

namespace voxlist::desk {
namespace {

// A cloud or an obstacle of so long before (us) is not shown.
constexpr std::int64_t kCloudAge_us = 2'000'000;

bool is_soon_old(const std::string& channel) {
  return channel == bus::kCloud.name || channel == bus::kCloudSlice.name ||
         channel == bus::kObstacles.name;
}

}  // namespace

Replay::Replay(std::unique_ptr<Events> events, viewing::Viewer& viewer,
               const std::vector<std::string>& robots)
    : events_(std::move(events)),
      viewer_(viewer),
      bus_({.url = "memq://", .prefix = ""}),
      feed_(bus_, viewer.scene(), robots) {
  bus_.subscribe(bus::kMapUpdate, [this](const map_update_t& m) { take(m); });
  bus_.subscribe(bus::kFreeSpace, [this](const map_update_t& m) {
    for (const bus::MapChange& change : space_assembler_.add(m)) viewer_.take_space(change);
  });
  next_ = events_->next();
}

bool Replay::advance(std::int64_t utime_us, int most) {
  for (; next_ && next_->utime_us <= utime_us && most > 0; --most) {
    const bool is_old = utime_us - next_->utime_us > kCloudAge_us && is_soon_old(next_->channel);
    if (!is_old) show(*next_);
    next_ = events_->next();
  }
  const bool is_there = !next_ || next_->utime_us > utime_us;
  if (is_there) now_us_ = utime_us;
  return is_there;
}

void Replay::show(const bus::Event& event) {
  now_us_ = event.utime_us;
  feed_.set_time(now_us_);
  bus_.publish_encoded(event.channel, event.bytes);
  bus_.handle(std::chrono::milliseconds(0));
}

// Whose map a recording has was decided when it was made.
void Replay::take(const map_update_t& message) {
  for (const bus::MapChange& change : assembler_.add(message)) viewer_.take(change, now_us_);
}

void Replay::rewind() {
  events_->rewind();
  next_ = events_->next();
  now_us_ = 0;
  assembler_.forget();
  space_assembler_.forget();
  viewer_.start_over();
}

}  // namespace voxlist::desk
