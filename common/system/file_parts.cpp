#include "voxlist/system/file_parts.h"

#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace voxlist {
namespace {

namespace fs = std::filesystem;

// Numbers of parts have two digits, from 100 on as many as they need. Beyond these many digits it
// is no number of a part.
constexpr std::size_t kLeastDigits = 2, kMostDigits = 3;

// The number in ".NN".
std::optional<int> number_in(std::string_view ending) {
  if (!ending.starts_with('.')) return std::nullopt;
  ending.remove_prefix(1);
  int number = 0;
  const auto [end, error] = std::from_chars(ending.data(), ending.data() + ending.size(), number);
  const bool is_number = error == std::errc() && end == ending.data() + ending.size();
  const bool is_long = ending.size() >= kLeastDigits && ending.size() <= kMostDigits;
  return is_number && is_long && number >= 0 ? std::optional(number) : std::nullopt;
}

std::map<int, fs::path> find(const fs::path& name) {
  std::map<int, fs::path> found;
  const std::string base = name.filename().string();
  std::error_code failure;
  const fs::path folder = name.has_parent_path() ? name.parent_path() : ".";
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with(base) || !entry.exists(failure)) continue;
    if (const auto number = number_in(std::string_view(file).substr(base.size())))
      found.emplace(*number, name.parent_path() / file);
  }
  return found;
}

fs::path part(const fs::path& name, int number) {
  std::string ending = ".";
  if (number < 10) ending += '0';
  ending += std::to_string(number);
  fs::path path = name;
  return path += ending;
}

}  // namespace

FileParts parts_of(const fs::path& name) {
  FileParts parts;
  std::error_code ignored;
  const std::map<int, fs::path> found =
      fs::exists(name, ignored) ? std::map<int, fs::path>() : find(name);
  int next = 0;
  for (const auto& [number, file] : found) {
    for (; next < number; ++next) parts.missing.push_back(part(name, next));
    parts.files.push_back(file);
    ++next;
  }
  if (parts.files.empty()) parts.files.push_back(name);
  return parts;
}

fs::path whole_of(const fs::path& file) {
  if (!number_in(file.extension().string())) return {};
  const fs::path name = file.parent_path() / file.stem();
  std::error_code ignored;
  return !fs::exists(name, ignored) && find(name).size() > 1 ? name : fs::path();
}

}  // namespace voxlist
