#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "services/voxlist/output/console.h"

namespace voxlist::desk {

/// What of the input was left out, by reason. The first few of each reason are told at once.
class Omissions {
 public:
  explicit Omissions(Console& console) : console_(console) {}

  /// Something was left out because of `reason`; `detail` tells a person what and where.
  void add(const std::string& reason, const std::string& detail);

  std::int64_t total() const;
  bool empty() const { return counts_.empty(); }

  /// "2 unreadable, 1 CLOUD/truncated".
  std::string summary() const;

 private:
  Console& console_;
  std::map<std::string, std::int64_t> counts_;
};

}  // namespace voxlist::desk
