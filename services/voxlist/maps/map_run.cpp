#include "services/voxlist/maps/map_run.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "services/voxlist/output/stop.h"
#include "voxlist/matching/localisation/leaving.h"
#include "voxlist/matching/localisation/reach_match.h"
#include "voxlist/matching/localisation/thread_arena.h"

namespace voxlist::desk {
namespace {

using matching::Localisation;
using matching::LocalisationState;

// Before a scan is looked at, it was taken where another piece is with this probability. Nothing is
// known of that: with it, none of 880 scans of places that have nothing in common came near to
// joining (the likeliest had 0.75, and 0.995 is sure).
constexpr double kReturns = 0.5;
// A piece goes on where the one before it ended, as a robot that is followed does (pose_track.cpp).
constexpr double kGoesOn = 0.995;
// Where the two searches of look_back() agree, this probability is enough: that they do makes it
// five times as likely at least, as much as is missing to kSureInReach. On real stations, first
// looks agreed in 27 of 30 cases that were right, and 2 of 19 where maps had nothing in common.
constexpr double kSureBack = 0.975;
// How often it is looked from a new piece back at the one before: as it grows, more of that is in
// sight, and more that looks like it.
constexpr int kLookBacks = 3;
// Most searches at the end for what has no place yet, each 0.1 to 1 s.
constexpr std::size_t kLastSearches = 200;

Pose2 pose_of(const Localisation& found) { return found.modes.front().T_map_base; }

// Whether a search looked at everything, and what it found is held in every direction.
bool tells_a_place(const Localisation& found) {
  return !found.modes.empty() && found.unseen < 1.0 &&
         worst_sigma_m(found.modes.front().covariance) < mapping::kSamePlace_m;
}

// Whether a scan came as the others of a piece came: after a gap, the robot may be anywhere.
bool goes_on(const mapping::Piece& piece, std::int64_t utime_us) {
  const auto& trajectory = piece.trajectory();
  if (trajectory.size() < 2) return false;
  const std::int64_t last_us = trajectory.back().utime_us,
                     usual_us = last_us - trajectory[trajectory.size() - 2].utime_us;
  return 2 * (utime_us - last_us) <= 3 * usual_us;
}

}  // namespace

MapRun::MapRun(const matching::LocaliserConfig& localiser, const mapping::MapBuilderConfig& mapper,
               mapping::KeyframeSpool& spool)
    : localiser_(localiser),
      mapper_(mapper),
      spool_(spool),
      goes_on_(false),
      look_ahead_(spool, localiser.matcher, localiser.threads != 1),
      now_(&new_piece()) {}

MapRun::MapRun(const matching::LocaliserConfig& localiser, const mapping::MapBuilderConfig& mapper,
               mapping::KeyframeSpool& spool, mapping::MapBuilder map, mapping::Piece::Keep keep)
    : localiser_(localiser),
      mapper_(mapper),
      spool_(spool),
      goes_on_(true),
      look_ahead_(spool, localiser.matcher, false) {
  pieces_.push_back(std::make_unique<mapping::Piece>(localiser_, std::move(map), std::move(keep)));
  now_ = pieces_.front().get();
}

void MapRun::localise(const Scan& scan) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const Said said = look_at(scan);
  const double elapsed_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  scan_log_.push_back({scan.number, scan.cloud.utime_us, said.state, said.probability, elapsed_ms});
}

MapRun::Said MapRun::look_at(const Scan& scan) {
  note(scan);
  if (const auto said = go_back(scan)) return *said;
  const Localisation found =
      now_->localiser().localise(scan.cloud, scan.T_odom_base, scan.odometry_tilt);
  if (found.odometry_bias) odometry_bias_ = found.odometry_bias;
  if (!floor_ && localiser_.tilt == TiltUse::kPlanar) floor_ = found.floor;
  const Said said{found.state, found.confidence};
  if (found.tracking()) {
    take(scan, found);
    return said;
  }
  note_lost(scan, found.state);
  // Not searched for at the end: what did not hold it now may seem to hold it elsewhere.
  if (matching::is_followed(found)) return said;
  is_near(scan, found) ? wait(scan) : begin_piece(scan, found);
  return said;
}

void MapRun::place(Scan scan, const Pose3& T_map_base) {
  ++scans_;
  now_->add(std::move(scan.cloud), T_map_base);
}

void MapRun::finish() {
  left_ = nullptr;
  now_ = &map();
  for (std::size_t i = pieces_.size(); i-- > 0;)
    if (pieces_[i].get() != now_ && !is_confirmed(*pieces_[i])) loosen(*pieces_[i]);
  searches_ = 0;
  while (join_one()) {
  }
  searches_ = 0;
  place_loose();
  if (goes_on_ || stop_requested()) return;
  matching::ThreadArena(localiser_.threads).run([this] {
    closing_ = close_piece(map(), spool_, localiser_.matcher, look_ahead_.finish());
  });
}

std::vector<StampedPose3> MapRun::trajectory() const {
  std::vector<StampedPose3> poses = map().trajectory();
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.utime_us < b.utime_us; });
  return poses;
}

RunFigures MapRun::figures() const {
  RunFigures figures;
  figures.placed = std::ssize(map().trajectory());
  for (const auto& piece : pieces_) {
    if (piece.get() == &map()) continue;
    ++figures.pieces;
    figures.in_pieces += std::ssize(piece->trajectory());
  }
  figures.ambiguous = count_ambiguous();
  figures.lost = scans_ - figures.placed - figures.in_pieces - figures.ambiguous;
  figures.loops = static_cast<std::int64_t>(closing_.loops);
  figures.loops_refused = static_cast<std::int64_t>(closing_.refused);
  figures.loops_moved_m = closing_.moved_m;
  figures.first_lost = first_lost_;
  figures.odometry = odometry_;
  figures.odometry_bias = odometry_bias_;
  figures.floor = floor_;
  return figures;
}

// Counts the AMBIGUOUS scans that have no place in any piece.
std::int64_t MapRun::count_ambiguous() const {
  std::set<std::int64_t> placed_us;
  for (const auto& piece : pieces_)
    for (const StampedPose3& pose : piece->trajectory()) placed_us.insert(pose.utime_us);
  return std::count_if(ambiguous_us_.begin(), ambiguous_us_.end(),
                       [&](std::int64_t utime_us) { return !placed_us.contains(utime_us); });
}

const mapping::Piece& MapRun::map() const {
  if (goes_on_) return *pieces_.front();
  return **std::max_element(pieces_.begin(), pieces_.end(), [](const auto& a, const auto& b) {
    return a->trajectory().size() < b->trajectory().size();
  });
}

// A piece of one scan may be of a bad one.
bool MapRun::is_confirmed(const mapping::Piece& piece) const {
  return piece.trajectory().size() > 1 || (goes_on_ && &piece == pieces_.front().get());
}

mapping::Piece& MapRun::new_piece() {
  pieces_.push_back(
      std::make_unique<mapping::Piece>(localiser_, mapping::MapBuilder(mapper_), spool_));
  return *pieces_.back();
}

void MapRun::erase(const mapping::Piece& piece) {
  if (left_ == &piece) left_ = nullptr;
  if (behind_ && behind_->piece == &piece) behind_.reset();
  joint_.forget(&piece);
  std::erase_if(pieces_, [&](const auto& other) { return other.get() == &piece; });
}

void MapRun::note(const Scan& scan) {
  ++scans_;
  if (!first_us_) first_us_ = scan.cloud.utime_us;
  odometry_trail_.note(scan.cloud.utime_us, scan.T_odom_base);
  odometry_ = odometry_ || scan.T_odom_base;
}

void MapRun::note_lost(const Scan& scan, LocalisationState state) {
  if (state == LocalisationState::kAmbiguous) ambiguous_us_.push_back(scan.cloud.utime_us);
  const double seconds = static_cast<double>(scan.cloud.utime_us - *first_us_) * 1e-6;
  if (!first_lost_) first_lost_ = LostScan{scan.number, seconds};
}

// Where the scan fits the piece before, the newest one's only scan was bad.
std::optional<MapRun::Said> MapRun::go_back(const Scan& scan) {
  if (!left_) return std::nullopt;
  const Localisation found =
      left_->localiser().localise(scan.cloud, scan.T_odom_base, scan.odometry_tilt);
  if (!found.tracking()) return std::nullopt;
  loosen(*std::exchange(now_, std::exchange(left_, nullptr)));
  behind_.reset();
  joint_.clear();
  take(scan, found);
  return Said{found.state, found.confidence};
}

// Whether the next scan, or the one after, fits the piece that the robot is in.
bool MapRun::is_near(const Scan& scan, const Localisation& found) const {
  if (!is_confirmed(*now_) || now_->trajectory().empty()) return false;
  return matching::is_near({now_->trajectory().back().utime_us, T_odom_placed_},
                           {scan.cloud.utime_us, scan.T_odom_base}, found,
                           localiser_.max_speed_mps);
}

// The scan belongs to no piece; at the end it is searched for.
void MapRun::wait(const Scan& scan) {
  mapping::Piece& piece = new_piece();
  const Localisation found =
      piece.localiser().localise(scan.cloud, scan.T_odom_base, scan.odometry_tilt);
  if (!found.tracking()) return erase(piece);
  piece.take(scan.cloud, found.modes.front(), scan.T_odom_base);
  loosen(piece);
}

// The scan is the origin of a new piece, unless it is blind. `elsewhere`: what the piece so far
// says of it.
void MapRun::begin_piece(const Scan& scan, const Localisation& elsewhere) {
  mapping::Piece& piece = new_piece();
  const Localisation found =
      piece.localiser().localise(scan.cloud, scan.T_odom_base, scan.odometry_tilt);
  if (!found.tracking()) return erase(piece);
  mapping::Piece* const last = std::exchange(now_, &piece);
  now_->take(scan.cloud, found.modes.front(), scan.T_odom_base);
  behind_.reset();
  joint_.clear();
  if (goes_on(*last, scan.cloud.utime_us) && !elsewhere.modes.empty())
    behind_ = {last, pose_of(elsewhere)};
  if (is_confirmed(*last) || !left_) {
    left_ = last;
  } else if (is_confirmed(*left_)) {
    loosen(*last);
  } else {
    loosen(*std::exchange(left_, last));
  }
  look_back();
}

void MapRun::take(const Scan& scan, const Localisation& found) {
  const bool is_second = !is_confirmed(*now_);
  T_odom_placed_ = scan.T_odom_base;
  const bool is_keyframe = now_->take(scan.cloud, found.modes.front(), scan.T_odom_base);
  if (is_second && left_ && !is_confirmed(*left_)) loosen(*left_);
  if (is_second) left_ = nullptr;
  if (!is_keyframe) return;
  if (const auto& all = now_->keyframes(); all.size() > 1)
    look_ahead_.add(all[all.size() - 2], all.back());
  look_back();
  search_elsewhere(scan);
}

// Its only scan belongs to no piece any more.
void MapRun::loosen(mapping::Piece& piece) {
  loose_.insert(loose_.end(), piece.keyframes().begin(), piece.keyframes().end());
  erase(piece);
}

// Whether the newest scan, which is a keyframe now, fits one of the others, which take turns: one
// search for each keyframe.
void MapRun::search_elsewhere(const Scan& scan) {
  std::vector<mapping::Piece*> others;
  for (const auto& piece : pieces_)
    if (piece.get() != now_ && is_confirmed(*piece)) others.push_back(piece.get());
  if (others.empty()) return;
  mapping::Piece& other = *others[searches_++ % others.size()];
  const Localisation found = other.localiser().recognise(scan.cloud, kReturns);
  if (!tells_a_place(found)) return;
  const Pose2 T_now_base = to_pose2(now_->trajectory().back().pose);
  const Pose2 T_other_now = pose_of(found) * T_now_base.inverse();
  if (joint_.add(&other, T_other_now * T_now_base, T_now_base, found.confidence))
    join(other, *now_, T_other_now);
}

// A drive goes on where it was, so backwards, the last scan of the piece before may fit the newest
// one, which may have grown since, as the next scan of any drive does; and it must be there where
// that piece said that the newest one's first scan may be. Of the two, the latter is more exact:
// it is by all scans of that piece.
void MapRun::look_back() {
  if (!behind_ || behind_->piece->keyframes().empty() || ++behind_->looks > kLookBacks)
    return behind_.reset();
  const mapping::SpooledKeyframe& last = behind_->piece->keyframes().back();
  const Localisation back = now_->localiser().recognise(spool_.read(last).cloud, kGoesOn);
  if (back.confidence < kSureBack || !tells_a_place(back)) return;
  const Pose2 T_behind_now = to_pose2(last.T_map_base) * pose_of(back).inverse();
  const Pose2 T_by_all = behind_->T_behind_now;
  if (mapping::is_same_place(T_behind_now, T_by_all)) return join(*behind_->piece, *now_, T_by_all);
  if (back.confidence < matching::kSureInReach) return;
  if (behind_->T_look && mapping::is_same_place(T_behind_now, *behind_->T_look))
    return join(*behind_->piece, *now_, T_behind_now);
  behind_->T_look = T_behind_now;
}

// The smaller piece goes into the larger one.
void MapRun::join(mapping::Piece& piece, mapping::Piece& other, const Pose2& T_piece_other) {
  const bool fixed = goes_on_ && &piece == pieces_.front().get();
  if (!fixed && piece.trajectory().size() < other.trajectory().size())
    return join(other, piece, T_piece_other.inverse());
  piece.join(other, T_piece_other);
  if (&other == now_) {
    piece.localiser().take_over(other.localiser(), T_piece_other);
    now_ = &piece;
  }
  erase(other);
  if (left_ == now_) left_ = nullptr;
  behind_.reset();
  joint_.clear();
}

// Searches each piece for the scans of smaller ones, the map first, until one joins another.
bool MapRun::join_one() {
  std::vector<mapping::Piece*> pieces;
  for (const auto& piece : pieces_) pieces.push_back(piece.get());
  std::stable_sort(pieces.begin(), pieces.end(), [this](const auto* a, const auto* b) {
    if (a == &map() || b == &map()) return a == &map() && b != &map();
    return a->trajectory().size() > b->trajectory().size();
  });
  for (std::size_t larger = 0; larger < pieces.size(); ++larger)
    for (std::size_t smaller = larger + 1; smaller < pieces.size(); ++smaller)
      if (joins(*pieces[larger], *pieces[smaller])) return true;
  return false;
}

bool MapRun::joins(mapping::Piece& larger, mapping::Piece& smaller) {
  joint_.clear();
  for (const mapping::SpooledKeyframe& keyframe : smaller.keyframes()) {
    if (stop_requested() || ++searches_ > kLastSearches) return false;
    const Localisation found = larger.localiser().recognise(spool_.read(keyframe).cloud, kReturns);
    const Pose2 T_smaller_base = to_pose2(keyframe.T_map_base);
    if (!tells_a_place(found) ||
        !joint_.add(&larger, pose_of(found), T_smaller_base, found.confidence))
      continue;
    join(larger, smaller, pose_of(found) * T_smaller_base.inverse());
    return true;
  }
  return false;
}

void MapRun::place_loose() {
  std::erase_if(loose_, [&](const mapping::SpooledKeyframe& keyframe) {
    if (stop_requested() || ++searches_ > kLastSearches) return false;
    const Cloud cloud = spool_.read(keyframe).cloud;
    const std::optional<Pose2>& T_odom_base = keyframe.T_odom_base;
    return place_between(cloud, T_odom_base) || place_anywhere(cloud, T_odom_base);
  });
}

// Places a scan that came while the robot was followed: the map has both of its sides now.
bool MapRun::place_between(const Cloud& cloud, const std::optional<Pose2>& T_odom_base) {
  const auto expected = odometry_trail_.expect(map().trajectory(), cloud.utime_us);
  if (!expected) return false;
  const Localisation found = map().localiser().recognise_near(cloud, *expected);
  if (found.tracking()) map().take(cloud, found.modes.front(), T_odom_base);
  return found.tracking();
}

bool MapRun::place_anywhere(const Cloud& cloud, const std::optional<Pose2>& T_odom_base) {
  const Localisation found = map().localiser().recognise(cloud, kReturns);
  const bool sure = tells_a_place(found) && mapping::is_sure_alone(found.confidence);
  if (sure) map().take(cloud, found.modes.front(), T_odom_base);
  return sure;
}

}  // namespace voxlist::desk
