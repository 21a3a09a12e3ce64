#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "voxlist/config/settings_visitor.h"

namespace voxlist::config {

/// One table of a settings file, tied to the struct that holds it.
struct Section {
  std::string name;  ///< empty: what stands in no table
  std::function<void(SettingsVisitor&)> visit;
  /// The table has a reader that knows more of its keys: unknown ones are left to it.
  bool shared = false;
};

/// The table `[name]` for a struct with a visit member; `settings` must outlive the section.
template <class Settings>
Section section(std::string name, Settings& settings) {
  return {std::move(name), [&settings](SettingsVisitor& visitor) { settings.visit(visitor); }};
}

/// The same for a program that needs only some keys of another program's table.
template <class Settings>
Section shared_section(std::string name, Settings& settings) {
  Section result = section(std::move(name), settings);
  result.shared = true;
  return result;
}

/// Lists of tables that stand in no table, `[[key]]`, for a struct whose members are such lists.
/// Several programs may read them.
template <class Settings>
Section root_section(Settings& settings) {
  return section("", settings);
}

/// Reads a TOML file into the sections' structs; keys that the file leaves out keep their values.
/// `other_tables` are tables, or lists of them, that belong to other programs: allowed, and not
/// looked into.
/// Returns all complaints at once, each "FILE:LINE: what is wrong and what is allowed": unknown and
/// duplicate keys, unknown tables, wrong types, values out of range. Text that is no TOML at all
/// ends the reading at that line. Empty: all is well. With complaints, use none of the structs.
/// Throws std::logic_error if a struct names a key twice.
std::vector<std::string> read_config(const std::filesystem::path& file,
                                     const std::vector<Section>& sections,
                                     const std::vector<std::string>& other_tables = {});

/// What is in force, as TOML with a comment above each key. Reading it back gives the same values
/// to the last bit.
std::string to_toml(const std::vector<Section>& sections);

/// The section as a Markdown table (key, value in force, range, meaning), for a README.
std::string markdown_table(const Section& section);

}  // namespace voxlist::config
