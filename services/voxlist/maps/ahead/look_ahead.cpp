#include "services/voxlist/maps/ahead/look_ahead.h"

#include "voxlist/io/files/file.h"
#include "voxlist/mapping/loops/session_closing.h"

namespace voxlist::desk {
namespace {

// Most pairs that wait: more are matched when the map is whole, by all threads.
constexpr std::size_t kMostWaiting = 256;

}  // namespace

LookAhead::LookAhead(mapping::KeyframeSpool& spool, const matching::MatcherConfig& config,
                     bool is_on)
    : spool_(spool),
      looker_(
          [this](std::size_t index) {
            return mapping::level_cloud(spool_.read(at_hand_.at(index)));
          },
          config),
      is_on_(is_on) {}

LookAhead::~LookAhead() { finish(); }

void LookAhead::add(const mapping::SpooledKeyframe& from, const mapping::SpooledKeyframe& to) {
  if (!is_on_) return;
  const std::lock_guard lock(mutex_);
  if (waiting_.size() < kMostWaiting && !is_over_) waiting_.push_back({from, to});
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  news_.notify_all();
}

void LookAhead::wait() {
  std::unique_lock lock(mutex_);
  news_.wait(lock, [this] { return waiting_.empty() && !is_looking_; });
}

const LookAhead::Looks& LookAhead::finish() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    waiting_.clear();
    news_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
  return looks_;
}

void LookAhead::work() {
  while (const std::optional<Pair> pair = next())
    if (auto found = look(*pair)) looks_[{pair->from.index, pair->to.index}] = *found;
}

std::optional<LookAhead::Pair> LookAhead::next() {
  std::unique_lock lock(mutex_);
  is_looking_ = false;
  news_.notify_all();
  news_.wait(lock, [this] { return is_over_ || !waiting_.empty(); });
  if (is_over_) return std::nullopt;
  is_looking_ = true;
  const Pair pair = waiting_.front();
  waiting_.pop_front();
  return pair;
}

// What the disk has lost is told by who needs it.
std::optional<mapping::NeighbourLook> LookAhead::look(const Pair& pair) try {
  at_hand_ = {{pair.from.index, pair.from}, {pair.to.index, pair.to}};
  return looker_.look(pair.from.index, pair.to.index, to_pose2(pair.from.T_map_base),
                      to_pose2(pair.to.T_map_base));
} catch (const io::FileError&) {
  return std::nullopt;
}

}  // namespace voxlist::desk
