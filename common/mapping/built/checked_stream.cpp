#include "voxlist/mapping/built/checked_stream.h"

#include <algorithm>
#include <bit>

#include "voxlist/io/files/cursor.h"
#include "voxlist/mapping/keyframe_format.h"

namespace voxlist::mapping {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;
constexpr std::size_t kWordsAtOnce = 8;

struct PieceHeader {
  std::uint32_t bytes = 0, checksum = 0;
};

}  // namespace

void CheckedWriter::put_words(std::span<const std::uint64_t> words) {
  for (std::size_t first = 0; first < words.size(); first += kWordsAtOnce) {
    const auto some = words.subspan(first, std::min(kWordsAtOnce, words.size() - first));
    unsigned set = 0;
    for (std::size_t i = 0; i < some.size(); ++i) set |= unsigned{some[i] != 0} << i;
    put(static_cast<std::uint8_t>(set));
    for (const std::uint64_t word : some)
      if (word != 0) put(word);
  }
}

void CheckedWriter::end_item() {
  if (bytes_.size() >= kPiece) write_piece();
}

void CheckedWriter::finish() {
  if (!bytes_.empty()) write_piece();
  write_piece();
}

void CheckedWriter::write_piece() {
  const PieceHeader header{static_cast<std::uint32_t>(bytes_.size()), checksum_of(bytes_)};
  file_.write({reinterpret_cast<const char*>(&header), sizeof header});
  file_.write(bytes_);
  bytes_.clear();
}

void CheckedReader::take_words(std::span<std::uint64_t> words) {
  for (std::size_t first = 0; first < words.size(); first += kWordsAtOnce) {
    const auto some = words.subspan(first, std::min(kWordsAtOnce, words.size() - first));
    const unsigned set = take<std::uint8_t>();
    for (std::size_t i = 0; i < some.size(); ++i)
      some[i] = (set >> i & 1U) != 0 ? take<std::uint64_t>() : 0;
  }
}

void CheckedReader::end() {
  if (piece_.empty()) next_piece();
  if (!piece_.empty() || position_ != file_.size()) throw io::FormatError("has more than a map");
}

std::string_view CheckedReader::take_bytes(std::size_t count) {
  if (piece_.empty()) next_piece();
  if (piece_.size() < count) throw io::FormatError("ends early");
  const std::string_view bytes = piece_.substr(0, count);
  piece_.remove_prefix(count);
  return bytes;
}

void CheckedReader::next_piece() {
  const std::string_view head = file_.at(position_, sizeof(PieceHeader));
  if (head.size() < sizeof(PieceHeader)) throw io::FormatError("ends early");
  PieceHeader header;
  std::memcpy(&header, head.data(), sizeof header);
  piece_ = file_.at(position_ + sizeof header, header.bytes);
  if (piece_.size() < header.bytes || checksum_of(piece_) != header.checksum)
    throw io::FormatError("is torn");
  position_ += sizeof header + header.bytes;
}

}  // namespace voxlist::mapping
