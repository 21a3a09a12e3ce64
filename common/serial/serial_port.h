#pragma once

#include <string>

#include "voxlist/serial/port.h"
#include "voxlist/system/file_descriptor.h"

namespace voxlist::serial {

/// A serial line of this machine: 8N1, no flow control, for nobody else while it is open. Times are
/// the wall clock's.
class SerialPort : public Port {
 public:
  /// Opens "/dev/ttyUSB0" and the like. Throws PortError.
  SerialPort(const std::string& path, int baud);

  /// Ends early, with nothing, when a signal comes.
  std::optional<Received> read(std::int64_t timeout_us) override;

  /// Waits until the system has taken all bytes. Above 38400 baud there is a pause after each, as
  /// the LMS 200 wants it: meant for short requests.
  void write(std::span<const std::uint8_t> bytes) override;

  void set_baud(int baud) override;
  void flush() override;
  std::int64_t now_us() const override;

  /// A descriptor to wait on for bytes.
  int fd() const { return fd_.get(); }

  /// What makes this port worse than it could be, in one line for the log, with what to do; empty:
  /// nothing.
  const std::string& warning() const { return warning_; }

 private:
  bool wait(short events, std::int64_t timeout_us) const;
  void write_some(std::span<const std::uint8_t>& bytes);

  std::string path_;
  FileDescriptor fd_;
  int baud_ = 0;
  std::string warning_;
};

}  // namespace voxlist::serial
