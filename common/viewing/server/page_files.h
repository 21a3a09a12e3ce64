#pragma once

#include <span>
#include <string_view>

namespace voxlist::viewing {

/// One file of the page, which is part of the program.
struct PageFile {
  std::string_view path;  ///< "/" is the page itself
  std::string_view type;  ///< as HTTP names it
  std::string_view text;
};

/// All of viewing/page; the build makes the table of them.
std::span<const PageFile> page_files();

/// The file of a path; null where there is none.
const PageFile* find_page_file(std::string_view path);

}  // namespace voxlist::viewing
