#include "services/voxlist/output/progress.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace voxlist::desk {
namespace {

constexpr std::chrono::milliseconds kDrawEvery(100);
constexpr std::chrono::seconds kPrintEvery(5);
constexpr int kBarWidth = 30;

// Below this share the time that is left cannot be estimated.
constexpr double kMinShare = 0.01;

std::string bar(double share) {
  std::string text(kBarWidth, '.');
  const auto done = static_cast<std::size_t>(std::lround(share * kBarWidth));
  text.replace(0, done, done, '#');
  return '[' + text + "] ";
}

}  // namespace

Progress::Progress(Console& console, std::string doing)
    : console_(console), doing_(std::move(doing)) {}

Progress::~Progress() { console_.erase(); }

void Progress::show(double share) {
  const auto now = Clock::now();
  if (now - shown_ < (console_.terminal() ? Clock::duration(kDrawEvery) : kPrintEvery)) return;
  shown_ = now;
  share = std::clamp(share, 0.0, 1.0);
  const std::string text = line(share, std::chrono::duration<double>(now - start_).count());
  if (console_.terminal()) {
    console_.draw(bar(share) + text);
  } else {
    console_.warn(text);
  }
}

std::string Progress::line(double share, double elapsed_s) const {
  std::string text = fmt::format("{}: {:.0f} %", doing_, 100.0 * share);
  if (share < kMinShare) return text;
  return fmt::format("{}, {:.0f} s left", text, elapsed_s * (1.0 - share) / share);
}

}  // namespace voxlist::desk
