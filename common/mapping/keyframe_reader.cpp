#include "voxlist/mapping/keyframe_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>

#include "voxlist/io/files/file.h"

namespace voxlist::mapping {
namespace {

// Bytes that are searched at once for a sync word.
constexpr std::uint64_t kSearched = std::uint64_t{1} << 20;

}  // namespace

KeyframeReader::KeyframeReader(const std::filesystem::path& file) : file_(file) {
  read_file_header();
  read_graph();
}

void KeyframeReader::read_file_header() {
  const std::string start(file_.at(0, kFileHeaderBytes));
  if (const auto header = parse_file_header(start)) return adopt(*header);
  if (const auto record = find_record(0)) {
    map_id_ = record->header.map_id;
    return;
  }
  ++damaged_places_;
  damaged_bytes_ = position_ = start.size();
  if (file_.size() <= kFileHeaderBytes) return;  // it never held a keyframe
  // Its magic may be what is damaged.
  adopt(first_format_header(start));
  if (!record_at(position_)) {
    throw io::FileError(file_.path(),
                        "is no keyframe file of Voxlist; give the folder that a map was saved to");
  }
}

void KeyframeReader::read_graph() {
  FoundGraph found = find_graph(file_.path().parent_path(), map_id_);
  graph_fault_ = std::move(found.fault);
  has_graph_ = found.is_there;
  if (!found.graph) return;
  moves_ = found.graph->moves;
  graph_ = GraphPoses(std::move(found.graph->keyframes));
}

void KeyframeReader::place_by_graph(Keyframe& keyframe) {
  const auto found = graph_.next(keyframe.cloud.utime_us);
  if (found) stand_at(*found, keyframe.T_map_base);
}

void KeyframeReader::adopt(const FileHeader& header) {
  map_id_ = header.map_id;
  position_ = header.bytes;
  first_format_ = header.first_format;
}

std::optional<Keyframe> KeyframeReader::next() {
  while (auto record = find_record(position_)) {
    note_gap(record->start);
    position_ = record->end;
    if (is_repeated(record->header)) continue;
    last_ = record->header;
    was_moved_ = was_moved_ || record->header.kind == RecordHeader::kMoved;
    if (record->header.kind == RecordHeader::kMoved) continue;
    next_number_ = std::max(next_number_, record->header.number) + 1;
    if (!record->keyframe) continue;
    place_by_graph(*record->keyframe);
    place_ = {record->start, record->end - record->start, record->header.payload_checksum};
    ++whole_;
    return std::move(record->keyframe);
  }
  note_gap(file_.size());
  position_ = file_.size();
  return std::nullopt;
}

std::optional<Keyframe> KeyframeReader::at(const KeyframePlace& place) {
  if (place.start + place.bytes > file_.size()) file_.refresh();
  auto record = record_at(place.start);
  return record ? std::move(record->keyframe) : std::nullopt;
}

std::optional<RecordHeader> KeyframeReader::header_at(std::uint64_t offset) {
  const std::string_view bytes = file_.at(offset, kRecordStartBytes);
  auto header = parse_record_header(bytes);
  if (!header && first_format_) header = parse_first_format_record(bytes);
  return header;
}

// The first format's map id has no checksum: there, records are not held against it.
std::optional<KeyframeReader::Record> KeyframeReader::record_at(std::uint64_t offset) {
  const auto header = header_at(offset);
  if (!header) return std::nullopt;
  if (!first_format_ && map_id_ && header->map_id != map_id_) return std::nullopt;
  const std::string_view payload = file_.at(offset + header->bytes, header->payload_bytes);
  if (payload.size() < header->payload_bytes || checksum_of(payload) != header->payload_checksum)
    return std::nullopt;
  Record record{offset, offset + header->bytes + payload.size(), *header, std::nullopt};
  if (header->kind != RecordHeader::kKeyframe) return record;
  record.keyframe = decode_payload(payload);
  return record.keyframe ? std::optional(std::move(record)) : std::nullopt;
}

std::optional<KeyframeReader::Record> KeyframeReader::find_record(std::uint64_t from) {
  auto record = record_at(from);
  while (!record && from < file_.size()) {
    from = next_candidate(from + 1);
    record = record_at(from);
  }
  return record;
}

// Where a record may begin, or the file's end.
std::uint64_t KeyframeReader::next_candidate(std::uint64_t from) {
  while (first_format_ && from < file_.size() && !header_at(from)) ++from;
  if (first_format_) return from;
  while (from < file_.size()) {
    const std::string_view bytes = file_.at(from, kSearched);
    const std::size_t found = bytes.find(kSync);
    if (found != std::string_view::npos) return from + found;
    if (bytes.size() < kSearched) return file_.size();
    from += bytes.size() - (kSync.size() - 1);
  }
  return from;
}

void KeyframeReader::note_gap(std::uint64_t end) {
  if (end <= position_) return;
  ++damaged_places_;
  damaged_bytes_ += end - position_;
}

// A record whose first writing was thought to have failed is there twice.
bool KeyframeReader::is_repeated(const RecordHeader& header) const {
  return last_ && header.map_id && last_->number == header.number &&
         last_->payload_checksum == header.payload_checksum;
}

double KeyframeReader::progress() const {
  return file_.size() == 0 ? 1.0
                           : static_cast<double>(position_) / static_cast<double>(file_.size());
}

std::string KeyframeReader::warning() const {
  const std::string damaged = damage(), graph = graph_fault();
  return damaged.empty() || graph.empty() ? damaged + graph : damaged + "; " + graph;
}

std::string KeyframeReader::graph_fault() const {
  constexpr const char* kLeft = ": keyframes stand where they were when they came";
  if (!graph_fault_.empty()) return graph_fault_ + kLeft;
  if (has_graph_ || !was_moved_) return {};
  return (file_.path().parent_path() / kGraphFile).string() + " is missing" + kLeft;
}

std::string KeyframeReader::damage() const {
  if (damaged_places_ == 0) return {};
  return fmt::format("{}: damaged in {} {} ({} bytes), which {} left out; {} keyframes are whole",
                     file_.path().string(), damaged_places_,
                     damaged_places_ == 1 ? "place" : "places", damaged_bytes_,
                     damaged_places_ == 1 ? "is" : "are", whole_);
}

}  // namespace voxlist::mapping
