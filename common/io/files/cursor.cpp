#include "voxlist/io/files/cursor.h"

#include <fmt/core.h>

#include <algorithm>
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

std::uint64_t count_words(std::string_view text) {
  std::uint64_t count = 0;
  while (!take_word(text).empty()) ++count;
  return count;
}

// What the C library of old Windows prints: 1.#QNAN, -1.#IND00, 1.#INF.
bool is_windows_nan(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  return word.starts_with("1.#");
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

void BinaryCursor::end() const {
  const auto is_filling = [](char c) { return c == '\0' || kSpace.find(c) != kSpace.npos; };
  if (!std::ranges::all_of(bytes_, is_filling)) {
    throw FormatError(fmt::format("has {} bytes more than its header announces", bytes_.size()));
  }
}

double TextCursor::next(Scalar) {
  const std::string_view word = next_word();
  try {
    return parse_number(word);
  } catch (const FormatError& error) {
    throw FormatError(fmt::format("line {}: {}", line_, error.what()));
  }
}

void TextCursor::skip(Scalar, std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    next_word();
  }
}

bool TextCursor::can_hold(std::uint64_t rows, std::uint64_t, std::uint64_t numbers_per_row) const {
  // A number takes a digit and a separator, which the last one may lack.
  return numbers_per_row == 0 || rows <= (text_.size() + 1) / 2 / numbers_per_row;
}

void TextCursor::begin_row(std::uint64_t numbers) {
  wanted_ = numbers;
  taken_ = 0;
  if (!take_next_line()) throw FormatError("ends before its data does");
}

void TextCursor::end_row() {
  if (const std::uint64_t more = count_words(row_); more > 0) refuse_row(taken_ + more);
}

void TextCursor::end() {
  if (take_next_line()) {
    throw FormatError(fmt::format("line {} comes after the last row announced", line_));
  }
}

std::string_view TextCursor::next_word() {
  const std::string_view word = take_word(row_);
  if (word.empty()) refuse_row(taken_);
  ++taken_;
  return word;
}

// The next line that is not blank.
bool TextCursor::take_next_line() {
  while (!text_.empty()) {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    row_ = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    line_ = next_line_++;
    if (row_.find_first_not_of(kSpace) != row_.npos) return true;
  }
  return false;
}

void TextCursor::refuse_row(std::uint64_t numbers) const {
  if (wanted_ > 0) {
    throw FormatError(fmt::format("line {} has {} numbers instead of {}", line_, numbers, wanted_));
  }
  throw FormatError(
      fmt::format("line {} has {} numbers, more or fewer than its lists say", line_, numbers));
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
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
  if (is_windows_nan(word)) return std::numeric_limits<double>::quiet_NaN();
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
