#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>

#include "voxlist/scanner/lms200/lms200_telegram.h"
#include "voxlist/serial/port.h"

namespace voxlist::scanner {

/// The device does not do what it should: what() is one line with what, the port, and what to do.
class Lms200Failure : public std::runtime_error {
 public:
  /// `silent`: nothing that makes sense was heard, so nothing but asking again can help.
  explicit Lms200Failure(const std::string& what, bool silent = false)
      : std::runtime_error(what), is_silent(silent) {}

  const bool is_silent;
};

/// Asks an LMS 200 and waits for its answers, one command at a time. All waiting is in Port::read.
class Lms200Link {
 public:
  /// `port` must outlive it; its name is for messages. Once a stop is requested every wait ends
  /// within 100 ms as an Lms200Failure.
  Lms200Link(serial::Port& port, std::string port_name, std::stop_token stop);

  /// Goes on at another speed and forgets what was under way.
  void set_baud(int baud);
  int baud() const { return baud_; }

  /// Sends a command and waits for nothing.
  void send(std::uint8_t command, std::span<const std::uint8_t> data);

  /// When a command may be sent again: when no answer came, or only when it was refused.
  enum class Repeat { kWhenSilent, kWhenRefused };

  /// Sends a command and returns its reply. Repeats it up to three times. Throws Lms200Failure:
  /// refused, silent for longer than `limit_us` after it had accepted the command, or restarted.
  Lms200Telegram ask(std::uint8_t command, std::span<const std::uint8_t> data = {},
                     Repeat repeat = Repeat::kWhenSilent, std::int64_t limit_us = 1'000'000);

  /// Puts the device in a mode (lms200_commands.h). Throws Lms200Failure also when it does not go.
  void set_mode(std::uint8_t mode, std::span<const std::uint8_t> password = {},
                Repeat repeat = Repeat::kWhenSilent);

  /// Waits for the next event until a time of the port's clock; nothing when none came.
  std::optional<Lms200Event> event(std::int64_t deadline_us);

  /// Lets time pass. What arrives meanwhile is kept.
  void wait(std::int64_t duration_us);

  /// Forgets what arrived.
  void forget();

  /// From now on a requested stop ends no wait: for switching the device off at the end.
  void ignore_stop() { stop_ = {}; }

  std::int64_t now_us() const { return port_.now_us(); }
  const Lms200Parser::Counts& counts() const { return parser_.counts(); }
  std::int64_t received_bytes() const { return received_bytes_; }
  const std::string& port_name() const { return port_name_; }

 private:
  enum class Answer { kReply, kRefused, kNone };

  Answer answer(std::uint8_t reply, std::int64_t limit_us, Lms200Telegram& telegram);
  void receive(std::int64_t timeout_us);
  std::int64_t damage() const;

  serial::Port& port_;
  const std::string port_name_;
  std::stop_token stop_;
  Lms200Parser parser_;
  int baud_ = 0;
  std::int64_t received_bytes_ = 0;
  std::int64_t looked_us_ = 0;  // when the port was last read
};

}  // namespace voxlist::scanner
