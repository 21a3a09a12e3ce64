#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/scanner/lms200/lms200_scan.h"
#include "voxlist/scanner/lms200/lms200_telegram.h"

namespace voxlist::scanner {

/// What the device says of itself (B1).
struct Lms200StatusReport {
  std::string firmware;  ///< "V02.10"
  int mode = 0;          ///< as in kSetMode
  bool defect = false;
  int measuring_mode = 0;
  int angle_deg = 180;
  int resolution_cdeg = 50;
  int baud = 9600;  ///< 0: a speed that is none of its own
  bool baud_permanent = false;
  int address = 0;
  int units = 0;  ///< 0 centimetres, 1 millimetres
  bool laser_on = true;
  Lms200Status status;
};

/// Nothing when the telegram is no B1 of a length that is known.
std::optional<Lms200StatusReport> decode_status_report(const Lms200Telegram& telegram);

/// The device's side of it: the long kind, 152 bytes and status.
Lms200Telegram encode_status_report(const Lms200StatusReport& report);

/// The device's settings in its EEPROM, as the bytes that it sent: those without a name here are to
/// be written back as they are.
struct Lms200Configuration {
  static constexpr std::size_t kAvailability = 4, kMeasuringMode = 5, kUnits = 6;
  static constexpr std::uint8_t kIndexBytes = 0x02;  ///< of kAvailability

  std::vector<std::uint8_t> bytes;

  bool operator==(const Lms200Configuration&) const = default;
};

/// Reads an F4. Nothing when it is none.
std::optional<Lms200Configuration> decode_configuration(const Lms200Telegram& telegram);

/// What became of a written configuration (F7).
struct Lms200Written {
  bool accepted = false;
  Lms200Configuration configuration;  ///< that is now in force
};

/// Reads an F7. Nothing when it is none.
std::optional<Lms200Written> decode_written(const Lms200Telegram& telegram);

/// Reads a BB: whether the variant was accepted. Nothing when it is none.
std::optional<bool> decode_variant_accepted(const Lms200Telegram& telegram);

/// Reads an A0: whether the mode was changed. Nothing when it is none.
std::optional<bool> decode_mode_changed(const Lms200Telegram& telegram);

/// Reads a BA or a 90: "LMS200;301063;V02.06". Nothing when it is neither.
std::optional<std::string> decode_type(const Lms200Telegram& telegram);

/// An entry of the error memory.
struct Lms200Error {
  std::uint8_t type = 0;  ///< as in a status' severity; bit 7: not acute any more
  std::uint8_t number = 0;

  bool operator==(const Lms200Error&) const = default;
};

/// Reads a B2. Nothing when it is none.
std::optional<std::vector<Lms200Error>> decode_errors(const Lms200Telegram& telegram);

}  // namespace voxlist::scanner
