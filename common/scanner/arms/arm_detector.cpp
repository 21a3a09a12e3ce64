#include "voxlist/scanner/arms/arm_detector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"

namespace voxlist::scanner {
namespace {

// An arm's outermost beams (rad) may pass its end, or see only half of it: two beams of 1 deg.
constexpr double kEndMargin_rad = 2.0 * kRadPerDeg;

// Fewer beams than these at one end of a line are noise, not an arm that comes or leaves. An arm
// comes or leaves in a line only if that explains so many more of its beams than an arm that stays.
constexpr std::size_t kMinPart = 3;

// A line says nothing about an arm when more than this share of the arm's beams contradict the
// picture.
constexpr double kMaxContradiction = 0.2;

// A line shows the edge of the mirror's plate, not an arm, when more of the other beams are near
// than this many and this share of those that measured something. The edge can also cover the
// beginning or the end of a line alone; four wild beams of 131 are no edge.
constexpr double kMaxOthersNear = 4.0, kMaxShareNear = 0.04;

// A passage is not followed over a hole in LASER that is longer than this (us): at half a turn a
// second an arm passes in less.
constexpr std::int64_t kMaxGap_us = 500'000;

struct Beam {
  std::int64_t utime_us;
  bool blocked;
};

// The number of first beams that differ from the rest, so that the fewest beams contradict.
struct Split {
  std::size_t first = 0;
  bool first_blocked = false;
  std::size_t contradictions = 0;
};

Split best_split(const std::vector<Beam>& beams) {
  std::size_t blocked = 0;
  for (const Beam& beam : beams) blocked += beam.blocked;
  const std::size_t free = beams.size() - blocked;
  const Split whole{0, blocked > free, std::min(blocked, free)};
  Split best = whole;
  std::size_t blocked_before = 0;
  for (std::size_t i = 1; i < beams.size(); ++i) {
    blocked_before += beams[i - 1].blocked;
    if (i < kMinPart || beams.size() - i < kMinPart) continue;
    const std::size_t free_before = i - blocked_before;
    const std::size_t coming = blocked_before + (free - free_before);
    const std::size_t leaving = free_before + (blocked - blocked_before);
    if (coming < best.contradictions) best = {i, false, coming};
    if (leaving < best.contradictions) best = {i, true, leaving};
  }
  return best.contradictions + kMinPart <= whole.contradictions ? best : whole;
}

}  // namespace

ArmDetector::ArmDetector(std::vector<BlockingArm> arms, double height_max_m)
    : arms_(std::move(arms)), height_max_m_(height_max_m), watches_(arms_.size()) {
  for (const BlockingArm& arm : arms_) {
    const double turned_rad = std::numbers::pi - arm.last_beam_rad;
    fan_begin_rad_ = std::min({fan_begin_rad_, arm.first_beam_rad, turned_rad});
  }
}

void ArmDetector::reset() {
  watches_.assign(arms_.size(), {});
  last_line_us_.reset();
}

std::vector<ArmPassage> ArmDetector::add(const LaserLine& line) {
  const std::int64_t gap_us = line.utime_us - last_line_us_.value_or(line.utime_us);
  if (gap_us < 0 || gap_us > kMaxGap_us) reset();
  last_line_us_ = line.utime_us;
  std::vector<ArmPassage> passages;
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    // Next to the plate's edge nothing is a passage.
    if (shows_edge(line, arms_[i])) {
      watches_[i] = {};
      continue;
    }
    const std::optional<Sight> sight = look(line, arms_[i]);
    if (!sight) continue;
    std::optional<ArmPassage> passage = follow(watches_[i], *sight);
    if (!passage) continue;
    passage->arm = i;
    passages.push_back(*passage);
  }
  return passages;
}

bool ArmDetector::is_near(const LaserLine& line, std::size_t beam) const {
  return line.ranges_m[beam] * elementary::sin(line.angle_rad(beam)) < height_max_m_;
}

bool ArmDetector::shows_edge(const LaserLine& line, const BlockingArm& arm) const {
  std::size_t others = 0, near = 0;
  for (std::size_t i = 0; i < line.ranges_m.size(); ++i) {
    const double angle_rad = line.angle_rad(i);
    const bool own = angle_rad >= arm.first_beam_rad && angle_rad <= arm.last_beam_rad;
    if (own || angle_rad < fan_begin_rad_ || angle_rad > std::numbers::pi - fan_begin_rad_)
      continue;
    others += !std::isnan(line.ranges_m[i]);
    near += is_near(line, i);
  }
  return static_cast<double>(near) > kMaxOthersNear + kMaxShareNear * static_cast<double>(others);
}

std::optional<ArmDetector::Sight> ArmDetector::look(const LaserLine& line,
                                                    const BlockingArm& arm) const {
  std::vector<Beam> own;
  std::size_t own_all = 0;
  for (std::size_t i = 0; i < line.ranges_m.size(); ++i) {
    const double angle_rad = line.angle_rad(i);
    if (angle_rad < arm.first_beam_rad + kEndMargin_rad ||
        angle_rad > arm.last_beam_rad - kEndMargin_rad) {
      continue;
    }
    ++own_all;
    if (std::isnan(line.ranges_m[i])) continue;
    own.push_back({line.utime_us + std::llround(beam_delay_us(line, i)), is_near(line, i)});
  }
  if (own.size() < kMinPart || 4 * own.size() < own_all) return std::nullopt;
  const Split split = best_split(own);
  if (static_cast<double>(split.contradictions) >
      kMaxContradiction * static_cast<double>(own.size())) {
    return std::nullopt;
  }
  Sight sight{
      split.first_blocked, split.first_blocked, own.front().utime_us, own.back().utime_us, {}};
  if (split.first > 0) {
    sight.last_blocked = !split.first_blocked;
    sight.change = {own[split.first - 1].utime_us, own[split.first].utime_us};
  }
  return sight;
}

std::optional<ArmPassage> ArmDetector::follow(Watch& watch, const Sight& sight) {
  const bool was_blocked = watch.blocked_us.has_value();
  // An arm that is there does not come: free beams before blocked ones are its own ragged end.
  const bool comes = !was_blocked && (sight.first_blocked || sight.last_blocked);
  const bool leaves = (was_blocked || comes) && !sight.last_blocked;
  if (comes) {
    if (!sight.first_blocked) watch.enter = sight.change;
    if (sight.first_blocked && watch.free_us) watch.enter = {*watch.free_us, sight.first_us};
  }
  std::optional<ArmPassage> passage;
  if (leaves && watch.enter) {
    passage = ArmPassage{0, *watch.enter, {}};
    if (sight.first_blocked) passage->leave = sight.change;
    if (!sight.first_blocked) passage->leave = {*watch.blocked_us, sight.first_us};
  }
  if (leaves || !(was_blocked || comes)) {
    watch = {sight.last_us, std::nullopt, std::nullopt};
  } else {
    watch.free_us.reset();
    watch.blocked_us = sight.last_us;
  }
  return passage;
}

}  // namespace voxlist::scanner
