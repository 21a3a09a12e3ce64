// Plays the localiser for the mapper: keyframe after keyframe, each when the one before is
// answered. Writes the map's version, which counts its keyframes, with each answer. Keyframe N is
// of second N, and of a place of its own within a kilometre or so. Usage: map_feeder [on], until it
// is ended; on: each cloud is a second after the last, also where that was none.
#include <chrono>
#include <iostream>
#include <optional>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"

namespace {

using namespace voxlist;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kBegin_us = 1'700'000'000'000'000;

struct Feeder {
  explicit Feeder(bool on) : goes_on(on) {
    bus.subscribe(bus::kMapUpdate, [this](const map_update_t& m) { take(m); });
  }

  void take(const map_update_t& message) {
    const bool answered = !map_id || message.utime == asked_us;
    map_id = message.map_id;
    version = message.version;
    if (answered) std::cout << version << std::endl;
    waiting = waiting && !answered;
  }

  void ask_for_map() {
    map_request_t message{};
    message.want = map_request_t::WANT_MAP;
    bus.publish(bus::kMapRequest, message);
  }

  void send_keyframe() {
    Cloud cloud;
    asked_us = cloud.utime_us = kBegin_us + (goes_on ? ++sent : version) * 1'000'000;
    for (int i = 0; i < 300; ++i)
      cloud.points.emplace_back(2.F, 0.02F * static_cast<float>(i), 0.5F);
    bus.publish(bus::kCloud, bus::to_message(cloud, "base", 0));
    localisation_t message{};
    message.utime = cloud.utime_us;
    message.map_id = *map_id;
    message.map_version = version;
    message.state = localisation_t::STATE_TRACKING;
    message.n_modes = 1;
    message.modes.resize(1);
    message.modes[0].pose[0] = static_cast<double>(version % 1000);
    message.modes[0].pose[1] = 10.0 * static_cast<double>(version / 1000);
    bus.publish(bus::kLocalisation, message);
  }

  // What is not answered within a while was lost, or the mapper was.
  void step() {
    if (!waiting || Clock::now() > asked_at + std::chrono::milliseconds(500)) {
      map_id ? send_keyframe() : ask_for_map();
      waiting = true;
      asked_at = Clock::now();
    }
    bus.handle(std::chrono::milliseconds(20));
  }

  bus::Bus bus{bus::BusOptions{}};
  std::optional<std::int64_t> map_id;
  std::int64_t version = 0, sent = 0;
  const bool goes_on;
  std::int64_t asked_us = 0;
  bool waiting = false;
  Clock::time_point asked_at;
};

}  // namespace

int main(int argc, char**) {
  Feeder feeder(argc > 1);
  for (int i = 0; i < 1'000'000; ++i) feeder.step();
  return 0;
}
