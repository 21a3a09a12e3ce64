#include "voxlist/io/files/keep_aside.h"

#include <unistd.h>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/files/file_window.h"

namespace voxlist::io {
namespace {

namespace fs = std::filesystem;

// Names that are tried: a folder with as many damaged files is not to be filled further.
constexpr int kNames = 10'000;

constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;

void copy_synced(const fs::path& from, const fs::path& to) {
  FileWindow in(from);
  AtomicFile out(to);
  for (std::uint64_t done = 0; done < in.size(); done += kPiece) out.write(in.at(done, kPiece));
  out.commit();
}

bool is_free(const fs::path& name) {
  std::error_code error;
  return fs::symlink_status(name, error).type() == fs::file_type::not_found;
}

}  // namespace

fs::path free_name(const fs::path& path, const std::string& ending) {
  for (int i = 1; i <= kNames; ++i) {
    fs::path name = path;
    name += ending + "-" + std::to_string(i);
    if (is_free(name)) return name;
  }
  throw FileError(path, "has too many " + ending + "-N beside it; move them away");
}

fs::path keep_aside(const fs::path& file, const std::string& ending) {
  fs::path name = file;
  name += ending;
  if (!is_free(name)) name = free_name(file, ending);
  if (::link(file.c_str(), name.c_str()) != 0) copy_synced(file, name);
  return name;
}

}  // namespace voxlist::io
