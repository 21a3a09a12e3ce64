#include "voxlist/service/inputs/channel_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace voxlist::service {
namespace {

using State = bus::Health::State;
using Verdict = TimeGate::Verdict;

// A condition lasts this long (us) after it was last seen: shorter, and people who look once a
// second miss it.
constexpr std::int64_t kLasting_us = 5'000'000;

// Silence is told after three periods, but not before this (us): a busy machine pauses, too.
constexpr std::int64_t kShortestSilence_us = 1'000'000;
constexpr std::int64_t kPeriods = 3;

// What never came is told after this (us): services start in any order.
constexpr std::int64_t kFirst_us = 3'000'000;

// Numbers that jump by more than this come from a sender that started anew.
constexpr std::int64_t kMaxGap = 1000;

const char* counter_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kRepeated:
      return "utime_repeated";
    case Verdict::kBackwards:
      return "utime_backwards";
    case Verdict::kAhead:
      return "utime_far_ahead";
    case Verdict::kNotMicroseconds:
      return "bad_utime";
    case Verdict::kFits:
      break;
  }
  return "";
}

std::string sentence_of(Verdict verdict, std::int64_t utime_us) {
  switch (verdict) {
    case Verdict::kRepeated:
      return utime_us == 0 ? "has utime 0 in every message: set the time of the data"
                           : "repeats a utime: each message needs the time of its own data";
    case Verdict::kBackwards:
      return "goes back in utime: do two programs publish it, or was a recording played again?";
    case Verdict::kAhead:
      return "jumps ahead in utime by more than a minute: was the clock set?";
    case Verdict::kNotMicroseconds:
      return utime_us < 0 ? "has a negative utime: it must be microseconds since 1970"
                          : "has a utime that is no microseconds: is it in nanoseconds?";
    case Verdict::kFits:
      break;
  }
  return {};
}

}  // namespace

ChannelCheck::ChannelCheck(bus::Health& health, Options options)
    : health_(health), options_(std::move(options)), gate_(options_.disorder_us) {}

bool ChannelCheck::take(std::int64_t utime_us) {
  heard_ = true;
  const Verdict verdict = gate_.judge(utime_us);
  if (verdict == Verdict::kFits) return true;
  health_.count(key_of(counter_of(verdict)));
  note(counter_of(verdict), State::kWarning,
       fmt::format("{} {}", options_.channel, sentence_of(verdict, utime_us)));
  return false;
}

void ChannelCheck::take_number(std::int32_t seq, std::int64_t skipped) {
  const std::int64_t gap = seq_ ? std::int64_t{seq} - *seq_ - 1 - skipped : 0;
  seq_ = seq;
  const bool is_told = noted_.contains("lost_on_the_way");
  if (!is_told) lost_ = {.messages = 0, .of = 1};
  ++lost_.of;
  if (gap <= 0 || gap > kMaxGap) return;
  lost_ = {.messages = lost_.messages + gap, .of = lost_.of + gap};
  health_.count(key_of("lost_on_the_way"), gap);
  note("lost_on_the_way", State::kWarning,
       fmt::format("{} has gaps in seq: {} of {} lost on their way, or left out by their sender "
                   "(its HEALTH tells); does it put each out in one burst, as LCM's own does? Pace "
                   "it, or allow listeners more: sysctl -w net.core.rmem_max=8000000",
                   options_.channel, lost_.messages, lost_.of));
}

void ChannelCheck::leave_out(std::int64_t messages) {
  if (messages <= 0) return;
  if (!noted_.contains("left_out")) left_out_ = 0;
  left_out_ += messages;
  note("left_out", State::kWarning,
       fmt::format("{} of {} left out for newer ones, which come before it is their turn: is the "
                   "machine too slow or too busy?",
                   left_out_, options_.channel));
}

void ChannelCheck::note(const std::string& key, State state, const std::string& sentence) {
  health_.raise(key_of(key), state, sentence);
  noted_[key].is_new = true;
}

void ChannelCheck::tick(std::int64_t now_us) {
  for (auto& [key, noted] : noted_) {
    if (std::exchange(noted.is_new, false)) noted.last_us = now_us;
    if (now_us - noted.last_us >= kLasting_us) health_.clear(key_of(key));
  }
  std::erase_if(noted_, [&](const auto& n) { return now_us - n.second.last_us >= kLasting_us; });
  note_silence(now_us);
}

void ChannelCheck::note_silence(std::int64_t now_us) {
  if (options_.remedy.empty()) return;
  if (!start_us_) start_us_ = now_us;
  if (std::exchange(heard_, false)) {
    if (last_heard_us_) {
      // A pause counts as three periods, so that it does not hide the next one.
      const std::int64_t step_us = now_us - *last_heard_us_;
      period_us_ = period_us_ == 0
                       ? step_us
                       : (3 * period_us_ + std::min(step_us, kPeriods * period_us_)) / 4;
    }
    last_heard_us_ = now_us;
  }
  const std::int64_t limit_us = std::max(kPeriods * period_us_, kShortestSilence_us);
  const std::int64_t silent_us = now_us - last_heard_us_.value_or(*start_us_);
  std::string sentence;
  if (last_heard_us_ && period_us_ > 0 && silent_us > limit_us)
    sentence =
        fmt::format("no {} for {} s: {}", options_.channel, silent_us / 1'000'000, options_.remedy);
  if (!last_heard_us_ && options_.is_needed && silent_us > kFirst_us)
    sentence = fmt::format("no {} yet: {}", options_.channel, options_.remedy);
  health_.raise(key_of("silent"), State::kWarning, sentence);
}

}  // namespace voxlist::service
