#include "voxlist/viewing/viewer.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace voxlist::viewing {
namespace {

// Look-ups of one tick, in which the bus waits: few milliseconds, which only a whole map and the
// largest keyframes take. A hall is ready after a second.
constexpr std::size_t kWorkOfATick = 100'000;

}  // namespace

void Viewer::take(const bus::MapChange& change, std::int64_t now_us) {
  if (std::exchange(map_id_, change.map_id) != change.map_id) scene_.start_over(now_us);
  levels_.apply(change);
  scene_.take(change, now_us);
  tell_map(change, now_us);
}

void Viewer::tell_map(const bus::MapChange& change, std::int64_t now_us) {
  scene_.board().put(
      "map",
      fmt::format("{{\"epoch\":{},\"map_id\":\"{}\",\"version\":{},\"utime_us\":{},"
                  "\"keyframes\":{},\"moves\":{},\"edits\":{},\"edge_m\":{},\"voxels\":{}}}",
                  levels_.epoch(), change.map_id, change.version, change.utime_us,
                  change.version - change.moves - change.edits, change.moves, change.edits,
                  levels_.level(kFine).edge_m, levels_.map().size()),
      now_us);
}

void Viewer::forget_map(std::int64_t now_us) {
  if (map_id_ == 0) return;
  map_id_ = 0;
  levels_.forget();
  scene_.start_over(now_us);
  scene_.board().put("map", fmt::format("{{\"epoch\":{}}}", levels_.epoch()), now_us);
}

void Viewer::start_over() {
  forget_map(0);
  forget_space();
  scene_.clear();
  scene_.board().put("rewound", "{}", 0);
}

void Viewer::tick() {
  levels_.refresh(kWorkOfATick);
  for (const ChangedBlock& changed : levels_.take_changed())
    for (auto& [number, client] : clients_) client.add(changed);
  for (const ChangedBlock& changed : space_.take_changed())
    for (auto& [number, client] : clients_) client.add_space(changed);
}

bool Viewer::is_space_wanted() const {
  return std::ranges::any_of(clients_, [](const auto& c) { return c.second.wants_space(); });
}

void Viewer::hear(int client, std::string_view text) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  if (text == "space on") found->second.want_space(true);
  if (text == "space off") found->second.want_space(false);
}

int Viewer::open() {
  clients_.emplace(++last_client_, Client{});
  return last_client_;
}

std::optional<Frame> Viewer::next(int client, std::int64_t now_us) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return std::nullopt;
  return found->second.next({scene_.board(), levels_, space_}, now_us);
}

}  // namespace voxlist::viewing
