#include "voxlist/io/clouds/ply.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/io/clouds/point_rows.h"
#include "voxlist/io/files/cursor.h"

namespace voxlist::io {
namespace {

struct Property {
  std::string name;
  Scalar type;
  std::optional<Scalar> length_type;  // set: a list
};

struct Element {
  std::string name;
  std::uint64_t rows;
  std::vector<Property> properties;
};

struct Header {
  std::string format;
  std::vector<Element> elements;
  std::size_t lines = 0;  // of the header
};

Scalar take_type(std::string_view& line) {
  const std::string name = lower_case(take_word(line));
  if (const auto type = ply_scalar(name)) {
    return *type;
  }
  throw FormatError(fmt::format("has a property of the type \"{}\", which is unknown", name));
}

Property parse_property(std::string_view line) {
  Property property;
  std::string_view rest = line;
  if (take_word(rest) == "list") {
    property.length_type = take_type(rest);
    line = rest;
  }
  property.type = take_type(line);
  property.name = take_word(line);
  return property;
}

void take_property(std::string_view line, Header& header) {
  if (header.elements.empty()) {
    throw FormatError("has a property before the first element");
  }
  header.elements.back().properties.push_back(parse_property(line));
}

// Takes a line of the header, keywords in any case. False at its end.
bool take_entry(std::string_view line, Header& header) {
  const std::string key = lower_case(take_word(line));
  if (key == "end_header") return false;
  if (key == "format") {
    header.format = lower_case(take_word(line));
  } else if (key == "element") {
    const std::string name = lower_case(take_word(line));
    header.elements.push_back({name, parse_count(take_word(line)), {}});
  } else if (key == "property") {
    take_property(line, header);
  } else if (key != "comment" && key != "obj_info" && !key.empty()) {
    throw FormatError(fmt::format("line {} of its header is unknown", header.lines));
  }
  return true;
}

Header take_header(std::string_view& bytes) {
  Header header;
  std::string_view magic = take_line(bytes);
  if (lower_case(take_word(magic)) != "ply" || !take_word(magic).empty()) {
    throw FormatError("does not start as a PLY file");
  }
  for (header.lines = 2; take_entry(take_line(bytes), header); ++header.lines) {
  }
  return header;
}

// How many numbers a row has; 0 when lists tell it.
std::uint64_t numbers_per_row(const Element& element) {
  const auto is_list = [](const Property& property) { return property.length_type.has_value(); };
  return std::ranges::any_of(element.properties, is_list) ? 0 : element.properties.size();
}

template <typename Cursor>
void check_size(const Element& element, const Cursor& cursor) {
  std::uint64_t bytes = 0;
  for (const Property& property : element.properties) {
    bytes += size_of(property.length_type.value_or(property.type));
  }
  if (!cursor.can_hold(element.rows, bytes, element.properties.size())) {
    throw FormatError("announces more data than it has");
  }
}

template <typename Cursor>
void skip_property(const Property& property, Cursor& cursor) {
  if (!property.length_type) {
    cursor.skip(property.type, 1);
    return;
  }
  const double length = cursor.next(*property.length_type);
  if (!(length >= 0.0 && length <= 4294967295.0) || length != std::floor(length)) {
    throw FormatError("has a list of an impossible length");
  }
  cursor.skip(property.type, static_cast<std::uint64_t>(length));
}

template <typename Cursor>
void skip_element(const Element& element, Cursor& cursor) {
  check_size(element, cursor);
  const std::uint64_t rows = element.properties.empty() ? 0 : element.rows;
  for (std::uint64_t row = 0; row < rows; ++row) {
    cursor.begin_row(numbers_per_row(element));
    for (const Property& property : element.properties) {
      skip_property(property, cursor);
    }
    cursor.end_row();
  }
}

PointRows point_rows(const Element& vertex, FurtherColumns* further) {
  std::vector<std::string> names;
  for (const Property& property : vertex.properties) {
    names.push_back(property.length_type ? "" : property.name);
  }
  PointRows rows(names, further);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (size_of(vertex.properties[i].type) == sizeof(double)) rows.count_from_first(i);
  return rows;
}

template <typename Cursor>
Cloud read_vertices(const Element& vertex, Cursor& cursor, FurtherColumns* further) {
  PointRows rows = point_rows(vertex, further);
  check_size(vertex, cursor);
  rows.reserve(vertex.rows);
  const std::uint64_t numbers = numbers_per_row(vertex);
  for (std::uint64_t row = 0; row < vertex.rows; ++row) {
    cursor.begin_row(numbers);
    for (std::size_t column = 0; column < vertex.properties.size(); ++column) {
      if (rows.wants(column)) {
        rows.set(column, cursor.next(vertex.properties[column].type));
      } else {
        skip_property(vertex.properties[column], cursor);
      }
    }
    cursor.end_row();
    rows.finish_row();
  }
  return rows.take();
}

// Elements after the vertices are read, too: what is left over then was announced by nobody.
template <typename Cursor>
Cloud read_body(const Header& header, Cursor cursor, FurtherColumns* further) {
  std::optional<Cloud> cloud;
  for (const Element& element : header.elements) {
    if (element.name == "vertex" && !cloud) {
      cloud = read_vertices(element, cursor, further);
    } else {
      skip_element(element, cursor);
    }
  }
  if (!cloud) throw FormatError("has no vertex element");
  cursor.end();
  return *std::move(cloud);
}

}  // namespace

Cloud parse_ply(std::string_view bytes, FurtherColumns* further) {
  const Header header = take_header(bytes);
  if (header.format == "ascii") {
    return read_body(header, TextCursor(bytes, header.lines + 1), further);
  }
  if (header.format == "binary_little_endian") {
    return read_body(header, BinaryCursor(bytes, std::endian::little), further);
  }
  if (header.format == "binary_big_endian") {
    return read_body(header, BinaryCursor(bytes, std::endian::big), further);
  }
  throw FormatError("has no format that is known");
}

}  // namespace voxlist::io
