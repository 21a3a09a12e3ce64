#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/convert.h"

namespace voxlist::services {

/// Puts a map's keyframes in the order of their indices, whatever the order that they come in, in
/// bounded memory.
class KeyframeQueue {
 public:
  /// Most keyframes that wait: an answer of the mapper's, and as many that come meanwhile; about
  /// 100 MB of large clouds. When one more comes, the one that is needed last is dropped, and
  /// missed later.
  static constexpr std::size_t kCapacity = 2 * bus::kKeyframesAtOnce;

  /// What became of a keyframe.
  enum class Verdict { kTaken, kRepeated, kDroppedOne };

  /// Takes a keyframe. One of another map, or another one than was handed out at its index (the
  /// mapper lost its newest and went on), starts all over from index 0.
  Verdict add(bus::PosedCloud keyframe);

  /// The mapper's map has so many keyframes, and none beyond. Where it is another one than before,
  /// or has fewer than were handed out, all starts over.
  void know_of(std::int64_t map_id, std::int32_t keyframes);

  /// Whether another keyframe was handed out at its index.
  bool is_contradicted_by(const bus::PosedCloud& keyframe) const;

  /// From index 0 on again.
  void start_over() { *this = {}; }

  /// The next keyframe in order, if it is there. The first of each map has index 0.
  std::optional<bus::PosedCloud> next();

  /// The index without which it cannot go on, if there is one: 0 before any keyframe, later where
  /// a gap is. Nothing while next() has something, or when all that is known of was handed out.
  std::optional<std::int32_t> missing() const;

  /// All that is known of was handed out.
  bool is_done() const;

  /// Keyframes that wait to be handed out.
  std::size_t waiting() const { return waiting_.size(); }

  /// Of the keyframe that next() hands out next.
  std::int32_t next_index() const { return static_cast<std::int32_t>(handed_out_us_.size()); }

 private:
  bool is_of_another_map(const bus::PosedCloud& keyframe) const;

  std::optional<std::int64_t> map_id_;
  std::vector<std::int64_t> handed_out_us_;  // utime of each
  std::map<std::int32_t, bus::PosedCloud> waiting_;
  std::int32_t last_known_ = -1;  // index
};

}  // namespace voxlist::services
