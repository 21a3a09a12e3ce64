#pragma once

#include <vector>

namespace voxlist::scanner {

/// The real scans of an LMS 200 in a robot log (CARMEN format): metres, half a degree apart.
std::vector<std::vector<float>> carmen_scans();

}  // namespace voxlist::scanner
