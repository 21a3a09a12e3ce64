#pragma once

#include <memory>
#include <string>

#include "voxlist/serial/edge_source.h"

namespace voxlist::services {

/// Rising edges on a pin, stamped by the kernel (libgpiod 1).
class GpioEdgeSource : public serial::EdgeSource {
 public:
  /// `chip` as "gpiochip0", `pin` its line. Throws PortError.
  GpioEdgeSource(const std::string& chip, unsigned pin);
  ~GpioEdgeSource() override;

  std::vector<std::int64_t> read(std::int64_t now_us) override;
  int wake_fd() const override;

 private:
  struct Line;
  std::unique_ptr<Line> line_;
};

}  // namespace voxlist::services
