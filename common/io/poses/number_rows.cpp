#include "voxlist/io/poses/number_rows.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "voxlist/geometry/time_limit.h"
#include "voxlist/io/files/cursor.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/files/file_kind.h"

namespace voxlist::io {
namespace {

using Numbers = std::vector<double>;

// Commas and semicolons are counted, and are spaces in the text.
struct Line {
  std::size_t number;
  std::string text;
  std::ptrdiff_t commas;

  bool has_commas() const { return commas > 0; }
};

// Numbers in a row: those of TUM, and of the 3 or 4 rows of a matrix.
constexpr std::size_t kTum = 8, kMatrix = 12, kWholeMatrix = 16;

// A first number from here on is EuRoC's time: nanoseconds, later than March 1973.
constexpr double kLeastEurocTime_ns = 1e17;

// How far a matrix may be from a rotation: files are written with six digits.
constexpr double kMaxMatrixError = 0.01;

Line take_row(std::string_view& rest, std::size_t number) {
  const auto is_comma = [](char c) { return c == ',' || c == ';'; };
  Line line{number, std::string(take_line(rest)), 0};
  line.commas = std::ranges::count_if(line.text, is_comma);
  std::ranges::replace_if(line.text, is_comma, ' ');
  return line;
}

// The file's lines that are not blank, without comments behind the first row.
struct Lines {
  std::optional<Line> comment;  // the last one before the rows
  std::vector<Line> rows;
};

Lines lines_of(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  std::string_view rest = text;
  Lines lines;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    Line line = take_row(rest, number);
    std::string_view words = line.text;
    const std::string_view first = take_word(words);
    if (first.empty()) continue;
    if (!first.starts_with('#')) {
      lines.rows.push_back(std::move(line));
    } else if (lines.rows.empty()) {
      lines.comment = std::move(line);
    }
  }
  return lines;
}

// The line's numbers; throws FormatError on what is none.
Numbers numbers_of(std::string_view text) {
  Numbers numbers;
  for (auto word = take_word(text); !word.empty(); word = take_word(text))
    numbers.push_back(parse_number(word));
  return numbers;
}

bool is_pose_row(const Line& line) {
  try {
    const Numbers numbers = numbers_of(line.text);
    const bool is_euroc =
        line.has_commas() && numbers.size() >= kTum && numbers.front() >= kLeastEurocTime_ns;
    return is_euroc || numbers.size() == kTum || numbers.size() == kMatrix ||
           numbers.size() == kWholeMatrix;
  } catch (const FormatError&) {
    return false;
  }
}

Pose3 pose_of(std::span<const double> position, const Eigen::Quaterniond& wanted) {
  const auto rotation = unit_quaternion(wanted.w(), wanted.x(), wanted.y(), wanted.z());
  if (!rotation) throw FormatError("the quaternion is not of unit length");
  Pose3 pose = Pose3::Identity();
  pose.linear() = rotation->toRotationMatrix();
  pose.translation() << position[0], position[1], position[2];
  return pose;
}

Pose3 pose_of_matrix(const Numbers& v) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(v.data());
  const Eigen::Matrix3d linear = matrix.leftCols<3>();
  const Eigen::Matrix3d error = linear * linear.transpose() - Eigen::Matrix3d::Identity();
  if (!(error.cwiseAbs().maxCoeff() <= kMaxMatrixError) || !(linear.determinant() > 0.0))
    throw FormatError("the matrix is no rotation");
  Pose3 pose = Pose3::Identity();
  pose.linear() = Eigen::Quaterniond(linear).normalized().toRotationMatrix();
  pose.translation() = matrix.col(3);
  return pose;
}

std::int64_t utime_of(double time, double us_per_unit) {
  const double us = time * us_per_unit;
  if (!(std::abs(us) <= static_cast<double>(kMaxUtime_us)))
    throw FormatError("the time must be in seconds; is it in nanoseconds? Divide it by 1e9");
  return std::llround(us);
}

// What the rows of a file mean.
class Reader {
 public:
  explicit Reader(const Line& first)
      : width_(numbers_of(first.text).size()),
        has_times_(width_ != kMatrix && width_ != kWholeMatrix),
        is_euroc_(first.has_commas() && has_times_ &&
                  numbers_of(first.text).front() >= kLeastEurocTime_ns) {}

  bool has_times() const { return has_times_; }

  // Nothing for a pose that nobody knows.
  std::optional<PoseRow> read(const Line& line, std::size_t row) const {
    const Numbers v = numbers_of(line.text);
    if (v.size() != width_)
      throw FormatError(fmt::format("{} numbers instead of {}", v.size(), width_));
    if (is_unknown(v)) return std::nullopt;
    const auto used = std::span(v).first(has_times_ ? kTum : width_);
    if (!std::ranges::all_of(used, [](double number) { return std::isfinite(number); }))
      throw FormatError("a number is not finite");
    PoseRow result{static_cast<std::int64_t>(row), "", 0, pose(v)};
    result.utime_us = has_times_ ? utime_of(v[0], is_euroc_ ? 1e-3 : 1e6) : result.scan * 1'000'000;
    return result;
  }

 private:
  bool is_unknown(const Numbers& v) const {
    const auto is = [&](std::size_t i) { return !std::isfinite(v[i]); };
    return has_times_ ? is(1) && is(2) : is(3) && is(7);
  }

  Pose3 pose(const Numbers& v) const {
    if (!has_times_) return pose_of_matrix(v);
    const auto position = std::span(v).subspan(1, 3);
    return is_euroc_ ? pose_of(position, Eigen::Quaterniond(v[4], v[5], v[6], v[7]))
                     : pose_of(position, Eigen::Quaterniond(v[7], v[4], v[5], v[6]));
  }

  std::size_t width_;
  bool has_times_, is_euroc_;
};

// A comment with as many names between commas as the rows have numbers is a table's header.
bool has_header(const Lines& lines) {
  return lines.comment && lines.comment->has_commas() &&
         lines.comment->commas == lines.rows.front().commas;
}

// A first line of names, between white space and without #, as some write TUM's.
bool has_names(const std::vector<Line>& lines) {
  return lines.size() > 1 && !lines[0].has_commas() && !lines[1].has_commas() &&
         !is_pose_row(lines[0]) && is_pose_row(lines[1]) &&
         lines[0].text.find_first_of("0123456789") == std::string::npos;
}

// Numbers alone are no header.
void refuse_numbers(const std::filesystem::path& path, const Line& first) {
  std::size_t count = 0;
  try {
    count = numbers_of(first.text).size();
  } catch (const FormatError&) {
    return;
  }
  throw FileError(path,
                  fmt::format("line {} has {} numbers and no line names them; a row of TUM has "
                              "8 (t x y z qx qy qz qw), one of KITTI 12",
                              first.number, count));
}

}  // namespace

std::optional<PoseTable> read_number_rows(const std::filesystem::path& path) {
  Lines found = lines_of(path);
  std::vector<Line>& lines = found.rows;
  if (lines.empty()) throw FileError(path, "has no poses, add a line for each");
  if (has_header(found)) return std::nullopt;
  if (has_names(lines)) lines.erase(lines.begin());
  if (!is_pose_row(lines[0])) {
    refuse_numbers(path, lines[0]);
    return std::nullopt;
  }
  const Reader reader(lines[0]);
  PoseTable table{{}, false, false, reader.has_times(), true, 0};
  for (std::size_t row = 0; row < lines.size(); ++row) {
    try {
      if (const auto pose = reader.read(lines[row], row)) {
        table.rows.push_back(*pose);
      } else {
        ++table.unknown;
      }
    } catch (const FormatError& error) {
      throw FileError(path, fmt::format("line {}: {}", lines[row].number, error.what()));
    }
  }
  if (table.rows.empty()) throw FileError(path, "has no pose that is known, all are nan or inf");
  return table;
}

}  // namespace voxlist::io
