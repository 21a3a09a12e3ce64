#include "services/viewer/foxglove_feed.h"

#include <fmt/core.h>

#include <random>
#include <voxlist/health_t.hpp>
#include <voxlist/pixel_map_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>

#include "voxlist/bus/bus.h"

namespace voxlist::services {
namespace {

// Another number for each start.
std::string new_session() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

// Clients see whatever is new of the map, every other second at most: it is told as a whole.
foreign::ConverterConfig live_config() {
  return {.retelling = {.share = 0.0, .after_us = 2'000'000}};
}

}  // namespace

FoxgloveFeed::FoxgloveFeed(bus::Bus& bus, const std::vector<std::string>& robots)
    : server_("voxlist", new_session()), converter_(server_, live_config()) {
  const auto listen = [&]<class M>(bus::Channel<M> channel) {
    bus.subscribe(channel, [this, name = std::string(channel.name)](const M& message) {
      converter_.take(name, message);
    });
  };
  listen(bus::kOdometry);
  listen(bus::kMapOdom);
  for (const std::string& robot : robots) {
    listen(bus::Channel<pixel_map_t>{("GRID_" + robot).c_str()});
    for (const char* scan : {bus::kScanPrefix, bus::kScanFarPrefix})
      listen(bus::Channel<planar_lidar_t>{(scan + robot).c_str()});
  }
}

viewing::ForeignProtocol FoxgloveFeed::protocol(const std::vector<std::string>& origins) {
  viewing::ForeignProtocol protocol;
  for (const std::string_view name : foreign::kFoxgloveProtocols) protocol.names.emplace_back(name);
  protocol.origins = origins;
  protocol.open = [this] { return server_.open(); };
  protocol.close = [this](int client) { server_.close(client); };
  protocol.next = [this](int client) -> std::optional<viewing::SocketMessage> {
    auto frame = server_.next(client);
    if (!frame) return std::nullopt;
    return viewing::SocketMessage{std::move(frame->bytes), frame->is_text};
  };
  protocol.hear = [this](int client, std::string_view bytes, bool is_text) {
    is_text ? server_.on_text(client, bytes) : server_.on_binary(client, bytes);
  };
  return protocol;
}

}  // namespace voxlist::services
