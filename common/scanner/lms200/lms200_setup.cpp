#include "voxlist/scanner/lms200/lms200_setup.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "voxlist/scanner/lms200/lms200_commands.h"
#include "voxlist/system/check.h"

namespace voxlist::scanner {
namespace {

struct Speed {
  int baud;
  std::uint8_t mode;
};

// Speeds in the order in which a device is likely to be found at them: 9600 is its speed after
// power-on.
constexpr std::array<Speed, 4> kSpeeds{{{9600, lms200::k9600Baud},
                                        {38400, lms200::k38400Baud},
                                        {19200, lms200::k19200Baud},
                                        {500000, lms200::k500000Baud}}};

// The measuring mode and unit (1: millimetres, 0: centimetres) for each greatest range (telegram
// listing, 7.46). Mode 0 alone marks dazzled beams in every value.
struct Ranging {
  int range_m;
  std::uint8_t measuring_mode;
  std::uint8_t units;
};
constexpr std::array<Ranging, 4> kRangings{{{8, 0, 1}, {16, 4, 1}, {32, 6, 1}, {80, 0, 0}}};

// An LMS 2xx that is there accepts a command within 60 ms (telegram listing, 4.3); adapters add
// theirs (us).
constexpr std::int64_t kProbe_us = 100'000;

// A status has 161 bytes with its 06, and a scan of 361 values 734 and some margin, ten bits each.
// A device that streams slowly finishes its telegram before it answers.
constexpr std::int64_t kStatusBits = 1610, kTelegramBits = 7420;

// New settings take the device up to 7 s to store (quick manual, C.6).
constexpr std::int64_t kWriteLimit_us = 8'000'000;

// The settings' memory bears a limited number of writes. A damaged line can cost one or two; a
// device that still forgets is defect.
constexpr int kMaxWrites = 3;

// The device is deaf for a while after a change of speed (us); public drivers wait 250 to 500 ms.
constexpr std::int64_t kAfterBaud_us = 250'000;

// The row of a table whose key has this value. The tables above name every value that a valid
// config can have.
template <class Table, class Key>
const auto& of(const Table& table, int value, Key key) {
  return *std::ranges::find(table, value, key);
}

int resolution_cdeg(const Lms200Config& config) {
  return static_cast<int>(std::lround(config.resolution_deg * 100.0));
}

Lms200Configuration with_wanted(Lms200Configuration configuration, const Ranging& wanted) {
  using C = Lms200Configuration;
  configuration.bytes[C::kAvailability] |= C::kIndexBytes;
  configuration.bytes[C::kMeasuringMode] = wanted.measuring_mode;
  configuration.bytes[C::kUnits] = wanted.units;
  return configuration;
}

}  // namespace

Lms200Setup::Lms200Setup(Lms200Link& link, const Lms200Config& config)
    : link_(link), config_(config) {
  VOXLIST_CHECK(why_invalid(config).empty(), "the config's values are not in the tables");
}

void Lms200Setup::fail(const std::string& what) const {
  throw Lms200Failure(fmt::format("the LMS 200 on {} {}", config_.port, what));
}

Lms200ScanFormat Lms200Setup::run() {
  find();
  read_type();
  const Lms200ScanFormat format = configure();
  set_variant();
  if (link_.baud() != config_.baud) change_baud(config_.baud);
  link_.set_mode(format.partial_scans ? lms200::kPartialScans : lms200::kContinuous);
  return format;
}

void Lms200Setup::find() {
  std::vector<int> bauds;
  const auto add = [&](int baud) {
    if (baud != 0 && std::ranges::count(bauds, baud) == 0) bauds.push_back(baud);
  };
  add(known_baud_);
  add(config_.baud);
  for (const Speed& one : kSpeeds) add(one.baud);
  const std::int64_t deadline_us =
      link_.now_us() + static_cast<std::int64_t>(config_.power_on_wait_s * 1e6);
  do {
    if (std::ranges::any_of(bauds, [this](int baud) { return answers_at(baud); })) return;
  } while (link_.now_us() < deadline_us);
  throw Lms200Failure("no LMS 200 answers on " + config_.port +
                          " at any speed; check its power (it starts in up to 60 s), its cable "
                          "(500 kbaud needs RS-422) and the port's name",
                      true);
}

// A device that streams is stopped; one that is silent has to tell its status.
bool Lms200Setup::answers_at(int baud) {
  link_.set_baud(baud);
  const std::uint8_t stop[] = {lms200::kOnRequest};
  const std::int64_t heard = link_.received_bytes();
  link_.send(lms200::kSetMode, stop);
  bool found = is_heard(kProbe_us);
  if (!found && link_.received_bytes() != heard)
    found = is_heard(2 * kTelegramBits * 1'000'000 / baud);
  if (!found) {
    link_.send(lms200::kGetStatus, {});
    found = is_heard(kProbe_us + kStatusBits * 1'000'000 / baud);
  }
  if (!found) return false;
  link_.wait(kProbe_us);
  link_.set_mode(lms200::kOnRequest);
  known_baud_ = baud;
  return true;
}

bool Lms200Setup::is_heard(std::int64_t duration_us) {
  const std::int64_t deadline_us = link_.now_us() + duration_us;
  while (const auto event = link_.event(deadline_us))
    if (event->kind == Lms200Event::Kind::kTelegram) return true;
  return false;
}

void Lms200Setup::read_type() {
  type_ = decode_type(link_.ask(lms200::kGetType)).value_or("");
  if (!type_.starts_with("LMS2"))
    fail(fmt::format("says that it is a \"{}\": not a device of this family", type_));
}

Lms200ScanFormat Lms200Setup::configure() {
  Lms200Configuration now = configuration();
  const Lms200Configuration wanted =
      with_wanted(now, of(kRangings, config_.range_m, &Ranging::range_m));
  if (config_.write_configuration && now != wanted) {
    // The CRC lets some damage pass: what is written back has to be read twice.
    if (configuration() != now) fail("sends damaged answers; check cable and earth");
    write(wanted);
    now = configuration();
    if (now != wanted) fail("did not keep its settings; set write_configuration = false");
  }
  Lms200ScanFormat format;
  format.measuring_mode = now.bytes[Lms200Configuration::kMeasuringMode];
  format.millimetres = now.bytes[Lms200Configuration::kUnits] == 1;
  format.index_bytes =
      (now.bytes[Lms200Configuration::kAvailability] & Lms200Configuration::kIndexBytes) != 0;
  format.resolution_cdeg = resolution_cdeg(config_);
  format.partial_scans = format.resolution_cdeg != 100;
  if (!format.known_mode() || now.bytes[Lms200Configuration::kUnits] > 1)
    fail("measures in a way that is not known here; set write_configuration = true");
  return format;
}

Lms200Configuration Lms200Setup::configuration() {
  const auto read = decode_configuration(link_.ask(lms200::kGetConfiguration));
  if (!read || read->bytes.size() <= Lms200Configuration::kUnits) fail("sent no configuration");
  return *read;
}

void Lms200Setup::write(const Lms200Configuration& wanted) {
  if (writes_ == kMaxWrites)
    fail("forgets its settings; it may be defect: write_configuration = false leaves them alone");
  ++writes_;
  std::vector<std::uint8_t> password(lms200::kPassword, std::end(lms200::kPassword) - 1);
  link_.set_mode(lms200::kInstallation, password);
  const auto written = decode_written(link_.ask(lms200::kSetConfiguration, wanted.bytes,
                                                Lms200Link::Repeat::kWhenRefused, kWriteLimit_us));
  link_.set_mode(lms200::kOnRequest);
  if (!written || !written->accepted)
    fail("refuses its settings; set write_configuration = false to use it as it is");
}

// A quarter of a degree is offered for 100 deg only; partial scans then cover 180 deg all the same.
void Lms200Setup::set_variant() {
  const int cdeg = resolution_cdeg(config_);
  const int angle_deg = cdeg == 25 ? 100 : 180;
  const auto status = decode_status_report(link_.ask(lms200::kGetStatus));
  if (!status) fail("sent no status");
  if (status->defect) fail("says that it is defect; see its error memory");
  if (status->angle_deg == angle_deg && status->resolution_cdeg == cdeg) return;
  const auto low = [](int word) { return static_cast<std::uint8_t>(word & 0xFF); };
  const std::uint8_t variant[] = {low(angle_deg), low(angle_deg >> 8), low(cdeg), low(cdeg >> 8)};
  if (!decode_variant_accepted(link_.ask(lms200::kSetVariant, variant)).value_or(false))
    fail("does not measure 180 deg in such steps; choose another resolution_deg");
}

// The answer still comes at the old speed. The command is never sent twice: nobody would know at
// which speed the device listens.
void Lms200Setup::change_baud(int baud) {
  link_.set_mode(of(kSpeeds, baud, &Speed::baud).mode, {}, Lms200Link::Repeat::kWhenRefused);
  link_.set_baud(baud);
  link_.wait(kAfterBaud_us);
  link_.forget();
  known_baud_ = baud;
  if (!decode_status_report(link_.ask(lms200::kGetStatus)))
    fail(
        fmt::format("does not answer at {} baud; 500 kbaud needs RS-422 and an adapter that can do "
                    "it, else set baud = 38400",
                    baud));
}

}  // namespace voxlist::scanner
