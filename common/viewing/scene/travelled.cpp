#include "voxlist/viewing/scene/travelled.h"

#include <cstring>

#include "voxlist/viewing/scene/board.h"

namespace voxlist::viewing {
namespace {

constexpr double kStep_m = 0.1;

// A pose that jumps so far was corrected: the robot did not drive there.
constexpr double kJump_m = 1.0;

std::string topic_name(std::int64_t number) { return "path/" + std::to_string(number); }

std::string first_as_json(std::int64_t first) {
  return "{\"first\":" + std::to_string(first) + "}";
}

}  // namespace

void Travelled::add(const Eigen::Vector3d& position, std::int64_t now_us, Board& board) {
  const double step_m = last_ ? (position - *last_).norm() : kStep_m;
  if (step_m < kStep_m) return;
  if (points_.size() == kPointsEach) begin_topic(now_us, board);
  const Eigen::Vector3f p = position.cast<float>();
  const bool begins = begins_ || step_m > kJump_m;
  points_.push_back({p.x(), p.y(), p.z(), begins ? 1.0F : 0.0F});
  begins_ = false;
  last_ = position;
  put(now_us, board);
}

// A new topic begins with the last point, so that pieces meet.
void Travelled::begin_topic(std::int64_t now_us, Board& board) {
  points_ = {points_.back()};
  points_.front().begins = 1.0F;
  ++topic_;
  if (topic_ - first_ < kMostTopics) return;
  board.drop(topic_name(first_));
  board.put("path", first_as_json(++first_), now_us);
}

void Travelled::put(std::int64_t now_us, Board& board) const {
  std::vector<std::uint8_t> bytes(points_.size() * sizeof(Point));
  std::memcpy(bytes.data(), points_.data(), bytes.size());
  board.put(topic_name(topic_), "{}", now_us, std::move(bytes));
}

void Travelled::start_over(std::int64_t now_us, Board& board) {
  board.drop("path/");
  points_.clear();
  last_.reset();
  begins_ = true;
  first_ = ++topic_;
  board.put("path", first_as_json(first_), now_us);
}

}  // namespace voxlist::viewing
