#include "voxlist/bus/channel_pattern.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace voxlist::bus {
namespace {

bool is_plain_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '/';
}

bool matches(std::string_view pattern, std::string_view channel) {
  // What is tried again where the rest does not fit: the last * takes one letter more.
  std::string_view pattern_behind_star;
  std::string_view channel_at_star;
  bool has_star = false;
  while (!channel.empty()) {
    if (!pattern.empty() && pattern.front() == '*') {
      pattern.remove_prefix(1);
      pattern_behind_star = pattern;
      channel_at_star = channel;
      has_star = true;
    } else if (!pattern.empty() && pattern.front() == channel.front()) {
      pattern.remove_prefix(1);
      channel.remove_prefix(1);
    } else if (has_star && !channel_at_star.empty() && channel_at_star.front() != '/') {
      channel_at_star.remove_prefix(1);
      pattern = pattern_behind_star;
      channel = channel_at_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*') == std::string_view::npos;
}

}  // namespace

bool is_plain_channel(const std::string& name) {
  return std::ranges::all_of(name, is_plain_letter);
}

bool is_channel_pattern(const std::string& text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](char c) { return c == '*' || is_plain_letter(c); });
}

bool matches(const std::string& pattern, const std::string& channel) {
  return matches(std::string_view(pattern), std::string_view(channel));
}

bool matches_any(const std::vector<std::string>& patterns, const std::string& channel) {
  return std::ranges::any_of(patterns, [&](const std::string& p) { return matches(p, channel); });
}

std::string regular_expression(const std::vector<std::string>& patterns) {
  std::string expression;
  for (const std::string& pattern : patterns) {
    expression += expression.empty() ? "(" : "|";
    for (const char c : pattern) expression += c == '*' ? std::string("[^/]*") : std::string(1, c);
  }
  return expression + ")";
}

}  // namespace voxlist::bus
