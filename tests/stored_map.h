#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::test {

/// All that a map folder holds.
struct StoredMap {
  std::optional<std::int64_t> map_id;
  std::vector<mapping::Keyframe> keyframes;
  std::string warning;
};

inline StoredMap load_map(const std::filesystem::path& folder) {
  mapping::KeyframeReader reader(folder / mapping::kKeyframeFile);
  StoredMap stored;
  while (auto keyframe = reader.next()) stored.keyframes.push_back(std::move(*keyframe));
  stored.map_id = reader.map_id();
  stored.warning = reader.warning();
  return stored;
}

}  // namespace voxlist::test
