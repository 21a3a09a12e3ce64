#pragma once

#include <cstdint>
#include <string>

#include "voxlist/scanner/lms200/lms200_config.h"
#include "voxlist/scanner/lms200/lms200_link.h"
#include "voxlist/scanner/lms200/lms200_reports.h"
#include "voxlist/scanner/lms200/lms200_scan.h"

namespace voxlist::scanner {

/// Brings an LMS 200 from whatever state it is in to sending scans as configured.
class Lms200Setup {
 public:
  /// `link` must outlive it. Precondition: the config is valid (why_invalid() is empty).
  Lms200Setup(Lms200Link& link, const Lms200Config& config);

  /// Finds the device and returns how it sends its scans from now on. Throws Lms200Failure,
  /// PortError; may be called again and again. It writes to the device's memory only what differs,
  /// and three times at most.
  Lms200ScanFormat run();

  /// "LMS200;301063;V02.10", once it was found.
  const std::string& type() const { return type_; }

  /// Whether a device was found, at the link's speed.
  bool found() const { return known_baud_ != 0; }

 private:
  void find();
  bool answers_at(int baud);
  bool is_heard(std::int64_t duration_us);
  void read_type();
  Lms200ScanFormat configure();
  Lms200Configuration configuration();
  void write(const Lms200Configuration& wanted);
  void set_variant();
  void change_baud(int baud);
  [[noreturn]] void fail(const std::string& what) const;

  Lms200Link& link_;
  const Lms200Config config_;
  std::string type_;
  int known_baud_ = 0;
  int writes_ = 0;
};

}  // namespace voxlist::scanner
