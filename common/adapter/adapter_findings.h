#pragma once

#include <string>
#include <vector>

#include "voxlist/adapter/adapter_report.h"

namespace voxlist::adapter {

/// Something that is wrong with a sensor's message, or with its settings.
struct AdapterFinding {
  /// One word, the same for the same fault.
  std::string key;
  /// The sentence tells a person what is wrong, and what to do.
  std::string sentence;
  /// Whether the message was of no use.
  bool is_error = false;
};

/// What a report tells that a person should know. `channel` is the sensor's.
std::vector<AdapterFinding> findings(const SensorReport& report, const std::string& channel);

}  // namespace voxlist::adapter
