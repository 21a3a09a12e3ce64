#include "services/mapper/map_channel.h"

#include <memory>
#include <string>
#include <utility>
#include <voxlist/map_update_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/multicast/paced_sender.h"

namespace voxlist::services {

void MapChannel::send_word(bus::MapChange nothing_new, std::int64_t answers) {
  if (nothing_new.version == 0) nothing_new.base_version = bus::kWholeMap;
  map_update_t message = std::move(bus::split_map(std::move(nothing_new)).front());
  message.answers = answers;
  push(std::move(message), true, false);
}

void MapChannel::send(bus::MapChange change) {
  const bool whole = change.is_whole();
  auto messages = bus::split_map(std::move(change));
  for (std::size_t i = 0; i < messages.size(); ++i)
    if (!push(std::move(messages[i]), !whole, whole && i + 1 == messages.size())) return;
}

bool MapChannel::push(map_update_t message, bool is_first, bool ends_whole) {
  const auto kept = std::make_shared<map_update_t>(std::move(message));
  const auto bytes = static_cast<std::size_t>(kept->getEncodedSize());
  const auto send = [this, kept, ends_whole] {
    bus_.publish(channel_, *kept);
    if (ends_whole) --wholes_queued_;
  };
  const bool queued = is_first ? sender_.push_first(bytes, send) : sender_.push(bytes, send);
  if (!queued) health_.count(std::string(channel_.name) + "/queue_full");
  if (queued && ends_whole) ++wholes_queued_;
  return queued;
}

}  // namespace voxlist::services
