// Publishes what is well made and not true, beside live services: updates of maps that are not
// there, poses, keyframes, requests. It listens for the ids and versions of the real ones. What
// cannot be told from the real thing (the README's limits) is not among it.
// Usage: mislead UPDATES|POSES|KEYFRAMES|REQUESTS SECONDS PER_SECOND
#include <chrono>
#include <cstdlib>
#include <deque>
#include <functional>
#include <string>
#include <vector>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/maps/map_chunks.h"

namespace {

using namespace voxlist;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kSecond_us = 1'000'000;

struct Misleader {
  Misleader() {
    bus.subscribe(bus::kMapUpdate, [this](const map_update_t& m) {
      if (m.answers == kQuestion) real = m;
    });
    bus.subscribe(bus::kLocalisation, [this](const localisation_t& m) {
      if (m.map_id != real.map_id || m.significance_log10 == kMark) return;
      said.push_back(m);
      if (said.size() > 20) said.pop_front();
    });
  }

  map_update_t update(std::int64_t map_id, std::int64_t version, std::int64_t base) {
    map_update_t m{};
    m.utime = real.utime + kSecond_us;
    m.map_id = map_id;
    m.version = version;
    m.base_version = base;
    m.n_chunks = 1;
    m.resolution_m = real.resolution_m;
    m.passed_resolution_m = real.passed_resolution_m;
    return m;
  }

  void add_block(map_update_t& m, std::int32_t x) {
    m.blocks.resize(1);
    m.blocks[0].x = x;
    m.blocks[0].bits[0] = -1;
    m.n_blocks = 1;
  }

  std::vector<map_update_t> updates() {
    const std::int64_t id = real.map_id, v = real.version;
    std::vector<map_update_t> all;
    for (const std::int64_t other : {id, id + 1, std::int64_t{0}})
      for (const std::int64_t version : {std::int64_t{0}, v - 5, v + 20, v + 1'000'000})
        if (version >= 0) all.push_back(update(other, version, bus::kWholeMap));
    map_update_t m = update(id, v + 20, bus::kWholeMap);
    add_block(m, 3);
    all.push_back(m);
    m.resolution_m = 1e-6;
    all.push_back(m);
    m = update(id, v + 1, v);
    add_block(m, 500'000);
    all.push_back(m);
    m = update(id, v + 1, v);
    m.n_chunks = 5000;
    add_block(m, 3);
    all.push_back(m);
    m = update(id, v, v);
    m.utime += 3600 * kSecond_us;
    all.push_back(m);
    return all;
  }

  std::vector<localisation_t> poses() {
    std::vector<localisation_t> all;
    for (localisation_t m : said) {
      m.state = localisation_t::STATE_TRACKING;
      m.confidence = 1.0;
      m.significance_log10 = kMark;
      m.modes.resize(1);
      m.n_modes = 1;
      m.modes[0].pose[0] += 5.0;
      all.push_back(m);  // of a cloud that is decided on
      m.map_id += 1;
      all.push_back(m);
      m = all.front();
      m.map_version += 3;
      all.push_back(m);
      m = all.front();
      m.utime += 3600 * kSecond_us;
      all.push_back(m);
    }
    return all;
  }

  std::vector<keyframe_t> keyframes() {
    Cloud cloud;
    for (int i = 0; i < 500; ++i) cloud.points.emplace_back(2.F, 0.01F * float(i), 0.5F);
    std::vector<keyframe_t> all;
    for (const std::int64_t map_id : {real.map_id, real.map_id + 1})
      for (const std::int32_t index : {0, 1, 1000, 2'000'000'000}) {
        cloud.utime_us = real.utime + index;
        all.push_back(bus::to_message(bus::PosedCloud{map_id, index, Pose3::Identity(), cloud}));
      }
    return all;
  }

  std::vector<map_request_t> requests() {
    std::vector<map_request_t> all;
    for (std::int32_t want = -1; want < 5; ++want) {
      map_request_t m{};
      m.utime = real.answers + want;
      m.want = want;
      all.push_back(m);
      m.first = -5;
      m.map_id = real.map_id;
      m.version = real.version + 1;
      all.push_back(m);
    }
    return all;
  }

  // The whole map is sent to nobody who has another one.
  void ask() {
    map_request_t request{};
    request.utime = kQuestion;
    request.map_id = 1;
    bus.publish(bus::kMapRequest, request);
  }

  template <class M>
  void run(bus::Channel<M> channel, const std::function<std::vector<M>()>& make, double seconds,
           double per_second) {
    const auto start = Clock::now();
    std::size_t sent = 0;
    std::vector<M> all;
    for (int i = 0; Clock::now() < start + std::chrono::duration<double>(seconds); ++i) {
      if (i % 20 == 0) ask();
      bus.handle(std::chrono::milliseconds(2));
      const double due = per_second * std::chrono::duration<double>(Clock::now() - start).count();
      for (; static_cast<double>(sent) < due && real.n_chunks > 0; ++sent) {
        if (sent >= all.size() || sent % 50 == 0) all = make();
        if (!all.empty()) bus.publish(channel, all[sent % all.size()]);
      }
    }
  }

  static constexpr std::int64_t kQuestion = 4711;
  // Tells its own poses from the localiser's, for drive, too.
  static constexpr double kMark = -77.0;

  bus::Bus bus{bus::BusOptions{}};
  map_update_t real{};
  std::deque<localisation_t> said;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  Misleader misleader;
  const std::string what = argv[1];
  const double seconds = std::atof(argv[2]), per_second = std::atof(argv[3]);
  if (what == "UPDATES")
    misleader.run<map_update_t>(
        bus::kMapUpdate, [&] { return misleader.updates(); }, seconds, per_second);
  if (what == "POSES")
    misleader.run<localisation_t>(
        bus::kLocalisation, [&] { return misleader.poses(); }, seconds, per_second);
  if (what == "KEYFRAMES")
    misleader.run<keyframe_t>(
        bus::kKeyframe, [&] { return misleader.keyframes(); }, seconds, per_second);
  if (what == "REQUESTS")
    misleader.run<map_request_t>(
        bus::kMapRequest, [&] { return misleader.requests(); }, seconds, per_second);
  return 0;
}
