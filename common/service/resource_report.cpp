#include "voxlist/service/resource_report.h"

#include <fmt/core.h>

namespace voxlist::service {
namespace {

constexpr std::int64_t kPeriod_us = 1'000'000;

// A loss is told for so long (us) after it was last seen, as other conditions are.
constexpr std::int64_t kLasting_us = 5'000'000;

double megabytes(std::int64_t bytes) { return static_cast<double>(bytes) * 1e-6; }

}  // namespace

bool ResourceReport::is_due(std::int64_t now_us) const {
  return !now_us_ || now_us - *now_us_ >= kPeriod_us;
}

void ResourceReport::take(const bus::Traffic& traffic, std::int64_t memory_bytes,
                          std::int64_t now_us, bus::Health& health) {
  now_us_ = now_us;
  health.gauge("memory_MB", megabytes(memory_bytes));
  health.gauge("send_queue_MB", megabytes(traffic.queued_bytes));
  tell(dropped_, traffic.dropped_packets, "packets_without_room",
       "packets found no room here, their messages are lost: does somebody send large messages in "
       "one burst, as LCM's own sender does? Pace it, or allow more: sysctl -w "
       "net.core.rmem_max=8000000",
       health);
  tell(incomplete_, traffic.incomplete_packets, "packets_incomplete",
       "packets of other machines came without all their fragments, their messages are lost: the "
       "network loses some, or sysctl -w net.ipv4.ipfrag_high_thresh=16000000 "
       "net.ipv4.ipfrag_time=2",
       health);
  tell(failed_, traffic.failed_messages, "messages_not_sent",
       "large messages were refused by the system: is the network's route still there?", health);
  tell(superseded_, traffic.superseded_messages, "messages_left_for_newer",
       "messages were left for newer ones, as listeners read too slowly: is the machine too busy?",
       health);
}

void ResourceReport::tell(Loss& loss, std::int64_t count, const std::string& key,
                          const std::string& sentence, bus::Health& health) const {
  const std::int64_t more = count - loss.counted;
  loss.counted = count;
  if (more > 0) {
    loss.of_this_time += more;
    loss.last_us = *now_us_;
    health.count(key, more);
    health.raise(key, bus::Health::State::kWarning,
                 fmt::format("{} {}", loss.of_this_time, sentence));
  } else if (*now_us_ - loss.last_us >= kLasting_us) {
    loss.of_this_time = 0;
    health.clear(key);
  }
}

}  // namespace voxlist::service
