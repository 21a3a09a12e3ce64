#include "voxlist/bus/network_report.h"

#include <array>
#include <utility>

#include "voxlist/bus/health.h"
#include "voxlist/bus/multicast/network_check.h"

namespace voxlist::bus {
namespace {

constexpr std::int64_t kPeriod_us = 5'000'000;

constexpr std::array kKeys = {"route", "interface", "ttl", "mtu", "receive_buffer", "fragments"};

}  // namespace

NetworkReport::NetworkReport(BusOptions options, std::string whose)
    : options_(std::move(options)), whose_(std::move(whose)) {}

void NetworkReport::take(std::int64_t now_us, Health& health) {
  if (looked_us_ && now_us - *looked_us_ < kPeriod_us) return;
  looked_us_ = now_us;
  const auto address = multicast_address(options_.url);
  if (!address || address->ttl == 0) return;
  const std::string prefix = whose_ + "network/";
  for (const char* key : kKeys) health.clear(prefix + key);
  const int asked = options_.receive_buffer_bytes;
  for (const NetworkFinding& finding :
       network_findings(*address, network_facts(*address, asked), asked))
    health.raise(prefix + finding.key,
                 finding.is_fault ? Health::State::kWarning : Health::State::kOk,
                 whose_.empty() ? finding.sentence : whose_ + ": " + finding.sentence);
}

std::string NetworkReport::summary() const {
  const auto address = multicast_address(options_.url);
  if (!address) return {};
  return ": " + network_summary(*address, network_facts(*address, options_.receive_buffer_bytes));
}

}  // namespace voxlist::bus
