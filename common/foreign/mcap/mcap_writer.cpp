#include "voxlist/foreign/mcap/mcap_writer.h"

#include <stdexcept>
#include <utility>

namespace voxlist::foreign {
namespace {

std::uint64_t ns(std::int64_t us) { return static_cast<std::uint64_t>(us) * 1000; }

// The number of the next one; they count from 1, for 0 means "none".
std::uint16_t next_number(const std::vector<std::string>& there) {
  if (there.size() >= UINT16_MAX) throw std::length_error("an MCAP file of too many channels");
  return static_cast<std::uint16_t>(there.size() + 1);
}

// The summary: groups of records, then where each group is.
class Summary {
 public:
  explicit Summary(std::uint64_t position) : position_(position) {}

  void add(Op op, const std::vector<std::string>& contents) {
    if (contents.empty()) return;
    const std::size_t start = bytes_.size();
    for (const std::string& content : contents) put_record(op, content, bytes_);
    std::string offset;
    offset += static_cast<char>(op);
    put(position_ + start, offset);
    put(static_cast<std::uint64_t>(bytes_.size() - start), offset);
    put_record(Op::kSummaryOffset, offset, offsets_);
  }

  // Ends with the footer, whose checksum is of all before itself.
  std::string take() {
    const std::uint64_t offsets_at = position_ + bytes_.size();
    bytes_ += offsets_;
    std::string footer;
    put(position_, footer);
    put(offsets_at, footer);
    bytes_ += static_cast<char>(Op::kFooter);
    put(static_cast<std::uint64_t>(footer.size() + sizeof(std::uint32_t)), bytes_);
    bytes_ += footer;
    put(crc_of(bytes_), bytes_);
    return std::move(bytes_);
  }

 private:
  const std::uint64_t position_;
  std::string bytes_, offsets_;
};

}  // namespace

McapWriter::McapWriter(std::filesystem::path file, std::size_t chunk_bytes)
    : file_(std::move(file)), chunk_bytes_(chunk_bytes) {
  write_raw(kMcapMagic);
  std::string header;
  put_text({}, header);  // no profile
  put_text("voxlist", header);
  write_record(Op::kHeader, header);
}

std::uint16_t McapWriter::add(const McapSchema& schema) {
  const std::uint16_t number = next_number(schemas_);
  schemas_.push_back(content_of(number, schema));
  chunk_.add(Op::kSchema, schemas_.back());
  return number;
}

std::uint16_t McapWriter::add(const McapChannel& channel) {
  const std::uint16_t number = next_number(channels_);
  channels_.push_back(content_of(number, channel));
  counts_.push_back(0);
  chunk_.add(Op::kChannel, channels_.back());
  return number;
}

void McapWriter::write(std::uint16_t channel, std::int64_t log_us, std::int64_t data_us,
                       std::string_view data) {
  const auto sequence = static_cast<std::uint32_t>(counts_.at(channel - 1U)++);
  chunk_.add_message(channel, sequence, ns(log_us), ns(data_us), data);
  span_.add(ns(log_us));
  ++messages_;
  if (chunk_.size() >= chunk_bytes_) write_chunk();
}

void McapWriter::write_raw(std::string_view bytes) {
  file_.write(bytes);
  position_ += bytes.size();
  crc_ = crc_of(bytes, crc_);
}

void McapWriter::write_record(Op op, std::string_view content) {
  std::string record;
  put_record(op, content, record);
  write_raw(record);
}

void McapWriter::write_chunk() {
  Chunk::Packed packed = chunk_.pack(position_);
  write_raw(packed.bytes);
  chunks_.push_back(std::move(packed.index));
  chunk_ = {};
}

void McapWriter::close() {
  if (chunk_.size() > 0) write_chunk();
  std::string end;
  put(crc_, end);
  write_record(Op::kDataEnd, end);
  write_summary();
  write_raw(kMcapMagic);
  file_.commit();
}

void McapWriter::write_summary() {
  Summary summary(position_);
  summary.add(Op::kSchema, schemas_);
  summary.add(Op::kChannel, channels_);
  summary.add(Op::kStatistics, {statistics()});
  summary.add(Op::kChunkIndex, chunks_);
  write_raw(summary.take());
}

std::string McapWriter::statistics() const {
  std::string counts;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    put(static_cast<std::uint16_t>(i + 1), counts);
    put(counts_[i], counts);
  }
  std::string content;
  put(messages_, content);
  put(static_cast<std::uint16_t>(schemas_.size()), content);
  put(static_cast<std::uint32_t>(channels_.size()), content);
  put(std::uint32_t{0}, content);  // attachments
  put(std::uint32_t{0}, content);  // metadata
  put(static_cast<std::uint32_t>(chunks_.size()), content);
  put(span_.start_ns(), content);
  put(span_.last_ns, content);
  put_text(counts, content);
  return content;
}

}  // namespace voxlist::foreign
