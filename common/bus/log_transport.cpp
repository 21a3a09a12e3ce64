#include <set>

#include "voxlist/bus/event_log.h"
#include "voxlist/bus/transport.h"

namespace voxlist::bus {
namespace {

class LogTransport : public Transport {
 public:
  explicit LogTransport(const std::string& path) : log_(path) {}

  void listen(const std::string& channel, int) override { channels_.insert(channel); }

  bool send(const std::string&, Bytes, Delivery) override { return false; }

  Received receive(std::chrono::milliseconds, int, const Receiver& receiver) override {
    while (const std::optional<Event> event = log_.next()) {
      if (!channels_.contains(event->channel)) continue;
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
  std::set<std::string> channels_;
};

}  // namespace

std::unique_ptr<Transport> open_log(const std::string& path) {
  return std::make_unique<LogTransport>(path);
}

}  // namespace voxlist::bus
