#pragma once

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
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

  /// Rows of binary data have no marks.
  void begin_row(std::uint64_t) {}
  void end_row() {}

  /// Nothing may be left but zeros (a page filled up by its writer) and white space.
  void end() const;

 private:
  std::string_view bytes_;
  std::endian order_;
};

/// The same for numbers written out as text between white space, a row a line; blank lines do not
/// count. What is no number, and a line with more or fewer of them than its row: FormatError with
/// the line.
class TextCursor {
 public:
  /// `line`: the number of the text's first line in its file.
  TextCursor(std::string_view text, std::size_t line) : text_(text), next_line_(line) {}

  double next(Scalar type);
  void skip(Scalar type, std::uint64_t count);
  bool can_hold(std::uint64_t rows, std::uint64_t bytes_per_row,
                std::uint64_t numbers_per_row) const;

  /// A row of so many numbers starts (0: as many as its lists tell), and is done.
  void begin_row(std::uint64_t numbers);
  void end_row();

  /// Nothing but white space may be left.
  void end();

 private:
  std::string_view next_word();
  bool take_next_line();
  [[noreturn]] void refuse_row(std::uint64_t numbers) const;

  std::string_view text_, row_;
  std::size_t next_line_, line_ = 0;
  std::uint64_t wanted_ = 0, taken_ = 0;
};

/// Takes the first line, without its end (LF or CRLF), off the text. FormatError when there is no
/// line end.
std::string_view take_line(std::string_view& text);

/// Lower case, of plain letters alone.
std::string lower_case(std::string_view text);

/// Takes the first word off the text; empty when only white space is left.
std::string_view take_word(std::string_view& text);

/// The number that the whole word is (nan and inf included, 1.#QNAN and 1.#INF of old Windows, too;
/// NaN when out of range). Otherwise FormatError.
double parse_number(std::string_view word);

/// The count that the whole word is. Otherwise FormatError.
std::uint64_t parse_count(std::string_view word);

}  // namespace voxlist::io
