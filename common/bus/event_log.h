#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/wire.h"
#include "voxlist/system/file_descriptor.h"

namespace voxlist::bus {

/// One recorded message.
struct Event {
  /// Counts up in the file.
  std::int64_t number = 0;

  /// When it was recorded, microseconds.
  std::int64_t utime_us = 0;

  std::string channel;
  std::vector<std::uint8_t> bytes;
};

/// Reads an LCM event log (the files of lcm-logger) that may be damaged: every length is checked,
/// after damage it goes on at the next whole event, and a torn tail is only its end. A log in parts
/// (NAME.00, NAME.01, ...) is read as one by its name; each part can be read by itself.
class EventLogReader {
 public:
  /// Throws std::runtime_error when a file cannot be opened. An empty file is a log without events.
  explicit EventLogReader(const std::string& path);

  /// The next whole event; nullopt at the end of the last file (as long as it was when opened).
  std::optional<Event> next();

  /// How often something was no whole event, the torn tail included.
  std::int64_t damaged_events() const { return damaged_; }

  /// Their bytes.
  std::int64_t skipped_bytes() const { return skipped_; }

  /// Parts that are not there, though later ones are.
  const std::vector<std::string>& missing_parts() const { return missing_; }

  /// Bytes read so far, and bytes of all files: for progress bars.
  std::int64_t position_bytes() const { return position_; }
  std::int64_t size_bytes() const { return size_; }

 private:
  struct Header;

  // One file of the log, where its bytes begin among all.
  struct Part {
    FileDescriptor file;
    std::int64_t start = 0;
  };

  void open(const std::string& path);
  std::vector<Part>::const_iterator part_at(std::int64_t position) const;
  std::int64_t end_of(std::vector<Part>::const_iterator part) const;
  bool read(std::int64_t position, void* to, std::size_t bytes) const;
  bool read_from_files(std::int64_t position, void* to, std::size_t bytes) const;
  bool is_read_ahead(std::int64_t position, std::size_t bytes) const;
  void read_ahead(std::int64_t position) const;
  std::optional<Header> read_header(std::int64_t position) const;
  bool ends_well(std::int64_t body, std::int64_t end) const;
  std::int64_t find_sync(std::int64_t from, std::int64_t limit) const;
  void skip_damage();

  std::vector<Part> parts_;
  std::vector<std::string> missing_;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;
  // What was read ahead, and from where on.
  mutable std::vector<std::uint8_t> ahead_;
  mutable std::int64_t ahead_at_ = 0;
  std::int64_t damaged_ = 0;
  std::int64_t skipped_ = 0;
};

/// Writes an LCM event log that lcm-logplayer and EventLogReader read.
class EventLogWriter {
 public:
  /// Creates or empties the file. `prefix` is put before every channel's name, as a Bus does.
  /// Throws std::runtime_error with the path and the system's reason.
  explicit EventLogWriter(std::string path, std::string prefix = {});

  /// Appends an event. Throws std::runtime_error, e.g. when the disk is full.
  void write(const std::string& channel, std::int64_t utime_us, Bytes bytes);

  /// Encodes and appends a message. Throws also when its lengths do not fit (check_lengths).
  template <class M>
  void write(Channel<M> channel, std::int64_t utime_us, const M& message) {
    std::vector<std::uint8_t> bytes;
    if (const Fault fault = encode(message, bytes); fault != Fault::kNone)
      refuse(channel.name, fault);
    write(channel.name, utime_us, bytes);
  }

  /// Hands all events to the system: they are in the file even if this process is killed. Throws as
  /// write() does.
  void flush();

  /// Writes what is still in memory, and closes. Throws as write() does: without it errors at the
  /// end go unseen.
  void close();

 private:
  [[noreturn]] void fail(const char* doing) const;
  [[noreturn]] void refuse(const std::string& channel, Fault fault) const;

  std::string path_, prefix_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::int64_t events_ = 0;
};

}  // namespace voxlist::bus
