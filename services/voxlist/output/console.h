#pragma once

#include <iosfwd>
#include <string>

namespace voxlist::desk {

/// Where the tool speaks: results on `out`, progress and warnings on `err`.
class Console {
 public:
  /// `terminal`: a person looks at `err`, so progress may be drawn over itself.
  Console(std::ostream& out, std::ostream& err, bool terminal)
      : out_(out), err_(err), terminal_(terminal) {}

  bool terminal() const { return terminal_; }

  /// A line of the result.
  void say(const std::string& line);

  /// A line about what is not as it should be, or about what goes on.
  void warn(const std::string& line);

  /// Draws a line that the next one replaces. Only on a terminal.
  void draw(const std::string& line);

  /// Takes the drawn line away.
  void erase();

 private:
  std::ostream& out_;
  std::ostream& err_;
  const bool terminal_;
  bool drawn_ = false;
};

}  // namespace voxlist::desk
