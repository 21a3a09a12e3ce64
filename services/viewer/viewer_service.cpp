#include "services/viewer/viewer_service.h"

#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_edits_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_hint_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/traversability_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/edit_convert.h"

namespace voxlist::services {
namespace {

using viewing::CommandAnswer;

// A page that hears nothing for longer than a few of these (us) knows that the service is gone.
constexpr std::int64_t kTimePeriod_us = 500'000;

// MAP_EDITS is asked for this often until it is there (us).
constexpr std::int64_t kEditsPeriod_us = 2'000'000;

std::string open_sentence(const std::string& address) {
  if (viewing::is_loopback(address)) return {};
  return "everybody who reaches " + address + " sees the page and can give commands";
}

viewing::ServerOptions listening(const ViewerServiceConfig& config) {
  return {config.address, static_cast<std::uint16_t>(config.port), viewing::inherited_socket()};
}

std::vector<std::string> names_of(const planning::RobotProfiles& robots) {
  std::vector<std::string> names;
  for (const planning::RobotProfile& robot : robots.in_use()) names.push_back(robot.name);
  return names;
}

}  // namespace

void ViewerService::check(const ViewerServiceConfig& config) {
  if (!viewing::is_address(config.address))
    throw std::invalid_argument("address must be in numbers, such as 127.0.0.1");
  if (const std::string why = why_invalid(config.robots); !why.empty())
    throw std::invalid_argument(why);
}

ViewerService::ViewerService(bus::Bus& bus, bus::Health& health, const ViewerServiceConfig& config)
    : bus_(bus),
      health_(health),
      viewer_(config.viewer),
      follower_(health),
      foxglove_(bus, names_of(config.robots)),
      server_(listening(config), owner(config.foxglove_origins)) {
  check(config);
  subscribe(config.robots);
  spdlog::info("the page is at http://{}:{}/", config.address, server_.port());
  health_.raise("open", bus::Health::State::kWarning, open_sentence(config.address));
  viewer_.scene().board().put(
      "hello", fmt::format("{{\"token\":\"{}\",\"session\":\"{}\"}}", server_.token(), getpid()),
      0);
}

// The longest of what waited before a tick tells how soon the bus is heard.
template <class M, class Handle>
void ViewerService::listen(bus::Channel<M> channel, Handle handle) {
  bus_.subscribe(channel, [this, handle = std::move(handle)](const M& message) {
    handle(message);
    if (!arrival_us_) arrival_us_ = bus_.arrival_utime_us();
  });
}

template <class M>
void ViewerService::show(bus::Channel<M> channel) {
  listen(channel, [this, name = std::string(channel.name)](const M& message) {
    viewer_.scene().take(message, now_us_);
    foxglove_.take(bus::Channel<M>{name.c_str()}, message);
  });
}

void ViewerService::subscribe(const planning::RobotProfiles& robots) {
  show(bus::kLocalisation);
  show(bus::kPose);
  show(bus::kPoseCovariance);
  show(bus::kObstacles);
  show(bus::kHealth);
  show(bus::kOctomap);
  for (const planning::RobotProfile& robot : robots.in_use()) {
    const std::string channel = "TRAVERSABILITY_" + robot.name;
    show(bus::Channel<traversability_t>{channel.c_str()});
  }
  listen(bus::kMapUpdate, [this](const map_update_t& m) { take(m); });
  listen(bus::kFreeSpace, [this](const map_update_t& m) {
    if (!space_follower_) return;
    for (const bus::MapChange& change : space_follower_->take(m)) {
      viewer_.take_space(change);
      foxglove_.take_space(change);
    }
  });
  listen(bus::kKeyframe, [this](const keyframe_t& m) { viewer_.scene().take(m, now_us_); });
  listen(bus::kCloud, [this](const pointcloud_t& m) {
    viewer_.scene().take_cloud(m, now_us_);
    foxglove_.take(bus::kCloud, m);
  });
  listen(bus::kCloudSlice, [this](const pointcloud_t& m) {
    viewer_.scene().take_slice(m, now_us_);
    foxglove_.take(bus::kCloudSlice, m);
  });
  bus_.subscribe_all(viewing::OtherRobots::kChannels,
                     [this](const std::string& channel, bus::Bytes bytes) {
                       const bus::Fault fault = viewer_.scene().take_other(channel, bytes, now_us_);
                       if (fault != bus::Fault::kNone)
                         health_.count(std::string("other_robots/") + bus::fault_name(fault));
                     });
  listen(bus::kMapEdits, [this](const map_edits_t& m) {
    if (const auto edits = bus::from_message(m)) viewer_.scene().take(*edits, now_us_);
  });
}

void ViewerService::take(const map_update_t& message) {
  for (const bus::MapChange& change : follower_.take(message)) {
    viewer_.take(change, now_us_);
    foxglove_.take(change);
  }
}

void ViewerService::tick(std::int64_t now_us) {
  now_us_ = now_us;
  if (arrival_us_) health_.add_latency_us(now_us - *arrival_us_);
  arrival_us_.reset();
  follow_map();
  follow_space();
  viewer_.tick();
  foxglove_.tick(now_us);
  if (!told_us_ || now_us - *told_us_ >= kTimePeriod_us) tell_time();
  server_.poll();
  report();
}

void ViewerService::follow_map() {
  if (const auto wanted = follower_.tick(now_us_)) bus_.publish(bus::kMapRequest, *wanted);
  if (!follower_.held()) return viewer_.forget_map(now_us_);
  if (const auto first = viewer_.scene().keyframe_due(now_us_))
    request(map_request_t::WANT_KEYFRAMES, *first);
  if (asked_edits_us_ && now_us_ - *asked_edits_us_ < kEditsPeriod_us) return;
  if (viewer_.scene().knows_edits()) return;
  asked_edits_us_ = now_us_;
  request(map_request_t::WANT_EDITS);
}

// What is free costs the mapper, the bus and this service something: it is asked for while somebody
// looks at it.
void ViewerService::follow_space() {
  if (!viewer_.is_space_wanted() && !foxglove_.wants_space()) {
    space_follower_.reset();
    return viewer_.forget_space();
  }
  if (!space_follower_) space_follower_.emplace(health_, service::kFreeSpaceSource);
  if (const auto wanted = space_follower_->tick(now_us_)) bus_.publish(bus::kMapRequest, *wanted);
  if (!space_follower_->held()) viewer_.forget_space();
}

void ViewerService::tell_time() {
  told_us_ = now_us_;
  foxglove_.tell_time(now_us_);
  viewer_.scene().board().put(
      "time",
      fmt::format("{{\"now_us\":{},\"clients\":{},\"recording\":\"{}\"}}", now_us_,
                  server_.clients(), recorder_.is_on() ? recorder_.file().filename().string() : ""),
      now_us_);
}

void ViewerService::report() {
  health_.gauge("clients", server_.clients());
  health_.gauge("refused_requests", static_cast<double>(server_.refused()));
}

viewing::ServerOwner ViewerService::owner(const std::vector<std::string>& foxglove_origins) {
  return {[this] { return viewer_.open(); },
          [this](int client) { viewer_.close(client); },
          [this](int client) { return viewer_.next(client, now_us_); },
          [this](const std::string& name, const std::string& json) { return obey(name, json); },
          foxglove_.protocol(foxglove_origins),
          [this](int client, std::string_view text) { viewer_.hear(client, text); }};
}

CommandAnswer ViewerService::obey(const std::string& name, const std::string& json) {
  const auto command = viewing::parse_command(name, json);
  if (!command) return {400, "no such command, or it does not say what it needs"};
  return std::visit([this](const auto& c) { return obey(c); }, *command);
}

// No two commands have the same time, so that an answer tells which one it belongs to.
std::int64_t ViewerService::next_utime_us() {
  return last_utime_us_ = std::max(now_us_, last_utime_us_ + 1);
}

CommandAnswer ViewerService::request(std::int32_t want, std::int32_t first) {
  map_request_t message{};
  message.utime = next_utime_us();
  message.want = want;
  message.first = first;
  bus_.publish(bus::kMapRequest, message);
  return {};
}

CommandAnswer ViewerService::obey(const viewing::HintCommand& command) {
  if (!follower_.held()) return {409, "there is no map"};
  pose_hint_t message{};
  message.utime = next_utime_us();
  message.map_id = follower_.held()->map_id;
  message.pose[0] = command.pose.x_m;
  message.pose[1] = command.pose.y_m;
  message.pose[2] = command.pose.yaw_rad;
  message.sigma_m = command.sigma_m;
  message.sigma_rad = command.sigma_rad;
  bus_.publish(bus::kPoseHint, message);
  return {};
}

CommandAnswer ViewerService::obey(const viewing::SaveCommand&) {
  return request(map_request_t::WANT_SAVE);
}

CommandAnswer ViewerService::obey(const viewing::LocaliseOnlyCommand& command) {
  constexpr std::int32_t kOn = map_request_t::WANT_LOCALISE_ONLY, kOff = map_request_t::WANT_EXTEND;
  return request(command.on ? kOn : kOff);
}

CommandAnswer ViewerService::obey(const viewing::EditCommand& command) {
  if (!follower_.held()) return {409, "there is no map"};
  const bus::EditWish wish{next_utime_us(), follower_.held()->map_id, command.kind, 0, command.box};
  bus_.publish(bus::kMapEdit, bus::to_message(wish));
  return {};
}

CommandAnswer ViewerService::obey(const viewing::RemoveEditCommand& command) {
  if (!follower_.held()) return {409, "there is no map"};
  const bus::EditWish wish{next_utime_us(), follower_.held()->map_id, std::nullopt, command.id, {}};
  bus_.publish(bus::kMapEdit, bus::to_message(wish));
  return {};
}

CommandAnswer ViewerService::obey(const viewing::RecordCommand& command) {
  if (!command.on) recorder_.stop();
  const std::string wrong = command.on ? recorder_.start(now_us_) : "";
  tell_time();
  return wrong.empty() ? CommandAnswer{} : CommandAnswer{409, wrong};
}

CommandAnswer ViewerService::obey(const viewing::PlayCommand&) {
  return {409, "this is live, not a recording"};
}

CommandAnswer ViewerService::obey(const viewing::SeekCommand&) {
  return {409, "this is live, not a recording"};
}

}  // namespace voxlist::services
