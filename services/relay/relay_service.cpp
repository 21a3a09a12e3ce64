#include "services/relay/relay_service.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <vector>
#include <voxlist/health_t.hpp>

#include "voxlist/bus/channel_pattern.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/multicast/address.h"

namespace voxlist::services {
namespace {

using Row = fleet::RelayChannel;

constexpr std::int64_t kReportPeriod_us = 1'000'000;

// A trouble is told for so long after it was last seen, and a robot counts as there (us).
constexpr std::int64_t kLasting_us = 5'000'000;

// What got lost while a robot was not heard for so long is not counted any more (us).
constexpr std::int64_t kForgotten_us = 600'000'000;

// Behind a robot's name: how much its relay has sent. No row can name it, for it has a slash.
constexpr const char* kSentCounts = "RELAY/SENT";

// Robots that are told apart: their names come from the network.
constexpr std::size_t kMostRobots = 200;

// What this robot says in the fleet it hears itself, as anyone does. Nothing of it for so long
// (us), though it was said, and the connection is broken: its interface went, and came back as
// another.
constexpr std::int64_t kDeaf_us = 10'000'000;

bus::BusOptions fleet_options(const fleet::RelayConfig& config) {
  return {.url = config.url, .prefix = "", .receive_buffer_bytes = config.receive_buffer_bytes};
}

// What goes out of the robot's bus, and what comes from the fleet's: this robot's own channels are
// listened to for its namesakes.
std::vector<std::string> patterns_out(const std::vector<Row>& rows) {
  std::vector<std::string> patterns;
  for (const Row& row : rows)
    if (row.direction == fleet::Direction::kOut) patterns.push_back(row.name);
  return patterns;
}

std::vector<std::string> patterns_in(const std::string& robot, const std::vector<Row>& rows) {
  std::vector<std::string> patterns = {robot + "/*", std::string("*/") + kSentCounts};
  for (const Row& row : rows)
    if (row.direction == fleet::Direction::kIn) patterns.push_back(row.robot + "/" + row.name);
  return patterns;
}

int port_of(const std::string& url) {
  const auto address = bus::multicast_address(url);
  return address ? address->port : -1;
}

}  // namespace

void RelayService::check(const fleet::RelayConfig& config, const bus::BusOptions& bus) {
  if (const std::string why = why_invalid(config); !why.empty()) throw std::invalid_argument(why);
  // Another group on the same port is the same bus: every message would come back.
  if (port_of(config.url) >= 0 && port_of(config.url) == port_of(bus.url))
    throw std::invalid_argument(
        fmt::format("url {} has the port of the robot's own bus, {}", config.url, bus.url));
}

RelayService::RelayService(bus::Bus& bus, bus::Health& health, const fleet::RelayConfig& config)
    : bus_(bus),
      health_(health),
      robot_(config.robot),
      fleet_(fleet_options(config)),
      network_(fleet_options(config), "fleet"),
      out_(config.channels_in_use(), fleet::Direction::kOut,
           [this](const std::string& channel, bus::Bytes bytes) { send_to_fleet(channel, bytes); }),
      in_(config.channels_in_use(), fleet::Direction::kIn,
          [this](const std::string& channel, bus::Bytes bytes) { send_to_robot(channel, bytes); }) {
  network_.take(0, health_);
  if (const auto address = bus::multicast_address(config.url); address && address->ttl == 0)
    health_.raise("fleet_stays_here", bus::Health::State::kWarning,
                  "fleet: what this robot says stays on this machine: url needs ?ttl=1");
  const std::vector<Row> rows = config.channels_in_use();
  fleet_.subscribe_all(patterns_in(robot_, rows),
                       [this](const std::string& name, bus::Bytes b) { take_from_fleet(name, b); });
  const std::vector<std::string> out = patterns_out(rows);
  if (out.empty()) return;
  bus_.subscribe_all(out, [this](const std::string& name, bus::Bytes bytes) {
    arrival_us_ = bus_.arrival_utime_us();
    out_.take("", name, robot_ + "/" + name, bytes, now_us_);
  });
}

void RelayService::take_from_fleet(const std::string& wire_name, bus::Bytes bytes) {
  const std::size_t slash = wire_name.find('/');
  if (!bus::is_plain_channel(wire_name) || slash == 0 || slash == std::string::npos)
    return health_.count("no_robots_names");
  const std::string robot = wire_name.substr(0, slash), name = wire_name.substr(slash + 1);
  if (robot == robot_) {
    ++own_heard_;
    own_heard_us_ = now_us_;
    return;
  }
  if (peers_.size() >= kMostRobots && !peers_.contains(robot)) forget_peers(kLasting_us);
  if (peers_.size() >= kMostRobots && !peers_.contains(robot))
    return health_.count("too_many_robots");
  Peer& peer = peers_[robot];
  peer.heard_us = now_us_;
  if (name == kSentCounts) return take_sent_counts(robot, bytes);
  arrival_us_ = fleet_.arrival_utime_us();
  if (in_.row_of(robot, name) != nullptr) peer.losses.hear(name);
  in_.take(robot, name, wire_name, bytes, now_us_);
}

void RelayService::take_sent_counts(const std::string& robot, bus::Bytes bytes) {
  health_t message{};
  if (bus::decode(bytes, message) != bus::Fault::kNone)
    return health_.count("malformed_sent_counts");
  fleet::SentCounts sent;
  for (const counter_t& counter : message.counters)
    if (in_.row_of(robot, counter.name) != nullptr) sent[counter.name] = counter.count;
  for (const auto& [name, count] : peers_[robot].losses.told(message.pid, sent))
    health_.count("in/" + in_.row_of(robot, name)->name + "/lost_on_the_way", count);
}

void RelayService::send_sent_counts() {
  health_t message{};
  message.utime = now_us_;
  message.service = "relay";
  message.pid = getpid();
  for (const auto& [name, count] : sent_by_channel_) {
    counter_t counter{};
    counter.name = name;
    counter.count = count;
    message.counters.push_back(counter);
  }
  message.n_counters = static_cast<std::int32_t>(message.counters.size());
  std::vector<std::uint8_t> bytes;
  if (bus::encode(message, bytes) != bus::Fault::kNone) return;
  ++sent_;
  fleet_.publish_encoded(robot_ + "/" + kSentCounts, bytes);
}

void RelayService::send_to_fleet(const std::string& channel, bus::Bytes bytes) {
  ++sent_;
  ++sent_by_channel_[channel.substr(robot_.size() + 1)];
  fleet_.publish_encoded(channel, bytes);
}

void RelayService::send_to_robot(const std::string& channel, bus::Bytes bytes) {
  bus_.publish_encoded(channel, bytes);
}

void RelayService::tick(std::int64_t now_us) {
  now_us_ = now_us;
  if (!fleet_.handle(std::chrono::milliseconds(0)))
    throw std::runtime_error("the connection to the fleet's bus broke; start again");
  out_.tick(now_us);
  in_.tick(now_us);
  if (arrival_us_) health_.add_latency_us(now_us - *arrival_us_);
  arrival_us_.reset();
  if (!reported_us_ || now_us - *reported_us_ >= kReportPeriod_us) report();
}

void RelayService::report() {
  reported_us_ = now_us_;
  tell("out/", out_.counters());
  tell("in/", in_.counters());
  report_traffic();
  network_.take(now_us_, health_);
  look_for_namesakes();
  look_for_rings();
  throw_if_deaf();
  send_sent_counts();
  forget_peers(kForgotten_us);
  const auto there = std::ranges::count_if(
      peers_, [&](const auto& peer) { return now_us_ - peer.second.heard_us <= kLasting_us; });
  health_.gauge("robots_heard", static_cast<double>(there));
}

void RelayService::forget_peers(std::int64_t silent_us) {
  std::erase_if(peers_,
                [&](const auto& peer) { return now_us_ - peer.second.heard_us > silent_us; });
}

void RelayService::throw_if_deaf() {
  if (!own_heard_us_) own_heard_us_ = now_us_;
  if (now_us_ - *own_heard_us_ > kDeaf_us)
    throw std::runtime_error("nothing comes through the fleet's bus any more; start again");
}

void RelayService::report_traffic() {
  const bus::Traffic traffic = fleet_.traffic();
  std::int64_t unsent = traffic.failed_messages;
  for (const auto& [what, count] : fleet_.losses())
    if (what.ends_with("/unsent_refused")) unsent += count;
  tell(
      unsent_, unsent, "fleet_messages_not_sent",
      "messages could not be sent to the fleet: is its network there, with a route for multicast?");
  tell(dropped_, traffic.dropped_packets, "fleet_packets_without_room",
       "packets of the fleet found no room here, their messages are lost: allow more with sysctl "
       "-w net.core.rmem_max=8000000");
  tell(
      incomplete_, traffic.incomplete_packets, "fleet_packets_incomplete",
      "packets of the fleet came without all their fragments, their messages are lost: its network "
      "loses some");
}

// Of what this robot sends it hears each message once, as anyone does. More than that is another's.
void RelayService::look_for_namesakes() {
  tell(namesakes_, std::max<std::int64_t>(0, own_heard_ - sent_), "namesakes_messages",
       "messages came from another robot of this name: give each a name of its own");
}

void RelayService::look_for_rings() {
  std::int64_t repeated = 0;
  for (const auto& [what, count] : in_.counters())
    if (what.ends_with("/repeated")) repeated += count;
  tell(rings_, repeated, "messages_repeated",
       "messages came in again: do relays join the same two buses twice?");
}

void RelayService::tell(const std::string& direction, const bus::Counters& counters) {
  for (const auto& [what, count] : counters) {
    std::int64_t& told = told_[direction + what];
    if (count > told) health_.count(direction + what, count - told);
    told = count;
  }
}

void RelayService::tell(Trouble& trouble, std::int64_t count, const std::string& key,
                        const std::string& sentence) {
  if (count > trouble.counted) {
    health_.count(key, count - trouble.counted);
    trouble.last_us = now_us_;
    trouble.counted = count;
    health_.raise(key, bus::Health::State::kWarning, fmt::format("{} {}", count, sentence));
  } else if (trouble.last_us && now_us_ - *trouble.last_us > kLasting_us) {
    health_.clear(key);
  }
}

}  // namespace voxlist::services
