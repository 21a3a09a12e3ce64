#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace voxlist::desk {

/// What a log holds, for people who look for something else in it.
class ChannelCounts {
 public:
  void add(const std::string& channel) { ++counts_[channel]; }

  /// "LASER (4500), MIRROR (4500)", ten channels at most; "nothing" of an empty log.
  std::string text() const;

 private:
  std::map<std::string, std::int64_t> counts_;
};

}  // namespace voxlist::desk
