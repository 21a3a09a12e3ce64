#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "voxlist/foreign/mcap/chunk.h"
#include "voxlist/foreign/mcap/records.h"
#include "voxlist/io/files/atomic_file.h"

namespace voxlist::foreign {

/// Writes an MCAP file, the recordings of Foxglove, Lichtblick, Rerun and ROS 2: chunks compressed
/// by zstd, each with its index, and a summary at the end, so that a reader finds any time without
/// reading the rest. What is in memory is one chunk, and some 50 bytes for each chunk and channel
/// of it. Compatible as of November 2026 (MCAP's major version 0).
///
/// The file is there when close() has returned, whole; before that, and after a crash, what was
/// there before it is. Functions throw io::FileError.
class McapWriter {
 public:
  /// Bytes of a chunk before compression: what a reader reads at least.
  static constexpr std::size_t kChunkBytes = 4'000'000;

  explicit McapWriter(std::filesystem::path file, std::size_t chunk_bytes = kChunkBytes);

  /// Each returns the number that the others take. At most 65,535 of each: then std::length_error.
  std::uint16_t add(const McapSchema& schema);
  std::uint16_t add(const McapChannel& channel);

  /// A message of the channel, of less than 4 GB. Times in microseconds since 1970, not negative:
  /// when it was recorded, and that of its data.
  void write(std::uint16_t channel, std::int64_t log_us, std::int64_t data_us,
             std::string_view data);

  /// Writes what is still in memory and the summary, and puts the file in its place.
  void close();

  std::uint64_t messages() const { return messages_; }

 private:
  void write_raw(std::string_view bytes);
  void write_record(Op op, std::string_view content);
  void write_chunk();
  void write_summary();
  std::string statistics() const;

  io::AtomicFile file_;
  const std::size_t chunk_bytes_;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;  // of all that was written so far
  Chunk chunk_;
  TimeSpan span_;
  std::uint64_t messages_ = 0;
  // Contents of the records that the summary repeats, and how many messages each channel has.
  std::vector<std::string> schemas_, channels_, chunks_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace voxlist::foreign
