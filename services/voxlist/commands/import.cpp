#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <memory>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/output/fresh_file.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "services/voxlist/recording/recording.h"
#include "voxlist/bus/cloud_view.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/packets/pcap_file.h"

namespace voxlist::desk {
namespace {

struct ImportOptions {
  std::filesystem::path scans;
  std::filesystem::path log;
  std::string channel;  // empty: scans are in base
};

// How many messages of each kind a log got.
struct Written {
  std::int64_t scans = 0, odometry = 0, truths = 0;
};

class Importer {
 public:
  Importer(const std::string& path, Omissions& omissions) : omissions_(omissions), log_(path) {}

  void operator()(const CloudRecord& record) {
    written_.scans += write(bus::kCloud, record.message);
  }
  void operator()(const OdometryRecord& record) {
    written_.odometry += write(bus::kOdometry, record.message);
  }
  void operator()(const TruthRecord& record) {
    written_.truths += write(bus::kTruth, record.message);
  }

  void operator()(const RawRecord& record) {
    log_.write(record.channel, bus::CloudView(record.bytes).utime_us(), record.bytes);
    ++written_.scans;
  }

  void close() { log_.close(); }
  const Written& written() const { return written_; }

 private:
  // Publishes at the data's own time, so that a replay runs at the data's pace. Returns how many
  // were written.
  template <class M>
  int write(bus::Channel<M> channel, const M& message) {
    std::vector<std::uint8_t> bytes;
    if (const bus::Fault fault = bus::encode(message, bytes); fault != bus::Fault::kNone) {
      const std::string reason = fmt::format("{}/{}", channel.name, bus::fault_name(fault));
      omissions_.add(reason, fmt::format("{} at utime {}", reason, message.utime));
      return 0;
    }
    log_.write(channel.name, message.utime, bytes);
    return 1;
  }

  Omissions& omissions_;
  bus::EventLogWriter log_;
  Written written_;
};

// As a bus takes it, and no channel that means something else.
std::string is_channel(const std::string& name) {
  const bool plain = !name.empty() && name.size() <= bus::kMaxChannelName &&
                     std::ranges::all_of(name, [](unsigned char c) {
                       return std::isalnum(c) || c == '_' || c == '-' || c == '/';
                     });
  if (!plain) return "a channel may only hold letters, digits, _ - and /";
  return name == bus::kCloud.name || name == bus::kOdometry.name || name == bus::kTruth.name
             ? name + " means something else: give the laser a channel of its own"
             : "";
}

std::string summary(const ImportOptions& options, const Written& written) {
  return fmt::format("{}: {} {}, {} ODOMETRY, {} TRUTH", options.log.string(), written.scans,
                     options.channel.empty() ? "CLOUD" : options.channel, written.odometry,
                     written.truths);
}

std::unique_ptr<Recording> open_input(const ImportOptions& options, Omissions& omissions) {
  const RawChannels raw = options.channel.empty() ? RawChannels() : RawChannels{options.channel};
  if (std::filesystem::is_regular_file(options.scans) && io::is_pcap(options.scans))
    return open_pcap_recording(options.scans, omissions, raw);
  return open_folder_recording(options.scans, omissions, raw);
}

int import_scans(const ImportOptions& options, Console& console) {
  Omissions omissions(console);
  const auto input = open_input(options, omissions);
  FreshFile file(options.log);
  Importer importer(file.path(), omissions);
  {
    Progress progress(console, "importing scans");
    while (!stop_requested()) {
      const auto record = input->next();
      if (!record) break;
      std::visit(importer, *record);
      progress.show(input->progress());
    }
  }
  importer.close();
  if (importer.written().scans == 0) {
    if (stop_requested())
      throw io::FileError(options.scans, "interrupted before the first scan, nothing was written");
    const std::string why = input->why_no_scan();
    throw io::FileError(options.scans, why.empty() ? "has no scan that can be read, nothing was "
                                                     "written"
                                                   : why);
  }
  if (!omissions.empty()) console.warn("left out: " + omissions.summary());
  return publish_or_keep_older(file, console, summary(options, importer.written()));
}

}  // namespace

void add_import(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "import", "Turns scans of other programs into an LCM log, for scripts/replay and the rest.");
  const auto options = std::make_shared<ImportOptions>();
  command
      ->add_option("SCANS_DIR", options->scans,
                   "folder of scan_*.ply or scan_*.pcd (poses.csv in it becomes TRUTH, "
                   "odometry.csv ODOMETRY), or of the KITTI data sets (velodyne); or a file .pcap "
                   "of a Velodyne VLP-16 or HDL-32E")
      ->required();
  command->add_option("-o,--output", options->log, "the log to write; an old one is replaced")
      ->required();
  command
      ->add_option("--channel", options->channel,
                   "for scans in the laser's own frame: the channel for them, with all that their "
                   "files tell of each point (time, ring, intensity), for cloud_adapter")
      ->check(is_channel);
  command->footer(
      "Examples:\n"
      "  voxlist import hall -o hall.lcmlog && scripts/replay hall.lcmlog\n"
      "  voxlist import raw_scans -o raw.lcmlog --channel VELODYNE\n"
      "  voxlist import drive.pcap -o raw.lcmlog --channel VELODYNE");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return import_scans(*options, console); };
  });
}

}  // namespace voxlist::desk
