#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace voxlist::services {

/// Records the bus with LCM's own lcm-logger, as scripts/record does: a process of its own, so that
/// nothing of it delays a page. One at a time; it ends with the object.
class Recorder {
 public:
  Recorder() = default;
  ~Recorder() { stop(); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Begins a recording in the state folder; its name tells the time. What is wrong, or nothing.
  std::string start(std::int64_t now_us);

  /// Ends it, and waits until the file is whole (1 s at most).
  void stop();

  /// Whether it still runs; looks whether the process has ended.
  bool is_on();

  /// OUT of the last recording (files OUT.00, OUT.01, ...).
  const std::filesystem::path& file() const { return file_; }

 private:
  int pid_ = -1;
  std::filesystem::path file_;
};

}  // namespace voxlist::services
