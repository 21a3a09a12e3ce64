#include "services/voxlist/report/run/map_report.h"

#include "services/voxlist/report/run/folder.h"
#include "voxlist/system/version.h"

namespace voxlist::desk {

Report map_report(const std::filesystem::path& path, const std::filesystem::path& truth_file,
                  Console& console) {
  const MapFolder folder = read_map_folder(path, console);
  Report report{"A run of Voxlist",
                "What one run of Voxlist made of its scans. A dagger beside a "
                "number: it comes from a clock.",
                {},
                {}};
  std::string command = "voxlist report -o DIR --map MAPDIR";
  report.entries = {run_summary(folder), run_states(folder), run_times(folder)};
  if (!truth_file.empty()) {
    const io::PoseTable truth = io::read_poses(truth_file);
    for (const std::string& note : io::notes_on(truth))
      console.warn(truth_file.string() + ": " + note);
    report.entries.push_back(run_errors(folder, truth, truth_file));
    report.entries.push_back(run_surfaces(folder, truth));
    command += " --truth " + truth_file.filename().string();
  }
  report.facts = {{"Voxlist", version()},
                  {"map folder", path.filename().empty() ? path.parent_path().filename().string()
                                                         : path.filename().string()},
                  {"truth", truth_file.empty() ? std::string("not given: --truth")
                                               : truth_file.filename().string()},
                  {"repeat", command}};
  if (folder.summary)
    report.facts.insert(report.facts.begin() + 1,
                        {"made by", folder.summary->value("version", std::string("unknown"))});
  return report;
}

}  // namespace voxlist::desk
