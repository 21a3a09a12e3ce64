#include "voxlist/scanner/arms/passage_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "voxlist/geometry/elementary.h"

namespace voxlist::scanner {
namespace {

// Noise that a fit starts with (rad): a whole span at 0.5 turns a second, 2.4 deg, so that every
// end has a say. It is halved down to the true noise, each time with up to kClimbs steps of
// Newton's method.
constexpr double kFirstNoise_rad = 0.04;
constexpr int kClimbs = 6;

// Each end is also pulled to the middle of its span, with a standard deviation of so many widths:
// too weak to move what the spans tell, strong enough to hold an end that lies in none of them.
constexpr double kMiddlePull = 10.0;

// Standard deviation of the mirror's rate against the reference (rad/s): before anything is known,
// and for a rate that was fitted before, as a crystal holds it (1e-4 of half a turn a second).
constexpr double kRoughRateSd_radps = 0.1, kCrystalRateSd_radps = 3e-4;

// Where the search for an end's standard deviation stops (rad): 11 deg, five spans, is not known at
// all.
constexpr double kMaxSd_rad = 0.2;

double logistic(double x) { return 1.0 / (1.0 + elementary::exp(-x)); }
double softplus(double x) {
  return x > 0.0 ? x + elementary::log1p(elementary::exp(-x))
                 : elementary::log1p(elementary::exp(x));
}

}  // namespace

PassageFit::PassageFit(std::size_t arms, const Options& options)
    : options_(options),
      arms_(arms),
      ends_rad_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * arms))),
      sd_rad_(ends_rad_),
      rate_prior_sd_(kRoughRateSd_radps) {}

void PassageFit::add(const PassageAngles& passage) {
  passages_.push_back(passage);
  drop_old();
  fit();
}

void PassageFit::clear() {
  if (passages_.size() > 4) {
    rate_prior_ = rate_;
    rate_prior_sd_ = kCrystalRateSd_radps;
  }
  passages_.clear();
}

void PassageFit::turn(double angle_rad) {
  for (PassageAngles& passage : passages_) {
    for (PassageAngles::Span& span : passage.ends) {
      span.low_rad += angle_rad;
      span.high_rad += angle_rad;
    }
  }
  ends_rad_.array() += angle_rad;
}

void PassageFit::drop_old() {
  std::vector<std::size_t> kept(arms_, 0);
  std::deque<PassageAngles> young;
  for (auto p = passages_.rbegin(); p != passages_.rend(); ++p) {
    const std::size_t n = ++kept[p->arm];
    const bool old = passages_.back().time_s - p->time_s > options_.max_age_s && n > 4;
    if (n <= options_.passages && !old) young.push_front(*p);
  }
  passages_ = std::move(young);
}

bool PassageFit::knows(std::size_t arm) const {
  return std::ranges::any_of(passages_, [&](const PassageAngles& p) { return p.arm == arm; });
}

double PassageFit::end_rad(std::size_t arm, std::size_t end, double time_s) const {
  return ends_rad_[static_cast<Eigen::Index>(2 * arm + end)] + rate_ * (time_s - origin_s_);
}

double PassageFit::middle_rad(double time_s) const {
  double sum = 0.0, arms = 0.0;
  for (std::size_t arm = 0; arm < arms_; ++arm) {
    if (!knows(arm)) continue;
    sum += 0.5 * (end_rad(arm, 0, time_s) + end_rad(arm, 1, time_s));
    arms += 1.0;
  }
  return sum / arms;
}

std::vector<PassageFit::End> PassageFit::collect() const {
  std::vector<End> ends;
  for (const PassageAngles& p : passages_)
    for (std::size_t e = 0; e < 2; ++e)
      ends.push_back({static_cast<Eigen::Index>(2 * p.arm + e), p.time_s - origin_s_,
                      p.ends[e].low_rad, p.ends[e].high_rad});
  return ends;
}

void PassageFit::fit() {
  origin_s_ = passages_.back().time_s;
  const std::vector<End> ends = collect();
  start_at_middles(ends);
  // The noise is narrowed down from a wide one, where every end has a say, to the true one.
  double noise_rad = std::max(kFirstNoise_rad, options_.noise_rad);
  for (; noise_rad > options_.noise_rad; noise_rad *= 0.5) climb(ends, noise_rad);
  climb(ends, options_.noise_rad);
  judge(ends);
}

void PassageFit::start_at_middles(const std::vector<End>& ends) {
  if (!options_.free_rate) rate_ = 0.0;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(ends_rad_.size()), count = sum;
  for (const End& e : ends) {
    sum[e.which] += 0.5 * (e.low_rad + e.high_rad) - rate_ * e.time_s;
    count[e.which] += 1.0;
  }
  for (Eigen::Index i = 0; i < sum.size(); ++i)
    if (count[i] > 0.0) ends_rad_[i] = sum[i] / count[i];
}

// Newton's method on the log-likelihood: of one end at x between low and high,
//   log(F((high - x) / s) - F((low - x) / s)),  F(x) = 1 / (1 + exp(-x)).
void PassageFit::climb(const std::vector<End>& ends, double noise_rad) {
  const Eigen::Index n = ends_rad_.size();
  for (int step = 0; step < kClimbs; ++step) {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n + 1);
    // Ends of arms that were never seen stay where they are.
    Eigen::MatrixXd curvature = 1e-3 * Eigen::MatrixXd::Identity(n + 1, n + 1);
    for (const End& e : ends) {
      const double x = ends_rad_[e.which] + rate_ * e.time_s;
      const double low = logistic((e.low_rad - x) / noise_rad);
      const double high = logistic((e.high_rad - x) / noise_rad);
      const double pull_sd = kMiddlePull * (e.high_rad - e.low_rad + noise_rad);
      const double pull = 1.0 / (pull_sd * pull_sd);
      const double g = (low + high - 1.0) / noise_rad + pull * (0.5 * (e.low_rad + e.high_rad) - x);
      const double h = (low * (1.0 - low) + high * (1.0 - high)) / (noise_rad * noise_rad) + pull;
      gradient[e.which] += g;
      gradient[n] += g * e.time_s;
      curvature(e.which, e.which) += h;
      curvature(e.which, n) += h * e.time_s;
      curvature(n, e.which) += h * e.time_s;
      curvature(n, n) += h * e.time_s * e.time_s;
    }
    const double rate_weight = options_.free_rate ? 1.0 / (rate_prior_sd_ * rate_prior_sd_) : 1e30;
    gradient[n] += options_.free_rate ? rate_weight * (rate_prior_ - rate_) : 0.0;
    curvature(n, n) += rate_weight;
    Eigen::VectorXd change = curvature.ldlt().solve(gradient);
    double farthest = 1e-12;
    for (const End& e : ends)
      farthest = std::max(farthest, std::abs(change[e.which] + change[n] * e.time_s));
    change *= std::min(1.0, 4.0 * noise_rad / farthest);
    ends_rad_ += change.head(n);
    if (options_.free_rate) rate_ += change[n];
    if (farthest < 1e-3 * noise_rad) return;
  }
}

void PassageFit::judge(const std::vector<End>& ends) {
  const double s = options_.noise_rad;
  const auto cost = [&](Eigen::Index which, double x_rad) {
    double sum = 0.0;
    for (const End& e : ends) {
      if (e.which != which) continue;
      const double x = x_rad + rate_ * e.time_s;
      sum += softplus((e.low_rad - x) / s) + softplus((x - e.high_rad) / s);
    }
    return sum;
  };
  // The way to where the likelihood has fallen by exp(-1/2): a standard deviation where it is
  // Gaussian, the half width where it is flat.
  const auto reach = [&](Eigen::Index which, double sign) {
    const double limit = cost(which, ends_rad_[which]) + 0.5;
    double inside = 0.0, outside = kMaxSd_rad;
    for (int i = 0; i < 10; ++i) {
      const double middle = 0.5 * (inside + outside);
      (cost(which, ends_rad_[which] + sign * middle) < limit ? inside : outside) = middle;
    }
    return outside;
  };
  double variance = 0.0, arms = 0.0;
  for (std::size_t arm = 0; arm < arms_; ++arm) {
    if (!knows(arm)) continue;
    for (const auto i :
         {static_cast<Eigen::Index>(2 * arm), static_cast<Eigen::Index>(2 * arm + 1)}) {
      sd_rad_[i] = 0.5 * (reach(i, 1.0) + reach(i, -1.0));
      variance += 0.25 * sd_rad_[i] * sd_rad_[i];
    }
    arms += 1.0;
  }
  variance /= arms * arms;
  // A line's end is known half as well as its middle.
  if (options_.free_rate) variance *= 4.0;
  double off = 0.0;
  for (const End& e : ends) {
    const double x = ends_rad_[e.which] + rate_ * e.time_s;
    const double d = std::max({0.0, e.low_rad - x, x - e.high_rad});
    off += d * d;
  }
  residual_rad_ = std::sqrt(variance + off / static_cast<double>(ends.size()));
}

}  // namespace voxlist::scanner
