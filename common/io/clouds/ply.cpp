#include "voxlist/io/clouds/ply.h"

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
  std::string_view format;
  std::vector<Element> elements;
};

Scalar take_type(std::string_view& line) {
  const std::string_view name = take_word(line);
  if (const auto type = ply_scalar(name)) {
    return *type;
  }
  throw FormatError("has a property of an unknown type");
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

Header take_header(std::string_view& bytes) {
  Header header;
  if (take_line(bytes) != "ply") {
    throw FormatError("does not start as a PLY file");
  }
  while (true) {
    std::string_view line = take_line(bytes);
    const std::string_view key = take_word(line);
    if (key == "end_header") {
      return header;
    } else if (key == "format") {
      header.format = take_word(line);
    } else if (key == "element") {
      const std::string_view name = take_word(line);
      header.elements.push_back({std::string(name), parse_count(take_word(line)), {}});
    } else if (key == "property") {
      if (header.elements.empty()) {
        throw FormatError("has a property before the first element");
      }
      header.elements.back().properties.push_back(parse_property(line));
    } else if (key != "comment" && key != "obj_info" && !key.empty()) {
      throw FormatError("has an unknown line in its header");
    }
  }
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
    for (const Property& property : element.properties) {
      skip_property(property, cursor);
    }
  }
}

PointRows point_rows(const Element& vertex) {
  std::vector<std::string> names;
  for (const Property& property : vertex.properties) {
    names.push_back(property.length_type ? "" : property.name);
  }
  return PointRows(names);
}

template <typename Cursor>
Cloud read_vertices(const Element& vertex, Cursor& cursor) {
  PointRows rows = point_rows(vertex);
  check_size(vertex, cursor);
  rows.reserve(vertex.rows);
  for (std::uint64_t row = 0; row < vertex.rows; ++row) {
    for (std::size_t column = 0; column < vertex.properties.size(); ++column) {
      if (rows.wants(column)) {
        rows.set(column, cursor.next(vertex.properties[column].type));
      } else {
        skip_property(vertex.properties[column], cursor);
      }
    }
    rows.finish_row();
  }
  return rows.take();
}

template <typename Cursor>
Cloud read_body(const Header& header, Cursor cursor) {
  for (const Element& element : header.elements) {
    if (element.name == "vertex") {
      return read_vertices(element, cursor);
    }
    skip_element(element, cursor);
  }
  throw FormatError("has no vertex element");
}

}  // namespace

Cloud parse_ply(std::string_view bytes) {
  const Header header = take_header(bytes);
  if (header.format == "ascii") {
    return read_body(header, TextCursor(bytes));
  }
  if (header.format == "binary_little_endian") {
    return read_body(header, BinaryCursor(bytes, std::endian::little));
  }
  if (header.format == "binary_big_endian") {
    return read_body(header, BinaryCursor(bytes, std::endian::big));
  }
  throw FormatError("has no format that is known");
}

}  // namespace voxlist::io
