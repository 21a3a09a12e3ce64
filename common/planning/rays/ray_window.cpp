#include "voxlist/planning/rays/ray_window.h"

#include <algorithm>

#include "voxlist/planning/rays/passed_through.h"
#include "voxlist/planning/rays/single_echoes.h"

namespace voxlist::planning {

void RayWindow::advance(const Pose3& T_odom_base, std::int64_t oldest_us) {
  const Eigen::Isometry3f T_now_then = (T_odom_base.inverse() * T_odom_base_).cast<float>();
  T_odom_base_ = T_odom_base;
  std::erase_if(rays_, [&](const Ray& ray) { return ray.utime_us < oldest_us || is_refuted(ray); });
  for (Ray& ray : rays_) {
    ray.point = T_now_then * ray.point;
    ray.origin = T_now_then * ray.origin;
  }
}

std::vector<Ray> RayWindow::add(const Cloud& cloud_base) {
  const std::vector<Echo> echoes = look_at_echoes(cloud_base);
  const std::vector<LineDrop> drops = find_line_drops(cloud_base);
  std::vector<Ray> news;
  news.reserve(cloud_base.points.size());
  for (std::size_t i = 0; i < cloud_base.points.size(); ++i)
    news.push_back({cloud_base.points[i], cloud_base.origin(i), cloud_base.utime_us,
                    echoes[i].is_wide, echoes[i].is_mixed, 0, false, drops[i]});
  count_passes(rays_, news);
  rays_.insert(rays_.end(), news.begin(), news.end());
  return news;
}

void RayWindow::mark_came(const std::vector<bool>& came) {
  for (std::size_t i = 0; i < came.size(); ++i)
    rays_[rays_.size() - came.size() + i].came = came[i];
}

void RayWindow::forget_gone(const std::vector<Eigen::Vector3f>& places, float radius_m,
                            std::int64_t before_us) {
  std::erase_if(rays_, [&](const Ray& ray) {
    return ray.is_wide && ray.utime_us < before_us &&
           std::ranges::any_of(places, [&](const Eigen::Vector3f& place) {
             return (ray.point - place).head<2>().squaredNorm() < radius_m * radius_m;
           });
  });
}

}  // namespace voxlist::planning
