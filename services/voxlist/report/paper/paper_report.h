#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "services/voxlist/report/page/page.h"

namespace voxlist::desk {

/// What of the paper is measured, and how.
struct PaperOptions {
  int seed = 1;
  bool quick = false;             ///< a few scans for each figure: the page says so
  std::vector<std::string> only;  ///< ids of figures; empty: all
  std::filesystem::path data;     ///< a folder of recorded scans; empty: none
};

/// Measures the paper's figures anew, and puts them beside the paper's values. `done` is told the
/// share that is done. Throws std::invalid_argument for a figure that is not there, io::FileError
/// for scans that cannot be read. Ends early, with what is measured, where stop_requested().
Report paper_report(const PaperOptions& options, const std::function<void(double)>& done);

/// The processor's name and how many there are of it.
std::string machine();

}  // namespace voxlist::desk
