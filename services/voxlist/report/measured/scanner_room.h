#pragma once

#include <array>
#include <string>
#include <vector>

#include "services/voxlist/report/measured/scanner_measures.h"
#include "services/voxlist/report/measured/scanner_recording.h"

namespace voxlist::desk {

/// How the simulated scanner of section V is built.
enum class Build { kMisaligned, kFlexing };
simulation::MirrorScannerConfig config_of(Build build);

/// An assembler that knows the scanner as it was drawn.
scanner::CloudAssemblerConfig as_drawn();

/// The same after `voxlist calibrate`'s own classes had a minute of the recording; as drawn, and
/// `refusal` says why, where they refuse.
scanner::CloudAssemblerConfig calibrated(const ScannerRecording& recording, std::string& refusal);

/// Distances to the closest point of the next scan of the same side of the mirror (m, sorted), and
/// what section V tells of them.
struct ClosestPoints {
  std::vector<double> distances_m;
  double mode_m = 0.0, median_m = 0.0, mean_m = 0.0;
};
ClosestPoints closest_points(const ScannerRecording& recording,
                             const scanner::CloudAssemblerConfig& assembler);

}  // namespace voxlist::desk
