#pragma once

#include <filesystem>
#include <string>

#include "voxlist/calibration/calibrate.h"

namespace voxlist::desk {

class Console;

/// What a log holds of a scanner: LASER, MIRROR and ODOMETRY, in the order of their times; `prefix`
/// stands before their names. Damage and forged messages are told and left out; of a longer log the
/// first ten minutes of LASER are taken. Throws FileError when there is no log or no line of LASER
/// in it.
calibration::CalibrationInput read_scanner_log(const std::filesystem::path& log,
                                               const std::string& prefix, Console& console);

}  // namespace voxlist::desk
