#include "voxlist/serial/adapter_latency.h"

#include <fmt/core.h>

#include <fstream>
#include <optional>

namespace voxlist::serial {
namespace {

// The adapter's latency timer (ms): its least. The default of 16 ms is longer than a scan, so scans
// would arrive in pairs.
constexpr int kLatency_ms = 1;

std::optional<int> number_in(const std::filesystem::path& file) {
  int number = 0;
  if (std::ifstream(file) >> number) return number;
  return std::nullopt;
}

}  // namespace

std::string quicken_adapter(const std::filesystem::path& port, const std::filesystem::path& sysfs) {
  std::error_code error;
  const std::filesystem::path device = std::filesystem::canonical(port, error);
  if (error) return "";
  const std::filesystem::path timer = sysfs / device.filename() / "latency_timer";
  const auto before_ms = number_in(timer);
  if (!before_ms || *before_ms <= kLatency_ms) return "";
  std::ofstream(timer) << kLatency_ms;
  const auto now_ms = number_in(timer);
  if (now_ms && *now_ms <= kLatency_ms) return "";
  return fmt::format(
      "{}: its USB adapter holds bytes back for {} ms: write {} to {} as root (a udev rule keeps "
      "it)",
      port.string(), *before_ms, kLatency_ms, timer.string());
}

}  // namespace voxlist::serial
