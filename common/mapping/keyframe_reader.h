#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "voxlist/io/files/file_window.h"
#include "voxlist/mapping/graph/stored_graph.h"
#include "voxlist/mapping/keyframe_format.h"

namespace voxlist::mapping {

/// Where in a file a keyframe's record lies.
struct KeyframePlace {
  std::uint64_t start = 0;
  std::uint64_t bytes = 0;
  /// The checksum of its payload.
  std::uint32_t checksum = 0;
};

/// Hands out the keyframes of a file one by one, in memory for one of them. After any damage it
/// goes on with the next whole record: a flipped bit costs at most the record that it is in. Where
/// the folder has the map's graph, keyframes stand where that says.
class KeyframeReader {
 public:
  /// Throws FileError when there is no such file or it is no keyframe file.
  explicit KeyframeReader(const std::filesystem::path& file);

  /// The next whole keyframe; nothing at the end. Throws FileError when the disk cannot be read.
  std::optional<Keyframe> next();

  /// Where in the file the keyframe lies that next() handed out last.
  KeyframePlace place() const { return place_; }

  /// The keyframe at a place as it was when it came, also of one that was appended after the
  /// opening; nothing when it is no longer whole. next() does not go on from there. Throws
  /// FileError when the disk cannot be read.
  std::optional<Keyframe> at(const KeyframePlace& place);

  /// The map's id; nothing in a file that is too short to hold one.
  std::optional<std::int64_t> map_id() const { return map_id_; }

  /// The number for the record after those that were handed out.
  std::uint32_t next_number() const { return next_number_; }

  /// How often the map's keyframes were moved, as the graph says.
  std::int64_t moves() const { return moves_; }

  /// How far it has come in the file, 0..1.
  double progress() const;

  /// Whether something of the file was left out so far.
  bool is_damaged() const { return damaged_places_ > 0; }

  /// What was damaged so far, and what is wrong with the graph, one line for the log; empty when
  /// all was whole.
  std::string warning() const;

 private:
  struct Record {
    std::uint64_t start = 0;
    std::uint64_t end = 0;
    RecordHeader header;
    std::optional<Keyframe> keyframe;  // nothing in a kind that is not known here
  };

  void read_file_header();
  void read_graph();
  void place_by_graph(Keyframe& keyframe);
  std::string damage() const;
  std::string graph_fault() const;
  void adopt(const FileHeader& header);
  std::optional<RecordHeader> header_at(std::uint64_t offset);
  std::optional<Record> record_at(std::uint64_t offset);
  std::optional<Record> find_record(std::uint64_t from);
  std::uint64_t next_candidate(std::uint64_t from);
  void note_gap(std::uint64_t end);
  bool is_repeated(const RecordHeader& header) const;

  io::FileWindow file_;
  std::optional<std::int64_t> map_id_;
  bool first_format_ = false;
  std::uint64_t position_ = 0;
  KeyframePlace place_;
  std::optional<RecordHeader> last_;
  std::uint32_t next_number_ = 0;
  std::string graph_fault_;
  bool has_graph_ = false, was_moved_ = false;
  std::int64_t moves_ = 0;
  GraphPoses graph_;
  std::uint64_t whole_ = 0;
  std::uint64_t damaged_places_ = 0;
  std::uint64_t damaged_bytes_ = 0;
};

}  // namespace voxlist::mapping
