#pragma once

#include <map>
#include <utility>
#include <vector>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>

#include "voxlist/bus/maps/map_chunks.h"

namespace voxlist::test {

/// Says what the mapper says: its word to each request, and the whole map to who has none, or
/// another version.
class StandInMapper {
 public:
  StandInMapper() = default;

  /// `map` is whole; version 0: empty.
  explicit StandInMapper(bus::MapChange map) : map_(std::move(map)) {}

  std::vector<map_update_t> answer(const map_request_t& request) const {
    std::vector<map_update_t> messages = word(request.utime);
    const bool is_older = request.map_id == map_.map_id && request.version != map_.version;
    if (map_.version == 0 || (request.map_id != 0 && !is_older)) return messages;
    for (map_update_t& message : bus::split_map(map_)) messages.push_back(std::move(message));
    return messages;
  }

  /// What it says at its start (answers: 0), and of a cloud that it did not add.
  std::vector<map_update_t> word(std::int64_t answers = 0) const {
    bus::MapChange nothing_new = map_;
    nothing_new.blocks = {};
    nothing_new.base_version = map_.version == 0 ? bus::kWholeMap : map_.version;
    std::vector<map_update_t> messages = bus::split_map(std::move(nothing_new));
    messages.front().answers = answers;
    return messages;
  }

  bus::MapChange& map() { return map_; }

 private:
  bus::MapChange map_;
};

}  // namespace voxlist::test
