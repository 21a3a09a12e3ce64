#pragma once

#include <string>
#include <vector>

#include "voxlist/adapter/adapter_report.h"

namespace voxlist::adapter {

/// How bad a finding is.
enum class Grade {
  kNote,     ///< as the settings want it
  kWarning,  ///< the message was used, but is it right?
  kError,    ///< the message was of no use
};

/// Something that a person should know of a sensor's message, or of its settings.
struct AdapterFinding {
  /// One word, the same for the same fault.
  std::string key;
  /// The sentence tells a person what is wrong, and what to do.
  std::string sentence;
  Grade grade = Grade::kWarning;
};

/// What a report tells that a person should know. `channel` is the sensor's.
std::vector<AdapterFinding> findings(const SensorReport& report, const std::string& channel);

}  // namespace voxlist::adapter
