#include "voxlist/foreign/mcap/records.h"

#include <zlib.h>

namespace voxlist::foreign {

void put_text(std::string_view text, std::string& to) {
  put(static_cast<std::uint32_t>(text.size()), to);
  to += text;
}

void put_bytes(std::string_view bytes, std::string& to) {
  put(static_cast<std::uint64_t>(bytes.size()), to);
  to += bytes;
}

void put_record(Op op, std::string_view content, std::string& to) {
  to += static_cast<char>(op);
  put_bytes(content, to);
}

std::string content_of(std::uint16_t id, const McapSchema& schema) {
  std::string content;
  put(id, content);
  put_text(schema.name, content);
  put_text(schema.encoding, content);
  put_text(schema.data, content);
  return content;
}

std::string content_of(std::uint16_t id, const McapChannel& channel) {
  std::string content;
  put(id, content);
  put(channel.schema, content);
  put_text(channel.topic, content);
  put_text(channel.encoding, content);
  put_text({}, content);  // a map of metadata: none
  return content;
}

std::uint32_t crc_of(std::string_view bytes, std::uint32_t before) {
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(before, data, bytes.size()));
}

}  // namespace voxlist::foreign
