#include "voxlist/adapter/deskew.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace voxlist::adapter {
namespace {

constexpr std::int64_t kStep_us = 2'000;

using Matrix34d = Eigen::Matrix<double, 3, 4>;

// The robot's poses at even steps over a sweep, seen from the cloud's frame.
class Steps {
 public:
  // Nothing when one of them is not known.
  static std::optional<Steps> over(const TimedPoints& points, const RobotMotion& motion,
                                   std::int64_t max_extrapolation_us, const Pose3& T_out_odom) {
    Steps steps;
    steps.first_s_ = static_cast<double>(points.first_us - points.utime_us) * 1e-6;
    const std::int64_t span_us = points.last_us - points.first_us;
    const std::int64_t n = (span_us + kStep_us - 1) / kStep_us;
    for (std::int64_t i = 0; i <= n; ++i) {
      const std::int64_t utime_us = points.first_us + (n == 0 ? 0 : span_us * i / n);
      const auto T_odom_base = motion.at(utime_us, max_extrapolation_us);
      if (!T_odom_base) return std::nullopt;
      steps.T_out_base_.emplace_back((T_out_odom * *T_odom_base).affine());
    }
    if (n > 0) steps.per_s_ = static_cast<double>(n) / (static_cast<double>(span_us) * 1e-6);
    return steps;
  }

  Matrix34d at(double offset_s) const {
    const double place = std::max(0.0, (offset_s - first_s_) * per_s_);
    const auto last = static_cast<double>(T_out_base_.size() - 1);
    if (!(place < last)) return T_out_base_.back();
    const auto i = static_cast<std::size_t>(place);
    return T_out_base_[i] + (place - std::floor(place)) * (T_out_base_[i + 1] - T_out_base_[i]);
  }

 private:
  double first_s_ = 0.0;
  double per_s_ = 0.0;
  std::vector<Matrix34d> T_out_base_;
};

Eigen::Vector3f moved(const Matrix34d& T, const Eigen::Vector3d& point) {
  return (T.leftCols<3>() * point + T.col(3)).cast<float>();
}

}  // namespace

bool add_moved(const TimedPoints& points, const RobotMotion& motion,
               std::int64_t max_extrapolation_us, const Pose3& T_out_odom, Cloud& cloud) {
  const auto steps = Steps::over(points, motion, max_extrapolation_us, T_out_odom);
  if (!steps) return false;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const double offset_s =
        points.offsets_s.empty() ? 0.0 : static_cast<double>(points.offsets_s[i]);
    const Matrix34d T = steps->at(offset_s);
    cloud.points.push_back(moved(T, points.points[i]));
    cloud.origins.push_back(moved(T, points.origin));
  }
  return true;
}

void add_standing(const TimedPoints& points, Cloud& cloud) {
  for (const Eigen::Vector3d& point : points.points) {
    cloud.points.push_back(point.cast<float>());
    cloud.origins.push_back(points.origin.cast<float>());
  }
}

}  // namespace voxlist::adapter
