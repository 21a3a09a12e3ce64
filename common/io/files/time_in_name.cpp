#include "voxlist/io/files/time_in_name.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>

namespace voxlist::io {
namespace {

constexpr std::string_view kDigits = "0123456789";

// From September 2001, when seconds got their tenth digit, until 2096.
constexpr std::uint64_t kFirst_s = 1'000'000'000, kLast_s = 4'000'000'000;

struct Unit {
  TimeUnit unit;
  const char* name;
  std::uint64_t per_second;
};
constexpr std::array<Unit, 4> kUnits = {{{TimeUnit::kSeconds, "seconds", 1},
                                         {TimeUnit::kMilliseconds, "milliseconds", 1'000},
                                         {TimeUnit::kMicroseconds, "microseconds", 1'000'000},
                                         {TimeUnit::kNanoseconds, "nanoseconds", 1'000'000'000}}};

std::string_view take_digits(std::string_view& text) {
  const std::string_view digits = text.substr(0, text.find_first_not_of(kDigits));
  text.remove_prefix(digits.size());
  return digits;
}

// Nothing where the number has more than 19 digits.
std::optional<std::uint64_t> value(std::string_view digits) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() ? std::optional(number) : std::nullopt;
}

// Microseconds in the decimals of a second.
std::int64_t microseconds(std::string_view decimals) {
  std::string six(decimals.substr(0, 6));
  six.resize(6, '0');
  return static_cast<std::int64_t>(*value(six));
}

// The part of a second after a time in seconds.
std::optional<std::string_view> decimals_of(std::string_view rest) {
  if (rest.empty()) return rest;
  const char mark = rest.front();
  rest.remove_prefix(1);
  const std::string_view digits = take_digits(rest);
  if (!rest.empty() || digits.empty() || digits.size() > 9) return std::nullopt;
  const bool is_fixed = digits.size() == 6 || digits.size() == 9;
  return mark == '.' || ((mark == '_' || mark == '-') && is_fixed) ? std::optional(digits)
                                                                   : std::nullopt;
}

// A number, and what stands after it in the name.
std::optional<TimeInName> since_1970(std::uint64_t number, std::string_view rest) {
  for (const Unit& unit : kUnits) {
    if (number / unit.per_second < kFirst_s || number / unit.per_second >= kLast_s) continue;
    if (unit.unit != TimeUnit::kSeconds) {
      if (!rest.empty()) return std::nullopt;
      const double us = static_cast<double>(number % unit.per_second) * 1e6;
      const auto part_us = static_cast<std::int64_t>(us / static_cast<double>(unit.per_second));
      const auto seconds = static_cast<std::int64_t>(number / unit.per_second);
      return TimeInName{seconds * 1'000'000 + part_us, unit.unit};
    }
    const auto decimals = decimals_of(rest);
    if (!decimals) return std::nullopt;
    return TimeInName{static_cast<std::int64_t>(number) * 1'000'000 + microseconds(*decimals),
                      unit.unit};
  }
  return std::nullopt;
}

// A name that is nothing but a number with a point.
std::optional<TimeInName> decimal(std::string_view stem) {
  const std::string_view whole = take_digits(stem);
  if (whole.empty() || whole.size() > 9 || !stem.starts_with('.')) return std::nullopt;
  const auto decimals = decimals_of(stem);
  if (!decimals) return std::nullopt;
  return TimeInName{static_cast<std::int64_t>(*value(whole)) * 1'000'000 + microseconds(*decimals),
                    TimeUnit::kSeconds};
}

}  // namespace

const char* name(TimeUnit unit) { return kUnits[static_cast<std::size_t>(unit)].name; }

std::optional<TimeInName> time_in_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  if (const auto time = decimal(stem)) return time;
  std::string_view rest = stem;
  while (!rest.empty()) {
    rest.remove_prefix(std::min(rest.find_first_of(kDigits), rest.size()));
    const std::string_view digits = take_digits(rest);
    const auto number = value(digits);
    if (!number) continue;
    if (const auto time = since_1970(*number, rest)) return time;
  }
  return std::nullopt;
}

}  // namespace voxlist::io
