#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "voxlist/serial/edge_source.h"
#include "voxlist/serial/edge_text.h"
#include "voxlist/system/file_descriptor.h"

namespace voxlist::serial {

/// Edges as a microcontroller writes them (edge_text.h) on a serial port, or anything does on a
/// pseudo-terminal or a fifo.
class TextEdgeSource : public EdgeSource {
 public:
  using Clock = std::function<std::int64_t()>;

  /// `baud` is for serial ports. `clock` tells when bytes arrive: the wall clock. Throws PortError.
  TextEdgeSource(const std::filesystem::path& path, int baud, Clock clock);

  std::vector<std::int64_t> read(std::int64_t now_us) override;
  int wake_fd() const override { return file_.get(); }
  std::int64_t garbage() const override { return text_.garbage(); }

 private:
  std::filesystem::path path_;
  Clock clock_;
  FileDescriptor file_;
  EdgeText text_;
};

}  // namespace voxlist::serial
