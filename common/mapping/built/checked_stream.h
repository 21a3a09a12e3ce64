#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file_window.h"

namespace voxlist::mapping {

/// Writes values as memory lies, in pieces of about 1 MiB: a piece's bytes and their CRC-32 (uint32
/// each), then the bytes; at the end a piece without bytes.
class CheckedWriter {
 public:
  explicit CheckedWriter(io::AtomicFile& file) : file_(file) {}

  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  /// Eight at a time, without those that are 0: surfaces and rays fill few words of a block.
  void put_words(std::span<const std::uint64_t> words);

  /// A piece may end here. Throws FileError, as all that write.
  void end_item();

  void finish();

 private:
  void write_piece();

  io::AtomicFile& file_;
  std::string bytes_;
};

/// Reads what a CheckedWriter wrote, in the same order. What is torn, flipped or missing is a
/// FormatError; a disk that cannot be read is a FileError.
class CheckedReader {
 public:
  explicit CheckedReader(io::FileWindow& file) : file_(file) {}

  template <class T>
  T take() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, take_bytes(sizeof value).data(), sizeof value);
    return value;
  }

  void take_words(std::span<std::uint64_t> words);

  /// Bytes of the whole file: no count in it can be larger.
  std::uint64_t size() const { return file_.size(); }

  /// Nothing may be left.
  void end();

 private:
  std::string_view take_bytes(std::size_t count);
  void next_piece();

  io::FileWindow& file_;
  std::uint64_t position_ = 0;
  std::string_view piece_;  // what is left of it
};

}  // namespace voxlist::mapping
