#include "voxlist/viewing/bus_feed.h"

#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_edits_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/traversability_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/viewing/scene/robot_scene.h"

namespace voxlist::viewing {

BusFeed::BusFeed(bus::Bus& bus, RobotScene& scene, const std::vector<std::string>& robots) {
  const auto show = [&]<class M>(bus::Channel<M> channel) {
    bus.subscribe(channel, [this, &scene](const M& message) { scene.take(message, now_us_); });
  };
  show(bus::kLocalisation);
  show(bus::kPose);
  show(bus::kPoseCovariance);
  show(bus::kObstacles);
  show(bus::kHealth);
  show(bus::kOctomap);
  show(bus::kKeyframe);
  for (const std::string& robot : robots) {
    const std::string channel = "TRAVERSABILITY_" + robot;
    show(bus::Channel<traversability_t>{channel.c_str()});
  }
  bus.subscribe(bus::kCloud,
                [this, &scene](const pointcloud_t& m) { scene.take_cloud(m, now_us_); });
  bus.subscribe(bus::kCloudSlice,
                [this, &scene](const pointcloud_t& m) { scene.take_slice(m, now_us_); });
  bus.subscribe_all(OtherRobots::kChannels,
                    [this, &scene](const std::string& channel, bus::Bytes bytes) {
                      scene.take_other(channel, bytes, now_us_);
                    });
  bus.subscribe(bus::kMapEdits, [this, &scene](const map_edits_t& m) {
    if (const auto edits = bus::from_message(m)) scene.take(*edits, now_us_);
  });
}

}  // namespace voxlist::viewing
