#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "voxlist/viewing/scene/keyframe_poses.h"

namespace voxlist::viewing {

class Board;

/// The way of the robot, on topics "path/0", "path/1", ... of kPointsEach points at most: only the
/// newest topic changes while it grows. Points 0.1 m apart are added; when they are too many, those
/// go without which the way looks the same. Topic "path" tells the first that counts. Each point
/// stands beside a keyframe, and moves with it.
class Travelled {
 public:
  static constexpr std::size_t kPointsEach = 64;
  /// Topics that are kept, 0.4 MB: the last 4 km of a way that bends by 0.05 m each metre.
  static constexpr std::size_t kMostTopics = 100;

  /// Adds a point of the map (m) where it is 0.1 m from the last one.
  void add(const Eigen::Vector3d& position, KeyframePoses& keyframes, std::int64_t now_us,
           Board& board);

  /// A keyframe stands elsewhere: so does what lies beside it.
  void move(std::size_t keyframe, const Pose3& T_map_base, std::int64_t now_us, Board& board);

  /// The next point begins a new piece.
  void interrupt() { begins_ = true; }

  /// Forgets all of it: the map is another one.
  void start_over(std::int64_t now_us, Board& board);

 private:
  struct Point {
    Eigen::Vector3f position;
    bool begins;
    std::optional<std::size_t> keyframe;
    Eigen::Vector3f in_keyframe;  // the position in the keyframe's base
  };
  using Piece = std::vector<Point>;

  static void mark_needed(const Piece& piece, std::size_t from, std::size_t to,
                          std::vector<bool>& is_needed);
  void thin(Piece& piece);
  void put(std::size_t piece, std::int64_t now_us, Board& board) const;
  void begin_piece(std::int64_t now_us, Board& board);

  std::deque<Piece> pieces_ = std::deque<Piece>(1);  // one for each topic from first_ on
  std::size_t thinned_ = 0;                          // points of the last piece that stay
  std::int64_t first_ = 0;
  std::optional<Eigen::Vector3d> last_;
  bool begins_ = true;
};

}  // namespace voxlist::viewing
