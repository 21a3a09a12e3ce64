#include "voxlist/foreign/lcm/lcm_types.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <vector>

namespace voxlist::foreign {
namespace {

// The name without its package, as fields tell it.
std::string_view short_name(const LcmType& type) {
  return type.name.substr(type.name.find('.') + 1);
}

bool is_of_a_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// Whether a line of the text begins with the word: so a field of that type does.
bool has_field_of(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != std::string_view::npos;
       at = text.find(word, at + 1)) {
    const std::size_t before = text.find_last_not_of(' ', at - 1), after = at + word.size();
    const bool begins = at > 0 && before != std::string_view::npos && text[before] == '\n';
    if (begins && after < text.size() && !is_of_a_word(text[after])) return true;
  }
  return false;
}

}  // namespace

const LcmType* lcm_type_of(bus::Bytes message) {
  std::uint64_t fingerprint = 0;
  if (message.size() < sizeof fingerprint) return nullptr;
  for (const std::uint8_t byte : message.first(sizeof fingerprint))
    fingerprint = fingerprint << 8 | byte;
  const auto types = lcm_types();
  const auto found =
      std::ranges::find(types, std::bit_cast<std::int64_t>(fingerprint), &LcmType::fingerprint);
  return found == types.end() ? nullptr : &*found;
}

std::string definition_of(const LcmType& type) {
  std::vector<const LcmType*> wanted{&type};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    for (const LcmType& other : lcm_types())
      if (std::ranges::find(wanted, &other) == wanted.end() &&
          has_field_of(wanted[i]->text, short_name(other)))
        wanted.push_back(&other);
  std::string text;
  for (const LcmType* each : wanted) text += std::string(each->text) + "\n";
  return text;
}

}  // namespace voxlist::foreign
