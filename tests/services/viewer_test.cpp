// The viewer on a bus of its own: what its operator asks goes there, what is said there goes to its
// page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/pose_hint_t.hpp>

#include "services/viewer/viewer_service.h"
#include "tests/stand_in_mapper.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::services {
namespace {

bus::MapChange small_map() {
  OccupancyMap map{VoxelMap(0.05), VoxelMap(0.1)};
  map.occupied.insert({1, 2, 3});
  bus::MapChange change;
  change.utime_us = 1'000'000;
  change.map_id = 77;
  change.version = 1;
  change.resolution = bus::resolution_of(map);
  change.blocks = bus::to_messages(map);
  return change;
}

struct Watched {
  Watched() {
    bus.subscribe(bus::kPoseHint, [this](const pose_hint_t& m) { hints.push_back(m); });
    bus.subscribe(bus::kMapEdit, [this](const map_edit_t& m) { edits.push_back(m); });
    bus.subscribe(bus::kMapRequest, [this](const map_request_t& m) { answer(m); });
  }

  void answer(const map_request_t& request) {
    wants.insert(request.want);
    if (!has_mapper) return;
    for (const auto& message : mapper.answer(request)) bus.publish(bus::kMapUpdate, message);
  }

  void run(int ticks = 20) {
    for (int i = 0; i < ticks; ++i) {
      bus.handle(std::chrono::milliseconds(0));
      viewer.tick(now_us += 20'000);
    }
  }

  // Topics that a new client gets.
  std::set<std::string> topics() {
    std::set<std::string> names;
    const int client = viewer.viewer().open();
    while (const auto frame = viewer.viewer().next(client, now_us)) {
      const std::size_t length = (*frame)[0] + 256U * (*frame)[1];
      const auto json = nlohmann::json::parse(
          frame->begin() + 4, frame->begin() + 4 + static_cast<std::ptrdiff_t>(length));
      names.insert(json.at("topic"));
    }
    viewer.viewer().close(client);
    return names;
  }

  unsigned obey(const std::string& name, const std::string& json = "{}") {
    const unsigned status = viewer.obey(name, json).status;
    run();
    return status;
  }

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"viewer"};
  ViewerService viewer{bus, health, [] {
                         ViewerServiceConfig config;
                         config.port = 0;
                         return config;
                       }()};
  test::StandInMapper mapper{small_map()};
  bool has_mapper = true;
  std::int64_t now_us = 10'000'000;
  std::vector<pose_hint_t> hints;
  std::vector<map_edit_t> edits;
  std::set<std::int32_t> wants;
};

TEST(ViewerService, ShowsTheMappersMap) {
  Watched watched;
  watched.run();
  EXPECT_THAT(watched.topics(), testing::IsSupersetOf({"hello", "time", "map", "blocks"}));
}

TEST(ViewerService, ShowsNoMapWhereThereIsNoMapper) {
  Watched watched;
  watched.has_mapper = false;
  watched.run();
  EXPECT_FALSE(watched.topics().contains("blocks"));
  EXPECT_TRUE(watched.wants.contains(map_request_t::WANT_MAP));
}

TEST(ViewerService, ShowsWhereTheRobotIs) {
  Watched watched;
  watched.bus.publish(bus::kLocalisation, localisation_t{});
  watched.run();
  EXPECT_TRUE(watched.topics().contains("robot"));
}

TEST(ViewerService, HandsAHintOnWithTheMapThatItIsOf) {
  Watched watched;
  watched.run();
  EXPECT_EQ(watched.obey("hint", R"({"x_m":1,"y_m":2,"yaw_rad":3,"sigma_m":1,"sigma_rad":0.5})"),
            204U);
  ASSERT_EQ(watched.hints.size(), 1U);
  EXPECT_EQ(watched.hints[0].map_id, 77);
  EXPECT_EQ(watched.hints[0].pose[1], 2.0);
  EXPECT_EQ(watched.hints[0].sigma_rad, 0.5);
}

TEST(ViewerService, RefusesAHintWithoutAMap) {
  Watched watched;
  watched.has_mapper = false;
  EXPECT_EQ(watched.obey("hint", R"({"x_m":1,"y_m":2,"yaw_rad":3,"sigma_m":1,"sigma_rad":0.5})"),
            409U);
  EXPECT_TRUE(watched.hints.empty());
}

TEST(ViewerService, AsksTheMapper) {
  Watched watched;
  watched.obey("save");
  EXPECT_TRUE(watched.wants.contains(map_request_t::WANT_SAVE));
  watched.obey("localise_only", R"({"on":true})");
  EXPECT_TRUE(watched.wants.contains(map_request_t::WANT_LOCALISE_ONLY));
  watched.obey("localise_only", R"({"on":false})");
  EXPECT_TRUE(watched.wants.contains(map_request_t::WANT_EXTEND));
}

TEST(ViewerService, HandsEditsOnEachWithATimeOfItsOwn) {
  Watched watched;
  watched.run();
  watched.viewer.obey("edit", R"({"kind":"blocked","lowest":[0,0,0],"highest":[1,1,1]})");
  watched.viewer.obey("remove_edit", R"({"id":5})");
  watched.run();
  ASSERT_EQ(watched.edits.size(), 2U);
  EXPECT_EQ(watched.edits[0].action, map_edit_t::KEEP_BLOCKED);
  EXPECT_EQ(watched.edits[1].action, map_edit_t::REMOVE);
  EXPECT_EQ(watched.edits[1].id, 5);
  EXPECT_NE(watched.edits[0].utime, watched.edits[1].utime);
}

TEST(ViewerService, RefusesWhatItCannotRead) {
  Watched watched;
  EXPECT_EQ(watched.obey("edit", "{}"), 400U);
  EXPECT_EQ(watched.obey("play", R"({"speed":1})"), 409U);
}

TEST(ViewerService, SaysInHealthThatItIsOpenToOthers) {
  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"viewer"};
  ViewerServiceConfig config;
  config.port = 0;
  config.address = "0.0.0.0";
  const ViewerService viewer(bus, health, config);
  EXPECT_EQ(health.state(), bus::Health::State::kWarning);
  EXPECT_THAT(health.message(), testing::HasSubstr("0.0.0.0"));
}

TEST(ViewerService, RefusesAnAddressThatIsAName) {
  ViewerServiceConfig config;
  config.address = "robot.example";
  EXPECT_THROW(ViewerService::check(config), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::services
