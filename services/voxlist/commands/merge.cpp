#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/maps/map_files.h"
#include "services/voxlist/maps/meeting.h"
#include "services/voxlist/maps/piece_closing.h"
#include "services/voxlist/maps/run_report.h"
#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/voxels/edits/edit_limits.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;

// Exit code where it is not sure how the maps lie to each other.
constexpr int kNotSure = 3;

struct MergeOptions {
  fs::path first, second, folder;
  MakingOptions making;
};

void refuse_one_map_twice(const MergeOptions& options) {
  if (fs::equivalent(options.first, options.second))
    throw io::FileError(options.second, "is given twice, give two maps");
}

void refuse_with_map(const fs::path& folder) {
  if (fs::exists(folder / mapping::kKeyframeFile))
    throw io::FileError(folder, "holds a map already, give another folder");
}

// A folder that somebody uses is told before the search, which takes a while.
void refuse_in_use(const fs::path& folder) {
  if (fs::is_directory(folder)) const FileLock free = mapping::lock_folder(folder);
}

void refuse_after_interrupt(const fs::path& folder) {
  if (stop_requested()) throw io::FileError(folder, "interrupted, nothing was written");
}

// Keyframes wait on the disk of the new map. Its own folder is made where it is sure only.
fs::path spool_folder(const fs::path& folder) {
  fs::path there = fs::absolute(folder);
  while (!fs::is_directory(there)) there = there.parent_path();
  return there;
}

// The map of a folder, its keyframes in the spool.
std::unique_ptr<mapping::Piece> read_piece(const fs::path& folder, const DeskSettings& settings,
                                           mapping::KeyframeSpool& spool, Console& console) {
  auto piece = std::make_unique<mapping::Piece>(settings.localiser,
                                                mapping::MapBuilder(settings.mapper), spool);
  mapping::KeyframeReader reader(folder / mapping::kKeyframeFile);
  while (!stop_requested()) {
    auto keyframe = reader.next();
    if (!keyframe) break;
    piece->add(std::move(keyframe->cloud), keyframe->T_map_base);
  }
  if (!reader.warning().empty()) console.warn(reader.warning());
  if (piece->keyframes().empty() && !stop_requested())
    throw io::FileError(folder, "holds an empty map, make one with voxlist map");
  piece->set_trajectory(trajectory_of(folder, piece->builder().poses()));
  return piece;
}

std::string refusal(const MergeOptions& options, const Meeting& meeting) {
  const std::string maps = options.second.string() + " and " + options.first.string();
  if (meeting.alike)
    return fmt::format(
        "{} were not merged: more than one place looks alike; a drive on through "
        "places that differ, in both, would help",
        maps);
  if (meeting.twins > 0)
    return fmt::format(
        "{} were not merged: the building repeats itself, {} of {} scans on ground of both fit "
        "elsewhere, too; a drive in both through 10 m that are like no other place would help",
        maps, meeting.twins, meeting.fitting);
  if (meeting.vague > 0)
    return fmt::format(
        "{} were not merged: {} of {} scans on ground of both fit all along a corridor; a drive in "
        "both through the same room would help",
        maps, meeting.vague, meeting.fitting);
  const std::string fit = meeting.asked == 0 ? "no scan of the one was found in the other"
                                             : fmt::format("{} of {} scans on ground of both fit",
                                                           meeting.fitting, meeting.asked);
  return fmt::format("{} were not merged: {}; a drive in both through the same 10 m would help",
                     maps, fit);
}

// Those of both, each on its own map's keyframes.
mapping::MapEdits edits_of_both(const MergeOptions& options, const mapping::Piece& piece,
                                Console& console) {
  mapping::MapEdits edits = edits_of(options.first, console);
  edits.append(edits_of(options.second, console), piece.first_session());
  if (const std::string fault = fault_of(edits.boxes()); !fault.empty())
    throw io::FileError(options.folder, "cannot have the edits of both maps: " + fault);
  return edits;
}

std::vector<StampedPose3> by_time(std::vector<StampedPose3> trajectory) {
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const auto& a, const auto& b) { return a.utime_us < b.utime_us; });
  return trajectory;
}

RunFigures figures_of(const MergeOptions& options, const mapping::Piece& piece,
                      const PieceClosing& closing) {
  RunFigures figures;
  figures.input = options.first.string() + " and " + options.second.string();
  figures.scans = figures.placed = std::ssize(piece.trajectory());
  figures.loops = static_cast<std::int64_t>(closing.loops);
  figures.loops_refused = static_cast<std::int64_t>(closing.refused);
  figures.loops_moved_m = closing.moved_m;
  return figures;
}

void write(const MergeOptions& options, const DeskSettings& settings, const mapping::Piece& piece,
           mapping::KeyframeSpool& spool, mapping::MapEdits edits, const RunFigures& figures,
           const PieceClosing& closing, Console& console) {
  MapFiles files(options.folder);
  const FileLock lock = mapping::lock_folder(options.folder);
  refuse_with_map(options.folder);
  const VoxelMap& voxels = piece.builder().map().occupied;
  const std::vector<StampedPose3> trajectory = by_time(piece.trajectory());
  files.write_views(piece.builder().map(), trajectory, closing.drawn);
  files.write_keyframes(spool, piece.keyframes(), voxels);
  files.write_graph(closing.graph, voxels);
  files.write_covariances(trajectory, piece.keyframes().size());
  if (!edits.edits.empty()) files.write_edits(std::move(edits), voxels);
  files.write_octomap(settings.octomap, settings.localiser.threads, !options.making.no_octomap,
                      console);
  Summary summary = summary_of(figures);
  describe(voxels, piece.keyframes().size(), summary);
  files.write_summary(std::move(summary));
}

int merge(const MergeOptions& options, Console& console) {
  const DeskSettings settings = options.making.settings();
  refuse_without_map(options.first);
  refuse_without_map(options.second);
  refuse_one_map_twice(options);
  refuse_with_map(options.folder);
  refuse_in_use(options.folder);
  mapping::KeyframeSpool spool(spool_folder(options.folder));
  const auto piece = read_piece(options.first, settings, spool, console);
  const auto other = read_piece(options.second, settings, spool, console);
  const matching::MatcherConfig& matcher = settings.localiser.matcher;
  const Meeting meeting = find_meeting(*piece, *other, spool, matcher);
  refuse_after_interrupt(options.folder);
  if (!meeting.T_map_other) {
    console.warn(refusal(options, meeting));
    return kNotSure;
  }
  piece->begin_session();
  piece->join(*other, *meeting.T_map_other);
  const PieceClosing closing = close_piece(*piece, spool, matcher);
  const RunFigures figures = figures_of(options, *piece, closing);
  refuse_after_interrupt(options.folder);
  const mapping::MapEdits edits = edits_of_both(options, *piece, console);
  piece->edit(edits);
  write(options, settings, *piece, spool, edits, figures, closing, console);
  console.say(fmt::format(
      "{} of {} scans on ground of both fit: {} and {} keyframes, {} voxels, hash {}",
      meeting.fitting, meeting.asked, piece->first_session(), other->keyframes().size(),
      piece->builder().map().occupied.size(), hash_text(piece->builder().map().occupied)));
  if (const std::string loops = closed_loops(figures); !loops.empty()) console.say(loops);
  console.say((options.folder / "map.png").string());
  return 0;
}

}  // namespace

void add_merge(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "merge", "Joins two maps of one place, where it is sure how they lie to each other.");
  const auto options = std::make_shared<MergeOptions>();
  command->add_option("A", options->first, "map folder, whose frame stays")->required();
  command->add_option("B", options->second, "map folder that is joined to it")->required();
  command->add_option("-o,--output", options->folder, "map folder for both, without a map so far")
      ->required();
  options->making.add_to(*command);
  command->footer(
      "Exit code 3: it is not sure how they lie, and nothing is written.\n"
      "Example:\n"
      "  voxlist merge monday_map tuesday_map -o hall_map");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return merge(*options, console); };
  });
}

}  // namespace voxlist::desk
