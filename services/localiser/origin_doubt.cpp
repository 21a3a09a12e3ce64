#include "services/localiser/origin_doubt.h"

namespace voxlist::services {
namespace {

// Points that are farther away (m) do not count.
constexpr double kRange_m = 100.0;

// A map that is not the robot's own is doubted after so many clouds: long enough to drive out of
// what has changed.
constexpr int kPatience = 10;

}  // namespace

void OriginDoubt::begin(std::int64_t map_id, bool is_own) {
  map_id_ = map_id;
  is_open_ = true;
  patience_ = is_own ? 0 : kPatience;
  end_trial();
}

void OriginDoubt::end() {
  is_open_ = false;
  end_trial();
}

void OriginDoubt::postpone() { patience_ = kPatience; }

bool OriginDoubt::add(matching::LocalisationState state) {
  if (!is_open_ || patience_ == 0) return is_open_;
  patience_ = state == matching::LocalisationState::kLost ? patience_ - 1 : kPatience;
  return false;
}

void OriginDoubt::end_trial() {
  other_ = {};
  localiser_.forget();
}

bool OriginDoubt::try_origin(const Cloud& cloud, const std::optional<Pose2>& T_odom_base) {
  end_trial();
  if (!localiser_.localise(cloud, T_odom_base).tracking()) return false;
  add_scan(cloud, Pose3::Identity(), kRange_m, other_);
  return !other_.empty();
}

bool OriginDoubt::fits_it(const Cloud& cloud, const std::optional<Pose2>& T_odom_base) {
  return !other_.empty() && localiser_.localise(cloud, T_odom_base).tracking();
}

}  // namespace voxlist::services
