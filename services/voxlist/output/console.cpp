#include "services/voxlist/output/console.h"

#include <ostream>

namespace voxlist::desk {

void Console::say(const std::string& line) {
  erase();
  out_ << line << std::endl;
}

void Console::warn(const std::string& line) {
  erase();
  err_ << "voxlist: " << line << std::endl;
}

void Console::draw(const std::string& line) {
  constexpr auto kEraseToEnd = "\x1b[K";
  err_ << '\r' << line << kEraseToEnd << std::flush;
  drawn_ = true;
}

void Console::erase() {
  if (drawn_) draw("");
  if (drawn_) err_ << '\r' << std::flush;
  drawn_ = false;
}

}  // namespace voxlist::desk
