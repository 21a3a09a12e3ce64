#include "voxlist/viewing/scene/travelled.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "voxlist/viewing/scene/board.h"

namespace voxlist::viewing {
namespace {

constexpr double kStep_m = 0.1;

// A pose that jumps so far was corrected: the robot did not drive there.
constexpr double kJump_m = 1.0;

// A full piece leaves out points that lie so near to the straight way past them (m), which is more
// than poses are off by from scan to scan. It goes on while no more than kMostKept are left.
constexpr float kStraight_m = 0.05F;
constexpr std::size_t kMostKept = Travelled::kPointsEach * 3 / 4;

std::string topic_name(std::int64_t number) { return "path/" + std::to_string(number); }

std::string first_as_json(std::int64_t first) {
  return "{\"first\":" + std::to_string(first) + "}";
}

float distance_to_line(const Eigen::Vector3f& point, const Eigen::Vector3f& from,
                       const Eigen::Vector3f& to) {
  const Eigen::Vector3f along = to - from;
  const float length2 = along.squaredNorm();
  const float part = length2 > 0.0F ? std::clamp(along.dot(point - from) / length2, 0.0F, 1.0F) : 0;
  return (from + part * along - point).norm();
}

}  // namespace

void Travelled::add(const Eigen::Vector3d& position, KeyframePoses& keyframes, std::int64_t now_us,
                    Board& board) {
  const double step_m = last_ ? (position - *last_).norm() : kStep_m;
  if (step_m < kStep_m) return;
  if (pieces_.back().size() == kPointsEach) {
    thin(pieces_.back());
    if (pieces_.back().size() > kMostKept) begin_piece(now_us, board);
  }
  Point point{position.cast<float>(), begins_ || step_m > kJump_m, keyframes.near(position), {}};
  if (point.keyframe)
    point.in_keyframe = (keyframes.pose(*point.keyframe).inverse() * position).eval().cast<float>();
  pieces_.back().push_back(point);
  begins_ = false;
  last_ = position;
  put(pieces_.size() - 1, now_us, board);
}

void Travelled::move(std::size_t keyframe, const Pose3& T_map_base, std::int64_t now_us,
                     Board& board) {
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    bool is_moved = false;
    for (Point& point : pieces_[i]) {
      if (point.keyframe != keyframe) continue;
      point.position = (T_map_base * point.in_keyframe.cast<double>()).eval().cast<float>();
      is_moved = true;
    }
    if (is_moved) put(i, now_us, board);
  }
}

// The point farthest from the line between the ends is needed where it is far, and so on to both
// sides of it. A point that begins a way is needed, and so is the one before it.
void Travelled::mark_needed(const Piece& piece, std::size_t from, std::size_t to,
                            std::vector<bool>& is_needed) {
  is_needed[from] = is_needed[to] = true;
  float farthest_m = kStraight_m;
  std::size_t farthest = to;
  for (std::size_t i = from + 1; i < to; ++i) {
    const float distance_m =
        distance_to_line(piece[i].position, piece[from].position, piece[to].position);
    if (distance_m > farthest_m) {
      farthest_m = distance_m;
      farthest = i;
    }
  }
  if (farthest == to) return;
  mark_needed(piece, from, farthest, is_needed);
  mark_needed(piece, farthest, to, is_needed);
}

// What was thinned before stays as it is: what is left out of each part lies within kStraight_m.
void Travelled::thin(Piece& piece) {
  std::vector<bool> is_needed(piece.size());
  std::fill_n(is_needed.begin(), thinned_, true);
  std::size_t from = thinned_ == 0 ? 0 : thinned_ - 1;
  for (std::size_t i = from + 1; i <= piece.size(); ++i) {
    if (i < piece.size() && !piece[i].begins) continue;
    mark_needed(piece, from, i - 1, is_needed);
    from = i;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < piece.size(); ++i)
    if (is_needed[i]) piece[kept++] = piece[i];
  piece.resize(kept);
  thinned_ = kept;
}

// A new topic begins with the last point, so that pieces meet.
void Travelled::begin_piece(std::int64_t now_us, Board& board) {
  Point last = pieces_.back().back();
  last.begins = true;
  put(pieces_.size() - 1, now_us, board);
  pieces_.push_back({last});
  thinned_ = 1;
  if (pieces_.size() <= kMostTopics) return;
  pieces_.pop_front();
  board.drop(topic_name(first_));
  board.put("path", first_as_json(++first_), now_us);
}

void Travelled::put(std::size_t piece, std::int64_t now_us, Board& board) const {
  std::vector<float> values;
  for (const Point& point : pieces_[piece]) {
    values.insert(values.end(), point.position.begin(), point.position.end());
    values.push_back(point.begins ? 1.0F : 0.0F);
  }
  std::vector<std::uint8_t> bytes(values.size() * sizeof(float));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  board.put(topic_name(first_ + static_cast<std::int64_t>(piece)), "{}", now_us, std::move(bytes));
}

void Travelled::start_over(std::int64_t now_us, Board& board) {
  board.drop("path/");
  first_ += static_cast<std::int64_t>(pieces_.size());
  pieces_ = std::deque<Piece>(1);
  thinned_ = 0;
  last_.reset();
  begins_ = true;
  board.put("path", first_as_json(first_), now_us);
}

}  // namespace voxlist::viewing
