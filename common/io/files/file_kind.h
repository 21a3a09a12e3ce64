#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace voxlist::io {

/// What a file is that was taken for another, by its first bytes, and what to do: "is compressed
/// (gzip), unpack it first". Empty where they tell nothing.
std::string what_it_is(std::string_view first_bytes);

/// The bytes without the mark with which some programs begin a text (UTF-8).
std::string_view without_mark(std::string_view bytes);

/// The text of a file, ended by a line end, without such a mark. Throws FileError as read_file, and
/// when it is no text: compressed, or UTF-16.
std::string read_text(const std::filesystem::path& path);

}  // namespace voxlist::io
