#include "voxlist/io/files/file_kind.h"

#include <array>

#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

using namespace std::string_view_literals;

struct Kind {
  std::string_view start;
  const char* what;
};

constexpr auto kWebPage = "is a web page: download the file itself";
constexpr auto kUtf16 = "is UTF-16 text, save it as UTF-8";
constexpr auto kBag = "is a ROS bag, export its clouds to PCD files (one scan a file)";

constexpr std::array kKinds = {
    Kind{"\x1f\x8b"sv, "is compressed (gzip), unpack it first"},
    Kind{"BZh"sv, "is compressed (bzip2), unpack it first"},
    Kind{"\xfd\x37zXZ"sv, "is compressed (xz), unpack it first"},
    Kind{"\x28\xb5\x2f\xfd"sv, "is compressed (zstd), unpack it first"},
    Kind{"PK\x03\x04"sv, "is a ZIP archive (or a spreadsheet), unpack or export it first"},
    Kind{"7z\xbc\xaf"sv, "is a 7z archive, unpack it first"},
    Kind{"#ROSBAG"sv, kBag},
    Kind{"\x89MCAP"sv, kBag},
    Kind{"SQLite format 3"sv, "is a database: of a ROS 2 bag, export its clouds to PCD files"},
    Kind{"LASF"sv, "is a LAS file, convert it to PLY or PCD"},
    Kind{"# Octomap"sv, "is an OctoMap, not a scan"},
    Kind{"<!DOCTYPE"sv, kWebPage},
    Kind{"<html"sv, kWebPage},
    Kind{"version https://git-lfs"sv, "is a pointer of git-lfs: git lfs pull fetches the file"},
    Kind{"/annex/objects"sv, "is a pointer of git-annex: git annex get fetches the file"},
    Kind{"\xff\xfe"sv, kUtf16},
    Kind{"\xfe\xff"sv, kUtf16},
};

}  // namespace

std::string what_it_is(std::string_view first_bytes) {
  for (const Kind& kind : kKinds)
    if (first_bytes.starts_with(kind.start)) return kind.what;
  return {};
}

std::string_view without_mark(std::string_view bytes) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (bytes.starts_with(kMark)) bytes.remove_prefix(kMark.size());
  return bytes;
}

std::string read_text(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  if (const std::string what = what_it_is(bytes); !what.empty()) throw FileError(path, what);
  return std::string(without_mark(bytes)) + "\n";
}

}  // namespace voxlist::io
