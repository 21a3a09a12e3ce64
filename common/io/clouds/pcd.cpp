#include "voxlist/io/clouds/pcd.h"

#include <fmt/core.h>
#include <lzf.h>

#include <cctype>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/io/clouds/point_rows.h"
#include "voxlist/io/files/cursor.h"

namespace voxlist::io {
namespace {

struct Field {
  std::string name;
  Scalar type;
  std::uint64_t count;

  bool is_padding() const { return name == "_"; }
};

struct Header {
  std::vector<Field> fields;
  std::uint64_t points;
  std::string encoding;
  std::size_t lines;  // of the header
};

using Words = std::vector<std::string>;
using Entries = std::map<std::string, Words, std::less<>>;

// PCL's own limit on COUNT is 32 bits; histograms of a few hundred are what is seen.
constexpr std::uint64_t kMaxCount = 1u << 20;

// Keywords in any case; COLUMNS is what FIELDS was called once.
std::string plain_key(std::string_view word) {
  const std::string key = lower_case(word);
  return key == "columns" ? "fields" : key;
}

Entries take_entries(std::string_view& bytes, std::size_t& lines) {
  Entries entries;
  while (!entries.contains("data")) {
    std::string_view line = take_line(bytes);
    ++lines;
    const std::string key = plain_key(take_word(line));
    if (key.empty() || key.starts_with('#')) {
      continue;
    }
    Words words;
    for (auto word = take_word(line); !word.empty(); word = take_word(line)) {
      words.emplace_back(word);
    }
    if (!entries.emplace(key, words).second) {
      throw FormatError("has a header line twice");
    }
  }
  return entries;
}

std::string upper_case(std::string_view key) {
  std::string upper(key);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

const Words& words_of(const Entries& entries, std::string_view key, std::size_t expected) {
  const auto found = entries.find(key);
  if (found == entries.end() || found->second.size() != expected) {
    throw FormatError(
        fmt::format("its header line {} is missing or of the wrong length", upper_case(key)));
  }
  return found->second;
}

std::vector<Field> parse_fields(const Entries& entries) {
  const auto names = entries.find("fields");
  const std::size_t n = names == entries.end() ? 0 : names->second.size();
  const Words& sizes = words_of(entries, "size", n);
  const Words& types = words_of(entries, "type", n);
  const Words counts = entries.contains("count") ? words_of(entries, "count", n) : Words(n, "1");
  std::vector<Field> fields;
  for (std::size_t i = 0; i < n; ++i) {
    const auto type = pcd_scalar(types[i], parse_count(sizes[i]));
    const std::uint64_t count = parse_count(counts[i]);
    if (!type || count > kMaxCount) {
      throw FormatError("has a field of an unknown type or an impossible count");
    }
    fields.push_back({names->second[i], *type, count});
  }
  return fields;
}

std::uint64_t parse_points(const Entries& entries) {
  const bool has_points = entries.contains("points");
  if (!has_points || entries.contains("width") || entries.contains("height")) {
    std::uint64_t area = 0;
    if (__builtin_mul_overflow(parse_count(words_of(entries, "width", 1)[0]),
                               parse_count(words_of(entries, "height", 1)[0]), &area) ||
        (has_points && parse_count(words_of(entries, "points", 1)[0]) != area)) {
      throw FormatError("its WIDTH times HEIGHT is not its POINTS");
    }
    return area;
  }
  return parse_count(words_of(entries, "points", 1)[0]);
}

Header take_header(std::string_view& bytes) {
  std::size_t lines = 0;
  const Entries entries = take_entries(bytes, lines);
  return {parse_fields(entries), parse_points(entries), lower_case(words_of(entries, "data", 1)[0]),
          lines};
}

std::uint64_t bytes_per_point(const std::vector<Field>& fields) {
  std::uint64_t bytes = 0;
  for (const Field& field : fields) {
    bytes += field.count * size_of(field.type);
  }
  return bytes;
}

std::uint64_t numbers_per_point(const std::vector<Field>& fields) {
  std::uint64_t numbers = 0;
  for (const Field& field : fields) {
    numbers += field.count;
  }
  return numbers;
}

// Further columns are numbers, one a point.
bool may_be_taken(const Field& field) {
  return PointRows::is_point_column(field.name) || (field.count == 1 && !field.is_padding());
}

PointRows point_rows(const std::vector<Field>& fields, FurtherColumns* further) {
  std::vector<std::string> names;
  for (const Field& field : fields) {
    names.push_back(may_be_taken(field) ? field.name : "");
  }
  PointRows rows(names, further);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (rows.wants(i) && fields[i].count != 1) {
      throw FormatError(fmt::format("its field {} does not have COUNT 1", names[i]));
    }
    if (size_of(fields[i].type) == sizeof(double)) rows.count_from_first(i);
  }
  return rows;
}

template <typename Cursor>
Cloud read_rows(const Header& header, Cursor cursor, FurtherColumns* further) {
  PointRows rows = point_rows(header.fields, further);
  if (!cursor.can_hold(header.points, bytes_per_point(header.fields),
                       numbers_per_point(header.fields))) {
    throw FormatError("announces more points than it has");
  }
  rows.reserve(header.points);
  const std::uint64_t numbers = numbers_per_point(header.fields);
  for (std::uint64_t point = 0; point < header.points; ++point) {
    cursor.begin_row(numbers);
    for (std::size_t i = 0; i < header.fields.size(); ++i) {
      if (rows.wants(i)) {
        rows.set(i, cursor.next(header.fields[i].type));
      } else {
        cursor.skip(header.fields[i].type, header.fields[i].count);
      }
    }
    cursor.end_row();
    rows.finish_row();
  }
  cursor.end();
  return rows.take();
}

bool is_size_of(std::uint64_t size, const Header& header) {
  std::uint64_t expected = 0;
  return !__builtin_mul_overflow(header.points, bytes_per_point(header.fields), &expected) &&
         size == expected;
}

// Compressed data is one column after the other: all x, then all y, ...
Cloud read_columns(const Header& header, std::string_view data, FurtherColumns* further) {
  PointRows rows = point_rows(header.fields, further);
  std::vector<BinaryCursor> columns;
  for (const Field& field : header.fields) {
    const std::uint64_t bytes = header.points * field.count * size_of(field.type);
    columns.emplace_back(data.substr(0, bytes), std::endian::little);
    data.remove_prefix(bytes);
  }
  rows.reserve(header.points);
  for (std::uint64_t point = 0; point < header.points; ++point) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (rows.wants(i)) {
        rows.set(i, columns[i].next(header.fields[i].type));
      }
    }
    rows.finish_row();
  }
  return rows.take();
}

// Unpacks LZF into exactly `size` bytes. Before that many are allocated, `packed` must be long
// enough: at best, LZF repeats 264 bytes for each 3 of its own.
std::string unpack(std::string_view packed, std::uint32_t size) {
  constexpr std::uint32_t kMaxRatio = 264 / 3;
  std::string columns;
  if (size == 0 && packed.empty()) {
    return columns;
  }
  if (!packed.empty() && size / kMaxRatio <= packed.size()) {
    columns.resize(size);
    const auto packed_size = static_cast<std::uint32_t>(packed.size());
    const auto unpacked = lzf_decompress(packed.data(), packed_size, columns.data(), size);
    if (unpacked > 0 && unpacked == size) {
      return columns;
    }
  }
  throw FormatError("has damaged compressed data");
}

Cloud read_compressed(Header header, std::string_view bytes, FurtherColumns* further) {
  BinaryCursor sizes(bytes, std::endian::little);
  const auto packed_size = static_cast<std::uint32_t>(sizes.next(Scalar::kUint32));
  const auto size = static_cast<std::uint32_t>(sizes.next(Scalar::kUint32));
  bytes.remove_prefix(8);
  // PCL announces padding but leaves it out of compressed data; others keep it. The size tells.
  if (!is_size_of(size, header)) {
    std::erase_if(header.fields, [](const Field& field) { return field.is_padding(); });
  }
  if (packed_size > bytes.size() || !is_size_of(size, header)) {
    throw FormatError("announces more or fewer points than it has");
  }
  BinaryCursor(bytes.substr(packed_size), std::endian::little).end();
  return read_columns(header, unpack(bytes.substr(0, packed_size), size), further);
}

}  // namespace

Cloud parse_pcd(std::string_view bytes, FurtherColumns* further) {
  const Header header = take_header(bytes);
  if (header.encoding == "ascii") {
    return read_rows(header, TextCursor(bytes, header.lines + 1), further);
  }
  if (header.encoding == "binary") {
    return read_rows(header, BinaryCursor(bytes, std::endian::little), further);
  }
  if (header.encoding == "binary_compressed") {
    return read_compressed(header, bytes, further);
  }
  throw FormatError("its DATA is none of ascii, binary and binary_compressed");
}

}  // namespace voxlist::io
