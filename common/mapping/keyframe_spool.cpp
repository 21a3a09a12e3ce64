#include "voxlist/mapping/keyframe_spool.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_format.h"
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
  const std::string header = file_header(kNoMap);
  if (file_.get() < 0 || !write_all(file_.get(), header))
    throw io::FileError(folder_, std::string("cannot be written: ") + std::strerror(errno));
  stored_.emplace("/proc/self/fd/" + std::to_string(file_.get()), std::vector<KeyframePlace>{});
  bytes_ = header.size();
}

std::size_t KeyframeSpool::add(const Keyframe& keyframe) {
  const std::lock_guard lock(mutex_);
  const std::size_t index = stored_->size();
  const std::string record = encode_record(keyframe, kNoMap, static_cast<std::uint32_t>(index));
  if (!write_all(file_.get(), record))
    throw io::FileError(folder_, std::string("cannot keep a keyframe: ") + std::strerror(errno));
  stored_->add({bytes_, record.size()});
  bytes_ += record.size();
  return index;
}

Keyframe KeyframeSpool::read(const SpooledKeyframe& keyframe) {
  const std::lock_guard lock(mutex_);
  auto found = stored_->read(keyframe.index);
  if (!found) throw io::FileError(folder_, "the disk lost keyframes while the map was made");
  found->T_map_base = keyframe.T_map_base;
  return std::move(*found);
}

void KeyframeSpool::write(const std::filesystem::path& file, std::int64_t map_id,
                          const std::vector<SpooledKeyframe>& keyframes) {
  NewKeyframeFile whole(file, map_id);
  for (const SpooledKeyframe& keyframe : keyframes) whole.add(read(keyframe));
  whole.commit();
}

}  // namespace voxlist::mapping
