#include "services/mapper/map_channel.h"

#include <memory>
#include <string>
#include <utility>
#include <voxlist/map_update_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/multicast/paced_sender.h"
#include "voxlist/system/memory.h"

namespace voxlist::services {

void MapChannel::send_word(bus::MapChange nothing_new, std::int64_t answers) {
  if (nothing_new.version == 0) nothing_new.base_version = bus::kWholeMap;
  map_update_t message = std::move(bus::split_map(std::move(nothing_new)).front());
  message.answers = answers;
  push_first(std::move(message));
}

void MapChannel::send(bus::MapChange change) {
  for (map_update_t& message : bus::split_map(std::move(change))) push_first(std::move(message));
}

void MapChannel::send_whole(bus::MapChange word, const OccupancyMap& map) {
  const auto whole = std::make_shared<bus::WholeMap>(std::move(word), map);
  for (std::size_t i = 0; i < whole->size(); ++i)
    if (!push_chunk(whole, i)) return;
  ++wholes_queued_;
}

bool MapChannel::push_chunk(const std::shared_ptr<bus::WholeMap>& whole, std::size_t chunk) {
  return note_queued(sender_.push(whole->bytes(chunk), [this, whole, chunk] {
    bus_.publish(channel_, whole->take(chunk));
    if (chunk + 1 < whole->size()) return;
    --wholes_queued_;
    give_memory_back();
  }));
}

void MapChannel::push_first(map_update_t message) {
  const auto kept = std::make_shared<map_update_t>(std::move(message));
  note_queued(sender_.push_first(static_cast<std::size_t>(kept->getEncodedSize()),
                                 [this, kept] { bus_.publish(channel_, *kept); }));
}

bool MapChannel::note_queued(bool queued) {
  if (!queued) health_.count(std::string(channel_.name) + "/queue_full");
  return queued;
}

}  // namespace voxlist::services
