#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "voxlist/bus/channels.h"

namespace voxlist::bus {

/// The bytes of one encoded message.
using Bytes = std::span<const std::uint8_t>;

/// Largest message that is sent or accepted: a scan of 2.5 million points with origins. Above it a
/// forged length could make a service allocate more than a robot has.
inline constexpr std::int64_t kMaxMessageBytes = 64'000'000;

/// Longest name of a channel that LCM sends, with prefix.
inline constexpr std::size_t kMaxChannelName = 63;

/// Most channels that a cloud may have: they cost memory even without points, and real clouds have
/// a handful.
inline constexpr std::int64_t kMaxCloudChannels = 64;

/// Why a message is refused.
enum class Fault {
  kNone,
  /// It ends before its fields do, or a length in it reaches past its end.
  kTruncated,
  /// Another type's fingerprint.
  kWrongType,
  /// A negative length; when sending: a count that is not its array's length.
  kBadLength,
  /// A string without its final zero, or with a zero inside.
  kBadText,
  /// Bytes are left over after the last field.
  kTrailingBytes,
  /// More than kMaxMessageBytes, or more elements than the type can sensibly have.
  kTooLarge,
  /// lcm's own decoder or encoder refused it, or memory ran out.
  kCodecFailed,
};

/// The fault's name in counters: "truncated", "wrong_type", ...
const char* fault_name(Fault fault);

/// Walks an encoded message without decoding it. The first fault sticks: all later steps do
/// nothing.
class WireReader {
 public:
  explicit WireReader(Bytes bytes);

  /// The first eight bytes must be this type's hash.
  void fingerprint(std::int64_t expected);

  /// Passes over that many bytes.
  void skip(std::int64_t bytes);

  /// Reads the length of an array whose elements take at least `min_bytes_each`. 0 after a fault.
  std::int64_t count(std::int64_t min_bytes_each, std::int64_t limit = kMaxMessageBytes);

  /// Reads a length and passes over that many elements of `bytes_each`. Returns the length, 0 after
  /// a fault.
  std::int64_t array(std::int64_t bytes_each);

  /// Passes over a string.
  void text();

  /// Reads a length and passes over that many pairs of a string and a value of `bytes_each`.
  void named_values(std::int64_t bytes_each);

  /// The first fault; kTrailingBytes when there was none but bytes are left.
  Fault finish() const;

 private:
  std::uint32_t read_u32();
  void fail(Fault fault);

  Bytes rest_;
  Fault fault_ = Fault::kNone;
};

/// One for each type: walks the fields behind the fingerprint. The pointer is null and only names
/// the type.
void walk(WireReader& in, const health_t*);
void walk(WireReader& in, const keyframe_t*);
void walk(WireReader& in, const localisation_t*);
void walk(WireReader& in, const map_edit_t*);
void walk(WireReader& in, const map_edits_t*);
void walk(WireReader& in, const map_octree_t*);
void walk(WireReader& in, const map_request_t*);
void walk(WireReader& in, const map_update_t*);
void walk(WireReader& in, const mirror_state_t*);
void walk(WireReader& in, const obstacles_t*);
void walk(WireReader& in, const pixel_map_t*);
void walk(WireReader& in, const planar_lidar_t*);
void walk(WireReader& in, const pointcloud_t*);
void walk(WireReader& in, const pose_hint_t*);
void walk(WireReader& in, const pose_t*);
void walk(WireReader& in, const rigid_transform_t*);
void walk(WireReader& in, const traversability_t*);
void walk(WireReader& in, const uncertain_pose_t*);

/// One for each type: what is wrong with a message that is about to be encoded. lcm's encoder
/// trusts the counts and would read past the arrays' ends.
Fault check_lengths(const health_t& message);
Fault check_lengths(const keyframe_t& message);
Fault check_lengths(const localisation_t& message);
Fault check_lengths(const map_edit_t& message);
Fault check_lengths(const map_edits_t& message);
Fault check_lengths(const map_octree_t& message);
Fault check_lengths(const map_request_t& message);
Fault check_lengths(const map_update_t& message);
Fault check_lengths(const mirror_state_t& message);
Fault check_lengths(const obstacles_t& message);
Fault check_lengths(const pixel_map_t& message);
Fault check_lengths(const planar_lidar_t& message);
Fault check_lengths(const pointcloud_t& message);
Fault check_lengths(const pose_hint_t& message);
Fault check_lengths(const pose_t& message);
Fault check_lengths(const rigid_transform_t& message);
Fault check_lengths(const traversability_t& message);
Fault check_lengths(const uncertain_pose_t& message);

/// Whether the bytes are exactly one message of type M. Allocates nothing, so it is safe on any
/// bytes.
template <class M>
Fault check_wire(Bytes bytes) {
  WireReader in(bytes);
  in.fingerprint(M::getHash());
  walk(in, static_cast<const M*>(nullptr));
  return in.finish();
}

/// Checks the bytes, then decodes them into `fresh`, which must be newly made (lcm keeps old array
/// contents). After a fault `fresh` means nothing.
template <class M>
Fault decode(Bytes bytes, M& fresh) {
  if (const Fault fault = check_wire<M>(bytes); fault != Fault::kNone) return fault;
  try {
    const int size = static_cast<int>(bytes.size());
    return fresh.decode(bytes.data(), 0, size) == size ? Fault::kNone : Fault::kCodecFailed;
  } catch (...) {
    return Fault::kCodecFailed;
  }
}

/// Encodes the message into `bytes`. After a fault `bytes` means nothing.
template <class M>
Fault encode(const M& message, std::vector<std::uint8_t>& bytes) {
  if (const Fault fault = check_lengths(message); fault != Fault::kNone) return fault;
  const int size = message.getEncodedSize();
  bytes.resize(static_cast<std::size_t>(size));
  return message.encode(bytes.data(), 0, size) == size ? Fault::kNone : Fault::kCodecFailed;
}

}  // namespace voxlist::bus
