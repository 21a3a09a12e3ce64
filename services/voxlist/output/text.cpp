#include "services/voxlist/output/text.h"

#include <cstdlib>
#include <iomanip>
#include <sstream>

namespace voxlist::desk {

std::string fixed(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string padded(const std::string& text, int width) {
  std::ostringstream out;
  out << (width < 0 ? std::left : std::right) << std::setw(std::abs(width)) << text;
  return out.str();
}

}  // namespace voxlist::desk
