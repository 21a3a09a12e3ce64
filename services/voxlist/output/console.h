#pragma once

#include <iosfwd>
#include <string>
#include <vector>

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

  /// Lines about how it is now. On a terminal the next ones replace them; elsewhere each is told as
  /// by warn().
  void show(const std::vector<std::string>& lines);

  /// Takes what was drawn away.
  void erase();

 private:
  std::ostream& out_;
  std::ostream& err_;
  const bool terminal_;
  bool drawn_ = false;
  std::size_t lines_above_ = 0;  // of those shown, above the cursor
};

}  // namespace voxlist::desk
