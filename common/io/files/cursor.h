#pragma once

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "voxlist/io/files/scalar.h"

namespace voxlist::io {

/// What is wrong with a file's content; readers that know the path turn it into a FileError.
class FormatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads numbers one after the other from binary data. Past the end: FormatError.
class BinaryCursor {
 public:
  BinaryCursor(std::string_view bytes, std::endian order) : bytes_(bytes), order_(order) {}

  double next(Scalar type);
  void skip(Scalar type, std::uint64_t count);

  /// Whether `rows` rows with these many bytes of numbers, in so many numbers, may still come.
  bool can_hold(std::uint64_t rows, std::uint64_t bytes_per_row,
                std::uint64_t numbers_per_row) const;

 private:
  std::string_view bytes_;
  std::endian order_;
};

/// The same for numbers written out as text between white space. What is no number: FormatError.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : text_(text) {}

  double next(Scalar type);
  void skip(Scalar type, std::uint64_t count);
  bool can_hold(std::uint64_t rows, std::uint64_t bytes_per_row,
                std::uint64_t numbers_per_row) const;

 private:
  std::string_view next_word();

  std::string_view text_;
};

/// Takes the first line, without its end (LF or CRLF), off the text. FormatError when there is no
/// line end.
std::string_view take_line(std::string_view& text);

/// Takes the first word off the text; empty when only white space is left.
std::string_view take_word(std::string_view& text);

/// The number that the whole word is (nan and inf included; NaN too when out of range). Otherwise
/// FormatError.
double parse_number(std::string_view word);

/// The count that the whole word is. Otherwise FormatError.
std::uint64_t parse_count(std::string_view word);

}  // namespace voxlist::io
