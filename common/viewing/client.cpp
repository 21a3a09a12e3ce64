#include "voxlist/viewing/client.h"

#include <fmt/core.h>

#include <array>

#include "voxlist/viewing/blocks/block_records.h"

namespace voxlist::viewing {
namespace {

// Blocks of one frame: up to 76 kB, which no socket takes longer than a moment to send.
constexpr std::size_t kBlocksAtOnce = 1000;

// A topic of so many bytes is followed by blocks, so that clouds do not keep a slow client from
// its map.
constexpr std::size_t kLargeTopic = 8'000;

std::optional<Frame> blocks_frame(const char* topic, std::uint32_t epoch, std::size_t which,
                                  const MapLevel& level, std::array<BlockSet, 2>& blocks) {
  const auto records = take_records(level, kBlocksAtOnce, blocks[which]);
  return frame_of(
      fmt::format("{{\"topic\":\"{}\",\"age_ms\":0,\"data\":{{\"epoch\":{},"
                  "\"level\":{},\"edge_m\":{},\"left\":[{},{}]}}}}",
                  topic, epoch, which, level.edge_m, blocks[0].size(), blocks[1].size()),
      records);
}

}  // namespace

template <std::size_t N>
template <class Levels>
void Client::Pending<N>::follow(const Levels& levels) {
  if (epoch == levels.epoch()) return;
  epoch = levels.epoch();
  for (std::size_t level = 0; level < N; ++level) {
    blocks[level].clear();
    blocks[level].add_all(levels.level(level).size());
  }
}

std::optional<Frame> Client::next(const Content& content, std::int64_t now_us) {
  map_.follow(content.levels);
  space_.follow(content.space);
  if (is_turn_of_blocks_) {
    is_turn_of_blocks_ = false;
    if (auto frame = next_blocks(content)) return frame;
  }
  if (auto frame = next_topic(content.board, now_us)) return frame;
  return next_blocks(content);
}

void Client::want_space(bool on) {
  wants_space_ = on;
  space_ = {};
}

std::optional<Frame> Client::next_topic(const Board& board, std::int64_t now_us) {
  const auto [number, topic] = board.next_after(seen_);
  if (topic == nullptr) return std::nullopt;
  seen_ = number;
  is_turn_of_blocks_ = topic->bytes.size() + topic->json.size() > kLargeTopic;
  return frame_of(fmt::format("{{\"topic\":\"{}\",\"age_ms\":{},\"data\":{}}}", topic->name,
                              (now_us - topic->told_us) / 1000, topic->json),
                  topic->bytes);
}

std::optional<Frame> Client::next_blocks(const Content& content) {
  const std::size_t which = map_.blocks[kCoarse].size() > 0 ? kCoarse : kFine;
  if (map_.blocks[which].size() == 0) return next_space(content.space);
  return blocks_frame("blocks", map_.epoch, which, content.levels.level(which), map_.blocks);
}

std::optional<Frame> Client::next_space(const SpaceLevels& space) {
  if (!wants_space_) return std::nullopt;
  const std::size_t which = space_.blocks[kFreeCells].size() > 0 ? kFreeCells : kOccupiedCells;
  if (space_.blocks[which].size() == 0) return std::nullopt;
  return blocks_frame("space", space_.epoch, which, space.level(which), space_.blocks);
}

}  // namespace voxlist::viewing
