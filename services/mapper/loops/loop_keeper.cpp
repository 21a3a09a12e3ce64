#include "services/mapper/loops/loop_keeper.h"

#include <fmt/core.h>

#include <stdexcept>
#include <utility>

#include "voxlist/bus/health.h"
#include "voxlist/geometry/angle.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/loops/stored_looks.h"
#include "voxlist/matching/localisation/thread_arena.h"

namespace voxlist::services {
namespace {

// So many keyframes from which ground of long before may be seen make a search worth it: four looks
// 2 m apart must agree.
constexpr std::size_t kReturns = 8;
// The pause between two searches, in times of what the last one took: searching takes a quarter of
// one core.
constexpr std::int64_t kPause = 4;
// A map is moved where a keyframe moves by more than this.
constexpr double kMoved_m = 0.01, kTurned_rad = 0.1 * kRadPerDeg;
// So many keyframes that came meanwhile are added at once, each in 3 to 10 ms; more, in the thread.
constexpr std::size_t kAtOnce = 3;

class Stopped : public std::runtime_error {
 public:
  Stopped() : std::runtime_error("stopped") {}
};

}  // namespace

// What the thread works on, and nobody else meanwhile.
struct LoopKeeper::Work {
  mapping::MapKeyframes keyframes;
  std::unique_ptr<mapping::StoredKeyframes> stored;
  mapping::SessionClosing closing;
  drawing::ClosedLoops drawn;
  std::optional<mapping::MapBuilder> builder;
  // How the newest of those was moved, and by how much (m) it was lifted.
  Pose2 T_new_old;
  double rise_m = 0.0;
  // No keyframe comes any more: what moves at all is moved, as at the desk.
  bool is_last = false;
  std::int64_t took_us = 0;

  bool moves_enough() const {
    return is_last ? closing.moves : closing.moved_m > kMoved_m || closing.turned_rad > kTurned_rad;
  }

  mapping::Keyframe read(std::size_t keyframe, const Background::Stop& stop) const {
    if (stop) throw Stopped();
    auto found = stored->read(keyframe);
    if (!found) throw std::runtime_error("the disk lost a keyframe");
    mapping::stand_at(keyframes[keyframe], found->T_map_base);
    return std::move(*found);
  }

  void build(const Background::Stop& stop) {
    while (builder->poses().size() < keyframes.size())
      builder->add(read(builder->poses().size(), stop));
  }
};

LoopKeeper::LoopKeeper(bus::Health& health, LoopUse use, const mapping::MapBuilderConfig& builder)
    : health_(health),
      use_(use),
      config_(builder),
      watch_(matching::MatcherConfig().scan.max_range_m) {}

void LoopKeeper::add(const StampedPose3& T_map_keyframe,
                     const std::optional<Pose2>& T_odom_keyframe) {
  const std::int64_t utime_us = T_map_keyframe.utime_us;
  const bool goes_back = !keyframes_.empty() && utime_us < keyframes_.back().utime_us;
  restore({utime_us, to_pose2(T_map_keyframe.pose), T_odom_keyframe, goes_back,
           tilt_of(T_map_keyframe.pose)});
}

void LoopKeeper::restore(const mapping::StoredGraph::Keyframe& keyframe) {
  keyframes_.push_back(keyframe);
  watch_.add(keyframe.T_map_keyframe);
}

void LoopKeeper::keep_looks(const std::filesystem::path& folder, std::int64_t map_id) {
  folder_ = folder;
  map_id_ = map_id;
  const std::string fault = mapping::read_looks(folder_, map_id_, keyframes_, memory_);
  if (fault.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(folder_ / mapping::kLooksFile, ignored);
  health_.count("loops/looks_lost");
}

void LoopKeeper::clear() {
  background_.cancel();
  work_.reset();
  memory_.clear();
  newest_looked_at_ = 0;
  keyframes_.clear();
  watch_.clear();
}

std::optional<ClosedMap> LoopKeeper::tick(std::int64_t now_us, const Open& open) {
  if (background_.is_busy()) return std::nullopt;
  if (!work_) {
    if (use_ == LoopUse::kAlways && is_worth_it(now_us)) begin(open);
    return std::nullopt;
  }
  const std::int64_t took_us = work_->took_us + background_.took_us();
  auto closed = go_on(open);
  if (!work_) next_us_ = now_us + kPause * took_us;
  return closed;
}

std::optional<ClosedMap> LoopKeeper::finish(const Open& open, double at_most_s) {
  if (!work_ && (use_ == LoopUse::kNever || newest_looked_at_ == keyframes_.size())) return {};
  if (!work_) begin(open);
  while (work_) {
    if (!background_.wait_for(at_most_s)) {
      health_.count("loops/out_of_time");
      background_.cancel();
    }
    work_->is_last = newest_looked_at_ == keyframes_.size();
    if (auto closed = go_on(open)) return closed;
  }
  return {};
}

bool LoopKeeper::is_worth_it(std::int64_t now_us) const {
  return watch_.returns() >= kReturns && (!next_us_ || now_us >= *next_us_);
}

void LoopKeeper::begin(const Open& open) {
  auto stored = open();
  if (!stored || stored->size() != keyframes_.size()) return;
  watch_.reset();
  newest_looked_at_ = keyframes_.size();
  work_ = std::make_shared<Work>();
  work_->keyframes = keyframes_;
  work_->stored = std::move(stored);
  background_.start([this, work = work_](const Background::Stop& stop) {
    const auto read = [&](std::size_t i) { return mapping::level_cloud(work->read(i, stop)); };
    matching::ThreadArena(1).run(
        [&] { work->closing = mapping::close_sessions(work->keyframes, read, {}, {}, &memory_); });
    write_looks(work->keyframes);
  });
}

// In the thread, when a search has ended. A disk that is full costs no more than the next start.
void LoopKeeper::write_looks(const mapping::MapKeyframes& keyframes) try {
  if (!folder_.empty()) mapping::write_looks(folder_, map_id_, keyframes, memory_);
} catch (const io::FileError&) {
}

// One step has ended. The next one begins, or the work is done, or is given up.
std::optional<ClosedMap> LoopKeeper::go_on(const Open& open) {
  background_.wait();
  work_->took_us += background_.took_us();
  const bool failed = !background_.failure().empty();
  if (failed) health_.count("loops/failed");
  if (failed || !prepare() || !reopen(open)) {
    work_.reset();
    return std::nullopt;
  }
  move_newer();
  if (keyframes_.size() <= work_->builder->poses().size() + kAtOnce) return taken();
  background_.start([work = work_](const Background::Stop& stop) { work->build(stop); });
  return std::nullopt;
}

// Whether there is a map to be made.
bool LoopKeeper::prepare() {
  if (work_->builder) return true;
  const auto& closing = work_->closing;
  tell(closing);
  if (!work_->moves_enough()) return false;
  work_->drawn = mapping::drawn(work_->keyframes, closing);
  work_->T_new_old = closing.poses.back() * work_->keyframes.back().T_map_keyframe.inverse();
  if (!closing.tilts.empty())
    work_->rise_m = closing.tilts.back().z_m - work_->keyframes.back().tilt.value_or(Tilt{}).z_m;
  work_->keyframes = mapping::moved(std::move(work_->keyframes), closing);
  work_->builder.emplace(config_);
  return true;
}

// For keyframes that came meanwhile.
bool LoopKeeper::reopen(const Open& open) {
  work_->stored = open();
  return work_->stored && work_->stored->size() == keyframes_.size();
}

// They go with the newest of those that were looked at.
void LoopKeeper::move_newer() {
  for (std::size_t i = work_->keyframes.size(); i < keyframes_.size(); ++i) {
    work_->keyframes.push_back(keyframes_[i]);
    mapping::StoredGraph::Keyframe& newer = work_->keyframes.back();
    newer.T_map_keyframe = work_->T_new_old * newer.T_map_keyframe;
    if (newer.tilt) newer.tilt->z_m += work_->rise_m;
  }
}

std::optional<ClosedMap> LoopKeeper::taken() try {
  static const Background::Stop never = false;
  const auto work = std::exchange(work_, nullptr);
  work->build(never);
  return ClosedMap{work->keyframes, work->closing.edges, work->drawn, std::move(*work->builder),
                   work->T_new_old};
} catch (const std::exception&) {
  health_.count("loops/failed");
  return std::nullopt;
}

void LoopKeeper::tell(const mapping::SessionClosing& closing) {
  using State = bus::Health::State;
  health_.gauge("loops", static_cast<double>(closing.loops));
  health_.raise("loops", State::kWarning,
                closing.refused == 0
                    ? std::string()
                    : fmt::format("{} looks agree that the drive came back to where it cannot have "
                                  "been, by how sure it was: they moved nothing",
                                  closing.refused));
}

}  // namespace voxlist::services
