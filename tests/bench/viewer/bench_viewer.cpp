// What the viewer costs: its handlers' and its loop's CPU time, and its memory, while a recording
// is played to it and clients look on. Arguments: a recording (default: a pose 50 times a second
// and nothing else). CPU time of one thread, of which nothing is the clients'.
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/viewer/viewer_service.h"
#include "tests/bench/figures.h"
#include "tests/bench/viewer/socket_client.h"
#include "tests/stand_in_mapper.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/bus/health.h"

namespace voxlist::bench {
namespace {

constexpr std::int64_t kTick_us = 20'000;

struct Audience {
  const char* name;
  int pages, frozen, foxglove;
};

constexpr Audience kAudiences[] = {{"nobody", 0, 0, 0},
                                   {"one page", 1, 0, 0},
                                   {"two pages", 2, 0, 0},
                                   {"one page, one that is frozen", 1, 1, 0},
                                   {"seven pages, one that is frozen", 7, 1, 0},
                                   {"a Foxglove client on all channels", 0, 0, 1}};

double heap_mb() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1e6;
}

bus::MapChange without_blocks(bus::MapChange change) {
  change.blocks = {};
  return change;
}

// A viewer, its bus and its clients.
class Play {
 public:
  Play(const Audience& audience, const bus::MapChange& first) : audience_(audience), said_(first) {
    bus_.subscribe(bus::kMapRequest, [this](const map_request_t& m) { answer(m); });
    config_.port = 0;
    viewer_.emplace(bus_, health_, config_);
    for (int i = 0; i < audience.pages + audience.frozen; ++i)
      clients_.push_back(
          std::make_unique<SocketClient>(viewer_->port(), "/live", "voxlist.live.v1"));
    for (int i = 0; i < audience.foxglove; ++i)
      clients_.push_back(std::make_unique<SocketClient>(viewer_->port(), "/", "foxglove.sdk.v1"));
  }

  void take(const bus::Event& event) {
    if (now_us_ == 0) begin_us_ = now_us_ = event.utime_us;
    while (now_us_ + kTick_us <= event.utime_us) tick();
    if (event.channel == bus::kMapUpdate.name) note(event);
    bus_.publish_encoded(event.channel, event.bytes);
    const double before_ms = cpu_ms();
    bus_.handle(std::chrono::milliseconds(0));
    handler_ms_.push_back(cpu_ms() - before_ms);
  }

  void print() const {
    const double seconds = static_cast<double>(now_us_ - begin_us_) * 1e-6;
    double handlers_ms = 0.0, ticks_ms = 0.0;
    for (const double ms : handler_ms_) handlers_ms += ms;
    for (const double ms : tick_ms_) ticks_ms += ms;
    std::printf(
        "%-34s handlers: p99 %.3f ms, most %.2f; ticks: p99 %.3f, most %.2f; %.2f %% of a core "
        "(handlers %.2f); heap at most %.1f MB; to the clients %.2f MB\n",
        audience_.name, percentile(handler_ms_, 0.99), percentile(handler_ms_, 1.0),
        percentile(tick_ms_, 0.99), percentile(tick_ms_, 1.0),
        (handlers_ms + ticks_ms) / seconds / 10.0, handlers_ms / seconds / 10.0, heap_mb_,
        static_cast<double>(bytes()) / 1e6);
    std::fflush(stdout);
  }

 private:
  // What the mapper would answer: nothing is missing, for the recording begins with an empty map.
  void answer(const map_request_t& request) {
    if (request.want != map_request_t::WANT_MAP || said_.map_id == 0) return;
    for (const map_update_t& message : test::StandInMapper(said_).word(request.utime))
      bus_.publish(bus::kMapUpdate, message);
  }

  void note(const bus::Event& event) {
    map_update_t message;
    if (bus::decode(event.bytes, message) != bus::Fault::kNone) return;
    for (const bus::MapChange& change : assembler_.add(message)) said_ = without_blocks(change);
  }

  void tick() {
    bus_.handle(std::chrono::milliseconds(0));  // what was answered
    now_us_ += kTick_us;
    const double before_ms = cpu_ms();
    viewer_->tick(now_us_);
    tick_ms_.push_back(cpu_ms() - before_ms);
    heap_mb_ = std::max(heap_mb_, heap_mb() - before_mb_);
    // Those that are frozen, the first ones, end their handshake and read nothing more.
    for (int i = 0; i < static_cast<int>(clients_.size()); ++i) {
      SocketClient& client = *clients_[static_cast<std::size_t>(i)];
      if (i >= audience_.frozen || !client.is_open()) client.read();
    }
  }

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& client : clients_) sum += client->bytes();
    return sum;
  }

  const double before_mb_ = heap_mb();
  const Audience audience_;
  bus::MapAssembler assembler_;
  bus::MapChange said_;  // the mapper's word
  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"viewer"};
  services::ViewerServiceConfig config_;
  std::optional<services::ViewerService> viewer_;
  std::vector<std::unique_ptr<SocketClient>> clients_;
  std::int64_t now_us_ = 0, begin_us_ = 0;
  std::vector<double> handler_ms_, tick_ms_;
  double heap_mb_ = 0.0;
};

// The empty map with which a recording begins.
bus::MapChange first_map(const std::vector<bus::Event>& events) {
  bus::MapAssembler assembler;
  for (const bus::Event& event : events) {
    map_update_t message;
    if (event.channel != bus::kMapUpdate.name) continue;
    if (bus::decode(event.bytes, message) != bus::Fault::kNone) continue;
    for (const bus::MapChange& change : assembler.add(message)) {
      bus::MapChange empty = without_blocks(change);
      empty.version = empty.moves = empty.edits = 0;
      return empty;
    }
  }
  return {};
}

// A robot that drives along x for 5 s.
std::vector<bus::Event> poses() {
  std::vector<bus::Event> events;
  for (int i = 0; i < 250; ++i) {
    const std::int64_t utime_us = 1'000'000 + i * kTick_us;
    const pose_t pose = bus::to_message(StampedPose2{utime_us, Pose2{0.02 * i, 0.0, 0.0}});
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(pose.getEncodedSize()));
    pose.encode(bytes.data(), 0, pose.getEncodedSize());
    events.push_back({i, utime_us, bus::kPose.name, std::move(bytes)});
  }
  return events;
}

std::vector<bus::Event> events_of(const std::string& log) {
  std::vector<bus::Event> events;
  bus::EventLogReader reader(log);
  while (auto event = reader.next()) events.push_back(std::move(*event));
  return events;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto events = argc > 1 && argv[1][0] != '-' ? events_of(argv[1]) : poses();
  const auto first = first_map(events);
  for (const Audience& audience : kAudiences) {
    Play play(audience, first);
    for (const voxlist::bus::Event& event : events) play.take(event);
    play.print();
  }
}
