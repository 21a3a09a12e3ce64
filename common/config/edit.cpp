#include "voxlist/config/edit.h"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace voxlist::config {
namespace {

// Lines with their ends.
std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    lines.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return lines;
}

toml::table parse(const std::string& text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(
        fmt::format("line {}: {}", error.source().begin.line, error.description()));
  }
}

// The text by lines, counted from 1 as TOML's places are.
class Editor {
 public:
  explicit Editor(const std::string& text)
      : lines_(split(text)), end_of_line_(text.find("\r\n") == text.npos ? "\n" : "\r\n") {}

  bool starts_with_bracket(toml::source_index line) const {
    const std::string& text = lines_[line - 1];
    const std::size_t first = text.find_first_not_of(" \t");
    return first != text.npos && text[first] == '[';
  }

  void replace(const toml::source_position& at, const std::string& value) {
    std::string& line = lines_[at.line - 1];
    const std::size_t begin = at.column - 1;
    line.replace(begin, std::min(line.find_first_of(" \t#\r\n", begin), line.size()) - begin,
                 value);
  }

  void insert_behind(toml::source_index line, const std::vector<std::string>& added) {
    if (line > 0 && !lines_[line - 1].ends_with('\n')) lines_[line - 1] += end_of_line_;
    auto at = lines_.begin() + static_cast<std::ptrdiff_t>(line);
    for (const std::string& text : added) at = lines_.insert(at, text + end_of_line_) + 1;
  }

  toml::source_index lines() const { return static_cast<toml::source_index>(lines_.size()); }

  std::string text() const {
    std::string all;
    for (const std::string& line : lines_) all += line;
    return all;
  }

 private:
  std::vector<std::string> lines_;
  const char* const end_of_line_;
};

toml::source_index last_line(const toml::table& table) {
  toml::source_index last = table.source().begin.line;
  for (const auto& [key, node] : table) last = std::max(last, node.source().end.line);
  return last;
}

using Values = std::vector<std::pair<std::string, std::string>>;

// Those of the values that the table does not have yet, as lines; the others get their places.
std::vector<std::string> replace_old(const toml::table& table, const Values& values,
                                     Editor& editor) {
  std::vector<std::string> added;
  for (const auto& [key, value] : values) {
    const toml::node* const old = table.get(key);
    if (old != nullptr)
      editor.replace(old->source().begin, value);
    else
      added.push_back(key + " = " + value);
  }
  return added;
}

void edit(const toml::table& table, const Values& values, Editor& editor) {
  const std::vector<std::string> added = replace_old(table, values, editor);
  editor.insert_behind(last_line(table), added);
}

std::string new_table(const std::string& table, const Values& values, Editor& editor) {
  std::vector<std::string> added;
  if (editor.lines() > 0) added.emplace_back();
  added.push_back("[" + table + "]");
  for (const auto& [key, value] : values) added.push_back(key + " = " + value);
  editor.insert_behind(editor.lines(), added);
  return editor.text();
}

}  // namespace

std::string with_numbers(const std::string& text, const std::string& table,
                         const std::vector<std::pair<std::string, std::string>>& values) {
  const toml::table document = parse(text);
  const toml::table* const found = document[table].as_table();
  Editor editor(text);
  if (!document.contains(table)) return new_table(table, values, editor);
  if (found == nullptr || !editor.starts_with_bracket(found->source().begin.line))
    throw std::runtime_error(fmt::format("write the keys of {0} under a line [{0}]", table));
  edit(*found, values, editor);
  return editor.text();
}

std::string with_numbers_of_entry(const std::string& text, const std::string& table,
                                  const std::string& array, std::size_t number,
                                  const std::vector<std::pair<std::string, std::string>>& values) {
  const toml::table document = parse(text);
  const toml::table* const entry = document[table][array][number].as_table();
  Editor editor(text);
  if (entry == nullptr || !editor.starts_with_bracket(entry->source().begin.line))
    throw std::runtime_error(
        fmt::format("write each of {0}.{1} under a line [[{0}.{1}]]", table, array));
  edit(*entry, values, editor);
  return editor.text();
}

}  // namespace voxlist::config
