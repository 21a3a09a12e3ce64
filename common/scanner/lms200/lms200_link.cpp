#include "voxlist/scanner/lms200/lms200_link.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "voxlist/scanner/lms200/lms200_commands.h"

namespace voxlist::scanner {
namespace {

// A command is sent so often before the device counts as silent or unwilling. One damaged byte in a
// request or a reply costs one try.
constexpr int kTries = 3;

// Longest single wait (us): a stop is noticed this soon.
constexpr std::int64_t kSlice_us = 100'000;

// A read that lasts longer than it was allowed to by this much (us) means that the system kept this
// program from reading. What arrives then may have waited, so its age tears no telegram.
constexpr std::int64_t kStall_us = 20'000;

// Wait for the 06 or 15 (us). The device sends it within 60 ms (telegram listing, 4.3, page 24);
// USB adapters and a busy host add theirs. Public drivers wait as long.
constexpr std::int64_t kAccepted_us = 250'000;

// The longest reply to a command is the status: 161 bytes with the 06, ten bits each.
constexpr std::int64_t kReplyBits = 1610;

// Wait after a damaged reply (us): the device does not send it again, but what is left of it has to
// pass before the command is repeated.
constexpr std::int64_t kAfterDamage_us = 200'000;

// Pause before a refused command is repeated (us). The device asks for 30 ms (telegram
// listing, 4.3).
constexpr std::int64_t kAfterRefusal_us = 35'000;

// A repeated command may be answered twice. So long (us) after the first answer the second one is
// still taken for it, and not for the answer to the next command.
constexpr std::int64_t kSecondAnswer_us = 100'000;

// A change of mode takes up to 3 s (telegram listing, 4.3).
constexpr std::int64_t kModeLimit_us = 3'000'000;

}  // namespace

Lms200Link::Lms200Link(serial::Port& port, std::string port_name, std::stop_token stop)
    : port_(port), port_name_(std::move(port_name)), stop_(std::move(stop)) {}

void Lms200Link::set_baud(int baud) {
  port_.set_baud(baud);
  baud_ = baud;
  parser_.clear();
}

void Lms200Link::forget() {
  port_.flush();
  parser_.clear();
}

void Lms200Link::send(std::uint8_t command, std::span<const std::uint8_t> data) {
  port_.write(encode(Lms200Telegram{0, command, {data.begin(), data.end()}}));
}

void Lms200Link::receive(std::int64_t timeout_us) {
  if (stop_.stop_requested()) throw Lms200Failure(port_name_ + ": asked to stop");
  timeout_us = std::clamp<std::int64_t>(timeout_us, 0, kSlice_us);
  const auto received = port_.read(timeout_us);
  const std::int64_t now_us = port_.now_us();
  if (now_us - std::exchange(looked_us_, now_us) > timeout_us + kStall_us) parser_.excuse(now_us);
  if (!received) return parser_.feed(now_us, {});
  received_bytes_ += static_cast<std::int64_t>(received->bytes.size());
  parser_.feed(received->utime_us, received->bytes);
}

// A clock that was set back ends a wait: it must not last until the old time comes again.
std::optional<Lms200Event> Lms200Link::event(std::int64_t deadline_us) {
  std::int64_t now_us = port_.now_us(), last_us = now_us;
  for (; now_us >= last_us; last_us = std::exchange(now_us, port_.now_us())) {
    if (auto event = parser_.next()) return event;
    if (now_us >= deadline_us) return std::nullopt;
    receive(deadline_us - now_us);
  }
  return std::nullopt;
}

void Lms200Link::wait(std::int64_t duration_us) {
  std::int64_t now_us = port_.now_us(), last_us = now_us;
  const std::int64_t end_us = now_us + duration_us;
  for (; now_us >= last_us && now_us < end_us; last_us = std::exchange(now_us, port_.now_us()))
    receive(end_us - now_us);
}

std::int64_t Lms200Link::damage() const {
  const Lms200Parser::Counts& counts = parser_.counts();
  return counts.bad_crc + counts.torn + counts.skipped_bytes;
}

Lms200Link::Answer Lms200Link::answer(std::uint8_t reply, std::int64_t limit_us,
                                      Lms200Telegram& telegram) {
  const std::int64_t transfer_us = kReplyBits * 1'000'000 / baud_;
  const std::int64_t damage = this->damage();
  std::int64_t deadline_us = port_.now_us() + kAccepted_us + transfer_us;
  while (auto event = this->event(deadline_us)) {
    switch (event->kind) {
      case Lms200Event::Kind::kAccepted:
        deadline_us = port_.now_us() + limit_us + transfer_us;
        break;
      case Lms200Event::Kind::kRefused:
        return Answer::kRefused;
      case Lms200Event::Kind::kTelegram:
        telegram = std::move(event->telegram);
        if (telegram.command == reply) return Answer::kReply;
        if (telegram.command == lms200::kRejected) return Answer::kRefused;
        if (telegram.command == lms200::kPoweredOn)
          throw Lms200Failure(
              fmt::format("the LMS 200 on {} restarted by itself; check its supply", port_name_));
    }
    if (this->damage() != damage)
      deadline_us = std::min(deadline_us, port_.now_us() + kAfterDamage_us);
  }
  return Answer::kNone;
}

Lms200Telegram Lms200Link::ask(std::uint8_t command, std::span<const std::uint8_t> data,
                               Repeat repeat, std::int64_t limit_us) {
  Answer got = Answer::kNone;
  for (int tries = 1; tries <= kTries; ++tries) {
    while (parser_.next()) {
    }
    send(command, data);
    Lms200Telegram reply;
    got = answer(command | lms200::kReply, limit_us, reply);
    if (got == Answer::kReply) {
      if (tries > 1) wait(kSecondAnswer_us);
      return reply;
    }
    if (got == Answer::kNone && repeat == Repeat::kWhenRefused) break;
    wait(kAfterRefusal_us);
  }
  const bool silent = got == Answer::kNone;
  throw Lms200Failure(fmt::format("the LMS 200 on {} {} command {:02X}; {}", port_name_,
                                  silent ? "does not answer" : "refuses", command,
                                  silent ? "check cable and adapter" : "switch it off and on"),
                      silent);
}

void Lms200Link::set_mode(std::uint8_t mode, std::span<const std::uint8_t> password,
                          Repeat repeat) {
  std::vector<std::uint8_t> data{mode};
  data.insert(data.end(), password.begin(), password.end());
  const Lms200Telegram reply = ask(lms200::kSetMode, data, repeat, kModeLimit_us);
  if (reply.data.empty() || reply.data[0] != 0)
    throw Lms200Failure(fmt::format(
        "the LMS 200 on {} does not go into mode {:02X}; switch it off and on", port_name_, mode));
}

}  // namespace voxlist::scanner
