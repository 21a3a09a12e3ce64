#include "voxlist/io/poses/pose_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <set>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/time_limit.h"
#include "voxlist/io/files/time_in_name.h"
#include "voxlist/io/poses/csv_table.h"
#include "voxlist/io/poses/number_rows.h"

namespace voxlist::io {
namespace {

/// A column of numbers in a fixed unit.
struct Quantity {
  std::size_t column;
  double scale = 1.0;
};

std::optional<Quantity> quantity(const CsvTable& csv, std::initializer_list<std::string_view> names,
                                 double scale = 1.0) {
  const auto column = csv.column(names);
  return column ? std::optional(Quantity{*column, scale}) : std::nullopt;
}

std::optional<Quantity> angle(const CsvTable& csv, std::string_view name) {
  const std::string base(name);
  const auto radians = quantity(csv, {base, base + "_rad"});
  return radians ? radians : quantity(csv, {base + "_deg"}, kRadPerDeg);
}

// EuRoC calls x p_RS_R_x [m].
std::optional<Quantity> length(const CsvTable& csv, std::string_view name) {
  const std::string base(name);
  for (const std::string before : {"", "p_rs_r_", "p_", "t", "t_", "pos_", "position_"})
    if (const auto found = quantity(csv, {before + base, before + base + "_m"})) return found;
  return std::nullopt;
}

// EuRoC calls qx q_RS_x [].
std::optional<Quantity> quaternion_part(const CsvTable& csv, char name) {
  const std::string base(1, name);
  return quantity(csv,
                  {"q" + base, "q_rs_" + base, "q_" + base, "quat_" + base, "orientation_" + base});
}

std::optional<Quantity> time(const CsvTable& csv) {
  const auto ns = csv.column({"p_rs_r_x", "p_rs_r_x_m"})
                      ? quantity(csv, {"timestamp", "timestamp_ns"}, 1e-3)
                      : quantity(csv, {"utime_ns", "timestamp_ns", "time_ns", "t_ns"}, 1e-3);
  if (ns) return ns;
  const auto us = quantity(csv, {"utime", "utime_us", "timestamp_us", "time_us", "t_us"});
  return us ? us : quantity(csv, {"t", "t_s", "time", "time_s", "timestamp", "timestamp_s"}, 1e6);
}

/// Which columns of the table hold what.
struct Columns {
  explicit Columns(const CsvTable& csv)
      : scan(csv.column({"index", "scan", "scan_index", "scan_number"})),
        file(csv.column({"file", "filename", "file_name", "scan_file"})),
        utime(time(csv)),
        x(length(csv, "x")),
        y(length(csv, "y")),
        z(length(csv, "z")),
        roll(angle(csv, "roll")),
        pitch(angle(csv, "pitch")),
        yaw(angle(csv, "yaw")),
        qw(quaternion_part(csv, 'w')),
        qx(quaternion_part(csv, 'x')),
        qy(quaternion_part(csv, 'y')),
        qz(quaternion_part(csv, 'z')) {
    if (!file && scan && scan == csv.column({"scan"}) && holds_names(csv, *scan)) {
      std::swap(file, scan);
    }
  }

  bool has_quaternion() const { return qw && qx && qy && qz; }
  bool complete() const { return x && y && (yaw || has_quaternion()); }

  std::optional<std::size_t> scan, file;
  std::optional<Quantity> utime, x, y, z, roll, pitch, yaw, qw, qx, qy, qz;

 private:
  static bool holds_names(const CsvTable& csv, std::size_t column) {
    return csv.rows() > 0 &&
           csv.text(0, column).find_first_not_of("+-.0123456789") != std::string::npos;
  }
};

/// One row of the table, read through the columns.
class RowReader {
 public:
  RowReader(const CsvTable& csv, const Columns& columns, std::size_t row)
      : csv_(csv), columns_(columns), row_(row) {}

  // nan or inf in x and y; z may be a constant.
  bool is_unknown() const {
    const auto has_none = [this](const std::optional<Quantity>& coordinate) {
      return !coordinate || csv_.is_not_finite(row_, coordinate->column);
    };
    return has_none(columns_.x) && has_none(columns_.y);
  }

  PoseRow read() const {
    PoseRow result;
    result.file = columns_.file ? csv_.text(row_, *columns_.file) : "";
    result.scan = scan(result.file);
    result.utime_us = columns_.utime ? utime_us() : result.scan * 1'000'000;
    result.pose.linear() = rotation().toRotationMatrix();
    result.pose.translation() << value(columns_.x), value(columns_.y), value(columns_.z);
    return result;
  }

 private:
  double value(const std::optional<Quantity>& quantity) const {
    return quantity ? csv_.number(row_, quantity->column) * quantity->scale : 0.0;
  }

  std::int64_t scan(const std::string& file) const {
    if (!columns_.scan) {
      return number_in_name(file).value_or(static_cast<std::int64_t>(row_));
    }
    const double number = csv_.number(row_, *columns_.scan);
    if (!(number >= 0.0 && number <= 1e9) || number != std::floor(number)) {
      throw csv_.error(row_, *columns_.scan, "must be a whole number from 0");
    }
    return static_cast<std::int64_t>(number);
  }

  std::int64_t utime_us() const {
    const double us = value(columns_.utime);
    if (std::abs(us) > static_cast<double>(kMaxUtime_us)) {
      throw csv_.error(row_, columns_.utime->column,
                       "is no time in this unit (utime is in microseconds, t in seconds; call the "
                       "column utime_ns if these are nanoseconds)");
    }
    return std::llround(us);
  }

  Eigen::Quaterniond rotation() const {
    if (columns_.has_quaternion()) {
      const auto q = unit_quaternion(value(columns_.qw), value(columns_.qx), value(columns_.qy),
                                     value(columns_.qz));
      if (!q) {
        throw csv_.error(row_, "columns qx, qy, qz, qw: the quaternion is not of unit length");
      }
      return *q;
    }
    using Eigen::Vector3d;
    return Eigen::Quaterniond(voxlist::rotation(value(columns_.yaw), Vector3d::UnitZ()) *
                              voxlist::rotation(value(columns_.pitch), Vector3d::UnitY()) *
                              voxlist::rotation(value(columns_.roll), Vector3d::UnitX()));
  }

  const CsvTable& csv_;
  const Columns& columns_;
  std::size_t row_;
};

// Degrees in a column of radians go far beyond a turn; so do radians that nobody wrapped, so that
// it is only told.
void note_degrees(const CsvTable& csv, PoseTable& table) {
  constexpr double kTurns_rad = 2.05 * std::numbers::pi;
  const auto column = csv.column({"yaw"});
  if (!column) return;
  double largest = 0.0;
  for (std::size_t row = 0; row < csv.rows(); ++row)
    if (!csv.is_not_finite(row, *column))
      largest = std::max(largest, std::abs(csv.number(row, *column)));
  if (largest > kTurns_rad)
    table.notes.push_back(
        fmt::format("yaw goes up to {:g} and is taken for radians: call the column "
                    "yaw_deg if these are degrees",
                    largest));
}

}  // namespace

PoseTable read_poses(const std::filesystem::path& path) {
  if (auto table = read_number_rows(path)) return *std::move(table);
  return read_pose_csv(path);
}

std::vector<std::string> notes_on(const PoseTable& table) {
  std::vector<std::string> notes = table.notes;
  if (table.unknown > 0)
    notes.push_back(fmt::format("{} rows hold no pose (nan or inf)", table.unknown));
  return notes;
}

PoseTable read_pose_csv(const std::filesystem::path& path) {
  const CsvTable csv(path);
  const Columns columns(csv);
  if (!columns.complete()) {
    throw FileError(path, fmt::format("needs columns x, y and yaw (or qx, qy, qz, qw), but has {}; "
                                      "name them in the first line",
                                      csv.column_names()));
  }
  PoseTable table{{},
                  columns.scan.has_value(),
                  columns.file.has_value(),
                  columns.utime.has_value(),
                  columns.z.has_value(),
                  0};
  std::set<std::int64_t> scans;
  std::set<std::string> files;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const RowReader reader(csv, columns, row);
    if (reader.is_unknown()) {
      ++table.unknown;
      continue;
    }
    table.rows.push_back(reader.read());
    const PoseRow& last = table.rows.back();
    if (columns.scan && !scans.insert(last.scan).second) {
      throw csv.error(row, *columns.scan, fmt::format("scan {} comes twice", last.scan));
    }
    if (columns.file && (last.file.empty() || !files.insert(last.file).second)) {
      throw csv.error(row, *columns.file,
                      fmt::format("file \"{}\" is empty or comes twice", last.file));
    }
  }
  if (table.rows.empty()) {
    throw FileError(path, "has no poses, add a line for each");
  }
  note_degrees(csv, table);
  return table;
}

PoseTable read_odometry_csv(const std::filesystem::path& path) {
  PoseTable table = read_poses(path);
  if (!table.has_times) {
    throw FileError(path, "odometry needs times, add a column utime (us) or t (s)");
  }
  for (std::size_t i = 1; i < table.rows.size(); ++i) {
    if (table.rows[i].utime_us < table.rows[i - 1].utime_us) {
      throw FileError(path,
                      fmt::format("time goes backwards at pose {}, sort the lines by time", i + 1));
    }
  }
  return table;
}

std::optional<Eigen::Quaterniond> unit_quaternion(double w, double x, double y, double z) {
  constexpr double kTolerance = 0.01;
  const Eigen::Quaterniond q(w, x, y, z);
  if (!(std::abs(q.norm() - 1.0) <= kTolerance)) {
    return std::nullopt;
  }
  return q.normalized();
}

std::optional<std::int64_t> number_in_name(const std::filesystem::path& file) {
  if (time_in_name(file)) return std::nullopt;
  constexpr std::size_t kMaxDigits = 9;
  const std::string stem = file.stem().string();
  const std::size_t last = stem.find_last_of("0123456789");
  if (last == std::string::npos) {
    return std::nullopt;
  }
  const std::size_t before = stem.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  if (last - first >= kMaxDigits) {
    return std::nullopt;
  }
  return std::stoll(stem.substr(first, last + 1 - first));
}

}  // namespace voxlist::io
