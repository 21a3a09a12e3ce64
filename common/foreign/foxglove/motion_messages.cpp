// What moves and what a 2D laser sees, encoded.
#include <cmath>

#include "voxlist/foreign/foxglove/message_parts.h"
#include "voxlist/foreign/foxglove/messages.h"

namespace voxlist::foreign {
namespace {

constexpr double kHeight_m = 1.0;

// An arrow's shaft and head (m); slower ones have none.
constexpr double kShaft_m = 0.05, kHead_m = 0.15, kSlowest_mps = 0.05;

void set_red(foxglove::Color& to) {
  to.set_r(0.9);
  to.set_g(0.2);
  to.set_b(0.15);
  to.set_a(0.6);
}

void add_post(const Mover& mover, foxglove::SceneEntity& to) {
  foxglove::CylinderPrimitive& post = *to.add_cylinders();
  Pose3 pose = Pose3::Identity();
  pose.translation() << mover.position, kHeight_m / 2.0;
  set(pose, *post.mutable_pose());
  set(Eigen::Vector3d(2.0 * mover.radius_m, 2.0 * mover.radius_m, kHeight_m), *post.mutable_size());
  post.set_bottom_scale(1.0);
  post.set_top_scale(1.0);
  set_red(*post.mutable_color());
}

void add_arrow(const Mover& mover, foxglove::SceneEntity& to) {
  const double speed_mps = mover.velocity_mps.norm();
  if (speed_mps < kSlowest_mps) return;
  foxglove::ArrowPrimitive& arrow = *to.add_arrows();
  Pose3 pose = Pose3::Identity();
  pose.translation() << mover.position, kHeight_m / 2.0;
  const Eigen::Vector3d along(mover.velocity_mps.x(), mover.velocity_mps.y(), 0.0);
  pose.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), along).toRotationMatrix();
  set(pose, *arrow.mutable_pose());
  arrow.set_shaft_length(speed_mps);
  arrow.set_shaft_diameter(kShaft_m);
  arrow.set_head_length(kHead_m);
  arrow.set_head_diameter(kHead_m);
  set_red(*arrow.mutable_color());
}

}  // namespace

std::string laser_scan(const Stamp& stamp, const Beams& beams) {
  foxglove::LaserScan message;
  set_stamp(stamp, message);
  set(Pose3::Identity(), *message.mutable_pose());
  message.set_start_angle(beams.first_rad);
  const auto steps = static_cast<double>(beams.ranges_m.size()) - 1.0;
  message.set_end_angle(beams.first_rad + beams.step_rad * std::max(0.0, steps));
  message.mutable_ranges()->Add(beams.ranges_m.begin(), beams.ranges_m.end());
  return message.SerializeAsString();
}

std::string movers(const Stamp& stamp, const std::vector<Mover>& all, std::int64_t lifetime_us) {
  foxglove::SceneUpdate message;
  for (std::size_t i = 0; i < all.size(); ++i) {
    foxglove::SceneEntity& entity = *message.add_entities();
    set_stamp(stamp, entity);
    entity.set_id(std::to_string(i));
    entity.mutable_lifetime()->set_seconds(lifetime_us / 1'000'000);
    entity.mutable_lifetime()->set_nanos(static_cast<int>(lifetime_us % 1'000'000) * 1000);
    add_post(all[i], entity);
    add_arrow(all[i], entity);
  }
  return message.SerializeAsString();
}

}  // namespace voxlist::foreign
