#include "voxlist/geometry/elementary.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

namespace voxlist::elementary {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kArguments = 100'000;
constexpr double kMostUlps = 0.96;  // 0.95 over 2 million arguments of each kind

// How far a result is from the true one, in units of its last place.
double ulps(double got, long double truth) {
  const auto nearest = static_cast<double>(truth);
  if (got == nearest || (std::isnan(got) && std::isnan(nearest))) return 0.0;
  int exponent = 0;
  std::frexp(nearest, &exponent);
  const long double last_place = std::ldexp(1.0L, std::max(exponent - 53, -1074));
  return static_cast<double>(std::abs(static_cast<long double>(got) - truth) / last_place);
}

class Arguments {
 public:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }

  // A number of any size from 2^low to 2^high.
  double of_size(int low, int high) {
    const auto power = low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low));
    return std::ldexp(uniform(1.0, 2.0), power) * (bits() % 2 == 0 ? 1.0 : -1.0);
  }

  std::uint64_t bits() { return random_(); }

 private:
  std::mt19937_64 random_{20};
};

// The worst of many arguments. long double tells the truth where it has 11 digits more.
template <class Function, class Truth, class Draw>
void expect_close(const Function& function, const Truth& truth, const Draw& draw) {
  static_assert(std::numeric_limits<double>::digits == 53);
  if (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "long double is too short";
  Arguments arguments;
  double worst = 0.0, worst_x = 0.0, worst_y = 0.0;
  for (int i = 0; i < kArguments; ++i) {
    const double x = draw(arguments), y = draw(arguments);
    const double error = ulps(function(x, y), truth(static_cast<long double>(x), y));
    if (error <= worst) continue;
    worst = error, worst_x = x, worst_y = y;
  }
  EXPECT_LT(worst, kMostUlps) << std::hexfloat << worst_x << ", " << worst_y;
}

const auto uniform = [](double low, double high) {
  return [=](Arguments& arguments) { return arguments.uniform(low, high); };
};
const auto any = [](Arguments& arguments) { return arguments.of_size(-1074, 1024); };
const auto any_above_0 = [](Arguments& arguments) { return std::abs(any(arguments)); };

TEST(Elementary, SineAndCosineAreWithinAUnitOfTheLastPlace) {
  // Turns by the thousand, at any size, and where one of them nearly vanishes.
  const auto near_zero = [](Arguments& a) {
    const auto quarters = static_cast<double>(a.bits() % 4'000'000);
    return std::nextafter(quarters * std::numbers::pi / 2, a.uniform(-1.0, 1.0) * kInfinity);
  };
  const auto check = [](const auto& draw) {
    expect_close([](double x, double) { return sin(x); },
                 [](long double x, double) { return std::sin(x); }, draw);
    expect_close([](double x, double) { return cos(x); },
                 [](long double x, double) { return std::cos(x); }, draw);
  };
  check(uniform(-1.0, 1.0));
  check(uniform(-1e4, 1e4));
  check(uniform(-4e6, 4e6));
  check(any);
  check(near_zero);
}

TEST(Elementary, SineAndCosineTogetherAreTheSameBitsAsEachAlone) {
  Arguments arguments;
  for (int i = 0; i < kArguments; ++i) {
    const double x = i % 2 == 0 ? arguments.uniform(-10.0, 10.0) : any(arguments);
    ASSERT_EQ(sine_cosine(x).sine, sin(x)) << x;
    ASSERT_EQ(sine_cosine(x).cosine, cos(x)) << x;
  }
}

TEST(Elementary, TheAngleOfAVectorIsWithinAUnitOfTheLastPlace) {
  const auto own = [](double y, double x) { return atan2(y, x); };
  const auto truth = [](long double y, double x) {
    return std::atan2(y, static_cast<long double>(x));
  };
  expect_close(own, truth, uniform(-20.0, 20.0));
  expect_close(own, truth, any);
  expect_close([](double y, double) { return atan2(y, 1.0); },
               [](long double y, double) { return std::atan2(y, 1.0L); }, uniform(0.0, 0.1));
}

TEST(Elementary, TheLengthOfAVectorIsWithinAUnitOfTheLastPlace) {
  const auto own = [](double y, double x) { return hypot(y, x); };
  const auto truth = [](long double y, double x) {
    return std::hypot(y, static_cast<long double>(x));
  };
  expect_close(own, truth, uniform(-20.0, 20.0));
  expect_close(own, truth, [](Arguments& a) { return a.of_size(-1074, -1020); });
  expect_close(own, truth, [](Arguments& a) { return a.of_size(480, 520); });
  expect_close(own, truth, [](Arguments& a) { return a.of_size(980, 1023); });
}

TEST(Elementary, TheExponentialIsWithinAUnitOfTheLastPlace) {
  const auto own = [](double x, double) { return exp(x); };
  const auto truth = [](long double x, double) { return std::exp(x); };
  expect_close(own, truth, uniform(-1.0, 1.0));
  expect_close(own, truth, uniform(-750.0, 720.0));
  expect_close(own, truth, [](Arguments& a) { return a.of_size(-1074, 12); });
}

TEST(Elementary, LogarithmsAreWithinAUnitOfTheLastPlace) {
  const auto own = [](double x, double) { return log(x); };
  const auto truth = [](long double x, double) { return std::log(x); };
  expect_close(own, truth, uniform(0.0, 3.0));
  expect_close(own, truth, uniform(0.99, 1.01));
  expect_close(own, truth, any_above_0);
  const auto own1 = [](double x, double) { return log1p(x); };
  const auto truth1 = [](long double x, double) { return std::log1p(x); };
  expect_close(own1, truth1, uniform(-1.0, 3.0));
  expect_close(own1, truth1, [](Arguments& a) { return a.of_size(-80, 0); });
  expect_close(own1, truth1, any_above_0);
}

void expect_same(double got, double expected, double x, double y) {
  EXPECT_TRUE((std::isnan(got) && std::isnan(expected)) ||
              std::bit_cast<std::uint64_t>(got) == std::bit_cast<std::uint64_t>(expected))
      << "at " << x << ", " << y << ": " << got << " instead of " << expected;
}

TEST(Elementary, ZerosInfinitiesAndNanComeOutAsTheStandardSays) {
  const double special[] = {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, std::nan("")};
  for (const double x : special) {
    expect_same(sin(x), std::sin(x), x, 0.0);
    expect_same(cos(x), std::cos(x), x, 0.0);
    expect_same(exp(x), std::exp(x), x, 0.0);
    expect_same(log(x), std::log(x), x, 0.0);
    expect_same(log1p(x), std::log1p(x), x, 0.0);
    for (const double y : special) {
      expect_same(atan2(x, y), std::atan2(x, y), x, y);
      expect_same(hypot(x, y), std::hypot(x, y), x, y);
    }
  }
}

// FNV-1a over the bits of results.
template <class Function>
std::uint64_t hash(const Function& function) {
  Arguments arguments;
  std::uint64_t hash = 0xcbf29ce484222325;
  for (int i = 0; i < kArguments; ++i) {
    const double x = arguments.uniform(-40.0, 40.0), y = arguments.uniform(-40.0, 40.0);
    hash = (hash ^ std::bit_cast<std::uint64_t>(function(x, y))) * 0x100000001b3;
  }
  return hash;
}

// A hash that differs means that maps made here differ from those of other machines.
TEST(Elementary, GivesTheBitsThatItGaveOnOtherMachines) {
  EXPECT_EQ(hash([](double x, double) { return sin(x); }), 0x4505b3da9bae1869);
  EXPECT_EQ(hash([](double x, double) { return cos(x); }), 0x642be0206509eb62);
  EXPECT_EQ(hash([](double x, double y) { return atan2(y, x); }), 0xad8a5b8125b9096c);
  EXPECT_EQ(hash([](double x, double y) { return hypot(y, x); }), 0xee5483ae72e79713);
  EXPECT_EQ(hash([](double x, double) { return exp(x); }), 0x50089fe2428fcfb4);
  EXPECT_EQ(hash([](double x, double) { return log(std::abs(x)); }), 0x2d0a9a1d9fcb625a);
  EXPECT_EQ(hash([](double x, double) { return log1p(std::abs(x)); }), 0xf6b28874fb783b49);
}

}  // namespace
}  // namespace voxlist::elementary
