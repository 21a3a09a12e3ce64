#include "services/voxlist/view/player.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "voxlist/viewing/commands.h"

namespace voxlist::desk {
namespace {

// Messages of one tick, so that the page is served while a long way is gone.
constexpr int kMessagesAtOnce = 2000;

constexpr std::int64_t kTimePeriod_us = 250'000;

}  // namespace

Player::Player(std::unique_ptr<Events> events, const Highlights& highlights,
               const std::string& name, const viewing::ViewerConfig& config,
               const viewing::ServerOptions& server, const std::vector<std::string>& robots)
    : highlights_(highlights),
      viewer_(config),
      replay_(std::move(events), viewer_, robots),
      shown_us_(highlights.begin_us),
      server_(server, owner()) {
  viewer_.scene().board().put(
      "hello",
      fmt::format("{{\"token\":\"{}\",\"recording\":{}}}", server_.token(), highlights.json(name)),
      0);
}

void Player::tick(std::int64_t now_us) {
  go_on(now_us);
  viewer_.tick();
  if (!told_us_ || now_us - *told_us_ >= kTimePeriod_us) tell_time(now_us);
  server_.poll();
}

void Player::go_on(std::int64_t now_us) {
  const std::int64_t passed_us = last_us_ ? now_us - *last_us_ : 0;
  last_us_ = now_us;
  if (!replay_.advance(shown_us_, kMessagesAtOnce)) return;
  shown_us_ += static_cast<std::int64_t>(speed_ * static_cast<double>(passed_us));
  shown_us_ = std::min(shown_us_, highlights_.end_us);
  if (shown_us_ == highlights_.end_us) speed_ = 0.0;
}

void Player::tell_time(std::int64_t now_us) {
  told_us_ = now_us;
  viewer_.scene().board().put(
      "clock", fmt::format("{{\"utime_us\":{},\"speed\":{}}}", shown_us_, speed_), shown_us_);
}

viewing::ServerOwner Player::owner() {
  return {[this] { return viewer_.open(); },
          [this](int client) { viewer_.close(client); },
          [this](int client) { return viewer_.next(client, shown_us_); },
          [this](const std::string& name, const std::string& json) { return obey(name, json); },
          {},
          [this](int client, std::string_view text) { viewer_.hear(client, text); }};
}

viewing::CommandAnswer Player::obey(const std::string& name, const std::string& json) {
  const auto command = viewing::parse_command(name, json);
  if (!command) return {400, "no such command, or it does not say what it needs"};
  told_us_.reset();
  if (const auto* play = std::get_if<viewing::PlayCommand>(&*command)) {
    speed_ = play->speed;
    const bool begins_again = speed_ > 0.0 && shown_us_ == highlights_.end_us;
    if (begins_again) replay_.rewind();
    if (begins_again) shown_us_ = highlights_.begin_us;
    return {};
  }
  if (const auto* seek = std::get_if<viewing::SeekCommand>(&*command)) {
    const std::int64_t to_us = std::clamp(seek->utime_us, highlights_.begin_us, highlights_.end_us);
    if (to_us < shown_us_) replay_.rewind();
    shown_us_ = to_us;
    return {};
  }
  return {409, "a recording takes no orders"};
}

}  // namespace voxlist::desk
