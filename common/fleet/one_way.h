#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/counters.h"
#include "voxlist/bus/wire.h"
#include "voxlist/fleet/relay_config.h"
#include "voxlist/fleet/repeats.h"
#include "voxlist/fleet/throttle.h"

namespace voxlist::fleet {

/// One direction of a relay: which messages are passed on, and when. The first row that matches a
/// channel is the channel's. What comes too fast waits; the newest of each channel takes the place
/// of the one that waits, so that the last word always arrives. What comes in again within seconds,
/// byte by byte, goes round in a ring of relays, and is left out.
///
/// counters(), by the row's name: ROW/passed, ROW/held_back (left for a newer one), ROW/raw_cloud
/// (of a row that lets none pass), ROW/repeated, ROW/too_much_waiting, and too_many_channels.
class OneWay {
 public:
  /// Most channels that are told apart: their names come from the network. Those that were silent
  /// for so long (us) make room for others.
  static constexpr std::size_t kMostChannels = 1000;
  static constexpr std::int64_t kSilent_us = 60'000'000;

  /// Most bytes that wait, of all channels together.
  static constexpr std::size_t kMostWaiting = 100'000'000;

  using Send = std::function<void(const std::string& channel, bus::Bytes)>;

  /// Takes the rows of this direction, in their order. `send` is called from take() and tick().
  OneWay(const std::vector<RelayChannel>& rows, Direction direction, Send send);

  /// What came on channel `name`, which goes on as `channel`. `robot`: whose it is; the rows' other
  /// robots do not match. Of the robot's own bus it is empty, and any row matches.
  void take(const std::string& robot, const std::string& name, const std::string& channel,
            bus::Bytes bytes, std::int64_t now_us);

  /// The row that takes channel `name` of a robot, as take() has it; null when none does.
  const RelayChannel* row_of(const std::string& robot, const std::string& name) const;

  /// Passes on what may go now.
  void tick(std::int64_t now_us);

  const bus::Counters& counters() const { return counters_; }

 private:
  struct Stream {
    std::string row;
    bool clouds;
    Throttle throttle;
    std::int64_t last_us;  // when a message came
    Repeats repeats;
    std::optional<std::vector<std::uint8_t>> waiting;
  };

  Stream* stream_of(const std::string& robot, const std::string& name, const std::string& channel,
                    std::int64_t now_us);
  void wait(Stream& stream, bus::Bytes bytes);
  void pass(const std::string& channel, const Stream& stream, bus::Bytes bytes);

  std::vector<RelayChannel> rows_;
  const Send send_;
  std::map<std::string, Stream> streams_;  // by the channels that they go on as
  std::size_t waiting_bytes_ = 0;
  const Direction direction_;
  bus::Counters counters_;
};

}  // namespace voxlist::fleet
