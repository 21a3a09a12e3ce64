// Writes a line for each message that tells how the services fare, as it comes, until it is ended:
//   TIME_MS LOCALISATION STATE UTIME MAP_ID CONFIDENCE OVERLAP ELAPSED_US
//   TIME_MS KEYFRAME INDEX MAP_ID
//   TIME_MS MAP_UPDATE VERSION MAP_ID ANSWERS
//   TIME_MS FREE_SPACE VERSION MAP_ID ANSWERS
//   TIME_MS TRAVERSABILITY_NAME VERSION MAP_ID
//   TIME_MS OBSTACLES UTIME sees|blind
//   TIME_MS HEALTH SERVICE PID STATE COUNTER=N... MESSAGE
//
// OVERLAP: of the first mode. TIME_MS: of the wall clock, on arrival. Usage: bus_watch [SECONDS]:
// ends by itself after that.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/traversability_t.hpp>

namespace {

std::ostream& line(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  return std::cout << buffer->recv_utime / 1000 << ' ' << channel << ' ';
}

void on_localisation(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                     const voxlist::localisation_t* m, void*) {
  constexpr std::array<const char*, 3> kNames = {"LOST", "AMBIGUOUS", "TRACKING"};
  const bool known = m->state >= 0 && m->state < std::ssize(kNames);
  line(buffer, channel) << (known ? kNames[static_cast<std::size_t>(m->state)] : "UNKNOWN") << ' '
                        << m->utime << ' ' << m->map_id << ' ' << m->confidence << ' '
                        << (m->modes.empty() ? 0.0 : m->modes.front().overlap) << ' '
                        << m->elapsed_us << std::endl;
}

void on_keyframe(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                 const voxlist::keyframe_t* m, void*) {
  line(buffer, channel) << m->index << ' ' << m->map_id << std::endl;
}

void on_map_update(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                   const voxlist::map_update_t* m, void*) {
  line(buffer, channel) << m->version << ' ' << m->map_id << ' ' << m->answers << std::endl;
}

void on_traversability(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                       const voxlist::traversability_t* m, void*) {
  line(buffer, channel) << m->version << ' ' << m->map_id << std::endl;
}

void on_obstacles(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                  const voxlist::obstacles_t* m, void*) {
  line(buffer, channel) << m->utime << ' ' << (m->blind.empty() ? "sees" : "blind") << std::endl;
}

void on_health(const lcm::ReceiveBuffer* buffer, const std::string& channel,
               const voxlist::health_t* m, void*) {
  line(buffer, channel) << m->service << ' ' << m->pid << ' ' << m->state;
  for (const voxlist::counter_t& counter : m->counters) {
    std::cout << ' ' << counter.name << '=' << counter.count;
  }
  std::cout << ' ' << m->message << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  const std::chrono::seconds timeout(argc > 1 ? std::atoi(argv[1]) : 600);
  const char* url = std::getenv("LCM_DEFAULT_URL");
  lcm::LCM lcm(url != nullptr ? url : "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=8000000");
  if (!lcm.good()) return 2;
  void* const nothing = nullptr;
  lcm.subscribeFunction("LOCALISATION", &on_localisation, nothing)->setQueueCapacity(1000);
  lcm.subscribeFunction("KEYFRAME", &on_keyframe, nothing)->setQueueCapacity(1000);
  lcm.subscribeFunction("MAP_UPDATE", &on_map_update, nothing)->setQueueCapacity(1000);
  lcm.subscribeFunction("FREE_SPACE", &on_map_update, nothing)->setQueueCapacity(1000);
  lcm.subscribeFunction("TRAVERSABILITY_.*", &on_traversability, nothing)->setQueueCapacity(1000);
  lcm.subscribeFunction("OBSTACLES", &on_obstacles, nothing)->setQueueCapacity(1000);
  lcm.subscribeFunction("HEALTH", &on_health, nothing)->setQueueCapacity(1000);
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (std::chrono::steady_clock::now() < end) lcm.handleTimeout(100);
  return 0;
}
