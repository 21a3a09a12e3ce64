#include "voxlist/adapter/point_times.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <utility>

namespace voxlist::adapter {
namespace {

using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;

auto near_s(double seconds) { return FloatNear(static_cast<float>(seconds), 1e-7F); }

// Three points with these times.
RawCloud told(std::vector<float> times) {
  RawCloud raw;
  raw.points.assign(times.size(), {1.0F, 0.0F, 0.0F});
  raw.times = std::move(times);
  return raw;
}

SensorConfig telling(TimeUnit unit, UtimeOf utime_of = UtimeOf::kTimeZero) {
  SensorConfig sensor;
  sensor.time_channel = "time";
  sensor.time_unit = unit;
  sensor.utime_of = utime_of;
  return sensor;
}

// Points at these azimuths, as rows 0, 1, ... of so many.
RawCloud seen_at(const std::vector<double>& azimuths_deg, std::uint32_t all_rows) {
  RawCloud raw;
  raw.all_rows = all_rows;
  for (const double deg : azimuths_deg) {
    const double rad = deg * 3.14159265358979 / 180.0;
    raw.rows.push_back(static_cast<std::uint32_t>(raw.points.size()));
    raw.points.emplace_back(5.0 * std::cos(rad), 5.0 * std::sin(rad), 1.0);
  }
  return raw;
}

SensorConfig turning(SweepOrder order, UtimeOf utime_of = UtimeOf::kFirst) {
  SensorConfig sensor;
  sensor.sweep_ms = 100.0;
  sensor.sweep_order = order;
  sensor.utime_of = utime_of;
  return sensor;
}

TEST(PointTimes, AreInTheUnitOfTheSetting) {
  const std::pair<TimeUnit, float> units[] = {{TimeUnit::kSeconds, 1.0F},
                                              {TimeUnit::kMilliseconds, 1e3F},
                                              {TimeUnit::kMicroseconds, 1e6F},
                                              {TimeUnit::kNanoseconds, 1e9F}};
  for (const auto& [unit, one_second] : units) {
    const PointTimes times =
        point_times(told({0.0F, 0.05F * one_second, 0.1F * one_second}), telling(unit));
    EXPECT_THAT(times.offsets_s, ElementsAre(near_s(0.0), near_s(0.05), near_s(0.1)));
    EXPECT_NEAR(times.last_s, 0.1, 1e-7);
    EXPECT_EQ(times.complaint, "");
  }
}

TEST(PointTimes, CountFromWhereUtimeIs) {
  const RawCloud raw = told({1000.0F, 1050.0F, 1100.0F});
  const auto offsets_s = [&](UtimeOf utime_of) {
    return point_times(raw, telling(TimeUnit::kMilliseconds, utime_of)).offsets_s;
  };
  EXPECT_THAT(offsets_s(UtimeOf::kTimeZero), ElementsAre(near_s(1.0), near_s(1.05), near_s(1.1)));
  EXPECT_THAT(offsets_s(UtimeOf::kFirst), ElementsAre(near_s(0), near_s(0.05), near_s(0.1)));
  EXPECT_THAT(offsets_s(UtimeOf::kMiddle), ElementsAre(near_s(-0.05), near_s(0), near_s(0.05)));
  EXPECT_THAT(offsets_s(UtimeOf::kLast), ElementsAre(near_s(-0.1), near_s(-0.05), near_s(0)));
}

TEST(PointTimes, OfAPointThatHasNoneAreNan) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const PointTimes times =
      point_times(told({kNan, 0.0F, -kInf, 0.1F, kInf}), telling(TimeUnit::kSeconds));
  EXPECT_FALSE(times.is_refused);
  EXPECT_TRUE(std::isnan(times.offsets_s[0]));
  EXPECT_TRUE(std::isnan(times.offsets_s[2]));
  EXPECT_TRUE(std::isnan(times.offsets_s[4]));
  EXPECT_EQ(times.first_s, 0.0);
  EXPECT_NEAR(times.last_s, 0.1, 1e-7);
}

TEST(PointTimes, AreRefusedWhenNoPointHasOne) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(point_times(told({kNan, kNan}), telling(TimeUnit::kSeconds)).is_refused);
}

TEST(PointTimes, OfAnotherUnitAreRefused) {
  const PointTimes times = point_times(told({0.0F, 50.0F, 100.0F}), telling(TimeUnit::kSeconds));
  EXPECT_TRUE(times.is_refused);
  EXPECT_THAT(times.complaint, HasSubstr("100 s apart: is time_unit right?"));
  EXPECT_TRUE(point_times(told({0.0F, 3e38F}), telling(TimeUnit::kNanoseconds)).is_refused);
}

TEST(PointTimes, FarFromUtimeAreRefused) {
  const PointTimes times = point_times(told({3599.8F, 3599.9F}), telling(TimeUnit::kSeconds));
  EXPECT_TRUE(times.is_refused);
  EXPECT_THAT(times.complaint, HasSubstr("set utime_of"));
}

TEST(PointTimes, ThatAreAllTheSameAreToldAndTaken) {
  const PointTimes times =
      point_times(told({1.7e9F, 1.7e9F}), telling(TimeUnit::kSeconds, UtimeOf::kLast));
  EXPECT_FALSE(times.is_refused);
  EXPECT_THAT(times.complaint, HasSubstr("all points have one time"));
}

TEST(PointTimes, AreNoneWithoutSettings) {
  const PointTimes times = point_times(told({0.0F, 0.1F}), {});
  EXPECT_TRUE(times.offsets_s.empty());
  EXPECT_EQ(times.last_s, 0.0);
}

TEST(PointTimes, AtConstantRateFollowTheRowsOfTheWholeMessage) {
  RawCloud raw = seen_at({0, 10, 20}, 5);
  raw.rows = {0, 2, 3};  // two were thinned out
  EXPECT_THAT(point_times(raw, turning(SweepOrder::kRows)).offsets_s,
              ElementsAre(near_s(0), near_s(0.05), near_s(0.075)));
  const PointTimes at_end = point_times(raw, turning(SweepOrder::kRows, UtimeOf::kLast));
  EXPECT_THAT(at_end.offsets_s, ElementsAre(near_s(-0.1), near_s(-0.05), near_s(-0.025)));
  EXPECT_EQ(at_end.last_s, 0.0) << "the last row was thinned out, its time counts";
}

TEST(PointTimes, AtConstantRateFollowTheTurn) {
  const RawCloud raw = seen_at({170, 90, 0, -90, -170}, 5);
  EXPECT_THAT(point_times(raw, turning(SweepOrder::kClockwise)).offsets_s,
              ElementsAre(near_s(0.1 * 10 / 360), near_s(0.025), near_s(0.05), near_s(0.075),
                          near_s(0.1 * 350 / 360)));
  EXPECT_NEAR(point_times(raw, turning(SweepOrder::kCounterclockwise)).offsets_s[1], 0.075, 1e-7);
}

}  // namespace
}  // namespace voxlist::adapter
