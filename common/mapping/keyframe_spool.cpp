#include "voxlist/mapping/keyframe_spool.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_format.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/keyframe_writer.h"

namespace voxlist::mapping {
namespace {

constexpr std::int64_t kNoMap = 0;

// Not every file system has files without a name; there one is made and its name taken away.
int open_nameless(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  std::string name = folder / "keyframes.XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

KeyframeSpool::KeyframeSpool(const std::filesystem::path& folder)
    : folder_(folder), file_(open_nameless(folder)) {
  if (file_.get() < 0 || !write_all(file_.get(), file_header(kNoMap)))
    throw io::FileError(folder_, std::string("cannot be written: ") + std::strerror(errno));
}

void KeyframeSpool::add(const Keyframe& keyframe) {
  if (!write_all(file_.get(), encode_record(keyframe, kNoMap, number_++)))
    throw io::FileError(folder_, std::string("cannot keep a keyframe: ") + std::strerror(errno));
}

void KeyframeSpool::write(const std::filesystem::path& file, std::int64_t map_id) const {
  KeyframeReader reader("/proc/self/fd/" + std::to_string(file_.get()));
  NewKeyframeFile whole(file, map_id);
  while (const auto keyframe = reader.next()) whole.add(*keyframe);
  if (reader.next_number() != number_)
    throw io::FileError(folder_, "the disk lost keyframes while the map was made");
  whole.commit();
}

}  // namespace voxlist::mapping
