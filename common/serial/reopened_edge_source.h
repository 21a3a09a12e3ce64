#pragma once

#include <functional>
#include <memory>

#include "voxlist/serial/edge_source.h"

namespace voxlist::serial {

/// A source that is opened again when its device is gone: first after half a second, then ever more
/// seldom, every 10 s in the end. It never throws.
class ReopenedEdgeSource : public EdgeSource {
 public:
  /// Opens the device or throws PortError.
  using Open = std::function<std::unique_ptr<EdgeSource>()>;

  explicit ReopenedEdgeSource(Open open) : open_(std::move(open)) {}

  std::vector<std::int64_t> read(std::int64_t now_us) override;
  int wake_fd() const override { return source_ ? source_->wake_fd() : -1; }
  std::string trouble() const override { return source_ ? source_->trouble() : trouble_; }
  std::int64_t garbage() const override {
    return garbage_ + (source_ ? source_->garbage() : std::int64_t{0});
  }

 private:
  void give_up(std::int64_t now_us, const char* why);

  Open open_;
  std::unique_ptr<EdgeSource> source_;
  std::string trouble_ = "not opened yet";
  std::int64_t next_us_ = 0, wait_us_ = 0, garbage_ = 0;
};

}  // namespace voxlist::serial
