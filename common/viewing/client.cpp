#include "voxlist/viewing/client.h"

#include <fmt/core.h>

#include "voxlist/viewing/blocks/block_records.h"

namespace voxlist::viewing {
namespace {

// Blocks of one frame: up to 76 kB, which no socket takes longer than a moment to send.
constexpr std::size_t kBlocksAtOnce = 1000;

// A topic of so many bytes is followed by blocks, so that clouds do not keep a slow client from
// its map.
constexpr std::size_t kLargeTopic = 8'000;

}  // namespace

std::optional<Frame> Client::next(const Board& board, const MapLevels& levels,
                                  std::int64_t now_us) {
  follow(levels);
  if (is_turn_of_blocks_) {
    is_turn_of_blocks_ = false;
    if (auto frame = next_blocks(levels)) return frame;
  }
  if (auto frame = next_topic(board, now_us)) return frame;
  return next_blocks(levels);
}

void Client::follow(const MapLevels& levels) {
  if (epoch_ == levels.epoch()) return;
  epoch_ = levels.epoch();
  for (std::size_t level = 0; level < kLevels; ++level) {
    blocks_[level].clear();
    blocks_[level].add_all(levels.level(level).size());
  }
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

std::optional<Frame> Client::next_blocks(const MapLevels& levels) {
  const std::size_t which = blocks_[kCoarse].size() > 0 ? kCoarse : kFine;
  if (blocks_[which].size() == 0) return std::nullopt;
  const auto records = take_records(levels.level(which), kBlocksAtOnce, blocks_[which]);
  return frame_of(
      fmt::format("{{\"topic\":\"blocks\",\"age_ms\":0,\"data\":{{\"epoch\":{},\"level\":{},"
                  "\"edge_m\":{},\"left\":[{},{}]}}}}",
                  epoch_, which, levels.level(which).edge_m, blocks_[kFine].size(),
                  blocks_[kCoarse].size()),
      records);
}

}  // namespace voxlist::viewing
