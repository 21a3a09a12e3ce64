#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <deque>
#include <vector>

namespace voxlist::scanner {

/// One passage of an arm, in angles of a reference that turns along with the mirror: the two ends
/// of the passage each lie in a span. `time_s` is when, in seconds of any origin.
struct PassageAngles {
  struct Span {
    double low_rad, high_rad;
    double middle_rad() const { return 0.5 * (low_rad + high_rad); }
  };
  std::size_t arm = 0;
  double time_s = 0.0;
  std::array<Span, 2> ends{};  ///< coming, leaving

  double middle_rad() const { return 0.5 * (ends[0].middle_rad() + ends[1].middle_rad()); }
};

/// Where the arms' passages begin and end, from many passages: for each arm two constant angles and
/// for all one rate against the reference. Each passage only says between which two beams it began,
/// 2.4 deg at 0.5 turns a second. But passages fall differently between the lines, and the angle
/// that lies in all spans at once is known far better than the mean of their middles: this is the
/// maximum of the likelihood of interval-censored observations with logistic noise, which is
/// concave (one maximum), and grows only linearly with a violation (a wild passage hardly pulls).
class PassageFit {
 public:
  struct Options {
    bool free_rate = false;     ///< else the reference turns exactly with the mirror
    double noise_rad = 0.001;   ///< of one end: jitter of the time stamps
    std::size_t passages = 64;  ///< of each arm that are kept
    double max_age_s = 1e9;     ///< older ones are left out, but for the last four of each arm
  };

  PassageFit(std::size_t arms, const Options& options);

  void add(const PassageAngles& passage);

  /// Forgets the passages, not the rate, which from then on is held to what it was.
  void clear();

  /// Turns all passages that are known by an angle: the reference has been turned.
  void turn(double angle_rad);

  std::size_t passages() const { return passages_.size(); }
  bool knows(std::size_t arm) const;

  /// Where an arm's passage begins (end 0) or ends (end 1) at a time; only of an arm that it knows.
  double end_rad(std::size_t arm, std::size_t end, double time_s) const;

  /// Half of the range of angles that fit an end's spans nearly as well as the best one.
  double end_sd_rad(std::size_t arm, std::size_t end) const {
    return sd_rad_[static_cast<Eigen::Index>(2 * arm + end)];
  }

  /// Middle of the passages, the mean over the arms that it knows (each minus its own angle in the
  /// caller's reference), at a time. Only with passages.
  double middle_rad(double time_s) const;

  /// Radians per second against the reference.
  double rate_radps() const { return rate_; }

  /// Standard deviation of middle_rad near the last passage: what the spans leave open, and how far
  /// passages are off them.
  double residual_rad() const { return residual_rad_; }

 private:
  struct End {  // one end of a passage, as the fit sees it
    Eigen::Index which;
    double time_s, low_rad, high_rad;
  };

  void drop_old();
  void fit();
  std::vector<End> collect() const;
  void start_at_middles(const std::vector<End>& ends);
  void climb(const std::vector<End>& ends, double noise_rad);
  void judge(const std::vector<End>& ends);

  Options options_;
  std::size_t arms_;
  std::deque<PassageAngles> passages_;
  double origin_s_ = 0.0;     // of the newest passage
  Eigen::VectorXd ends_rad_;  // arm 0 coming, leaving, arm 1 ..., at origin_s_
  Eigen::VectorXd sd_rad_;
  double rate_ = 0.0;
  double rate_prior_ = 0.0, rate_prior_sd_;
  double residual_rad_ = 0.0;
};

}  // namespace voxlist::scanner
