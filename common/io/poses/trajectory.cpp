#include "voxlist/io/poses/trajectory.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "voxlist/geometry/time_limit.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/cursor.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/poses/pose_file.h"

namespace voxlist::io {
namespace {

StampedPose3 parse_line(std::string_view line) {
  std::array<double, 8> v{};
  for (double& value : v) {
    value = parse_number(take_word(line));
    if (!std::isfinite(value)) {
      throw FormatError("a number is not finite");
    }
  }
  const auto rotation = unit_quaternion(v[7], v[4], v[5], v[6]);
  if (!take_word(line).empty() || std::abs(v[0]) * 1e6 > static_cast<double>(kMaxUtime_us)) {
    throw FormatError("is not \"t x y z qx qy qz qw\" with t in seconds");
  }
  if (!rotation) {
    throw FormatError("the quaternion is not of unit length");
  }
  StampedPose3 stamped{std::llround(v[0] * 1e6), Pose3::Identity()};
  stamped.pose.linear() = rotation->toRotationMatrix();
  stamped.pose.translation() << v[1], v[2], v[3];
  return stamped;
}

std::string seconds(std::int64_t utime_us) {
  const std::lldiv_t time = std::lldiv(std::abs(utime_us), 1'000'000);
  return fmt::format("{}{}.{:06}", utime_us < 0 ? "-" : "", time.quot, time.rem);
}

std::string format_line(const StampedPose3& stamped) {
  const auto& p = stamped.pose.translation();
  const Eigen::Quaterniond q(stamped.pose.linear());
  return fmt::format("{} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                     seconds(stamped.utime_us), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

std::vector<StampedPose3> read_tum(const std::filesystem::path& path) {
  const std::string bytes = read_file(path) + "\n";
  std::string_view rest = bytes;
  std::vector<StampedPose3> trajectory;
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    const std::string_view line = take_line(rest);
    std::string_view words = line;
    const std::string_view first = take_word(words);
    if (first.empty() || first.starts_with('#')) {
      continue;
    }
    try {
      trajectory.push_back(parse_line(line));
    } catch (const FormatError& error) {
      throw FileError(path, fmt::format("line {}: {}", line_number, error.what()));
    }
  }
  return trajectory;
}

std::vector<StampedPose3> trajectory_of(const PoseTable& table) {
  std::vector<StampedPose3> trajectory;
  for (const PoseRow& row : table.rows) trajectory.push_back({row.utime_us, row.pose});
  return trajectory;
}

void write_tum(const std::filesystem::path& path, const std::vector<StampedPose3>& trajectory) {
  std::string bytes = "# t_s x_m y_m z_m qx qy qz qw\n";
  for (const StampedPose3& stamped : trajectory) {
    bytes += format_line(stamped);
  }
  write_file_atomically(path, bytes);
}

void write_covariances(const std::filesystem::path& path,
                       const std::vector<StampedPose3>& trajectory,
                       const std::vector<Eigen::Matrix3d>& covariances) {
  std::string bytes =
      "# t_s xx xy xa yy ya aa: covariance of x, y (m) and yaw a (rad) in the map's axes, beside "
      "the first keyframe\n";
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    bytes += seconds(trajectory[i].utime_us);
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column)
        bytes += fmt::format(" {:.6e}", covariances[i](row, column));
    bytes += '\n';
  }
  write_file_atomically(path, bytes);
}

}  // namespace voxlist::io
