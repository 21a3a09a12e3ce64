#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "voxlist/bus/health.h"
#include "voxlist/service/inputs/time_gate.h"

namespace voxlist::service {

/// Watches one channel, and tells HEALTH what is wrong with it: one condition for each thing, from
/// when it is first seen until it has not been seen for five seconds.
class ChannelCheck {
 public:
  struct Options {
    std::string channel;
    /// What to look at when nothing comes: "is the scanner running?". Empty: the service tells of
    /// silence itself.
    std::string remedy;
    /// Whether it is a fault when nothing ever comes.
    bool is_needed = true;
    /// Times so much older than the newest are no fault.
    std::int64_t disorder_us = 0;
  };

  ChannelCheck(bus::Health& health, Options options);

  /// A message came. False: its time does not fit, and the message is to be left out; it is counted
  /// then.
  bool take(std::int64_t utime_us);

  /// Its number, which counts up by one a message. Numbers that stay the same are none. `skipped`
  /// messages before it came, but were left out here.
  void take_number(std::int32_t seq, std::int64_t skipped = 0);

  /// So many messages were left out, as newer ones were there: what came is more than can be used.
  void leave_out(std::int64_t messages);

  /// Something is wrong with a message. `key` is one word.
  void note(const std::string& key, bus::Health::State state, const std::string& sentence);

  /// Tells of silence, and takes back what is over.
  void tick(std::int64_t now_us);

 private:
  void note_silence(std::int64_t now_us);
  std::string key_of(const std::string& key) const { return options_.channel + '/' + key; }

  struct Noted {
    bool is_new = true;
    std::int64_t last_us = 0;
  };

  bus::Health& health_;
  const Options options_;
  TimeGate gate_;
  std::map<std::string, Noted> noted_;
  std::optional<std::int32_t> seq_;
  std::int64_t left_out_ = 0;  // since it is told
  struct {
    std::int64_t messages = 0;
    std::int64_t of = 0;
  } lost_;  // since it is told
  bool heard_ = false;
  std::optional<std::int64_t> start_us_;
  std::optional<std::int64_t> last_heard_us_;
  std::int64_t period_us_ = 0;  // 0: not known yet
};

}  // namespace voxlist::service
