#include "services/simulator/laser_faults.h"

#include <map>
#include <stdexcept>
#include <string>

namespace voxlist::services {
namespace {

const std::map<std::string, double simulation::Lms200Faults::*> kRandom = {
    {"drop_byte", &simulation::Lms200Faults::drop_byte},
    {"corrupt_byte", &simulation::Lms200Faults::corrupt_byte},
    {"noise_byte", &simulation::Lms200Faults::noise_byte},
    {"dazzle", &simulation::Lms200Faults::dazzle},
    {"over_max", &simulation::Lms200Faults::over_max}};

const std::map<std::string, bool simulation::Lms200Faults::*> kLasting = {
    {"refuse", &simulation::Lms200Faults::refuse},
    {"silent", &simulation::Lms200Faults::silent},
    {"address_81", &simulation::Lms200Faults::address_81},
    {"wrong_unit", &simulation::Lms200Faults::wrong_unit},
    {"partial_bits", &simulation::Lms200Faults::partial_bits},
    {"pollution", &simulation::Lms200Faults::pollution}};

constexpr const char* kPowerCycle = "power_cycle";

}  // namespace

LaserFaults::LaserFaults(const LaserFaultConfig& config) : config_(config) {
  const auto random = kRandom.find(config.name);
  const auto lasting = kLasting.find(config.name);
  if (random != kRandom.end())
    faults_.*random->second = config.probability;
  else if (lasting != kLasting.end())
    faults_.*lasting->second = true;
  else if (!config.name.empty() && config.name != kPowerCycle)
    throw std::invalid_argument("laser_fault: there is no fault \"" + config.name + "\"");
}

void LaserFaults::apply(double run_s, std::int64_t utime_us, simulation::Lms200Device& device) {
  if (config_.name.empty()) return;
  const bool on = run_s >= config_.from_s && run_s < config_.to_s;
  if (on == on_) return;
  on_ = on;
  if (config_.name == kPowerCycle) {
    if (on) device.power_cycle(utime_us);
  } else {
    device.set_faults(on ? faults_ : simulation::Lms200Faults{});
  }
}

}  // namespace voxlist::services
