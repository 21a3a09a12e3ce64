#include "voxlist/bus/event_log.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "voxlist/system/file_parts.h"

namespace voxlist::bus {
namespace {

constexpr std::array<std::uint8_t, 4> kSync = {0xED, 0xA1, 0xDA, 0x01};
constexpr std::int64_t kSyncBytes = kSync.size();
// An event's header: sync word, event number, timestamp, length of the channel's name, length of
// the data.
constexpr std::size_t kHeaderBytes = 4 + 8 + 8 + 4 + 4;
// Bytes that are read at once while looking for the next event after damage. Damage is mostly
// short.
constexpr std::int64_t kBlockBytes = 4096;
// Bytes that are read at once: most messages are small, and a call of the system for each of their
// parts took a twentieth of mapping's time.
constexpr std::size_t kAheadBytes = std::size_t{1} << 18;

std::uint64_t read_big_endian(Bytes bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

void append_big_endian(std::uint64_t value, int bytes, std::vector<std::uint8_t>& to) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
    to.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

std::string system_error(const std::string& doing, const std::string& path) {
  return fmt::format("cannot {} {}: {}", doing, path, std::strerror(errno));
}

}  // namespace

struct EventLogReader::Header {
  std::int64_t number;
  std::int64_t utime_us;
  std::int64_t channel_length;
  std::int64_t data_length;
};

EventLogReader::EventLogReader(const std::string& path) {
  const FileParts parts = parts_of(path);
  for (const auto& file : parts.files) open(file.string());
  for (const auto& file : parts.missing) missing_.push_back(file.string());
}

void EventLogReader::open(const std::string& path) {
  // Not to wait for ever where it is a pipe.
  FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (file.get() < 0) throw std::runtime_error(system_error("open log", path));
  if (fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode))
    throw std::runtime_error(fmt::format("cannot open log {}: not a file", path));
  parts_.push_back({std::move(file), size_});
  size_ += status.st_size;
}

std::optional<Event> EventLogReader::next() {
  while (position_ < size_) {
    const std::optional<Header> header = read_header(position_);
    if (!header) {
      skip_damage();
      continue;
    }
    Event event{header->number, header->utime_us,
                std::string(static_cast<std::size_t>(header->channel_length), '\0'),
                std::vector<std::uint8_t>(static_cast<std::size_t>(header->data_length))};
    const std::int64_t channel_at = position_ + static_cast<std::int64_t>(kHeaderBytes);
    const std::int64_t data_at = channel_at + header->channel_length;
    if (!read(channel_at, event.channel.data(), event.channel.size()) ||
        !read(data_at, event.bytes.data(), event.bytes.size())) {
      skip_damage();
      continue;
    }
    position_ = data_at + header->data_length;
    return event;
  }
  return std::nullopt;
}

// The header at that place, if a whole event stands there.
std::optional<EventLogReader::Header> EventLogReader::read_header(std::int64_t position) const {
  std::array<std::uint8_t, kHeaderBytes> bytes;
  if (!read(position, bytes.data(), bytes.size())) return std::nullopt;
  if (!std::equal(kSync.begin(), kSync.end(), bytes.begin())) return std::nullopt;
  const auto field = [&](std::size_t at, std::size_t length) {
    return read_big_endian(Bytes(bytes).subspan(at, length));
  };
  const Header header{
      static_cast<std::int64_t>(field(4, 8)), static_cast<std::int64_t>(field(12, 8)),
      static_cast<std::int64_t>(field(20, 4)), static_cast<std::int64_t>(field(24, 4))};
  const bool sane = header.channel_length >= 1 &&
                    header.channel_length <= static_cast<std::int64_t>(kMaxChannelName) &&
                    header.data_length <= kMaxMessageBytes;
  const std::int64_t body = position + static_cast<std::int64_t>(kHeaderBytes);
  const std::int64_t end = body + header.channel_length + header.data_length;
  // An event lies in one part, whatever its lengths say.
  const bool is_in_part = end <= end_of(part_at(position));
  return sane && is_in_part && ends_well(body, end) ? std::optional(header) : std::nullopt;
}

// A wrong length shows where the event ends: not at the next event, having run over the next
// event's start. An event before a damaged one does not end at an event either, but has run over
// none.
bool EventLogReader::ends_well(std::int64_t body, std::int64_t end) const {
  if (end >= size_) return end == size_;
  return find_sync(end, end + kSyncBytes) == end || find_sync(body, end) == end;
}

// Where the first whole sync word within [from, limit) starts; limit when there is none.
std::int64_t EventLogReader::find_sync(std::int64_t from, std::int64_t limit) const {
  limit = std::min(limit, size_);
  std::array<std::uint8_t, kBlockBytes> block;
  for (std::int64_t at = from; at + kSyncBytes <= limit; at += kBlockBytes - kSyncBytes + 1) {
    const auto end = block.begin() + std::min(kBlockBytes, limit - at);
    if (!read(at, block.data(), static_cast<std::size_t>(end - block.begin()))) break;
    const auto found = std::search(block.begin(), end, kSync.begin(), kSync.end());
    if (found != end) return at + (found - block.begin());
  }
  return limit;
}

void EventLogReader::skip_damage() {
  const std::int64_t next = find_sync(position_ + 1, size_);
  ++damaged_;
  skipped_ += next - position_;
  position_ = next;
}

std::vector<EventLogReader::Part>::const_iterator EventLogReader::part_at(
    std::int64_t position) const {
  return std::prev(std::ranges::upper_bound(parts_, position, {}, &Part::start));
}

std::int64_t EventLogReader::end_of(std::vector<Part>::const_iterator part) const {
  return std::next(part) == parts_.end() ? size_ : std::next(part)->start;
}

bool EventLogReader::read(std::int64_t position, void* to, std::size_t bytes) const {
  if (bytes > kAheadBytes) return read_from_files(position, to, bytes);
  if (!is_read_ahead(position, bytes)) read_ahead(position);
  if (!is_read_ahead(position, bytes)) return read_from_files(position, to, bytes);
  std::memcpy(to, ahead_.data() + (position - ahead_at_), bytes);
  return true;
}

bool EventLogReader::is_read_ahead(std::int64_t position, std::size_t bytes) const {
  return position >= ahead_at_ && position + static_cast<std::int64_t>(bytes) <=
                                      ahead_at_ + static_cast<std::int64_t>(ahead_.size());
}

// Nothing where the disk cannot read all of it.
void EventLogReader::read_ahead(std::int64_t position) const {
  const std::int64_t left = std::max<std::int64_t>(size_ - position, 0);
  ahead_at_ = position;
  ahead_.resize(std::min(kAheadBytes, static_cast<std::size_t>(left)));
  if (!read_from_files(position, ahead_.data(), ahead_.size())) ahead_.clear();
}

// The parts are one sequence of bytes.
bool EventLogReader::read_from_files(std::int64_t position, void* to, std::size_t bytes) const {
  auto* at = static_cast<char*>(to);
  while (bytes > 0) {
    const auto part = part_at(position);
    const std::size_t wanted = std::min(bytes, static_cast<std::size_t>(end_of(part) - position));
    const ssize_t got = pread(part->file.get(), at, wanted, position - part->start);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    position += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

EventLogWriter::EventLogWriter(std::string path, std::string prefix)
    : path_(std::move(path)),
      prefix_(std::move(prefix)),
      file_(std::fopen(path_.c_str(), "wbe"), &std::fclose) {
  if (!file_) fail("create log");
}

void EventLogWriter::write(const std::string& channel_name, std::int64_t utime_us, Bytes bytes) {
  const std::string channel = prefix_ + channel_name;
  if (!file_) throw std::logic_error(fmt::format("log {} is closed", path_));
  std::vector<std::uint8_t> header(kSync.begin(), kSync.end());
  append_big_endian(static_cast<std::uint64_t>(events_++), 8, header);
  append_big_endian(static_cast<std::uint64_t>(utime_us), 8, header);
  append_big_endian(channel.size(), 4, header);
  append_big_endian(bytes.size(), 4, header);
  header.insert(header.end(), channel.begin(), channel.end());
  if (std::fwrite(header.data(), 1, header.size(), file_.get()) != header.size() ||
      std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
    fail("write log");
  }
}

void EventLogWriter::flush() {
  if (file_ && std::fflush(file_.get()) != 0) fail("write log");
}

void EventLogWriter::close() {
  if (file_ && std::fclose(file_.release()) != 0) fail("write log");
}

void EventLogWriter::fail(const char* doing) const {
  throw std::runtime_error(system_error(doing, path_));
}

void EventLogWriter::refuse(const std::string& channel, Fault fault) const {
  throw std::runtime_error(fmt::format("cannot write log {}: message on {} is wrong: {}", path_,
                                       channel, fault_name(fault)));
}

}  // namespace voxlist::bus
