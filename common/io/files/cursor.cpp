#include "voxlist/io/files/cursor.h"

#include <charconv>
#include <limits>
#include <string>

namespace voxlist::io {
namespace {

constexpr std::string_view kSpace = " \t\r\n\v\f";

std::string quoted(std::string_view word) {
  std::string text = "\"";
  for (const char c : word.substr(0, 40)) {
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  return text + "\"";
}

}  // namespace

double BinaryCursor::next(Scalar type) {
  const std::string_view rest = bytes_;
  skip(type, 1);
  return decode(type, rest.data(), order_);
}

void BinaryCursor::skip(Scalar type, std::uint64_t count) {
  if (count > bytes_.size() / size_of(type)) {
    throw FormatError("ends before its data does");
  }
  bytes_.remove_prefix(count * size_of(type));
}

bool BinaryCursor::can_hold(std::uint64_t rows, std::uint64_t bytes_per_row, std::uint64_t) const {
  return bytes_per_row == 0 || rows <= bytes_.size() / bytes_per_row;
}

double TextCursor::next(Scalar) { return parse_number(next_word()); }

void TextCursor::skip(Scalar, std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    next_word();
  }
}

bool TextCursor::can_hold(std::uint64_t rows, std::uint64_t, std::uint64_t numbers_per_row) const {
  // A number takes a digit and a separator, which the last one may lack.
  return numbers_per_row == 0 || rows <= (text_.size() + 1) / 2 / numbers_per_row;
}

std::string_view TextCursor::next_word() {
  const std::string_view word = take_word(text_);
  if (word.empty()) {
    throw FormatError("ends before its data does");
  }
  return word;
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) {
    throw FormatError("ends inside its header");
  }
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return line;
}

std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kSpace));
  text.remove_prefix(word.size());
  return word;
}

double parse_number(std::string_view word) {
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    throw FormatError(quoted(word) + " is not a number");
  }
  return error == std::errc() ? value : std::numeric_limits<double>::quiet_NaN();
}

std::uint64_t parse_count(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    throw FormatError(quoted(word) + " is not a count");
  }
  return value;
}

}  // namespace voxlist::io
