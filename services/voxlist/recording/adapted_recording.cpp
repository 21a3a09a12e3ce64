#include "services/voxlist/recording/adapted_recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <deque>
#include <utility>

#include "voxlist/adapter/adapter_findings.h"
#include "voxlist/adapter/cloud_adapter.h"
#include "voxlist/bus/cloud_view.h"
#include "voxlist/bus/convert.h"
#include "voxlist/service/inputs/raw_cloud_input.h"

namespace voxlist::desk {
namespace {

using adapter::Adapted;
using adapter::MessageFate;

class AdaptedRecording : public Recording {
 public:
  AdaptedRecording(std::unique_ptr<Recording> raw, const adapter::AdapterConfig& config,
                   Omissions& omissions)
      : raw_(std::move(raw)), config_(config), adapter_(config), omissions_(omissions) {}

  std::optional<Record> next() override {
    while (ready_.empty() && !ended_) take(raw_->next());
    if (ready_.empty()) return std::nullopt;
    Record record = std::move(ready_.front());
    ready_.pop_front();
    return record;
  }

  double progress() const override { return raw_->progress(); }
  bool has_times() const override { return raw_->has_times(); }
  RowOfScan match(const io::PoseTable& poses) const override { return raw_->match(poses); }

  std::string why_no_scan() const override {
    return raws_ == 0 ? raw_->why_no_scan()
                      : fmt::format("none of its {} raw scans became a cloud: {}", raws_,
                                    omissions_.empty() ? "see above" : omissions_.summary());
  }

 private:
  void take(std::optional<Record> record) {
    ended_ = !record;
    if (ended_) return keep(adapter_.finish());
    std::visit([this](auto& one) { take(one); }, *record);
  }

  // It comes before the clouds that waited for it.
  void take(OdometryRecord& record) {
    const auto pose = bus::from_message(record.message);
    ready_.emplace_back(std::move(record));
    if (pose) keep(adapter_.add_odometry(*pose));
  }
  void take(TruthRecord& record) { ready_.emplace_back(std::move(record)); }
  void take(CloudRecord& record) {
    if (raws_ == 0) ready_.emplace_back(std::move(record));
  }
  void take(const RawRecord& record) {
    ++raws_;
    const auto sensor =
        std::ranges::find(config_.sensors, record.channel, &adapter::SensorConfig::channel);
    auto raw = service::take_raw_cloud(bus::CloudView(record.bytes), *sensor);
    if (!raw.cloud)
      return omissions_.add(record.channel + "/no_time_channel",
                            fmt::format("scan {}: {}", record.number, raw.refusal));
    raw.cloud->number = record.number;
    keep(adapter_.add_cloud(static_cast<std::size_t>(sensor - config_.sensors.begin()),
                            std::move(*raw.cloud)));
  }

  void keep(const Adapted& adapted) {
    for (std::size_t i = 0; i < adapted.clouds.size(); ++i)
      ready_.emplace_back(
          CloudRecord{adapted.numbers[i], bus::to_message(adapted.clouds[i], "base", clouds_++)});
    for (std::size_t i = 0; i < adapted.sensors.size(); ++i)
      tell(config_.sensors[i].channel, adapted.sensors[i]);
  }

  void tell(const std::string& channel, const adapter::SensorReport& report) {
    for (const adapter::AdapterFinding& finding : adapter::findings(report, channel))
      omissions_.remark(channel + '/' + finding.key, finding.sentence);
    for (const MessageFate fate :
         {MessageFate::kOutOfOrder, MessageFate::kBadTimes, MessageFate::kNoPoints,
          MessageFate::kNoOdometry, MessageFate::kOverflow})
      for (std::int64_t i = 0; i < report[fate]; ++i)
        omissions_.add(fmt::format("{}/{}", channel, adapter::counter_name(fate)),
                       fmt::format("a scan of {}: {}", channel, adapter::counter_name(fate)));
  }

  const std::unique_ptr<Recording> raw_;
  const adapter::AdapterConfig config_;
  adapter::CloudAdapter adapter_;
  Omissions& omissions_;
  std::deque<Record> ready_;
  std::int64_t raws_ = 0;
  std::int32_t clouds_ = 0;
  bool ended_ = false;
};

}  // namespace

RawChannels channels_of(const adapter::AdapterConfig& config) {
  RawChannels channels;
  for (const adapter::SensorConfig& sensor : config.sensors) channels.push_back(sensor.channel);
  return channels;
}

std::unique_ptr<Recording> adapted(std::unique_ptr<Recording> raw,
                                   const adapter::AdapterConfig& config, Omissions& omissions) {
  return std::make_unique<AdaptedRecording>(std::move(raw), config, omissions);
}

}  // namespace voxlist::desk
