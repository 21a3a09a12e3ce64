#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "voxlist/foreign/mcap/records.h"

namespace voxlist::foreign {

/// The times of the first and the last message (ns); nothing is in it while first_ns > last_ns.
struct TimeSpan {
  std::uint64_t first_ns = UINT64_MAX, last_ns = 0;

  void add(std::uint64_t time_ns);

  /// As records tell it: 0 where there is no message.
  std::uint64_t start_ns() const { return first_ns > last_ns ? 0 : first_ns; }
};

/// Records that are compressed together, and where in them each channel's messages are.
class Chunk {
 public:
  void add(Op op, std::string_view content) { put_record(op, content, records_); }

  /// `log_ns`: when the message was recorded. `publish_ns`: the time of its data.
  void add_message(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_ns,
                   std::uint64_t publish_ns, std::string_view data);

  /// Bytes before they are compressed.
  std::size_t size() const { return records_.size(); }

  /// What goes into the file, and the record that tells where it is. `position`: of the chunk in
  /// the file. Throws std::runtime_error when the compressor fails.
  struct Packed {
    std::string bytes;
    std::string index;
  };
  Packed pack(std::uint64_t position) const;

 private:
  std::string records_;
  TimeSpan span_;
  // Each channel's messages: time (ns) and offset in records_, as the index has them.
  std::map<std::uint16_t, std::string> index_;
};

}  // namespace voxlist::foreign
