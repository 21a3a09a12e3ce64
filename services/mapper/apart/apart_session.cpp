#include "services/mapper/apart/apart_session.h"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "voxlist/bus/health.h"
#include "voxlist/service/stop.h"

namespace voxlist::services {
namespace {

using matching::Localisation;
using matching::ScanMoment;

// Most bytes of a piece that are kept: what comes then is of another piece.
constexpr std::size_t kMostBytes = 256'000'000;
// A map of fewer clouds may be of a bad one: the localiser sees to that (OriginDoubt).
constexpr std::int64_t kFewest = 2;
// Clouds that fit both are asked from places so far (m) apart: what a cloud shows changes with the
// place, and neighbours err together. As far as where two maps are merged.
constexpr double kEach_m = 2.0;
// What one such cloud says is taken for no surer than this, however well it is tracked: it takes
// two.
constexpr double kSurest = 0.9999;

std::size_t bytes_of(const Cloud& cloud) {
  return (cloud.points.size() + cloud.origins.size()) * sizeof(Eigen::Vector3f);
}

const Pose2& pose_of(const Localisation& found) { return found.modes.front().T_map_base; }

}  // namespace

ApartSession::ApartSession(bus::Health& health, const std::filesystem::path& folder, bool is_saved,
                           const matching::LocaliserConfig& localiser,
                           const mapping::MapBuilderConfig& builder)
    : health_(health),
      localiser_(localiser),
      builder_(builder),
      is_saved_(is_saved),
      file_(health, folder) {
  if (const auto left = file_.left_by_another()) take_up(*left);
}

ApartSession::~ApartSession() = default;

// The file goes where all of its clouds hang together, and so are in a new one.
void ApartSession::take_up(const std::filesystem::path& left) try {
  const std::vector<ApartCloud> clouds = read_apart_file(left);
  for (const ApartCloud& seen : clouds) {
    if (service::stop_requested()) return;
    const ScanMoment now{seen.cloud.utime_us, seen.T_odom_base};
    piece_ ? go_on(seen.cloud, now) : begin(seen.cloud, now);
  }
  if (kept_.size() == clouds.size()) file_.remove_left(left);
  if (piece_) piece_->localiser().forget();  // nobody knows where the robot is now
  in_piece_.reset();
} catch (const std::exception&) {
  health_.count("apart/not_read");
}

void ApartSession::lost(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                        const Localisation& in_map) {
  if (!file_.is_possible() || !joining_.empty()) return;
  const ScanMoment now{cloud.utime_us, T_odom_base};
  if (piece_)
    go_on(cloud, now);
  else if (has_left_map(now, in_map))
    begin(cloud, now);
}

// Where the robot was never found in a saved map, it may be anywhere.
bool ApartSession::has_left_map(const ScanMoment& now, const Localisation& in_map) const {
  if (found_ == 0) return is_saved_;
  if (found_ < kFewest && !is_saved_) return false;
  return !matching::is_followed(in_map) &&
         !matching::is_near(in_map_, now, in_map, localiser_.max_speed_mps);
}

// Of a piece of one cloud, that may be the bad one.
bool ApartSession::is_left_by(const ScanMoment& now, const Localisation& found) const {
  if (matching::is_followed(found)) return false;
  return piece_->trajectory().size() < 2 ||
         !matching::is_near(*in_piece_, now, found, localiser_.max_speed_mps);
}

void ApartSession::go_on(const Cloud& cloud, const ScanMoment& now) {
  const Localisation found = look(cloud, now);
  if (found.tracking())
    take(cloud, found, now);
  else if (!piece_)
    begin(cloud, now);
}

// What the piece says of a cloud; if the robot has left it, the piece is over.
Localisation ApartSession::look(const Cloud& cloud, const ScanMoment& now) {
  const Localisation found = piece_->localiser().localise(cloud, now.T_odom_base);
  if (found.tracking() || !in_piece_) in_piece_ = now;
  if (!found.tracking() && is_left_by(now, found)) leave();
  return found;
}

// The cloud is the origin of a piece, unless it is blind.
void ApartSession::begin(const Cloud& cloud, const ScanMoment& now) {
  piece_ = std::make_unique<mapping::Piece>(
      localiser_, mapping::MapBuilder(builder_),
      [this](const mapping::Keyframe& keyframe, const std::optional<Pose2>& T_odom_base) {
        keep({keyframe.cloud, keyframe.T_map_base, T_odom_base});
      });
  const Localisation found = piece_->localiser().localise(cloud, now.T_odom_base);
  if (!found.tracking()) return end_piece();
  in_piece_ = now;
  take(cloud, found, now);
}

void ApartSession::take(const Cloud& cloud, const Localisation& found, const ScanMoment& now) {
  if (bytes_ > kMostBytes) return health_.count("apart/no_room");
  piece_->take(cloud, found.modes.front(), now.T_odom_base);
}

// A piece of one cloud may be of a bad one: it is written with the second.
void ApartSession::keep(ApartCloud keyframe) {
  bytes_ += bytes_of(keyframe.cloud);
  kept_.push_back(std::move(keyframe));
  if (kept_.size() == 2) file_.write(kept_.front());
  if (kept_.size() > 1) file_.write(kept_.back());
  tell();
}

// Nothing is added to the piece meanwhile: the map has it.
void ApartSession::found(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                         const Localisation& in_map) {
  in_map_ = {cloud.utime_us, T_odom_base};
  ++found_;
  if (!piece_) return;
  const Localisation in_piece = look(cloud, in_map_);
  if (!in_piece.tracking()) return;
  const Pose2 &T_map_base = pose_of(in_map), &T_piece_base = pose_of(in_piece);
  if (asked_at_ && distance_m(*asked_at_, T_piece_base) < kEach_m) return;
  asked_at_ = T_piece_base;
  const double confidence = std::min({in_map.confidence, in_piece.confidence, kSurest});
  if (joint_.add(nullptr, T_map_base, T_piece_base, confidence))
    join(T_map_base * T_piece_base.inverse());
}

void ApartSession::join(const Pose2& T_map_piece) {
  joining_ = std::move(kept_);
  for (ApartCloud& keyframe : joining_) keyframe.pose = to_pose3(T_map_piece) * keyframe.pose;
  end_piece();
}

std::optional<ApartCloud> ApartSession::place_next() {
  if (joining_.empty()) return std::nullopt;
  ApartCloud keyframe = std::move(joining_.back());
  joining_.pop_back();
  health_.count("apart/joined");
  if (joining_.empty()) file_.remove();
  return keyframe;
}

void ApartSession::move(const Pose2& T_new_old) {
  for (ApartCloud& keyframe : joining_) keyframe.pose = to_pose3(T_new_old) * keyframe.pose;
  joint_.clear();
  asked_at_.reset();
}

// The robot is elsewhere: what was mapped is in its recording.
void ApartSession::leave() {
  file_.leave();
  end_piece();
}

void ApartSession::end_piece() {
  piece_.reset();
  kept_.clear();
  bytes_ = 0;
  in_piece_.reset();
  joint_.clear();
  asked_at_.reset();
  tell();
}

void ApartSession::tell() const {
  health_.gauge("apart_keyframes", static_cast<double>(kept_.size()));
  std::string sentence;
  if (kept_.size() > 1)
    sentence =
        fmt::format("mapping apart, {} keyframes that have no place in the map yet, kept in {}",
                    kept_.size(), file_.path().string());
  health_.raise("apart", bus::Health::State::kWarning, sentence);
}

}  // namespace voxlist::services
