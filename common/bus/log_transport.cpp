#include "voxlist/bus/channel_pattern.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/bus/transport.h"

namespace voxlist::bus {
namespace {

class LogTransport : public Transport {
 public:
  explicit LogTransport(const std::string& path) : log_(path) {}

  void listen(const std::vector<std::string>& patterns, int) override {
    patterns_.insert(patterns_.end(), patterns.begin(), patterns.end());
  }

  bool send(const std::string&, Bytes, Delivery) override { return false; }

  Received receive(std::chrono::milliseconds, int, const Receiver& receiver) override {
    while (const std::optional<Event> event = log_.next()) {
      if (!matches_any(patterns_, event->channel)) continue;
      receiver({event->channel, event->bytes, event->utime_us});
      return Received::kMessage;
    }
    return Received::kEnded;
  }

  // All of a log waits from the start: taking more at once would supersede all but its last
  // messages.
  int batch() const override { return 1; }

 private:
  EventLogReader log_;
  std::vector<std::string> patterns_;
};

}  // namespace

std::unique_ptr<Transport> open_log(const std::string& path) {
  return std::make_unique<LogTransport>(path);
}

}  // namespace voxlist::bus
