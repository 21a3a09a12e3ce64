#include "voxlist/planning/obstacles/moving_tracks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace voxlist::planning {
namespace {

// Points of one thing are no farther apart than this (m): a person's legs.
constexpr double kTogether_m = 0.25;

// Things that are followed (m, half their extent) and the points that make one.
constexpr double kLargest_m = 0.6;
constexpr std::size_t kFewestPoints = 4;

// A slice's part of a thing is complete when two slices brought no more of it (us).
constexpr std::int64_t kComplete_us = 130'000;

// A thing moves this fast at most (m/s) from one sighting to the next; its middle may always be
// seen this far (m) from where it was.
constexpr double kFastest_mps = 2.0, kMiddle_m = 0.3;

// Sightings older than this are no longer looked at (us): as long as points are kept, so that a
// place which is empty was seen to be.
constexpr std::int64_t kOldest_us = 3'500'000;

// What moves is faster (m/s), was seen so often, and went so far (m) at least.
constexpr double kSlowest_mps = 0.3, kLeastWay_m = 0.3;
constexpr std::size_t kSightings = 3;

// A place is empty when fewer than one in so many points are left: later rays miss some of them.
constexpr std::ptrdiff_t kLeftBehind = 2;

// A thing has come when one in so many of its points is where rays went through before: what is
// left of a wall in sight has some of them at its edge.
constexpr std::ptrdiff_t kCame = 3;

constexpr std::size_t kMostTracks = 64;

double seconds(std::int64_t us) { return static_cast<double>(us) * 1e-6; }

// Cells of one thing for each, by flooding from cell to cell.
std::vector<std::vector<const TypedPoint*>> things(const LocalGrid& grid,
                                                   const std::vector<const TypedPoint*>& points) {
  std::map<std::size_t, std::vector<const TypedPoint*>> left;
  for (const TypedPoint* point : points) left[point->cell].push_back(point);
  const auto disc = grid.disc(kTogether_m);
  std::vector<std::vector<const TypedPoint*>> things;
  while (!left.empty()) {
    std::vector<std::size_t> open{left.begin()->first};
    std::vector<const TypedPoint*> thing;
    while (!open.empty()) {
      const std::size_t cell = open.back();
      open.pop_back();
      const auto found = left.find(cell);
      if (found == left.end()) continue;
      thing.insert(thing.end(), found->second.begin(), found->second.end());
      left.erase(found);
      grid.around(cell, disc, [&](std::size_t other, float) {
        if (left.contains(other)) open.push_back(other);
      });
    }
    things.push_back(std::move(thing));
  }
  return things;
}

// Points that are still at a place.
std::ptrdiff_t points_at(const Eigen::Vector2d& place, double radius_m,
                         const std::vector<TypedPoint>& standing) {
  return std::count_if(standing.begin(), standing.end(), [&](const TypedPoint& point) {
    return (point.place().cast<double>() - place).norm() < radius_m;
  });
}

}  // namespace

Eigen::Vector2d MovingTracks::Track::velocity_mps() const {
  const Sighting& first = sightings.front();
  const double dt_s = std::max(1e-3, seconds(last().utime_us - first.utime_us));
  return (last().position - first.position) / dt_s;
}

std::vector<MovingTracks::Sighting> MovingTracks::sightings(
    const Pose3& T_odom_base, std::int64_t newest_us, const LocalGrid& grid,
    const std::vector<const TypedPoint*>& points) {
  std::vector<Sighting> seen;
  for (const auto& thing : things(grid, points)) {
    if (thing.size() < kFewestPoints) continue;
    Eigen::AlignedBox2f box;
    Sighting sighting{thing[0]->utime_us, thing[0]->utime_us, 0, {}, 0.0, std::ssize(thing), false};
    std::ptrdiff_t came = 0;
    std::int64_t into_us = 0;
    for (const TypedPoint* point : thing) {
      box.extend(point->place());
      sighting.first_us = std::min(sighting.first_us, point->utime_us);
      sighting.last_us = std::max(sighting.last_us, point->utime_us);
      into_us += point->utime_us - thing[0]->utime_us;
      came += point->came;
    }
    sighting.radius_m = static_cast<double>(box.sizes().maxCoeff()) / 2.0;
    if (sighting.radius_m > kLargest_m || sighting.last_us > newest_us) continue;
    sighting.came = kCame * came >= sighting.points;
    sighting.utime_us = thing[0]->utime_us + into_us / static_cast<std::int64_t>(thing.size());
    const Eigen::Vector3d middle(box.center().x(), box.center().y(), 0.0);
    sighting.position = (T_odom_base * middle).head<2>();
    seen.push_back(sighting);
  }
  return seen;
}

void MovingTracks::follow(const Sighting& sighting) {
  Track* nearest = nullptr;
  double nearest_m = 0.0;
  for (Track& track : tracks_) {
    const double dt_s = seconds(sighting.utime_us - track.last().utime_us);
    const double away_m = (sighting.position - track.last().position).norm();
    if (dt_s < 0.0 || away_m > kMiddle_m + kFastest_mps * dt_s) continue;
    if (!nearest || away_m < nearest_m) nearest = &track, nearest_m = away_m;
  }
  if (nearest && sighting.first_us > nearest->last().last_us)
    nearest->sightings.push_back(sighting);
  else if (!nearest && tracks_.size() < kMostTracks)
    tracks_.push_back({{sighting}});
}

void MovingTracks::forget(std::int64_t utime_us) {
  for (Track& track : tracks_) {
    std::erase_if(track.sightings, [&](const Sighting& sighting) {
      return utime_us - sighting.utime_us > kOldest_us;
    });
  }
  std::erase_if(tracks_, [](const Track& track) { return track.sightings.empty(); });
}

void MovingTracks::update(const Pose3& T_odom_base, std::int64_t utime_us, const LocalGrid& grid,
                          const std::vector<TypedPoint>& standing, std::int64_t sighting_us) {
  forget(utime_us);
  std::vector<const TypedPoint*> recent;
  for (const TypedPoint& point : standing)
    if (utime_us - point.utime_us <= sighting_us) recent.push_back(&point);
  const std::int64_t complete_us = sighting_us > 0 ? kComplete_us : 0;
  for (const Sighting& seen : sightings(T_odom_base, utime_us - complete_us, grid, recent))
    follow(seen);
  const Pose3 T_base_odom = T_odom_base.inverse();
  for (Track& track : tracks_) {
    const Sighting& first = track.sightings.front();
    const double way_m = (track.last().position - first.position).norm();
    const Eigen::Vector3d was(first.position.x(), first.position.y(), 0.0);
    track.came |= std::ranges::any_of(track.sightings, &Sighting::came);
    track.moves = track.sightings.size() >= kSightings &&
                  track.velocity_mps().norm() > kSlowest_mps &&
                  way_m > std::max(kLeastWay_m, 2.0 * first.radius_m) &&
                  points_at((T_base_odom * was).head<2>(), first.radius_m, standing) <
                      first.points / kLeftBehind;
  }
}

std::vector<MovingObstacle> MovingTracks::moving(const Pose3& T_odom_base,
                                                 std::int64_t utime_us) const {
  const Pose3 T_base_odom = T_odom_base.inverse();
  std::vector<MovingObstacle> moving;
  for (const Track& track : tracks_) {
    if (!track.moves && !track.came) continue;
    const Eigen::Vector2d velocity =
        track.moves ? track.velocity_mps() : Eigen::Vector2d(Eigen::Vector2d::Zero());
    const Eigen::Vector2d now =
        track.last().position + seconds(utime_us - track.last().utime_us) * velocity;
    const Eigen::Vector3d position = T_base_odom * Eigen::Vector3d(now.x(), now.y(), 0.0);
    const Eigen::Vector3d turned =
        T_base_odom.linear() * Eigen::Vector3d(velocity.x(), velocity.y(), 0.0);
    moving.push_back({position.head<2>().cast<float>(), turned.head<2>().cast<float>(),
                      static_cast<float>(track.last().radius_m)});
  }
  return moving;
}

}  // namespace voxlist::planning
