#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/foreign/foxglove/converter.h"
#include "voxlist/foreign/websocket/foxglove_server.h"
#include "voxlist/viewing/server/web_server.h"

namespace voxlist::bus {
class Bus;
}

namespace voxlist::services {

/// What the bus says, for Foxglove's and Lichtblick's clients on the page's port.
class FoxgloveFeed {
 public:
  /// Listens to the channels that only those clients are shown: odometry, and grids and scans of
  /// the robots with these names. The bus must outlive it.
  FoxgloveFeed(bus::Bus& bus, const std::vector<std::string>& robots);

  /// A message of a channel that the page is shown, too. Those that Foxglove has no type for mean
  /// nothing here.
  template <class M>
  void take(bus::Channel<M> channel, const M& message) {
    if constexpr (requires { converter_.take(std::string(), message); })
      converter_.take(channel.name, message);
  }
  void take(const bus::MapChange& change) { converter_.take(change); }
  void take_space(const bus::MapChange& change) { converter_.take_space(change); }

  /// Whether any of those clients looks at free space.
  bool wants_space() { return converter_.wants_space(); }

  void tick(std::int64_t now_us) { converter_.tick(now_us); }
  void tell_time(std::int64_t now_us) { server_.tell_time(now_us); }

  /// For the server. `origins`: pages elsewhere that may look on.
  viewing::ForeignProtocol protocol(const std::vector<std::string>& origins);

 private:
  foreign::FoxgloveServer server_;
  foreign::Converter converter_;
};

}  // namespace voxlist::services
