#pragma once

#include <string>
#include <vector>

namespace voxlist::bus {

/// Whether a name has only letters, digits, _ - and /: all that a channel's name may have.
bool is_plain_channel(const std::string& name);

/// Whether a text is a pattern of channels: such a name, in which each * stands for any letters but
/// /. So POSE is POSE alone, GRID_* every robot's grid, */POSE the POSE of every prefix.
bool is_channel_pattern(const std::string& text);

/// Whether the pattern, or one of them, matches all of the name.
bool matches(const std::string& pattern, const std::string& channel);
bool matches_any(const std::vector<std::string>& patterns, const std::string& channel);

/// What one of the patterns matches, in lcm's own words.
std::string regular_expression(const std::vector<std::string>& patterns);

}  // namespace voxlist::bus
