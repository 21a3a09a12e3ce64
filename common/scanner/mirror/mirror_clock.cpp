#include "voxlist/scanner/mirror/mirror_clock.h"

#include <cmath>
#include <optional>

#include "voxlist/scanner/arms/arm_detector.h"
#include "voxlist/scanner/mirror/half_turns.h"
#include "voxlist/scanner/mirror/mirror_answer.h"
#include "voxlist/scanner/mirror/mirror_evidence.h"

namespace voxlist::scanner {
namespace {

// LASER's time has jumped when a line is older than the one before by more than kOutOfOrder_us, or
// newer by more than kTimeJump_us: more than any wait for the bus, less than a clock is set by.
constexpr std::int64_t kTimeJump_us = 2'000'000, kOutOfOrder_us = 100'000;

}  // namespace

class MirrorClock::Impl {
 public:
  explicit Impl(const MirrorClockConfig& config)
      : detector_(config.arms, config.arm_height_max_m), evidence_(config) {}

  void add_edge(std::int64_t utime_us) { evidence_.clock.add_edge(utime_us); }

  MirrorState add_line(const LaserLine& line) {
    notice_time(line.utime_us);
    notice_new_rate();
    evidence_.clock.notice_restart();
    evidence_.silence.looked(line.utime_us);
    for (const ArmPassage& passage : detector_.add(line)) take(passage);
    notice_stall(line);
    auto [state, trouble] = mirror_answer(evidence_);
    trouble_ = trouble;
    state.half_revolutions = half_turns_.count(state);
    return state;
  }

  MirrorTrouble trouble() const { return trouble_; }

  Counts counts() const {
    Counts counts = counts_;
    const StepClock::Counts& clock = evidence_.clock.counts();
    counts.edges = clock.edges;
    counts.lost_edges = clock.lost;
    counts.extra_edges = clock.doubled + clock.strange;
    counts.clock_restarts = clock.restarts;
    return counts;
  }

  double clock_period_us() const { return evidence_.clock.period_us(); }

 private:
  void notice_time(std::int64_t utime_us) {
    if (started_ && jumped(utime_us)) {
      ++counts_.time_jumps;
      if (!evidence_.clock.running(utime_us)) evidence_.clock.reset_clock();
      detector_.reset();
      started_ = false;
    }
    if (!started_) evidence_.start(utime_us);
    started_ = true;
    evidence_.now_us = utime_us;
  }

  // All that was learnt belongs to the old rate, also how still a turning mirror leaves the lines.
  void notice_new_rate() {
    if (!evidence_.clock.changed_rate()) return;
    detector_.reset();
    evidence_.start(evidence_.now_us);
    evidence_.new_rate = true;
  }

  bool jumped(std::int64_t utime_us) const {
    const std::int64_t gap_us = utime_us - evidence_.now_us;
    if (gap_us < -kOutOfOrder_us) return true;
    // A laser that was away for a while does not stop the clock.
    return gap_us > kTimeJump_us && !evidence_.clock.running(utime_us);
  }

  void take(const ArmPassage& passage) {
    ++counts_.arm_events;
    evidence_.silence.passed(passage);
    const std::optional<bool> by_arms = evidence_.arms.add(passage);
    evidence_.clock.set_direction(evidence_.arms.direction());
    const MirrorByClock::Verdict by_clock = evidence_.clock.add(passage);
    if (by_clock.slip_rad && !evidence_.wrong_rate()) note_slip(*by_clock.slip_rad);
    if (by_arms.value_or(false) || by_clock.fits.value_or(false)) {
      evidence_.stall.turned();
      evidence_.new_rate = false;
    } else if (by_arms || by_clock.fits) {
      ++counts_.strange_arm_events;
    }
  }

  void note_slip(double slip_rad) {
    const auto steps = std::llround(std::abs(slip_rad) / evidence_.clock.step_rad());
    counts_.missed_steps += steps;
    evidence_.slip = {evidence_.now_us, steps, evidence_.arms.direction() * slip_rad};
  }

  void notice_stall(const LaserLine& line) {
    if (!evidence_.stall.add(line, evidence_.rate_radps(), evidence_.arms_silent_in_view())) return;
    ++counts_.stalls;
    detector_.reset();
    evidence_.clock.doubt();
    evidence_.arms.doubt();
  }

  ArmDetector detector_;
  MirrorEvidence evidence_;
  HalfTurns half_turns_;
  MirrorTrouble trouble_ = MirrorTrouble::kNoArmYet;
  bool started_ = false;
  Counts counts_;
};

MirrorClock::MirrorClock(const MirrorClockConfig& config) : impl_(std::make_unique<Impl>(config)) {}
MirrorClock::MirrorClock(MirrorClock&&) noexcept = default;
MirrorClock::~MirrorClock() = default;

void MirrorClock::add_edge(std::int64_t utime_us) { impl_->add_edge(utime_us); }
MirrorState MirrorClock::add_line(const LaserLine& line) { return impl_->add_line(line); }
MirrorTrouble MirrorClock::trouble() const { return impl_->trouble(); }
MirrorClock::Counts MirrorClock::counts() const { return impl_->counts(); }
double MirrorClock::clock_period_us() const { return impl_->clock_period_us(); }

}  // namespace voxlist::scanner
