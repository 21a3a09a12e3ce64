#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "voxlist/serial/edge_source.h"

namespace voxlist::serial {

/// Rising edges on a modem line of a serial port: a thread waits for each in the kernel and takes
/// the time right after. Only a real port can do that (TIOCMIWAIT): not a pseudo-terminal, and not
/// every USB adapter.
class ModemEdgeSource : public EdgeSource {
 public:
  /// `line`: cts, dcd, dsr or ri. Throws PortError; std::invalid_argument for another line.
  ModemEdgeSource(const std::filesystem::path& path, const std::string& line);
  ~ModemEdgeSource() override;

  std::vector<std::int64_t> read(std::int64_t now_us) override;
  int wake_fd() const override;

 private:
  class Waiter;
  std::unique_ptr<Waiter> waiter_;
};

}  // namespace voxlist::serial
