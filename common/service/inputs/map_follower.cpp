#include "voxlist/service/inputs/map_follower.h"

#include <string>
#include <utility>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>

namespace voxlist::service {

const MapSource kMapSource{"MAP_UPDATE", map_request_t::WANT_MAP};
const MapSource kFreeSpaceSource{"FREE_SPACE", map_request_t::WANT_FREE_SPACE};

namespace {

// A map that is on its way and of which nothing has come for so long (us) has lost a part.
constexpr std::int64_t kPatience_us = 500'000;

}  // namespace

std::vector<bus::MapChange> MapFollower::take(const map_update_t& message) {
  const bool is_the_mappers = word_.take(message);
  follow_word();
  if (!is_the_mappers) return {};
  if (message.base_version == bus::kWholeMap) last_progress_us_ = now_us_;
  return assembler_.add(message);
}

void MapFollower::follow_word() {
  const auto& word = word_.word();
  const auto& held = assembler_.held();
  if (word && held && (held->map_id != word->map_id || held->version > word->version))
    assembler_.forget();
}

bool MapFollower::is_behind() const {
  const auto& word = word_.word();
  const auto& held = assembler_.held();
  return word && (!held || held->version < word->version);
}

std::optional<map_request_t> MapFollower::tick(std::int64_t now_us) {
  now_us_ = now_us;
  word_.tick(now_us);
  follow_word();
  count_refusals();
  if (!is_behind()) last_progress_us_ = now_us;
  if (now_us - last_progress_us_ >= kPatience_us) word_.doubt();
  const auto utime_us = word_.due(now_us);
  if (!utime_us) return std::nullopt;
  map_request_t request{};
  request.utime = *utime_us;
  request.want = source_.want;
  if (!held()) return request;
  request.map_id = held()->map_id;
  request.version = held()->version;
  return request;
}

std::optional<std::int64_t> MapFollower::map_id() const {
  const auto& word = word_.word();
  return word ? std::optional(word->map_id) : std::nullopt;
}

void MapFollower::count_refusals() {
  for (const auto& [what, times] : assembler_.counters()) {
    const std::int64_t before = std::exchange(counted_[what], times);
    if (times != before) health_.count(std::string(source_.channel) + "/" + what, times - before);
  }
}

}  // namespace voxlist::service
