#include "services/voxlist/commands/views/mcap_export.h"

#include <fmt/core.h>

#include <map>
#include <utility>

#include "services/voxlist/output/fresh_file.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/foreign/foxglove/converter.h"
#include "voxlist/foreign/lcm/lcm_types.h"
#include "voxlist/foreign/mcap/mcap_writer.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

// MCAP knows no LCM: names of one's own begin with x-.
const std::string kLcmEncoding = "x-lcm";

// The file as an audience: each topic is a channel of it.
class McapAudience : public foreign::Audience {
 public:
  explicit McapAudience(foreign::McapWriter& writer) : writer_(writer) {}

  void set_time(std::int64_t log_us) { log_us_ = log_us; }

  bool wants(const foreign::Topic&) override { return true; }

  void tell(const foreign::Topic& topic, std::int64_t utime_us, std::string bytes) override {
    const auto [channel, is_new] = channels_.try_emplace(topic);
    if (is_new)
      channel->second =
          writer_.add(foreign::McapChannel{schema_for(topic.kind), topic.name, "protobuf"});
    writer_.write(channel->second, log_us_, utime_us, bytes);
  }

 private:
  std::uint16_t schema_for(foreign::Kind kind) {
    const auto [schema, is_new] = schemas_.try_emplace(kind);
    if (is_new)
      schema->second = writer_.add(
          foreign::McapSchema{foreign::name_of(kind), "protobuf", foreign::schema_of(kind)});
    return schema->second;
  }

  foreign::McapWriter& writer_;
  std::int64_t log_us_ = 0;
  std::map<foreign::Kind, std::uint16_t> schemas_;
  std::map<foreign::Topic, std::uint16_t> channels_;
};

// The messages as they were. A channel that carries two types is two channels of the file.
class RawCopy {
 public:
  explicit RawCopy(foreign::McapWriter& writer) : writer_(writer) {}

  void write(const bus::Event& event) {
    const foreign::LcmType* type = foreign::lcm_type_of(event.bytes);
    const auto [channel, is_new] = channels_.try_emplace({event.channel, type});
    if (is_new)
      channel->second =
          writer_.add(foreign::McapChannel{type ? schema_for(*type) : std::uint16_t{0},
                                           foreign::ascii(event.channel), kLcmEncoding});
    writer_.write(channel->second, event.utime_us, event.utime_us,
                  {reinterpret_cast<const char*>(event.bytes.data()), event.bytes.size()});
  }

 private:
  std::uint16_t schema_for(const foreign::LcmType& type) {
    const auto [schema, is_new] = schemas_.try_emplace(&type);
    if (is_new)
      schema->second = writer_.add(
          foreign::McapSchema{std::string(type.name), kLcmEncoding, foreign::definition_of(type)});
    return schema->second;
  }

  foreign::McapWriter& writer_;
  std::map<const foreign::LcmType*, std::uint16_t> schemas_;
  std::map<std::pair<std::string, const foreign::LcmType*>, std::uint16_t> channels_;
};

class Exporter {
 public:
  Exporter(const McapExport& options, const std::filesystem::path& file)
      : prefix_(options.prefix), writer_(file) {}

  void take(const bus::Event& event) {
    raw_.write(event);
    if (!event.channel.starts_with(prefix_)) return;
    audience_.set_time(event.utime_us);
    converter_.take(event.channel.substr(prefix_.size()), event.bytes);
  }

  // Returns how many messages are in the file.
  std::uint64_t close() {
    converter_.tell_rest();
    writer_.close();
    return writer_.messages();
  }

  const bus::Counters& faults() const { return converter_.faults(); }

 private:
  const std::string prefix_;
  foreign::McapWriter writer_;
  McapAudience audience_{writer_};
  RawCopy raw_{writer_};
  foreign::Converter converter_{audience_, {}};
};

// Returns how many messages of the log there were.
std::int64_t copy(bus::EventLogReader& log, Exporter& exporter, Console& console) {
  Progress progress(console, "exporting");
  std::int64_t events = 0, senseless = 0;
  while (!stop_requested()) {
    const auto event = log.next();
    if (!event) break;
    ++(bus::is_sane_utime(event->utime_us) ? events : senseless);
    if (bus::is_sane_utime(event->utime_us)) exporter.take(*event);
    progress.show(static_cast<double>(log.position_bytes()) /
                  static_cast<double>(log.size_bytes()));
  }
  if (senseless > 0) console.warn(fmt::format("left out: {} messages without a time", senseless));
  return events;
}

void tell_losses(const bus::EventLogReader& log, const Exporter& exporter, Console& console) {
  for (const std::string& part : log.missing_parts()) console.warn(part + " is not there");
  if (log.damaged_events() > 0)
    console.warn(fmt::format("{} damaged events were left out", log.damaged_events()));
  for (const auto& [reason, count] : exporter.faults())
    console.warn(fmt::format("{} {} are in the file, but not converted", count, reason));
}

}  // namespace

int export_mcap(const McapExport& options, Console& console) {
  bus::EventLogReader log(options.log.string());
  FreshFile file(options.file);
  Exporter exporter(options, file.path());
  const std::int64_t events = copy(log, exporter, console);
  if (events == 0 && !stop_requested())
    throw io::FileError(options.log,
                        "has no message that can be read: give a log of lcm-logger, "
                        "scripts/record or voxlist import");
  const std::uint64_t messages = exporter.close();
  tell_losses(log, exporter, console);
  return publish_or_keep_older(
      file, console,
      fmt::format("{}: {} messages of the log, {} converted", options.file.string(), events,
                  messages - static_cast<std::uint64_t>(events)));
}

}  // namespace voxlist::desk
