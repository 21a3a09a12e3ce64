#include "services/voxlist/output/console.h"

#include <ostream>

namespace voxlist::desk {
namespace {

// What steers a terminal (ECMA-48, and DEC's private modes).
constexpr auto kEraseToEnd = "\x1b[K";
constexpr auto kEraseBelow = "\x1b[J";
constexpr auto kCutLongLines = "\x1b[?7l";
constexpr auto kBreakLongLines = "\x1b[?7h";

}  // namespace

void Console::say(const std::string& line) {
  erase();
  out_ << line << std::endl;
}

void Console::warn(const std::string& line) {
  erase();
  err_ << "voxlist: " << line << std::endl;
}

void Console::draw(const std::string& line) {
  err_ << '\r' << line << kEraseToEnd << std::flush;
  drawn_ = true;
}

void Console::show(const std::vector<std::string>& lines) {
  if (!terminal_) {
    for (const std::string& line : lines) warn(line);
    return;
  }
  erase();
  // A line that is too long is cut: broken in two it would not be found again.
  err_ << kCutLongLines;
  for (const std::string& line : lines) err_ << line << '\n';
  err_ << kBreakLongLines << std::flush;
  lines_above_ = lines.size();
}

void Console::erase() {
  if (lines_above_ > 0) err_ << "\x1b[" << lines_above_ << 'A' << kEraseBelow << std::flush;
  lines_above_ = 0;
  if (drawn_) draw("");
  if (drawn_) err_ << '\r' << std::flush;
  drawn_ = false;
}

}  // namespace voxlist::desk
