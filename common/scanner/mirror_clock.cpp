#include "scanner/mirror_clock.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "geometry/pose.h"
#include "scanner/arm_rate.h"
#include "scanner/line_motion.h"
#include "scanner/mirror_track.h"
#include "scanner/step_clock.h"

namespace voxlist {
namespace {

using State = MirrorState::State;

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr std::int64_t kTimeJump_us = 2'000'000, kOutOfOrder_us = 100'000;

// Jitter of LASER's time stamps, and a little for what is not perfect in an arm.
constexpr double kStampJitter_us = 300.0;
constexpr double kMinNoise_rad = 2e-4;

// A line under even time bends where the wall clock is corrected.
constexpr double kArmsMaxAge_s = 120.0;

// Rates that differ by more are two rates.
constexpr double kRateTolerance = 0.02;
constexpr std::size_t kRatePassages = 4;

// A track of so many passages has settled.
constexpr std::size_t kGrownPassages = 16;

// Turns without a passage until an arm is missing, or the mirror stands for all we know.
constexpr double kMissingTurns = 2.5, kSilentGaps = 1.5;

// For how long a slip is told after it was put right.
constexpr double kTellSlip_s = 5.0;

// Lines are compared over this much of the beam's turn: twice the mirror's.
constexpr double kCompare_rad = 22.5 * std::numbers::pi / 180.0;
constexpr double kMinCompare_us = 30'000.0, kMaxCompare_us = 800'000.0,
                 kFirstCompare_us = 100'000.0;

// Without arms so far, lines that are still for so long speak for a mirror that stands.
constexpr double kNeverTurned_us = 3e6;

double wrap_turn(double angle_rad) {
  const double a = std::fmod(angle_rad, kTurn_rad);
  return a < 0.0 ? a + kTurn_rad : a;
}

template <class... Args>
std::string text(const char* format, Args... args) {
  char line[200];
  std::snprintf(line, sizeof line, format, args...);
  return line;
}

// Even time as a reference that turns.
struct EvenTime {
  double rate_radps = 0.0;
  std::int64_t origin_us = 0;
  double seconds(std::int64_t utime_us) const {
    return static_cast<double>(utime_us - origin_us) * 1e-6;
  }
  double angle_rad(std::int64_t utime_us) const { return rate_radps * seconds(utime_us); }
};

}  // namespace

class MirrorClock::Impl {
 public:
  explicit Impl(const MirrorClockConfig& config)
      : config_(config),
        step_rad_(kTurn_rad / config.steps_per_revolution),
        direction_(wanted_direction()),
        detector_(config.arms, config.arm_height_max_m),
        arm_rate_(config.arms, direction_),
        seen_us_(config.arms.size()) {}

  void add_edge(std::int64_t utime_us) { clock_.add_edge(utime_us); }

  MirrorState add_line(const LaserLine& line) {
    notice_time_jump(line.utime_us);
    now_us_ = line.utime_us;
    if (!origin_us_) origin_us_ = now_us_;
    if (clock_.ready() && (!clock_track_ || clock_generation_ != clock_.generation()))
      start_clock_track();
    for (const ArmPassage& passage : detector_.add(line)) take(passage);
    watch_.add(motion_.add(line, compare_lag_us()), now_us_);
    notice_stall();
    return counted(state());
  }

  Counts counts() const {
    Counts counts = counts_;
    const StepClock::Counts& c = clock_.counts();
    counts.edges = c.edges;
    counts.lost_edges = c.lost;
    counts.extra_edges = c.doubled + c.strange;
    counts.clock_restarts = c.restarts;
    return counts;
  }

  double clock_period_us() const { return clock_.period_us(); }

 private:
  double wanted_direction() const { return config_.turns_backwards ? -1.0 : 1.0; }
  double seconds(std::int64_t utime_us) const {
    return static_cast<double>(utime_us - *origin_us_) * 1e-6;
  }

  // ---- time and references

  void notice_time_jump(std::int64_t utime_us) {
    if (!origin_us_) return;
    const std::int64_t gap_us = utime_us - now_us_;
    // A laser that was away for a while does not stop the clock.
    const bool away = gap_us > kTimeJump_us && clock_.running(utime_us);
    if (gap_us > -kOutOfOrder_us && (gap_us <= kTimeJump_us || away)) return;
    ++counts_.time_jumps;
    if (!clock_.running(utime_us)) clock_.reset();
    clock_track_.reset();
    forget_arms();
    origin_us_.reset();
    tell_until_us_.reset();
    turned_rad_.reset();
    stalled_ = false;
  }

  void forget_arms() {
    detector_.reset();
    motion_.reset();
    watch_.reset();
    arms_track_.reset();
    arm_rate_.reset();
    seen_us_.assign(config_.arms.size(), std::nullopt);
    any_seen_us_.reset();
  }

  PassageFit::Options fit_options(double rate_radps) const {
    PassageFit::Options options;
    options.noise_rad = kMinNoise_rad + std::abs(rate_radps) * kStampJitter_us * 1e-6;
    return options;
  }

  double clock_rate_radps() const { return direction_ * step_rad_ / (clock_.period_us() * 1e-6); }
  double arms_rate_radps() const { return even_.rate_radps + arms_track_->rate_radps(); }

  // Without a clock nobody knows on which stop of its stair the mirror stands.
  double arms_residual_rad() const {
    const double stair_rad = config_.staircase ? step_rad_ / std::sqrt(12.0) : 0.0;
    return std::hypot(arms_track_->residual_rad(), stair_rad);
  }

  void start_clock_track() {
    clock_generation_ = clock_.generation();
    clock_track_.emplace(config_.arms.size(), step_rad_, fit_options(clock_rate_radps()));
  }

  void start_arms_track(double rate_radps) {
    even_ = {rate_radps, arm_rate_.passages().front().middle_us()};
    PassageFit::Options options = fit_options(rate_radps);
    options.free_rate = true;
    options.max_age_s = kArmsMaxAge_s;
    arms_track_.emplace(config_.arms.size(), 0.0, options);
  }

  // ---- passages

  // The clock's angle at a time that is known to some jitter: the least and the greatest.
  PassageAngles::Span clock_span(std::int64_t utime_us) const {
    const double steps = clock_.steps_at(utime_us);
    if (!config_.staircase) return {steps, steps};
    const double jitter = 3.0 * kStampJitter_us / clock_.period_us();
    return {std::floor(steps - jitter), std::floor(steps + jitter)};
  }

  PassageAngles by_clock(const ArmPassage& passage) const {
    return angles(passage, [this](const TimeSpan& span) {
      const double a = direction_ * step_rad_ * clock_span(span.after_us).low_rad;
      const double b = direction_ * step_rad_ * clock_span(span.before_us).high_rad;
      return PassageAngles::Span{std::min(a, b), std::max(a, b)};
    });
  }

  PassageAngles by_even_time(const ArmPassage& passage) const {
    return angles(passage, [this](const TimeSpan& span) {
      const double a = even_.angle_rad(span.after_us), b = even_.angle_rad(span.before_us);
      return PassageAngles::Span{std::min(a, b), std::max(a, b)};
    });
  }

  template <class ToAngles>
  PassageAngles angles(const ArmPassage& passage, const ToAngles& to_angles) const {
    PassageAngles result{passage.arm,
                         seconds(passage.middle_us()),
                         {to_angles(passage.enter), to_angles(passage.leave)}};
    for (PassageAngles::Span& span : result.ends) {
      span.low_rad -= config_.arms[passage.arm].angle_rad;
      span.high_rad -= config_.arms[passage.arm].angle_rad;
    }
    return result;
  }

  void take(const ArmPassage& passage) {
    ++counts_.arm_events;
    seen_us_[passage.arm] = any_seen_us_ = passage.middle_us();
    const std::optional<bool> by_arms = take_by_arms(passage);
    const std::optional<bool> by_clock = take_by_clock(passage);
    if (by_arms.value_or(false) || by_clock.value_or(false)) {
      watch_.turned();
      stalled_ = false;
    } else if (by_arms || by_clock) {
      ++counts_.strange_arm_events;
    }
  }

  // Whether the passage was where it was expected; nothing when nothing was.
  std::optional<bool> take_by_clock(const ArmPassage& passage) {
    if (!clock_track_ || !clock_.running(passage.middle_us())) return std::nullopt;
    const bool was_locked = clock_track_->locked();
    const MirrorTrack::Verdict verdict = clock_track_->add(by_clock(passage));
    if (verdict == MirrorTrack::Verdict::kSlipped && was_locked && !wrong_rate()) {
      const auto steps = std::llround(std::abs(clock_track_->slip_rad()) / step_rad_);
      counts_.missed_steps += steps;
      tell(text("missed %lld steps of the motor: the arms came %.1f deg late",
                static_cast<long long>(steps),
                direction_ * clock_track_->slip_rad() * 180.0 / std::numbers::pi));
    }
    const bool fits = verdict == MirrorTrack::Verdict::kFits;
    return was_locked || fits ? std::optional(fits) : std::nullopt;
  }

  std::optional<bool> take_by_arms(const ArmPassage& passage) {
    const std::optional<double> rate = arm_rate_.add(passage);
    if (arms_track_) {
      const MirrorTrack::Verdict verdict = arms_track_->add(by_even_time(passage));
      if (verdict != MirrorTrack::Verdict::kFirst) return verdict == MirrorTrack::Verdict::kFits;
      arms_track_.reset();
    }
    if (!rate) return std::nullopt;
    start_arms_track(*rate);
    for (const ArmPassage& p : arm_rate_.passages()) arms_track_->add(by_even_time(p));
    turn_direction(std::copysign(1.0, *rate));
    return arms_track_->locked();
  }

  void turn_direction(double direction) {
    if (direction == direction_) return;
    direction_ = direction;
    if (clock_track_) start_clock_track();
  }

  void tell(std::string what) {
    told_ = std::move(what);
    tell_until_us_ = now_us_ + std::llround(kTellSlip_s * 1e6);
  }

  // ---- what is wrong

  bool wrong_rate() const {
    if (!clock_.running(now_us_) || !arms_track_ || !arms_track_->locked() ||
        arms_track_->passages() < kRatePassages) {
      return false;
    }
    return std::abs(arms_rate_radps() / clock_rate_radps() - 1.0) > kRateTolerance;
  }

  std::optional<double> rate_radps() const {
    if (arms_track_ && arms_track_->locked()) return arms_rate_radps();
    if (clock_.ready()) return clock_rate_radps();
    return std::nullopt;
  }

  double compare_lag_us() const {
    const std::optional<double> rate = rate_radps();
    if (!rate) return kFirstCompare_us;
    return std::clamp(kCompare_rad / (2.0 * std::abs(*rate)) * 1e6, kMinCompare_us, kMaxCompare_us);
  }

  double since_s(std::int64_t utime_us) const {
    return static_cast<double>(now_us_ - utime_us) * 1e-6;
  }

  // No arm for clearly longer than from one arm to the next.
  bool arms_silent() const {
    const std::optional<double> rate = rate_radps();
    if (!rate || !any_seen_us_) return false;
    double gap_rad = kTurn_rad;
    if (config_.arms.size() == 2) {
      const double gap = wrap_turn(config_.arms[1].angle_rad - config_.arms[0].angle_rad);
      gap_rad = std::max(gap, kTurn_rad - gap);
      // One that has been missing is not waited for.
      if (missing_arm()) gap_rad = kTurn_rad;
    }
    return since_s(*any_seen_us_) > kSilentGaps * gap_rad / std::abs(*rate);
  }

  std::optional<std::size_t> missing_arm() const {
    const std::optional<double> rate = rate_radps();
    if (!rate || !any_seen_us_) return std::nullopt;
    for (std::size_t arm = 0; arm < seen_us_.size(); ++arm) {
      const double unseen_s = since_s(seen_us_[arm].value_or(*origin_us_));
      if (unseen_s > kMissingTurns * kTurn_rad / std::abs(*rate)) return arm;
    }
    return std::nullopt;
  }

  void notice_stall() {
    const bool stands = watch_.stalled() || (arms_silent() && !watch_.moving());
    if (!stalled_ && stands) {
      stalled_ = true;
      stalled_us_ = now_us_;
      ++counts_.stalls;
      detector_.reset();
      arm_rate_.reset();
      if (clock_track_) clock_track_->doubt();
      if (arms_track_) arms_track_->doubt();
    } else if (stalled_ && watch_.turning()) {
      stalled_ = false;
    }
  }

  // ---- the answer

  MirrorState state() {
    MirrorState state;
    state.utime_us = now_us_;
    if (stalled_) {
      state.state = State::kStalled;
      state.reason = text("the mirror stands: for %.1f s nothing turns in the lines or no arm came",
                          since_s(stalled_us_));
      return state;
    }
    const bool wrong = wrong_rate();
    const bool by_clock =
        clock_.running(now_us_) && clock_track_ && clock_track_->locked() && !wrong;
    const bool by_arms = arms_track_ && arms_track_->locked();
    // A clock that has just come back is not yet known as well as the arms' own line.
    const bool clock_is_better =
        by_clock && (!by_arms || clock_track_->passages() >= kGrownPassages ||
                     clock_track_->residual_rad() <= arms_residual_rad());
    if (clock_is_better) {
      answer_by_clock(state);
    } else if (by_arms && !arms_silent()) {
      answer_by_arms(state);
    } else {
      state.reason = why_searching();
      return state;
    }
    state.angle_known = true;
    state.state = State::kLocked;
    std::string fault = what_is_wrong(wrong, by_clock);
    if (!fault.empty()) state.state = State::kFault;
    state.reason = std::move(fault);
    return state;
  }

  void answer_by_clock(MirrorState& state) const {
    const double steps = std::floor(clock_.steps_at(now_us_));
    const auto step = static_cast<std::int64_t>(steps);
    state.utime_us = clock_.edge_us(step);
    const std::int64_t in_turn = step % config_.steps_per_revolution;
    state.angle_rad = wrap_turn(direction_ * step_rad_ * static_cast<double>(in_turn) +
                                clock_track_->offset_rad(seconds(state.utime_us)));
    state.rate_radps = clock_rate_radps();
    state.step_rad = step_rad_;
    state.residual_rad = clock_track_->residual_rad();
  }

  void answer_by_arms(MirrorState& state) const {
    state.angle_rad =
        wrap_turn(even_.angle_rad(now_us_) + arms_track_->offset_rad(seconds(now_us_)));
    state.rate_radps = arms_rate_radps();
    state.residual_rad = arms_residual_rad();
  }

  std::string why_searching() const {
    if (const auto gap = arm_rate_.strange_gap_rad()) {
      return text("arms are %.0f deg apart, which the settings say in neither direction",
                  *gap * 180.0 / std::numbers::pi);
    }
    if (!any_seen_us_ && watch_.still_us() > kNeverTurned_us)
      return "no arm seen yet, and the lines do not change: the mirror seems to stand";
    if (!any_seen_us_) return "no arm seen yet";
    if (arms_silent()) return text("no arm seen for %.1f s", since_s(*any_seen_us_));
    return "waiting for more passages of the arms";
  }

  std::string what_is_wrong(bool wrong, bool by_clock) const {
    if (direction_ != wanted_direction()) return "reversed: the mirror turns against its settings";
    if (wrong) {
      return text(
          "wrong rate: a turn takes %.3f s by the arms, %.3f s by the clock and "
          "steps_per_revolution; going on with the arms",
          kTurn_rad / std::abs(arms_rate_radps()), kTurn_rad / std::abs(clock_rate_radps()));
    }
    if (config_.has_clock && !clock_.running(now_us_)) return "clock lost: going on with the arms";
    if (config_.has_clock && !by_clock) return "clock not yet in step: going on with the arms";
    if (tell_until_us_ && now_us_ < *tell_until_us_) return told_;
    if (arms_silent())
      return text("no arm seen for %.1f s: going on with the clock", since_s(*any_seen_us_));
    if (const auto arm = missing_arm()) {
      return text("arm %zu (%.0f deg) not seen for more than two turns: going on without it", *arm,
                  config_.arms[*arm].angle_rad * 180.0 / std::numbers::pi);
    }
    return {};
  }

  // Half turns since the angle became known.
  MirrorState counted(MirrorState state) {
    if (!state.angle_known) {
      turned_rad_.reset();
      return state;
    }
    if (!turned_rad_) {
      turned_rad_ = first_rad_ = state.angle_rad;
    } else {
      const double expected =
          *turned_rad_ + state.rate_radps * static_cast<double>(state.utime_us - turned_us_) * 1e-6;
      turned_rad_ = expected + wrap_angle(state.angle_rad - expected);
    }
    turned_us_ = state.utime_us;
    state.half_revolutions =
        static_cast<std::int64_t>(std::trunc((*turned_rad_ - first_rad_) / std::numbers::pi));
    return state;
  }

  const MirrorClockConfig config_;
  const double step_rad_;
  double direction_;  // as seen
  StepClock clock_;
  ArmDetector detector_;
  LineMotion motion_;
  StallWatch watch_;
  ArmRate arm_rate_;
  std::optional<MirrorTrack> clock_track_, arms_track_;
  std::int64_t clock_generation_ = 0;
  EvenTime even_;
  std::optional<std::int64_t> origin_us_;  // of the tracks' seconds
  std::int64_t now_us_ = 0;
  std::vector<std::optional<std::int64_t>> seen_us_;
  std::optional<std::int64_t> any_seen_us_;
  bool stalled_ = false;
  std::int64_t stalled_us_ = 0;
  std::string told_;
  std::optional<std::int64_t> tell_until_us_;
  std::optional<double> turned_rad_;
  double first_rad_ = 0.0;
  std::int64_t turned_us_ = 0;
  Counts counts_;
};

MirrorClock::MirrorClock(const MirrorClockConfig& config) : impl_(std::make_unique<Impl>(config)) {}
MirrorClock::MirrorClock(MirrorClock&&) noexcept = default;
MirrorClock::~MirrorClock() = default;

void MirrorClock::add_edge(std::int64_t utime_us) { impl_->add_edge(utime_us); }
MirrorState MirrorClock::add_line(const LaserLine& line) { return impl_->add_line(line); }
MirrorClock::Counts MirrorClock::counts() const { return impl_->counts(); }
double MirrorClock::clock_period_us() const { return impl_->clock_period_us(); }

}  // namespace voxlist
