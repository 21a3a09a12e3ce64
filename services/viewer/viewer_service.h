#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/viewer/foxglove_feed.h"
#include "services/viewer/recorder.h"
#include "voxlist/bus/channels.h"
#include "voxlist/planning/profiles/robot_profile.h"
#include "voxlist/service/inputs/map_follower.h"
#include "voxlist/viewing/commands.h"
#include "voxlist/viewing/server/web_server.h"
#include "voxlist/viewing/viewer.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Settings of the viewer.
struct ViewerServiceConfig {
  std::string address = "127.0.0.1";
  int port = 7668;
  std::vector<std::string> foxglove_origins;
  viewing::ViewerConfig viewer;
  planning::RobotProfiles robots;

  template <class Visitor>
  void visit(Visitor& v) {
    v("address", address,
      "where the page is served, in numbers. Others than 127.0.0.1 and ::1 let everybody who "
      "reaches "
      "the machine see it and give commands; from elsewhere, better: ssh -L 7668:127.0.0.1:7668");
    v("port", port, "of the page; 0: any that is free, told in the log", 0, 65'535);
    v("foxglove_origins", foxglove_origins,
      "pages elsewhere that may look on by Foxglove's protocol (never give commands), such as "
      "https://app.foxglove.dev; programs that are no pages always may");
    viewer.visit(v);
  }

  /// The robots, whose floor plans are shown.
  template <class Visitor>
  void visit_root(Visitor& v) {
    robots.visit(v);
  }
};

/// Serves the live page: what the bus tells goes to it, what its operator asks goes to the bus.
class ViewerService {
 public:
  /// Throws std::runtime_error when it cannot listen.
  ViewerService(bus::Bus& bus, bus::Health& health, const ViewerServiceConfig& config);

  /// Throws std::invalid_argument for an address that is not in numbers.
  static void check(const ViewerServiceConfig& config);

  void tick(std::int64_t now_us);

  /// Does what an operator asks, by the command's name and its JSON.
  viewing::CommandAnswer obey(const std::string& name, const std::string& json);

  std::uint16_t port() const { return server_.port(); }
  const std::string& token() const { return server_.token(); }
  viewing::Viewer& viewer() { return viewer_; }

 private:
  void subscribe(const planning::RobotProfiles& robots);
  template <class M, class Handle>
  void listen(bus::Channel<M> channel, Handle handle);
  template <class M>
  void show(bus::Channel<M> channel);
  void take(const map_update_t& message);
  void follow_map();
  void follow_space();
  void tell_time();
  void report();
  viewing::ServerOwner owner(const std::vector<std::string>& foxglove_origins);

  viewing::CommandAnswer obey(const viewing::HintCommand& command);
  viewing::CommandAnswer obey(const viewing::SaveCommand& command);
  viewing::CommandAnswer obey(const viewing::LocaliseOnlyCommand& command);
  viewing::CommandAnswer obey(const viewing::EditCommand& command);
  viewing::CommandAnswer obey(const viewing::RemoveEditCommand& command);
  viewing::CommandAnswer obey(const viewing::RecordCommand& command);
  viewing::CommandAnswer obey(const viewing::PlayCommand& command);
  viewing::CommandAnswer obey(const viewing::SeekCommand& command);
  viewing::CommandAnswer request(std::int32_t want, std::int32_t first = 0);
  std::int64_t next_utime_us();

  bus::Bus& bus_;
  bus::Health& health_;
  viewing::Viewer viewer_;
  service::MapFollower follower_;
  // Only while a page looks at free and occupied space.
  std::optional<service::MapFollower> space_follower_;
  FoxgloveFeed foxglove_;
  Recorder recorder_;
  std::int64_t now_us_ = 0;
  std::optional<std::int64_t> arrival_us_, told_us_, asked_edits_us_;
  std::int64_t last_utime_us_ = 0;  // of a command
  viewing::WebServer server_;
};

}  // namespace voxlist::services
