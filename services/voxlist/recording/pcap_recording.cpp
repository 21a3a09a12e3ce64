#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "services/voxlist/recording/recording.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/wire.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/packets/pcap_file.h"
#include "voxlist/scanner/velodyne/velodyne_sweeps.h"

namespace voxlist::desk {
namespace {

using scanner::VelodyneKind;
using scanner::VelodyneSweep;

// What the laser's clock may go ahead of the recorder's, or stay behind (us), before it is told.
constexpr std::int64_t kNewsOfDrift_us = 5'000;

pointcloud_t to_raw_message(VelodyneSweep sweep, std::int64_t number) {
  Cloud cloud;
  cloud.utime_us = sweep.utime_us;
  cloud.points = std::move(sweep.points);
  pointcloud_t message = bus::to_message(cloud, "laser", static_cast<std::int32_t>(number));
  message.n_channels = 3;
  message.channel_names = {"intensity", "ring", "time"};
  message.channels = {std::move(sweep.intensities), std::move(sweep.rings),
                      std::move(sweep.after_s)};
  return message;
}

// The sweeps of the first Velodyne laser in a recording of its network.
class PcapRecording : public Recording {
 public:
  PcapRecording(const std::filesystem::path& path, Omissions& omissions, std::string channel)
      : path_(path), omissions_(omissions), channel_(std::move(channel)), file_(path) {}

  std::optional<Record> next() override {
    while (const auto packet = file_.next())
      if (auto sweep = take(*packet)) return to_record(std::move(*sweep));
    if (std::exchange(ended_, true)) return std::nullopt;
    auto last = sweeps_.finish();
    tell_at_end();
    return last ? std::optional(to_record(std::move(*last))) : std::nullopt;
  }

  double progress() const override { return file_.progress(); }

  std::string why_no_scan() const override {
    if (number_ > 0) return {};
    return "has no data packet of a Velodyne VLP-16 or HDL-32E" +
           (others_.empty() ? "; it has no UDP packets at all" : "; it has " + listed_others());
  }

  // Rows of the scans' own times.
  RowOfScan match(const io::PoseTable& poses) const override {
    return [&poses](std::int64_t, std::int64_t utime_us) -> std::optional<std::size_t> {
      const auto row = std::ranges::find(poses.rows, utime_us, &io::PoseRow::utime_us);
      if (row == poses.rows.end()) return std::nullopt;
      return static_cast<std::size_t>(row - poses.rows.begin());
    };
  }

 private:
  std::optional<VelodyneSweep> take(const io::UdpPacket& udp) {
    const scanner::VelodynePacket packet = scanner::read_velodyne(udp.payload);
    if (packet.kind == VelodyneKind::kNoData) {
      ++others_[fmt::format("of {} B to port {}", udp.payload.size(), udp.port)];
      return std::nullopt;
    }
    if (packet.kind != VelodyneKind::kData) return leave_out(udp, packet), std::nullopt;
    if (laser_.empty()) laser_ = udp.from;
    if (udp.from == laser_) return sweeps_.add(packet, udp.utime_us);
    omissions_.add(
        "of_another_laser",
        fmt::format("{} is a second laser's; {}, which speaks first, is taken", udp.from, laser_));
    return std::nullopt;
  }

  void leave_out(const io::UdpPacket& udp, const scanner::VelodynePacket& packet) {
    if (packet.kind == VelodyneKind::kUnknownModel)
      return omissions_.add("of_unknown_model",
                            fmt::format("a packet of {} of model 0x{:02X}: VLP-16 (0x22) and "
                                        "HDL-32E (0x21) are known",
                                        udp.from, packet.model));
    omissions_.add("broken_packets",
                   fmt::format("a packet of {} at {} is broken", udp.from, udp.utime_us));
  }

  Record to_record(VelodyneSweep sweep) {
    RawRecord record{number_, channel_, {}};
    bus::encode(to_raw_message(std::move(sweep), number_), record.bytes);
    ++number_;
    return record;
  }

  void tell_at_end() {
    const std::string name = path_.string();
    if (!file_.complaint().empty()) omissions_.remark(file_.complaint());
    if (sweeps_.missing_packets() > 0)
      omissions_.remark(
          fmt::format("{}: {} packets of the laser are missing; the sweeps have holes "
                      "there",
                      name, sweeps_.missing_packets()));
    if (sweeps_.late_packets() > 0)
      omissions_.remark(
          fmt::format("{}: {} packets came after later ones, or twice: they are left "
                      "out",
                      name, sweeps_.late_packets()));
    if (std::abs(sweeps_.drift_us()) > kNewsOfDrift_us)
      omissions_.remark(
          fmt::format("{}: at its end the laser's clock is {:.0f} ms ahead of the "
                      "recorder's; times are the laser's",
                      name, static_cast<double>(sweeps_.drift_us()) * 1e-3));
    if (!others_.empty() && number_ > 0)
      omissions_.remark(name + ": passed over " + listed_others());
  }

  std::string listed_others() const {
    std::string text;
    for (const auto& [what, count] : others_)
      text += fmt::format("{}{} packets {}", text.empty() ? "" : ", ", count, what);
    return text;
  }

  const std::filesystem::path path_;
  Omissions& omissions_;
  const std::string channel_;
  io::PcapFile file_;
  scanner::VelodyneSweeps sweeps_;
  std::string laser_;                           // its address
  std::map<std::string, std::int64_t> others_;  // no data packets, by what they are
  std::int64_t number_ = 0;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<Recording> open_pcap_recording(const std::filesystem::path& path,
                                               Omissions& omissions, const RawChannels& raw) {
  if (raw.size() == 1) return std::make_unique<PcapRecording>(path, omissions, raw.front());
  throw io::FileError(path, raw.empty() ? "has points in the laser's own frame: name a channel for "
                                          "them (import --channel), or tell where the laser sits "
                                          "(--config, with [cloud_adapter])"
                                        : "has the sweeps of one laser: give settings of "
                                          "[cloud_adapter] with that one");
}

}  // namespace voxlist::desk
