#include "voxlist/mapping/keyframe_writer.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_format.h"

namespace voxlist::mapping {
namespace {

[[noreturn]] void fail(const char* doing) {
  throw std::runtime_error(fmt::format("{}: {}", doing, std::strerror(errno)));
}

struct stat info_of(int file) {
  struct stat info {};
  if (::fstat(file, &info) != 0) fail("cannot be looked at");
  return info;
}

KeyframePlace place_of(std::string_view record, std::uint64_t start) {
  return {start, record.size(), parse_record_header(record)->payload_checksum};
}

}  // namespace

NewKeyframeFile::NewKeyframeFile(const std::filesystem::path& file, std::int64_t map_id)
    : file_(file), map_id_(map_id) {
  file_.write(file_header(map_id));
}

KeyframePlace NewKeyframeFile::add(const Keyframe& keyframe) {
  const std::string record = encode_record(keyframe, map_id_, number_++);
  file_.write(record);
  const KeyframePlace place = place_of(record, bytes_);
  bytes_ += record.size();
  return place;
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

KeyframeWriter::KeyframeWriter(const std::filesystem::path& file, std::int64_t map_id,
                               std::uint32_t next_number)
    : path_(file),
      file_(::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC)),
      map_id_(map_id),
      next_number_(next_number) {
  if (file_.get() < 0)
    throw io::FileError(path_, std::string("cannot be opened: ") + std::strerror(errno));
  size_ = info_of(file_.get()).st_size;
}

KeyframePlace KeyframeWriter::append(const Keyframe& keyframe) {
  const KeyframePlace place = append(encode_record(keyframe, map_id_, next_number_));
  ++next_number_;
  return place;
}

void KeyframeWriter::append_moved(std::int64_t moves) {
  append(encode_moved(moves, map_id_, next_number_));
}

// What failed is cut off again. Where even that fails, a torn record stays, which the reader steps
// over. After a failed sync the system may have dropped what was written, so that goes, too.
KeyframePlace KeyframeWriter::append(const std::string& record) try {
  const std::int64_t before = info_of(file_.get()).st_size;
  try {
    if (!write_all(file_.get(), record)) fail("cannot write a keyframe");
    if (::fdatasync(file_.get()) != 0) fail("cannot bring a keyframe to the disk");
  } catch (const std::runtime_error&) {
    [[maybe_unused]] const int torn = ::ftruncate(file_.get(), before);
    throw;
  }
  size_ = info_of(file_.get()).st_size;
  return place_of(record, static_cast<std::uint64_t>(before));
} catch (const std::runtime_error& failure) {
  throw io::FileError(path_, failure.what() + std::string("; the keyframes before it are safe"));
}

bool KeyframeWriter::is_in_place() const {
  struct stat there {
  }, mine{};
  if (::stat(path_.c_str(), &there) != 0 || ::fstat(file_.get(), &mine) != 0) return false;
  return there.st_dev == mine.st_dev && there.st_ino == mine.st_ino && mine.st_size >= size_;
}

}  // namespace voxlist::mapping
