#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "voxlist/bus/health.h"
#include "voxlist/bus/traffic.h"

namespace voxlist::service {

/// Tells HEALTH what a service holds (gauges memory_MB, send_queue_MB), and what the network lost:
/// packets that found no room when they came or came without all their fragments, messages that the
/// system refused to send, and those that were left for newer ones.
class ResourceReport {
 public:
  /// Whether a second has passed since take().
  bool is_due(std::int64_t now_us) const;

  /// How things are now. A loss is told until there was none for five seconds.
  void take(const bus::Traffic& traffic, std::int64_t memory_bytes, std::int64_t now_us,
            bus::Health& health);

 private:
  struct Loss {
    std::int64_t counted = 0;
    std::int64_t of_this_time = 0;  // since it is told
    std::int64_t last_us = 0;
  };

  void tell(Loss& loss, std::int64_t count, const std::string& key, const std::string& sentence,
            bus::Health& health) const;

  std::optional<std::int64_t> now_us_;
  Loss dropped_;
  Loss incomplete_;
  Loss failed_;
  Loss superseded_;
};

}  // namespace voxlist::service
