#include "voxlist/config/toml_document.h"

#include <fmt/core.h>

#include <fstream>

namespace voxlist::config {
namespace {

std::vector<std::string> read_lines(std::istream& stream) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

bool is_header(const std::string& line) {
  const auto first = line.find_first_not_of(" \t");
  return first != std::string::npos && line[first] == '[';
}

// A key and value that are right by themselves and wrong in their file can only be a repetition.
bool is_repeated_key(const std::string& line) {
  if (is_header(line)) return false;
  try {
    return !toml::parse(line).empty();
  } catch (const toml::parse_error&) {
    return false;
  }
}

}  // namespace

std::string complaint(const std::filesystem::path& file, toml::source_index line,
                      const std::string& what) {
  return fmt::format("{}:{}: {}", file.string(), line, what);
}

TomlDocument parse_toml(const std::filesystem::path& file) {
  TomlDocument document;
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) {
    document.complaints.push_back(file.string() + ": cannot be read; check the path");
    return document;
  }
  std::vector<std::string> lines = read_lines(stream);
  // The parser stops at its first error. Repeated keys are taken out one by one, so that all of
  // them, and all that is wrong elsewhere, can be told at once.
  for (std::size_t attempt = 0; attempt <= lines.size(); ++attempt) {
    try {
      document.table = toml::parse(joined(lines));
      return document;
    } catch (const toml::parse_error& error) {
      const auto number = error.source().begin.line;
      document.complaints.push_back(complaint(file, number, std::string(error.description())));
      if (number < 1 || number > lines.size() || !is_repeated_key(lines[number - 1])) break;
      lines[number - 1].clear();
    }
  }
  return document;
}

}  // namespace voxlist::config
