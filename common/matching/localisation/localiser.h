#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/floors/floor_belief.h"
#include "voxlist/matching/floors/levelling.h"
#include "voxlist/matching/floors/standing_heights.h"
#include "voxlist/matching/localisation/localisation.h"
#include "voxlist/matching/localisation/thread_arena.h"
#include "voxlist/matching/motion/level_odometry.h"
#include "voxlist/matching/motion/pose_hint.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

class LostSearch;
class PoseTrack;
struct MotionLimits;

struct LocaliserConfig {
  MatcherConfig matcher;
  /// Without odometry: the fastest that the robot moves and turns.
  double max_speed_mps = 2.0;
  double max_turn_rate_dps = 120.0;
  TiltUse tilt = TiltUse::kPlanar;
  /// Threads that matching uses; 0: one for each core. Changes speed: no result depends on it.
  int threads = 0;

  template <class Visitor>
  void visit(Visitor& v) {
    v("max_speed_mps", max_speed_mps, "fastest motion to expect without odometry", 0.01, 50.0);
    v("max_turn_rate_dps", max_turn_rate_dps, "fastest turn to expect without odometry", 1.0,
      720.0);
    v("tilt", tilt, kTiltNames,
      "planar: clouds are level, poses are x, y, yaw; refine: height, roll and pitch are found "
      "too, "
      "beginning with the floor; odometry: beginning with ODOMETRY's roll and pitch");
    v("threads", threads,
      "threads that matching uses, 0: one for each core; no result depends on it", 0, 1024);
    matcher.visit(v);
  }
};

/// Finds each cloud's pose in a map: tracks from the last pose and the motion since, and searches
/// the whole map when it is lost. A scan that fits nowhere in reach is LOST by itself; after two of
/// them the robot may be elsewhere, and the whole map is searched. As long as one scan cannot tell
/// where it is, candidates live on over the next scans and the motion between them (AMBIGUOUS),
/// until one of them is sure; then it tracks. A cloud whose floor leans by 5 deg or more is LOST by
/// itself: taken for level, it would be placed decimetres off. AMBIGUOUS with one mode: in one
/// direction nothing in sight tells where it is, and the mode's covariance says which. Time is the
/// clouds' own. Use from one thread.
class Localiser {
 public:
  /// The map must outlive the localiser. It may change between two calls: the localiser notices by
  /// its revision, and the next cloud pays for making it ready anew (tens of milliseconds).
  Localiser(const OccupancyMap& map, const LocaliserConfig& config = {});
  ~Localiser();

  /// These blocks of the map have gained or lost something. Without this call the next cloud's
  /// result is the same, but comes later.
  void map_changed(const ChangedBlocks& changed);

  /// Locates a cloud (in base). `T_odom_base`: odometry's pose at the cloud's time, if there is
  /// odometry. In an empty map the cloud defines the map frame: TRACKING at the identity.
  Localisation localise(const Cloud& cloud,
                        const std::optional<Pose2>& T_odom_base = std::nullopt) {
    return localise(cloud, T_odom_base, std::nullopt);
  }

  /// The same with odometry's roll and pitch, if it measures them: used where config's tilt says
  /// so.
  Localisation localise(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                        const std::optional<Tilt>& odometry_tilt);

  /// Where the robot should be at a time, and how sure that is: by odometry since its last sure
  /// pose, or by its last step. Nothing while none is known.
  std::optional<UncertainPose> predict(std::int64_t utime_us,
                                       const std::optional<Pose2>& T_odom_base) const;

  /// Locates a cloud by itself, without a guess and without memory.
  Localisation locate(const Cloud& cloud);

  /// Searches the whole map for a cloud that may have been taken elsewhere, without a guess and
  /// without memory. It is judged as in tracking, by what was measured on maps of one scan, of few
  /// and of many. `here`: the probability, before the cloud is looked at, that it was taken where
  /// the map is.
  Localisation recognise(const Cloud& cloud, double here);

  /// The same for a cloud that was taken near `expected`, T_map_base, or nowhere in the map.
  Localisation recognise_near(const Cloud& cloud, const UncertainPose& expected);

  /// Goes on from a pose that is known (T_map_base).
  void start_at(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
                const UncertainPose& pose);

  /// Goes on where another localiser is in its own map. `T_this_other`: from that map to this one.
  void take_over(Localiser& other, const Pose2& T_this_other);

  /// The map was moved under the robot. `T_new_old`: from the map before to the map since.
  void move(const Pose2& T_new_old);

  /// Somebody thinks that the robot is there now (T_map_base): the next scans of a robot that is
  /// lost are looked for there, too. It is believed only where it would be without the hint.
  /// Returns false where nobody asks: the map is empty, or the scans say where the robot is.
  bool hint(const UncertainPose& pose);

  /// Forgets where the robot was: the next cloud is searched for in the whole map.
  void forget();

 private:
  MotionLimits limits() const;
  std::optional<Pose2> seen_from_above(const std::optional<Pose2>& T_odom_base,
                                       const std::optional<Tilt>& odometry_tilt) const;
  // Drops what was made of the map when that has changed since.
  void follow_map();
  Matcher& matcher();
  Localisation localise(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base);
  // What a cloud leaves behind when it was located.
  struct Belief;
  using Locate = std::function<Localisation(const PreparedScan&)>;

  Belief belief() const;
  void believe(Belief belief);
  Localisation locate_level(const Cloud& cloud, const KnownTilt& known, const Locate& locate);
  Localisation locate_at(const Cloud& cloud, const Tilt& tilt, const Locate& locate);
  Localisation locate_tilted(const Cloud& cloud, const KnownTilt& known,
                             const std::optional<Pose2>& expected, const Locate& locate);
  MatchPoints spatial_points(const Cloud& cloud) const;
  bool jumps(const Localisation& found) const;
  void weigh_floors(const MatchPoints& points, Localisation& result);
  struct RefinedTilt {
    Tilt tilt;
    double inlier_ratio = 0.0;
    bool is_near = false;  // to where it began
  };
  bool stands_on_floor(const MatchPoints& points, const KnownTilt& known,
                       const Localisation& found);
  Localisation not_level(Localisation result);
  RefinedTilt refined_tilt(const MatchPoints& points, const Pose2& place, const Tilt& start);
  RefinedTilt tilt_by_modes(const MatchPoints& points, const KnownTilt& known,
                            const Localisation& found);
  RefinedTilt best_guess(const MatchPoints& points, const KnownTilt& known, const Pose2& place);
  Tilt expected_tilt(const Cloud& cloud, const MatchPoints& points, const KnownTilt& known,
                     const Pose2& expected, const Locate& locate);
  Localisation located_from(const Cloud& cloud, const MatchPoints& points, const Tilt& first,
                            const Locate& locate);
  std::vector<Tilt> searched_tilts(const Cloud& cloud, const MatchPoints& points,
                                   const KnownTilt& known, const Locate& locate);
  Localisation located_anywhere(const Cloud& cloud, const MatchPoints& points,
                                const KnownTilt& known, const Locate& locate);
  Localisation answered(const Cloud& cloud, const std::optional<Pose2>& expected,
                        const std::optional<Tilt>& odometry_tilt, const Locate& locate);
  Localisation begin(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base);
  Localisation track(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base);
  Localisation search(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base);

  const OccupancyMap& map_;
  const LocaliserConfig config_;
  MapRevision revision_;  // of the map that matcher_ was made of
  ThreadArena threads_;
  std::unique_ptr<Matcher> matcher_;
  std::unique_ptr<PoseTrack> track_;
  std::unique_ptr<LostSearch> search_;
  OdometryCheck odometry_check_;
  Levelling levelling_;
  StandingHeights standing_heights_;
  FloorBelief floor_belief_;
  LevelOdometry level_odometry_;
  PoseHint hint_;
  std::optional<UncertainPose> hinted_;  // of the cloud that is located
};

}  // namespace voxlist::matching
