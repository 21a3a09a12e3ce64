#include "tests/io/files/damage.h"

#include <algorithm>
#include <array>

namespace voxlist::test {

std::string Damage::operator()(const std::string& valid) {
  std::string bytes = valid;
  for (std::size_t times = 1 + below(3); times > 0; --times) {
    damage_once(bytes);
  }
  return bytes;
}

void Damage::damage_once(std::string& bytes) {
  const std::size_t at = below(bytes.size());
  const std::size_t length = std::min(1 + below(64), bytes.size() - at);
  switch (below(8)) {
    case 0:
      bytes.resize(at);
      break;
    case 1:
      for (std::size_t i = 0; i < std::min<std::size_t>(bytes.size(), 1 + below(16)); ++i) {
        bytes[below(bytes.size())] = any_byte();
      }
      break;
    case 2:
      std::generate_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length,
                      [this] { return any_byte(); });
      break;
    case 3:
      bytes.erase(at, length);
      break;
    case 4:
      bytes.insert(at, bytes.substr(below(bytes.size()), length));
      break;
    case 5: {
      const std::size_t line = std::min(bytes.find('\n', at), bytes.size());
      bytes.insert(line, bytes.substr(at, line - at));
      break;
    }
    case 6:
      bytes.resize(below(2048));
      std::generate(bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size() + 1)),
                    bytes.end(), [this] { return any_byte(); });
      break;
    default:
      change_number(bytes);
  }
}

void Damage::change_number(std::string& bytes) {
  static const std::array<std::string, 10> kNumbers{
      "0",          "-1",    "1",           "255", "4294967295", "18446744073709551615",
      "2147483648", "1e308", "99999999999", "nan"};
  const std::string_view digits = "0123456789";
  const std::size_t first =
      bytes.find_first_of(digits, below(std::min<std::size_t>(bytes.size(), 500)));
  if (first != std::string::npos) {
    const std::size_t last = bytes.find_first_not_of(digits, first);
    bytes.replace(first, std::min(last, bytes.size()) - first, kNumbers[below(kNumbers.size())]);
  }
}

}  // namespace voxlist::test
