#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace voxlist::config {

/// A settings file's text with some keys of `[table]` set, and everything else (comments, order,
/// line ends) as it was: a key that is there gets its new value in its place, a new one a line
/// behind the table's last, a new table stands at the end. Values are TOML numbers, as text. Throws
/// std::runtime_error, for a person to read after the file's name, when the text is no TOML or
/// writes the table in another way than under a line `[table]`.
std::string with_numbers(const std::string& text, const std::string& table,
                         const std::vector<std::pair<std::string, std::string>>& values);

/// The same for the tables [[table.array]]: the one with this number, from 0, which must be there.
std::string with_numbers_of_entry(const std::string& text, const std::string& table,
                                  const std::string& array, std::size_t number,
                                  const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace voxlist::config
