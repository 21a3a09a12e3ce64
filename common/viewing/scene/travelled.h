#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace voxlist::viewing {

class Board;

/// The way of the robot, on topics "path/0", "path/1", ... of kPointsEach points: only the newest
/// topic changes while it grows. Topic "path" tells the first that counts.
class Travelled {
 public:
  static constexpr std::size_t kPointsEach = 64;
  /// Topics that are kept: at 0.1 m between points the last 6 km.
  static constexpr std::int64_t kMostTopics = 1000;

  /// Adds a point of the map (m) where it is 0.1 m from the last one.
  void add(const Eigen::Vector3d& position, std::int64_t now_us, Board& board);

  /// The next point begins a new piece.
  void interrupt() { begins_ = true; }

  /// Forgets all of it: the map is another one.
  void start_over(std::int64_t now_us, Board& board);

 private:
  struct Point {
    float x, y, z, begins;
  };

  void put(std::int64_t now_us, Board& board) const;
  void begin_topic(std::int64_t now_us, Board& board);

  std::vector<Point> points_;  // of the newest topic
  std::int64_t topic_ = 0, first_ = 0;
  std::optional<Eigen::Vector3d> last_;
  bool begins_ = true;
};

}  // namespace voxlist::viewing
