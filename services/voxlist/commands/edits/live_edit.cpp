#include "services/voxlist/commands/edits/live_edit.h"

#include <fmt/core.h>

#include <chrono>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_edits_t.hpp>

#include "services/voxlist/live/bus_options.h"
#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/bus/maps/edit_convert.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

// The mapper answers once the edit is on the disk and in the map; a packet may be lost.
constexpr int kTries = 20;
constexpr std::chrono::milliseconds kWait{250};

map_edit_t message_for(const EditWish& wish) {
  refuse_without_map(wish.folder);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  bus::EditWish sent;
  sent.utime_us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  sent.map_id = mapping::KeyframeReader(wish.folder / mapping::kKeyframeFile).map_id().value_or(0);
  sent.kind = wish.kind;
  sent.id = wish.id;
  if (wish.kind) sent.box = wish.box();
  return bus::to_message(sent);
}

}  // namespace

int edit_live(const EditWish& wish, const LiveOptions& live, Console& console) {
  const map_edit_t message = message_for(wish);
  bus::Bus bus(read_bus_options(live.config, live.url));
  std::optional<map_edits_t> answer;
  bus.subscribe(bus::kMapEdits, [&](const map_edits_t& told) {
    if (told.answers == message.utime) answer = told;
  });
  for (int i = 0; i < kTries && !answer && !stop_requested(); ++i) {
    bus.publish(bus::kMapEdit, message);
    bus.handle(kWait);
  }
  if (answer && answer->refusal.empty()) {
    console.say(fmt::format("the mapper has edited its map: {} edits now", answer->n_boxes));
    return 0;
  }
  console.warn(answer ? "the mapper did not edit its map: " + answer->refusal
                      : "no mapper answers on this bus: is it running?");
  return 1;
}

}  // namespace voxlist::desk
