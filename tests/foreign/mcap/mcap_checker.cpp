#include "tests/foreign/mcap/mcap_checker.h"

#include <zlib.h>
#include <zstd.h>

#include <set>
#include <stdexcept>
#include <utility>

namespace voxlist::test {
namespace {

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
constexpr std::size_t kFooterBytes = 9 + 20;

std::uint32_t crc(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

// Takes fields off the front. Past the end: std::out_of_range.
class Fields {
 public:
  explicit Fields(std::string_view bytes) : rest_(bytes) {}

  bool empty() const { return rest_.empty(); }
  std::size_t left() const { return rest_.size(); }

  std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) throw std::out_of_range("a length reaches past the end");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }

  std::uint64_t number(std::size_t bytes) {
    std::uint64_t value = 0;
    const std::string_view taken = take(bytes);
    for (std::size_t i = bytes; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(taken[i]);
    return value;
  }

  std::string_view text() { return take(number(4)); }

 private:
  std::string_view rest_;
};

struct Record {
  int op;
  std::string_view content;
  std::size_t offset;  // in what it was read from
};

std::vector<Record> records_of(std::string_view bytes) {
  std::vector<Record> records;
  Fields in(bytes);
  while (!in.empty()) {
    const std::size_t offset = bytes.size() - in.left();
    const int op = static_cast<int>(in.number(1));
    records.push_back({op, in.take(in.number(8)), offset});
  }
  return records;
}

struct Schema {
  std::string name, encoding, data;
  bool operator==(const Schema&) const = default;
};

struct Channel {
  std::uint64_t schema = 0;
  std::string topic, encoding;
  bool operator==(const Channel&) const = default;
};

class Checker {
 public:
  explicit Checker(std::string_view file) : file_(file) {}

  McapFile check() try {
    const bool ends = file_.size() > 2 * kMagic.size() + kFooterBytes &&
                      file_.starts_with(kMagic) && file_.ends_with(kMagic);
    if (!ends) throw std::out_of_range("the magic bytes are not there");
    check_data(file_.substr(kMagic.size(), file_.size() - 2 * kMagic.size()));
    return std::move(found_);
  } catch (const std::exception& error) {
    found_.wrong.push_back(error.what());
    return std::move(found_);
  }

 private:
  void claim(bool holds, const std::string& what) {
    if (!holds) found_.wrong.push_back(what);
  }

  void check_data(std::string_view inner) {
    bool is_summary = false;
    for (const Record& record : records_of(inner)) {
      const std::size_t at = record.offset + kMagic.size();
      starts_.emplace(at, record);
      if (is_summary) {
        check_summary(record);
      } else if (record.op == 0x0F) {
        claim(Fields(record.content).number(4) == crc(file_.substr(0, at)), "data's checksum");
        is_summary = true;
        summary_at_ = at + 9 + record.content.size();
      } else {
        read_data(record);
      }
    }
    claim(is_summary, "there is no summary");
    claim(indexed_ == found_.chunks, "not every chunk is in the summary");
    claim(has_statistics_, "there are no statistics");
  }

  void read_data(const Record& record) {
    Fields in(record.content);
    if (record.op == 0x06) read_chunk(in);
    if (record.op == 0x07) read_message_index(in);
    claim(record.op == 0x01 || record.op == 0x06 || record.op == 0x07, "an unknown record");
  }

  void read_chunk(Fields& in) {
    claim(waiting_.empty(), "messages that no index has");
    ++found_.chunks;
    const std::uint64_t first = in.number(8), last = in.number(8);
    const std::uint64_t size = in.number(8), checksum = in.number(4);
    claim(in.text() == "zstd", "compression");
    const std::string_view packed = in.take(in.number(8));
    if (size > 100'000'000) throw std::out_of_range("a chunk of more than 100 MB");
    chunk_.resize(size);
    claim(ZSTD_decompress(chunk_.data(), size, packed.data(), packed.size()) == size, "zstd");
    claim(crc(chunk_) == checksum, "a chunk's checksum");
    std::uint64_t earliest = UINT64_MAX, latest = 0;
    for (const Record& record : records_of(chunk_)) {
      const std::uint64_t time = read_in_chunk(record);
      if (record.op != 0x05) continue;
      earliest = std::min(earliest, time);
      latest = std::max(latest, time);
    }
    claim((earliest == UINT64_MAX && first == 0) || (first == earliest && last == latest),
          "a chunk's times");
  }

  // Returns a message's time.
  std::uint64_t read_in_chunk(const Record& record) {
    Fields in(record.content);
    const std::uint64_t id = in.number(2);
    if (record.op == 0x03) schemas_[id] = schema(in);
    if (record.op == 0x04) channels_[id] = channel(in);
    if (record.op != 0x05) return 0;
    const Channel& its = channels_.at(id);
    const Schema type = its.schema == 0 ? Schema{} : schemas_.at(its.schema);
    claim(in.number(4) == counts_[id]++, "a sequence number");
    McapMessage message{its.topic, its.encoding, type.name, type.encoding, type.data, 0, 0, {}};
    message.log_ns = in.number(8);
    message.publish_ns = in.number(8);
    message.data = in.take(in.left());
    waiting_.insert({id, message.log_ns, record.offset});
    found_.messages.push_back(message);
    return message.log_ns;
  }

  void read_message_index(Fields& in) {
    const std::uint64_t id = in.number(2);
    Fields entries(in.text());
    while (!entries.empty()) {
      const std::uint64_t time = entries.number(8), offset = entries.number(8);
      claim(waiting_.erase({id, time, offset}) == 1, "an index of no message");
    }
  }

  void check_summary(const Record& record) {
    claim(waiting_.empty(), "messages that no index has");
    Fields in(record.content);
    switch (record.op) {
      case 0x02:
        return check_footer(in, record.offset + kMagic.size());
      case 0x03:
        return check_same(in, schemas_, schema);
      case 0x04:
        return check_same(in, channels_, channel);
      case 0x08:
        return check_chunk_index(in);
      case 0x0B:
        return check_statistics(in);
      case 0x0E:
        return check_group(in);
      default:
        claim(false, "an unknown record in the summary");
    }
  }

  template <class Known, class Read>
  void check_same(Fields& in, const Known& known, Read read) {
    const auto id = in.number(2);
    claim(known.at(id) == read(in), "the summary says something else");
  }

  void check_footer(Fields& in, std::size_t at) {
    claim(in.number(8) == summary_at_, "where the summary is");
    claim(starts_.at(in.number(8)).op == 0x0E, "where the offsets are");
    const std::size_t until = at + kFooterBytes - 4;
    claim(in.number(4) == crc(file_.substr(summary_at_, until - summary_at_)),
          "the summary's checksum");
  }

  void check_chunk_index(Fields& in) {
    ++indexed_;
    const std::uint64_t first = in.number(8), last = in.number(8), start = in.number(8);
    const Record& chunk = starts_.at(start);
    Fields there(chunk.content);
    claim(chunk.op == 0x06 && first == there.number(8) && last == there.number(8),
          "an index of another chunk");
    claim(in.number(8) == 9 + chunk.content.size(), "a chunk's length");
    Fields offsets(in.text());
    std::uint64_t index_bytes = 0;
    while (!offsets.empty()) {
      const std::uint64_t id = offsets.number(2);
      const Record& index = starts_.at(offsets.number(8));
      claim(index.op == 0x07 && Fields(index.content).number(2) == id, "an offset of no index");
      index_bytes += 9 + index.content.size();
    }
    claim(in.number(8) == index_bytes, "the indexes' length");
    claim(in.text() == "zstd" && in.number(8) > 0 && in.number(8) == there.number(8),
          "a chunk's sizes");
  }

  void check_statistics(Fields& in) {
    has_statistics_ = true;
    claim(in.number(8) == found_.messages.size(), "number of messages");
    claim(in.number(2) == schemas_.size() && in.number(4) == channels_.size(),
          "number of schemas and channels");
    claim(in.number(8) == 0, "attachments or metadata");
    claim(in.number(4) == found_.chunks, "number of chunks");
    in.take(16);
    Fields counts(in.text());
    while (!counts.empty()) {
      const std::uint64_t id = counts.number(2);
      claim(counts.number(8) == counts_[id], "number of a channel's messages");
    }
  }

  void check_group(Fields& in) {
    const int op = static_cast<int>(in.number(1));
    const std::uint64_t start = in.number(8), length = in.number(8);
    for (const Record& record : records_of(file_.substr(start, length)))
      claim(record.op == op, "a group of several kinds");
  }

  static Schema schema(Fields& in) {
    Schema read{std::string(in.text()), std::string(in.text()), {}};
    read.data = in.text();
    return read;
  }

  static Channel channel(Fields& in) {
    const std::uint64_t schema = in.number(2);
    Channel read{schema, std::string(in.text()), {}};
    read.encoding = in.text();
    return read;
  }

  const std::string_view file_;
  McapFile found_;
  std::map<std::size_t, Record> starts_;  // by offset in the file
  std::string chunk_;
  std::map<std::uint64_t, Schema> schemas_;
  std::map<std::uint64_t, Channel> channels_;
  std::map<std::uint64_t, std::uint64_t> counts_;
  // Messages of the chunk that no index has told yet: channel, time, offset.
  std::set<std::tuple<std::uint64_t, std::uint64_t, std::uint64_t>> waiting_;
  std::size_t summary_at_ = 0, indexed_ = 0;
  bool has_statistics_ = false;
};

}  // namespace

McapFile check_mcap(std::string_view file) { return Checker(file).check(); }

}  // namespace voxlist::test
