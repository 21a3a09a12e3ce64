#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "voxlist/system/file_descriptor.h"

namespace voxlist::serial {

/// The device's end of a serial line that exists in this machine only: a simulator serves it, and
/// the other end is opened by its name like any serial port. Nothing here ever waits.
class PseudoTerminal {
 public:
  /// Makes the line and a symbolic link to its other end, in place of an older link of that name
  /// (of nothing else). Throws PortError.
  explicit PseudoTerminal(const std::filesystem::path& link);

  /// Takes the link away, unless somebody else has put another there. Who has the line open sees it
  /// unplugged.
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// What has arrived: up to 4096 bytes.
  std::vector<std::uint8_t> read();

  /// Sends bytes and says how many found room: the rest is lost unless it is sent again. Bytes that
  /// nobody listens to are gone, as on a wire.
  std::size_t write(std::span<const std::uint8_t> bytes);

  /// The speed that the other end has set; 0: one that is not known.
  int baud() const;

  /// Whether somebody has the other end open.
  bool is_open() const;

  /// A descriptor to wait on for bytes. While nobody has the other end open, poll says POLLHUP at
  /// once.
  int fd() const { return master_.get(); }

  const std::filesystem::path& link() const { return link_; }

 private:
  std::filesystem::path link_;
  FileDescriptor master_;
  std::filesystem::path other_end_;
};

}  // namespace voxlist::serial
