#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxlist/viewing/blocks/map_levels.h"
#include "voxlist/viewing/blocks/space_levels.h"
#include "voxlist/viewing/client.h"
#include "voxlist/viewing/scene/frame.h"
#include "voxlist/viewing/scene/robot_scene.h"

namespace voxlist::viewing {

/// What is shown, and how finely.
struct ViewerConfig {
  double detail_m = 0.05;
  int most_points = 5000;
  std::vector<OtherRobotPlace> other_robots;

  template <class Visitor>
  void visit(Visitor& v) {
    v("detail_m", detail_m,
      "edge of the voxels that are shown, at least; the map's own are shown where those are larger",
      0.04, 1.0);
    v("most_points", most_points, "points of a cloud that are shown: more load the line", 100,
      100'000);
    v("other_robot", other_robots,
      "where the maps of other robots of the fleet lie in this one; none: only robots with the "
      "same map are drawn");
  }
};

/// Everything that is shown, and what each client has still to get of it. Knows neither sockets nor
/// a bus.
class Viewer {
 public:
  explicit Viewer(const ViewerConfig& config)
      : levels_(config.detail_m),
        scene_(static_cast<std::size_t>(config.most_points), config.other_robots) {}

  /// Where messages other than the map's go.
  RobotScene& scene() { return scene_; }
  const MapLevels& levels() const { return levels_; }

  void take(const bus::MapChange& change, std::int64_t now_us);

  /// FREE_SPACE's changes, and that there are none any more.
  void take_space(const bus::MapChange& change) { space_.apply(change); }
  void forget_space() { space_.forget(); }

  /// Whether any page looks at free and occupied space.
  bool is_space_wanted() const;

  /// There is no map any more.
  void forget_map(std::int64_t now_us);

  /// Forgets all but what was told first ("hello"), and lets pages know: a recording begins again.
  void start_over();

  /// Brings the levels after the map, some of the way, and tells clients what has changed.
  void tick();

  /// A client comes, by a number of its own, and goes.
  int open();
  void close(int client) { clients_.erase(client); }

  /// What a client's page says: "space on" and "space off"; all else means nothing.
  void hear(int client, std::string_view text);

  /// What the client is to be sent now; nothing: it has all.
  std::optional<Frame> next(int client, std::int64_t now_us);

 private:
  void tell_map(const bus::MapChange& change, std::int64_t now_us);

  MapLevels levels_;
  SpaceLevels space_;
  RobotScene scene_;
  std::map<int, Client> clients_;
  int last_client_ = 0;
  std::int64_t map_id_ = 0;
};

}  // namespace voxlist::viewing
