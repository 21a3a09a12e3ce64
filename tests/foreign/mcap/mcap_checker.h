#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace voxlist::test {

/// A message of an MCAP file.
struct McapMessage {
  std::string topic, encoding;
  std::string schema, schema_encoding, definition;  // empty: the channel has none
  std::uint64_t log_ns = 0, publish_ns = 0;
  std::string data;
};

/// What a file holds, and all that is wrong with it: lengths, checksums, indexes, statistics.
struct McapFile {
  std::vector<McapMessage> messages;
  std::size_t chunks = 0;
  std::vector<std::string> wrong;
};

/// Reads a file from its first byte to its last, and follows every index of its summary.
McapFile check_mcap(std::string_view file);

}  // namespace voxlist::test
