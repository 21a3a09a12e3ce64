// What the mapper answers and tells: requests, edits by hand, the map and its changes.
#include <fmt/core.h>

#include <algorithm>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>

#include "services/mapper/mapper_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::services {

void MapperService::take_request(const map_request_t& message) {
  if (message.want == map_request_t::WANT_FREE_SPACE) return answer_for_free_space(message);
  if (message.want == map_request_t::WANT_NEW_MAP) give_up(message.map_id);
  send_word(message.utime);
  switch (message.want) {
    case map_request_t::WANT_MAP:
      if (has_use_for_map(message) && !map_channel_.is_sending_whole())
        map_channel_.send_whole(nothing_new(builder_.map()), builder_.map());
      return;
    case map_request_t::WANT_KEYFRAMES:
      return resend_keyframes(static_cast<std::size_t>(std::max(0, message.first)));
    case map_request_t::WANT_SAVE:
      save_wanted_ = true;
      return;
    case map_request_t::WANT_LOCALISE_ONLY:
      return set_extending(false);
    case map_request_t::WANT_EXTEND:
      return set_extending(true);
    case map_request_t::WANT_EDITS:
      return edit_channel_.tell(edited_boxes(), message.utime);
    case map_request_t::WANT_WORD:
    case map_request_t::WANT_NEW_MAP:
      return;
    default:
      return health_.count("MAP_REQUEST/unknown_want");
  }
}

// A map that is not to be written is not.
void MapperService::set_extending(bool wanted) {
  if (wanted && !config_.extend) return health_.count("MAP_REQUEST/extend_refused");
  is_extending_ = wanted;
  health_.raise("localise_only", bus::Health::State::kOk,
                wanted ? "" : "localises only, as it was told: voxlist localise-only off");
}

// On the disk first, as a move. Returns why not; empty: it is done.
std::string MapperService::edit(const bus::EditWish& wish) {
  if (wish.map_id != map_id_) return "it is of another map";
  if (!config_.extend) return "the mapper only serves its map (extend = false)";
  mapping::MapEdits edits = keyframes_.edits();
  edits.map_id = map_id_;
  if (!wish.kind && !edits.remove(wish.id)) return fmt::format("there is no edit {}", wish.id);
  if (wish.kind) {
    if (std::string why = edits.refusal(wish.box, builder_.poses()); !why.empty()) return why;
    edits.add(*wish.kind, wish.box, builder_.poses());
  }
  const std::int64_t before = version();
  if (std::string why = keyframes_.write_edits(edits); !why.empty()) return why;
  builder_.edit(std::move(edits));
  send_change(before);
  return {};
}

bus::EditedBoxes MapperService::edited_boxes() const {
  const mapping::MapEdits& edits = keyframes_.edits();
  bus::EditedBoxes boxes{
      decided_utime_us_, map_id_, edits.changes, moves_, {}, edits.placed(builder_.poses())};
  for (const mapping::MapEdit& edit : edits.edits) boxes.ids.push_back(edit.id);
  return boxes;
}

// From the first request on: each MAP_UPDATE has its FREE_SPACE.
void MapperService::answer_for_free_space(const map_request_t& message) {
  is_free_space_wanted_ = true;
  free_channel_.send_word(nothing_new(builder_.free_space()), message.utime);
  if (has_use_for_map(message) && !free_channel_.is_sending_whole())
    free_channel_.send_whole(nothing_new(builder_.free_space()), builder_.free_space());
}

bus::MapChange MapperService::nothing_new(const OccupancyMap& map) const {
  bus::MapChange change;
  change.utime_us = decided_utime_us_;
  change.map_id = map_id_;
  change.version = change.base_version = version();
  change.resolution = bus::resolution_of(map);
  change.moves = moves_;
  change.T_new_old = T_new_old_;
  change.edits = keyframes_.edits().changes;
  return change;
}

void MapperService::send_word(std::int64_t answers) {
  map_channel_.send_word(nothing_new(builder_.map()), answers);
}

void MapperService::send_change(std::int64_t base_version) {
  send_map_change(base_version);
  if (is_free_space_wanted_) send_free_space_change(base_version);
}

void MapperService::send_map_change(std::int64_t base_version) {
  map_channel_.send(change_of(base_version, builder_.map(), builder_.changed_blocks()));
}

void MapperService::send_free_space_change(std::int64_t base_version) {
  free_channel_.send(change_of(base_version, builder_.free_space(), builder_.changed_free_space()));
}

bus::MapChange MapperService::change_of(std::int64_t base_version, const OccupancyMap& map,
                                        const ChangedBlocks& changed) const {
  bus::MapChange change = nothing_new(map);
  change.base_version = base_version;
  if (base_version != version()) change.blocks = bus::to_messages(map, changed);
  return change;
}

// Not who has another map: before it drops that, it asks again.
bool MapperService::has_use_for_map(const map_request_t& message) const {
  if (version() == 0) return false;  // the answer has said all
  return message.map_id == 0 || (message.map_id == map_id_ && message.version != version());
}

void MapperService::send_keyframes(std::size_t first, std::size_t at_most) {
  for (std::size_t i = first; i < keyframes_.size() && at_most > 0; ++i, --at_most) {
    // The listener asks again for what did not fit.
    if (!sender_.push(keyframes_.bytes(i), [this, i] { send_keyframe(i); }))
      return health_.count("KEYFRAME/queue_full");
  }
}

void MapperService::send_keyframe(std::size_t index) {
  const mapping::Keyframe keyframe = keyframes_.read(index);
  bus_.publish(bus::kKeyframe,
               bus::to_message(bus::PosedCloud{map_id_, static_cast<std::int32_t>(index),
                                               keyframe.T_map_base, keyframe.cloud}));
}

void MapperService::resend_keyframes(std::size_t first) {
  if (resends_queued_ > 0) return health_.count("MAP_REQUEST/already_answering");
  send_keyframes(first, bus::kKeyframesAtOnce);
  if (sender_.push(0, [this] { --resends_queued_; })) ++resends_queued_;
}

}  // namespace voxlist::services
