#pragma once

#include <functional>
#include <string>

#include "services/voxlist/maps/map_run.h"
#include "services/voxlist/maps/summary.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/recording/scan_input.h"

namespace voxlist::desk {

/// Exit code of a run that placed less than half of its scans.
inline constexpr int kMostlyLost = 3;

/// Calls what hands all scans of the input to the run, shows how far it is, and tells what it came
/// to. `doing` says what is done, on the terminal.
RunFigures carry_out(ScanInput& input, const MapRun& run, const std::string& doing,
                     Console& console, const std::function<void(Progress&)>& place_all);

/// One line that says which scans have no place in the map, why, and what would help. Empty when
/// all have one.
std::string shortfall(const RunFigures& figures);

/// One line that says what odometry is off by all the time. Empty where scans have not told yet.
std::string odometry_bias(const RunFigures& figures);

/// One line that says what closing loops has moved. Empty where it moved nothing.
std::string closed_loops(const RunFigures& figures);

/// One line that says which loops were not believed. Empty when there is none.
std::string refused_loops(const RunFigures& figures);

/// One line that says what is off with the floor of the first scans. Empty where it is level and at
/// base's height, as it should be.
std::string floor_is_off(const RunFigures& figures);

/// Whether less than half was placed of the scans whose place was asked for.
bool mostly_lost(const RunFigures& figures);

}  // namespace voxlist::desk
