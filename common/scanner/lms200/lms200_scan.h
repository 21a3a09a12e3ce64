#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/geometry/laser_line.h"
#include "voxlist/scanner/lms200/lms200_telegram.h"

namespace voxlist::scanner {

/// The last data byte of every reply.
struct Lms200Status {
  int severity = 0;          ///< 0 well, 1 information, 2 warning, 3 error, 4 fatal
  bool restarted = false;    ///< since the last reply
  bool implausible = false;  ///< values contradict each other
  bool polluted = false;     ///< the front window needs cleaning

  bool operator==(const Lms200Status&) const = default;
};

Lms200Status decode_lms200_status(std::uint8_t byte);
std::uint8_t encode(const Lms200Status& status);

/// How the device was configured to send its scans.
struct Lms200ScanFormat {
  int measuring_mode = 0;   ///< 0-2: 8 m in mm or 80 m in cm; 3, 4: 16 m; 5, 6, 15: 32 m
  bool millimetres = true;  ///< else centimetres
  int angle_deg = 180;
  int resolution_cdeg = 100;   ///< hundredths of a degree
  bool partial_scans = false;  ///< mode 2A: each turn of the mirror by itself, 1 deg steps
  bool index_bytes = false;    ///< availability bit 1: scan and telegram indices are sent

  /// Whether the measuring mode is one of those above.
  bool known_mode() const;

  double unit_m() const { return millimetres ? 1e-3 : 1e-2; }

  /// The first range that is beyond maximum.
  double range_limit_m() const;

  /// Values in a scan; a partial scan covers 180 deg, and one value less if it begins later.
  std::size_t values(int partial) const;

  /// Angle of the first value. Partial scan p begins p quarters of a degree later.
  double first_angle_rad(int partial) const;

  double step_rad() const;
};

/// One measured value.
struct Lms200Value {
  enum class Kind { kRange, kOverMaximum, kDazzled, kInvalid };

  Kind kind = Kind::kInvalid;
  double range_m = 0.0;    ///< of a kRange
  std::uint8_t flags = 0;  ///< upper bits by measuring mode: fields that were infringed, reflector

  bool operator==(const Lms200Value&) const = default;
};

/// One B0 telegram. Without partial scans it has the values of 1, 2 or 4 turns of the mirror.
struct Lms200Scan {
  std::vector<Lms200Value> values;  ///< from the right to the left, seen from above
  int partial = 0;                  ///< 0 to 3: begins so many quarters of a degree later
  std::uint8_t scan_index = 0;      ///< counts turns of the mirror; with index bytes
  std::uint8_t telegram_index = 0;  ///< counts telegrams; with index bytes
  Lms200Status status;

  bool operator==(const Lms200Scan&) const = default;
};

/// A scan, or why there is none: a counter's name.
struct Lms200ScanResult {
  std::optional<Lms200Scan> scan;
  const char* refused = nullptr;
};

/// Reads a B0 telegram and refuses one that is not as configured (not_a_scan, wrong_count,
/// wrong_unit, wrong_partial) or that the device itself does not stand by (device_error).
Lms200ScanResult decode_scan(const Lms200Telegram& telegram, const Lms200ScanFormat& format);

/// The device's side of it. Ranges are rounded to the unit; those past the limit are over maximum.
Lms200Telegram encode_scan(const Lms200Scan& scan, const Lms200ScanFormat& format);

/// The scan as a line whose first beam left at a time. Times of the other beams hold for one turn
/// of the mirror (1 deg steps) only.
LaserLine to_laser_line(const Lms200Scan& scan, const Lms200ScanFormat& format,
                        std::int64_t utime_us);

/// A line's ranges as the device would send them.
std::vector<Lms200Value> to_values(const LaserLine& line);

}  // namespace voxlist::scanner
