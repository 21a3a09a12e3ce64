#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "voxlist/bus/bus.h"

namespace voxlist::bus {

class Health;

/// Tells in HEALTH what of this machine makes messages between machines get lost: route, interface,
/// MTU, receive buffer, room for fragments. It looks again every few seconds, so what is put right
/// is told no more. Nothing where the url's messages stay on this machine.
class NetworkReport {
 public:
  /// `whose`: put before each sentence, where a service has more than one Bus.
  explicit NetworkReport(BusOptions options, std::string whose = "");

  /// Looks when it is time to, the first time at once. Any clock that runs on.
  void take(std::int64_t now_us, Health& health);

  /// Where messages go, for a line of the log, which begins with ": "; empty where there is no
  /// network.
  std::string summary() const;

 private:
  const BusOptions options_;
  const std::string whose_;
  std::optional<std::int64_t> looked_us_;
};

}  // namespace voxlist::bus
