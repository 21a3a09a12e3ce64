#include "voxlist/mapping/pieces/carried_scans.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <vector>

namespace voxlist::mapping {
namespace {

class NearestKeyframe {
 public:
  explicit NearestKeyframe(std::span<const StampedPose3> keyframes)
      : keyframes_(keyframes), by_time_(keyframes.size()) {
    std::iota(by_time_.begin(), by_time_.end(), std::size_t{0});
    std::stable_sort(by_time_.begin(), by_time_.end(),
                     [&](std::size_t a, std::size_t b) { return time(a) < time(b); });
  }

  std::size_t to(const StampedPose3& scan) const {
    const auto later = first_from(scan.utime_us);
    const bool is_before = later == by_time_.end() ||
                           (later != by_time_.begin() &&
                            scan.utime_us - time(*(later - 1)) <= time(*later) - scan.utime_us);
    return nearest_of_time(time(is_before ? *(later - 1) : *later), scan);
  }

 private:
  std::int64_t time(std::size_t i) const { return keyframes_[i].utime_us; }

  std::vector<std::size_t>::const_iterator first_from(std::int64_t utime_us) const {
    return std::lower_bound(
        by_time_.begin(), by_time_.end(), utime_us,
        [&](std::size_t i, std::int64_t searched_us) { return time(i) < searched_us; });
  }

  std::size_t nearest_of_time(std::int64_t utime_us, const StampedPose3& scan) const {
    const auto away_m2 = [&](std::size_t i) {
      return (keyframes_[i].pose.translation() - scan.pose.translation()).squaredNorm();
    };
    return *std::min_element(first_from(utime_us), first_from(utime_us + 1),
                             [&](std::size_t a, std::size_t b) { return away_m2(a) < away_m2(b); });
  }

  std::span<const StampedPose3> keyframes_;
  std::vector<std::size_t> by_time_;
};

}  // namespace

void carry_scans(std::span<StampedPose3> scans, std::span<const StampedPose3> before,
                 std::span<const StampedPose3> after) {
  const NearestKeyframe nearest(before);
  for (StampedPose3& scan : scans) {
    const std::size_t i = nearest.to(scan);
    scan.pose = after[i].pose * before[i].pose.inverse() * scan.pose;
  }
}

}  // namespace voxlist::mapping
