#include "services/voxlist/live/robot_view.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/obstacles_t.hpp>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/localisation/localisation.h"

namespace voxlist::desk {
namespace {

// What is older than this (s) is no longer how it is: a scan takes a second at most.
constexpr double kOld_s = 3.0;

// Candidates that are shown: the localiser publishes a handful.
constexpr std::size_t kMaxCandidates = 8;

std::string pose_text(const double (&pose)[3]) {
  return fmt::format("x {:7.2f} m  y {:7.2f} m  yaw {:6.1f} deg", pose[0], pose[1],
                     pose[2] / kRadPerDeg);
}

// How sure a mode's pose is, in the direction in which it is least sure.
std::string sigma_text(const pose_mode_t& mode) {
  const Eigen::Map<const Eigen::Matrix3d> covariance(mode.covariance);
  return fmt::format("1 sigma {:.3f} m {:.2f} deg", worst_sigma_m(covariance),
                     std::sqrt(std::max(0.0, covariance(2, 2))) / kRadPerDeg);
}

std::string state_text(const localisation_t& message) {
  switch (message.state) {
    case localisation_t::STATE_LOST:
    case localisation_t::STATE_AMBIGUOUS:
    case localisation_t::STATE_TRACKING:
      return name(static_cast<matching::LocalisationState>(message.state));
    default:
      return "?";
  }
}

}  // namespace

RobotView::RobotView() : last_(std::make_unique<localisation_t>()) {}
RobotView::~RobotView() = default;

void RobotView::take(const localisation_t& message, double now_s) {
  if (!seen()) first_utime_us_ = message.utime;
  ++localisations_;
  tracking_ += message.state == localisation_t::STATE_TRACKING;
  *last_ = message;
  last_seen_s_ = now_s;
}

void RobotView::take(const keyframe_t& message, double) { keyframes_ = message.index + 1; }

void RobotView::take(const obstacles_t& message, double now_s) {
  nearest_m_ = std::numeric_limits<float>::infinity();
  for (const auto& nearest_m : message.nearest_m) {
    for (const float range : nearest_m) nearest_m_ = std::min(nearest_m_, range);
  }
  nearest_seen_s_ = now_s;
}

std::vector<std::string> RobotView::lines(double now_s) const {
  if (!seen())
    return {
        "waiting for LOCALISATION: are the services running, and does a scanner publish CLOUD?"};
  std::vector<std::string> lines = {pose_line(now_s)};
  if (last_->state != localisation_t::STATE_AMBIGUOUS) return lines;
  const std::size_t shown = std::min(last_->modes.size(), kMaxCandidates);
  for (std::size_t i = 0; i < shown; ++i)
    lines.push_back(fmt::format("  candidate {}: {}  {}  probability {:.2f}", i + 1,
                                pose_text(last_->modes[i].pose), sigma_text(last_->modes[i]),
                                last_->modes[i].probability));
  return lines;
}

std::string RobotView::pose_line(double now_s) const {
  const double age_s = now_s - last_seen_s_;
  if (age_s > kOld_s)
    return fmt::format("no LOCALISATION for {:.0f} s; the last was {}{}  map {:4} keyframes", age_s,
                       state_text(*last_),
                       last_->modes.empty() ? "" : " at " + pose_text(last_->modes.front().pose),
                       keyframes_);
  const double time_s =
      (static_cast<double>(last_->utime) - static_cast<double>(first_utime_us_)) * 1e-6;
  std::string text = fmt::format("{:5.0f} s  {:9}", time_s, state_text(*last_));
  // Of several candidates each has its own line.
  if (!last_->modes.empty() && last_->state == localisation_t::STATE_TRACKING)
    text += "  " + pose_text(last_->modes.front().pose) + "  " + sigma_text(last_->modes.front());
  return text + surroundings(now_s);
}

std::string RobotView::surroundings(double now_s) const {
  std::string text = fmt::format("  map {:4} keyframes", keyframes_);
  if (nearest_seen_s_ && now_s - *nearest_seen_s_ <= kOld_s && std::isfinite(nearest_m_))
    text += fmt::format("  nearest obstacle {:.2f} m", nearest_m_);
  return text;
}

std::string RobotView::summary() const {
  return fmt::format("{} clouds, {} placed, map of {} keyframes", localisations_, tracking_,
                     keyframes_);
}

}  // namespace voxlist::desk
