#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace voxlist::desk {

/// What a log holds, for people who look for something else in it.
class ChannelCounts {
 public:
  void add(const std::string& channel) { ++counts_[channel]; }

  /// "has no CLOUD; it holds robot2/CLOUD (12): give --prefix robot2/, or its settings with
  /// --config", of a channel that was looked for under a prefix. Where no prefix would help:
  /// `remedy`.
  std::string why_without(const std::string& channel, const std::string& prefix,
                          const std::string& remedy = {}) const;

 private:
  std::string text() const;
  std::vector<std::string> prefixes_of(const std::string& channel) const;

  std::map<std::string, std::int64_t> counts_;
};

}  // namespace voxlist::desk
