#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <set>

#include "services/voxlist/recording/channel_counts.h"
#include "services/voxlist/recording/recording.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/files/file_kind.h"
#include "voxlist/io/scans/row_match.h"
#include "voxlist/system/file_parts.h"

namespace voxlist::desk {
namespace {

// How far a pose's time may be from its scan's (us): what rounding to hundredths of a second costs.
constexpr std::int64_t kSameTime_us = 10'000;

// A jump in seq beyond this comes from a sender that started anew.
constexpr std::int64_t kMaxGap = 1000;

RowOfScan match_times(const io::PoseTable& poses) {
  std::map<std::int64_t, std::size_t> rows;
  for (std::size_t row = 0; row < poses.rows.size(); ++row) {
    rows.emplace(poses.rows[row].utime_us, row);
  }
  return [rows](std::int64_t, std::int64_t utime_us) -> std::optional<std::size_t> {
    const auto after = rows.lower_bound(utime_us);
    const auto is_same = [&](auto at) {
      return at != rows.end() && std::abs(at->first - utime_us) <= kSameTime_us;
    };
    const bool has_before = after != rows.begin() && is_same(std::prev(after));
    const bool use_before = has_before && (!is_same(after) || utime_us - std::prev(after)->first <=
                                                                  after->first - utime_us);
    if (use_before) return std::prev(after)->second;
    return is_same(after) ? std::optional(after->second) : std::nullopt;
  };
}

RowOfScan match_numbers(const io::PoseTable& poses) {
  std::map<std::int64_t, std::size_t> rows;
  for (std::size_t row = 0; row < poses.rows.size(); ++row) rows.emplace(poses.rows[row].scan, row);
  return [rows](std::int64_t number, std::int64_t) {
    const auto found = rows.find(number);
    return found == rows.end() ? std::nullopt : std::optional(found->second);
  };
}

// A table, and which of its rows the log's scans had so far.
struct RowUse {
  io::PoseTable poses;
  std::set<std::size_t> used = {};
};

std::string why_no_log(const std::filesystem::path& path) {
  std::string start(512, '\0');
  std::ifstream(path).read(start.data(), std::ssize(start));
  if (start.starts_with("ply") || start.starts_with("# .PCD"))
    return "is one scan, give the folder that holds it";
  const std::string what = io::what_it_is(start);
  return what.empty() ? "is no LCM log, give one or a folder of scans" : what;
}

class LogRecording : public Recording {
 public:
  LogRecording(const std::filesystem::path& path, std::string prefix, Omissions& omissions,
               RawChannels raw)
      : path_(path),
        prefix_(std::move(prefix)),
        omissions_(omissions),
        log_(path.string()),
        raw_channels_(std::move(raw)) {
    if (!bus::EventLogReader(path.string()).next()) {
      throw io::FileError(path, why_no_log(path));
    }
    tell_parts();
  }

  std::optional<Record> next() override {
    while (auto event = log_.next()) {
      tell_damage();
      channels_.add(event->channel);
      if (!event->channel.starts_with(prefix_)) continue;
      event->channel.erase(0, prefix_.size());
      if (auto record = read(*event)) return record;
    }
    tell_damage();
    tell_rows();
    return std::nullopt;
  }

  double progress() const override {
    return static_cast<double>(log_.position_bytes()) / static_cast<double>(log_.size_bytes());
  }

  std::string why_no_scan() const override {
    const std::string wanted = raw_channels_.empty() ? bus::kCloud.name : raw_channels_.front();
    return clouds_ + raws_ > 0 ? std::string() : channels_.why_without(wanted, prefix_);
  }

  RowOfScan match(const io::PoseTable& poses) const override {
    for (const std::string& note : io::notes_on(poses)) omissions_.remark("poses: " + note);
    row_use_ = std::make_shared<RowUse>(poses);
    return [row_of = poses.has_times ? match_times(poses) : match_numbers(poses), use = row_use_](
               std::int64_t number, std::int64_t utime_us) {
      const auto row = row_of(number, utime_us);
      if (row) use->used.insert(*row);
      return row;
    };
  }

 private:
  void tell_parts() {
    for (const std::string& part : log_.missing_parts())
      omissions_.add("missing parts", part + " is not there");
    if (const auto whole = whole_of(path_); !whole.empty())
      omissions_.remark(fmt::format("{} is one part of a recording: give {} for all of it",
                                    path_.string(), whole.string()));
  }

  std::optional<Record> read(const bus::Event& event) {
    if (std::ranges::find(raw_channels_, event.channel) != raw_channels_.end())
      return read_raw(event);
    if (event.channel == bus::kOdometry.name) return decoded(event, OdometryRecord{});
    if (event.channel == bus::kTruth.name) return decoded(event, TruthRecord{});
    if (event.channel != bus::kCloud.name) return std::nullopt;
    auto record = decoded(event, CloudRecord{clouds_++, {}});
    if (record) count_lost(std::get<CloudRecord>(*record));
    return record;
  }

  // A gap in seq is clouds that the log lost: they have numbers, too.
  void count_lost(CloudRecord& cloud) {
    const std::int64_t seq = cloud.message.seq, gap = seq - last_seq_;
    const std::int64_t number = last_number_ + gap;
    if (last_seq_ >= 0 && gap > 0 && gap <= kMaxGap && number > cloud.number) {
      cloud.number = number;
      clouds_ = number + 1;
    }
    last_seq_ = seq;
    last_number_ = cloud.number;
  }

  std::optional<Record> read_raw(const bus::Event& event) {
    const std::int64_t number = raws_++;
    const bus::Fault fault = bus::check_wire<pointcloud_t>(event.bytes);
    if (fault == bus::Fault::kNone) return RawRecord{number, event.channel, event.bytes};
    tell(event, fault);
    return std::nullopt;
  }

  template <class R>
  std::optional<Record> decoded(const bus::Event& event, R record) {
    const bus::Fault fault = bus::decode(event.bytes, record.message);
    if (fault == bus::Fault::kNone) return record;
    tell(event, fault);
    return std::nullopt;
  }

  void tell(const bus::Event& event, bus::Fault fault) {
    omissions_.add(fmt::format("{}/{}", event.channel, bus::fault_name(fault)),
                   fmt::format("{}: {} in event {} is {}", path_.string(), event.channel,
                               event.number, bus::fault_name(fault)));
  }

  // Which scans there are is known at the end.
  void tell_rows() {
    if (!row_use_) return;
    const std::string note = io::rows_without_scan(row_use_->poses, row_use_->used);
    if (!note.empty()) omissions_.remark("poses: " + note);
  }

  void tell_damage() {
    for (; damage_told_ < log_.damaged_events(); ++damage_told_) {
      omissions_.add("damaged events", fmt::format("{}: damage before byte {}", path_.string(),
                                                   log_.position_bytes()));
    }
  }

  const std::filesystem::path path_;
  const std::string prefix_;
  Omissions& omissions_;
  bus::EventLogReader log_;
  ChannelCounts channels_;
  mutable std::shared_ptr<RowUse> row_use_;  // of the last table that was matched
  const RawChannels raw_channels_;
  std::int64_t clouds_ = 0, raws_ = 0, damage_told_ = 0;
  std::int64_t last_seq_ = -1, last_number_ = 0;
};

}  // namespace

std::unique_ptr<Recording> open_log_recording(const std::filesystem::path& log,
                                              const std::string& prefix, Omissions& omissions,
                                              const RawChannels& raw) {
  return std::make_unique<LogRecording>(log, prefix, omissions, raw);
}

}  // namespace voxlist::desk
