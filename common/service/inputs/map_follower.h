#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/service/inputs/mapper_word.h"

namespace voxlist {
class map_request_t;
}

namespace voxlist::service {

/// Where one of the mapper's maps comes from: its channel, and what a request for it wants.
struct MapSource {
  const char* channel;
  std::int32_t want;
};

/// What was hit and passed (MAP_UPDATE); which cells are free and which occupied (FREE_SPACE).
extern const MapSource kMapSource, kFreeSpaceSource;

/// MAP_UPDATE's door, or FREE_SPACE's: what it lets through is the mapper's map, and never goes
/// back to an older version of it unless the mapper itself has. Asks the mapper for what is
/// missing.
class MapFollower {
 public:
  explicit MapFollower(bus::Health& health, const MapSource& source = kMapSource)
      : health_(health), source_(source), word_(health, source.channel) {}

  /// The changes to apply now, in this order: mostly none or one.
  std::vector<bus::MapChange> take(const map_update_t& message);

  /// The request to send now, if one is due. Call it often.
  std::optional<map_request_t> tick(std::int64_t now_us);

  /// Asks the mapper whether this is still its map.
  void doubt() { word_.doubt(); }

  /// The mapper's map. When it becomes another one, all that was made of the one before is to be
  /// dropped.
  std::optional<std::int64_t> map_id() const;

  /// What the changes so far lead to. Nothing: there is no map, or what is there is not the
  /// mapper's any more. Version 0: the mapper says that its map is empty.
  const std::optional<bus::MapAssembler::Held>& held() const { return assembler_.held(); }

 private:
  void follow_word();
  void count_refusals();
  bool is_behind() const;

  bus::Health& health_;
  const MapSource source_;
  MapperWord word_;
  bus::MapAssembler assembler_;
  bus::Counters counted_;
  std::int64_t last_progress_us_ = 0;
  std::int64_t now_us_ = 0;
};

}  // namespace voxlist::service
