#pragma once

#include <cstddef>

namespace voxlist::bench {

/// How clouds are sent.
struct Sending {
  enum class Sender {
    kLcm,  ///< lcm_publish()
    kBus,  ///< Bus::publish()
  };
  Sender sender = Sender::kBus;
  std::size_t points = 100'000;
  bool with_origins = false;
  double rate_hz = 10.0;
  int clouds = 30;
};

/// What sending cost.
struct Sent {
  std::size_t bytes = 0;       ///< of one message
  double longest_call_ms = 0;  ///< that publishing kept the caller
  double processor_share = 0;  ///< of one core
};

/// Sends the clouds, and returns when they are out.
Sent send_clouds(const Sending& sending);

}  // namespace voxlist::bench
