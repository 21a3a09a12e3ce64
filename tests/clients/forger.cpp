// Publishes forged messages on every channel at a steady rate, and says how many on each.
// Usage: forger SEED COUNT PER_SECOND
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <thread>

#include "tests/bus/forge.h"
#include "voxlist/bus/bus.h"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const auto seed = static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10));
  const long count = std::atol(argv[2]);
  const std::chrono::duration<double> period(1.0 / std::atof(argv[3]));
  voxlist::bus::Bus bus{voxlist::bus::BusOptions{}};
  voxlist::bus::Forge forge(seed);
  std::map<std::string, long> sent;
  const auto start = std::chrono::steady_clock::now();
  for (long i = 0; i < count; ++i) {
    const voxlist::bus::Forgery forgery = forge.next();
    bus.publish_encoded(forgery.channel, forgery.bytes);
    ++sent[forgery.channel];
    std::this_thread::sleep_until(start + static_cast<double>(i + 1) * period);
  }
  std::cout << "seed " << seed;
  for (const auto& [channel, times] : sent) std::cout << ' ' << channel << '=' << times;
  std::cout << '\n';
}
