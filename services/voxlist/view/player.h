#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/voxlist/view/highlights.h"
#include "services/voxlist/view/replay.h"
#include "voxlist/viewing/server/web_server.h"
#include "voxlist/viewing/viewer.h"

namespace voxlist::desk {

/// A recording as a live page with a time bar.
class Player {
 public:
  /// `name`: of the recording. Throws std::runtime_error when it cannot listen.
  Player(std::unique_ptr<Events> events, const Highlights& highlights, const std::string& name,
         const viewing::ViewerConfig& config, const viewing::ServerOptions& server,
         const std::vector<std::string>& robots);

  /// Plays on, and serves the page. `now_us`: of a clock that never goes back.
  void tick(std::int64_t now_us);

  std::uint16_t port() const { return server_.port(); }

  /// The time of the recording that is shown (us).
  std::int64_t shown_us() const { return shown_us_; }

  /// Does what the page asks.
  viewing::CommandAnswer obey(const std::string& name, const std::string& json);

 private:
  void go_on(std::int64_t now_us);
  void tell_time(std::int64_t now_us);
  viewing::ServerOwner owner();

  const Highlights highlights_;
  viewing::Viewer viewer_;
  Replay replay_;
  double speed_ = 1.0;
  std::int64_t shown_us_;
  std::optional<std::int64_t> last_us_, told_us_;
  viewing::WebServer server_;
};

}  // namespace voxlist::desk
