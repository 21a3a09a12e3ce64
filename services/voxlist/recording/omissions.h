#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "services/voxlist/output/console.h"

namespace voxlist::desk {

/// What of the input was left out, by reason. The first few of each reason are told at once.
class Omissions {
 public:
  explicit Omissions(Console& console) : console_(console) {}

  /// Something was left out because of `reason`; `detail` tells a person what and where.
  void add(const std::string& reason, const std::string& detail);

  /// Something that is taken as it is, but that a person should know; not counted. The same text is
  /// told once, and of each `kind` only the first few.
  void remark(const std::string& kind, const std::string& text);
  void remark(const std::string& text) { remark(text, text); }

  std::int64_t total() const;
  bool empty() const { return counts_.empty(); }

  /// "2 unreadable, 1 CLOUD/truncated".
  std::string summary() const;

 private:
  Console& console_;
  std::map<std::string, std::int64_t> counts_;
  std::map<std::string, std::int64_t> remarks_;
  std::set<std::string> told_;
};

}  // namespace voxlist::desk
