#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/network_report.h"
#include "voxlist/fleet/loss_count.h"
#include "voxlist/fleet/one_way.h"
#include "voxlist/fleet/relay_config.h"

namespace voxlist::bus {
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Passes the robot's channels on to the fleet's bus as ROBOT/CHANNEL, and those of other robots to
/// the robot's bus, by the same name. Nothing goes round: what came in has a / in its name, and
/// only names without go out; and what has this robot's own name never comes in.
///
/// On ROBOT/RELAY/SENT (health_t) each relay tells the others once a second how many messages of
/// each channel it has sent, so that they can count what got lost on the way.
class RelayService {
 public:
  /// Throws std::runtime_error when the fleet's network cannot be opened.
  RelayService(bus::Bus& bus, bus::Health& health, const fleet::RelayConfig& config);

  /// Throws std::invalid_argument for settings that do not fit together, or not to the robot's bus.
  static void check(const fleet::RelayConfig& config, const bus::BusOptions& bus);

  /// Takes what the fleet says, passes on what may go by now, and tells HEALTH. Throws
  /// std::runtime_error when the connection to the fleet broke, or carries nothing any more.
  void tick(std::int64_t now_us);

  /// Can be read when a message of the fleet waits.
  int wake_fd() const { return fleet_.file_descriptor(); }

 private:
  // A count that is a warning while it grows.
  struct Trouble {
    std::int64_t counted = 0;
    std::optional<std::int64_t> last_us;
  };

  // Another robot, as long as it is heard.
  struct Peer {
    std::int64_t heard_us = 0;
    fleet::LossCount losses;
  };

  void take_from_fleet(const std::string& wire_name, bus::Bytes bytes);
  void take_sent_counts(const std::string& robot, bus::Bytes bytes);
  void send_sent_counts();
  void send_to_fleet(const std::string& channel, bus::Bytes bytes);
  void send_to_robot(const std::string& channel, bus::Bytes bytes);
  void report();
  void report_traffic();
  void tell(const std::string& direction, const bus::Counters& counters);
  void tell(Trouble& trouble, std::int64_t count, const std::string& key,
            const std::string& sentence);
  void look_for_namesakes();
  void look_for_rings();
  void forget_peers(std::int64_t silent_us);
  void throw_if_deaf();

  bus::Bus& bus_;
  bus::Health& health_;
  const std::string robot_;
  bus::Bus fleet_;
  bus::NetworkReport network_;
  fleet::OneWay out_, in_;
  std::int64_t now_us_ = 0;
  std::optional<std::int64_t> arrival_us_;  // of the message that came last
  std::optional<std::int64_t> reported_us_;
  bus::Counters told_;  // of what HEALTH has counted
  std::map<std::string, Peer> peers_;
  fleet::SentCounts sent_by_channel_;
  Trouble unsent_, dropped_, incomplete_, namesakes_, rings_;
  std::int64_t sent_ = 0, own_heard_ = 0;
  std::optional<std::int64_t> own_heard_us_;
};

}  // namespace voxlist::services
