#include "services/voxlist/maps/scan_log.h"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <sstream>
#include <string>
#include <system_error>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

using matching::LocalisationState;

constexpr const char* kHead = "scan,utime_us,state,probability,elapsed_ms";

std::optional<LocalisationState> state_of(const std::string& word) {
  for (const LocalisationState state :
       {LocalisationState::kLost, LocalisationState::kAmbiguous, LocalisationState::kTracking})
    if (word == matching::name(state)) return state;
  return std::nullopt;
}

template <class Number>
bool read(const std::string& text, Number& number) {
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  return failure == std::errc() && end == text.data() + text.size();
}

std::optional<ScanRow> row_of(const std::string& line) {
  std::array<std::string, 5> fields;
  std::istringstream in(line);
  for (std::string& field : fields)
    if (!std::getline(in, field, ',')) return std::nullopt;
  ScanRow row;
  const auto state = state_of(fields[2]);
  if (!in.eof() || !state || !read(fields[0], row.number) || !read(fields[1], row.utime_us) ||
      !read(fields[3], row.probability) || !read(fields[4], row.elapsed_ms))
    return std::nullopt;
  row.state = *state;
  return row;
}

}  // namespace

void write_scan_log(const std::filesystem::path& folder, const std::vector<ScanRow>& rows) {
  std::string text = fmt::format("{}\n", kHead);
  for (const ScanRow& row : rows)
    text += fmt::format("{},{},{},{:.6f},{:.3f}\n", row.number, row.utime_us,
                        matching::name(row.state), row.probability, row.elapsed_ms);
  io::write_file_atomically(folder / kScanLogFile, text);
}

std::optional<std::vector<ScanRow>> read_scan_log(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kScanLogFile;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  std::istringstream in(io::read_file(path));
  std::vector<ScanRow> rows;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (number == 1 && line == kHead) continue;
    const auto row = row_of(line);
    if (!row) throw io::FileError(path, fmt::format("line {} is no row of {}", number, kHead));
    rows.push_back(*row);
  }
  return rows;
}

}  // namespace voxlist::desk
