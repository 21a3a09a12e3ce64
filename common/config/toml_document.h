#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <vector>

namespace voxlist::config {

/// A parsed settings file, and what is wrong with it as TOML ("FILE:LINE: what").
struct TomlDocument {
  toml::table table;
  std::vector<std::string> complaints;
};

/// Parses a file. A key that is given twice is a complaint and its first value stands; any other
/// error of syntax ends the parsing with an empty table.
TomlDocument parse_toml(const std::filesystem::path& file);

/// "FILE:LINE: what".
std::string complaint(const std::filesystem::path& file, toml::source_index line,
                      const std::string& what);

}  // namespace voxlist::config
