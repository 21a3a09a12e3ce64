#include "voxlist/calibration/calibrate.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/calibration/test_room.h"

namespace voxlist::calibration {
namespace {

using test::record;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::vector<double> kTwoSpeeds_s{1.0, 3.0};

class CalibrationInARoom : public testing::TestWithParam<test::TestRoom (*)()> {
 protected:
  const test::TestRoom room_ = GetParam()();
  const scanner::ScannerGeometry truth_ = test::miscalibrated();
};

TEST_P(CalibrationInARoom, BringsTheSystematicErrorBelowACentimetreAtSixMetres) {
  const Calibration result = calibrate(record(room_, {.truth = truth_}), {}, {});
  ASSERT_THAT(result.refusals, IsEmpty());
  const scanner::ScannerGeometry found =
      calibration::with_parameters({}, result.answer->parameters);
  EXPECT_GT(test::systematic_error({}, truth_, 1.0).max_m, 0.07);
  const test::SystematicError after = test::systematic_error(found, truth_, 1.0);
  RecordProperty("max_error_m", std::to_string(after.max_m));
  EXPECT_LT(after.max_m, 0.003);
  EXPECT_GT(result.answer->thickness_before_m, 2.0 * result.answer->thickness_after_m);
  EXPECT_LT(result.answer->thickness_after_m, 0.005);
}

TEST_P(CalibrationInARoom, FindsTheLatencyWhenTheMirrorHadTwoSpeeds) {
  const Calibration result =
      calibrate(record(room_, {.truth = truth_, .sweeps_s = kTwoSpeeds_s}), {}, {});
  ASSERT_THAT(result.refusals, IsEmpty());
  EXPECT_THAT(result.warnings, IsEmpty());
  const scanner::ScannerGeometry found =
      calibration::with_parameters({}, result.answer->parameters);
  EXPECT_NEAR(found.latency_ms, truth_.latency_ms, 0.03);
  for (const double sweep_s : {1.0, 3.0, 4.8})
    EXPECT_LT(test::systematic_error(found, truth_, sweep_s).max_m, 0.003) << sweep_s;
}

INSTANTIATE_TEST_SUITE_P(Each, CalibrationInARoom,
                         testing::Values(test::office, test::corridor, test::hall),
                         [](const auto& room) { return room.param().name; });

// RMS over seeds of error over standard deviation.
TEST(Calibration, KnowsHowWellItKnows) {
  constexpr int kSeeds = 10;
  const scanner::ScannerGeometry truth = test::miscalibrated();
  CalibrationConfig config;
  config.level_sd_deg = 1e-4;  // this floor is level
  ParameterVector squares = ParameterVector::Zero();
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto log =
        record(test::corridor(), {.truth = truth, .sweeps_s = kTwoSpeeds_s, .seed = seed});
    const Calibration result = calibrate(log, {}, config);
    ASSERT_TRUE(result.answer) << "seed " << seed;
    const ParameterVector error = result.answer->parameters - parameters_of(truth);
    squares += error.cwiseQuotient(result.answer->sd).cwiseAbs2();
  }
  for (int i = 0; i < kParameters; ++i) {
    const double ratio = std::sqrt(squares[i] / kSeeds);
    const char* key = kParameterInfos[static_cast<std::size_t>(i)].key;
    RecordProperty(key, std::to_string(ratio));
    EXPECT_GT(ratio, 0.5) << key;
    EXPECT_LT(ratio, 2.0) << key;
  }
}

TEST(Calibration, GivesTheSameAnswerAgain) {
  const auto log = record(test::office(), {.truth = test::miscalibrated(), .duration_s = 20.0});
  EXPECT_EQ(calibrate(log, {}, {}).answer->parameters, calibrate(log, {}, {}).answer->parameters);
}

TEST(Calibration, PutsTheSidesTogetherFromSeveralDegreesApart) {
  scanner::ScannerGeometry truth = test::miscalibrated();
  truth.mirror_phase_0_deg = 2.0;
  truth.mirror_phase_1_deg = -1.5;
  const Calibration result = calibrate(record(test::office(), {.truth = truth}), {}, {});
  ASSERT_THAT(result.refusals, IsEmpty());
  const scanner::ScannerGeometry found =
      calibration::with_parameters({}, result.answer->parameters);
  EXPECT_LT(test::systematic_error(found, truth, 1.0).max_m, 0.005);
}

TEST(Calibration, MakesTheCloudLevelOnATiltedMount) {
  scanner::CloudAssemblerConfig scanner;
  scanner.geometry.mount_roll_deg = 3.0;
  scanner.geometry.mount_pitch_deg = -5.0;
  scanner::ScannerGeometry truth = scanner.geometry;
  truth.mirror_phase_0_deg = truth.mirror_phase_1_deg = 0.4;
  const Calibration result = calibrate(record(test::office(), {.truth = truth}), scanner, {});
  ASSERT_THAT(result.refusals, IsEmpty());
  const scanner::ScannerGeometry found =
      calibration::with_parameters(scanner.geometry, result.answer->parameters);
  EXPECT_LT(test::systematic_error(found, truth, 1.0).max_m, 0.004);
}

TEST(Calibration, HoldsWhatBelongsToASideThatIsNotInUse) {
  const scanner::ScannerGeometry truth = test::miscalibrated();
  scanner::CloudAssemblerConfig scanner;
  scanner.mirror_sides = 1;
  const Calibration result =
      calibrate(record(test::office(), {.truth = truth, .single_sided = true}), scanner, {});
  ASSERT_THAT(result.refusals, IsEmpty());
  EXPECT_THAT(result.warnings, Contains(HasSubstr("side 1 of the mirror is not in use")));
  const ParameterVector& found = result.answer->parameters;
  EXPECT_EQ(found[kOffset1], scanner.geometry.mirror_offset_1_m);
  EXPECT_NEAR(found[kHeight], truth.mirror_height_m, 0.001);
}

TEST(Calibration, RefusesALogThatIsTooShort) {
  const auto log = record(test::office(), {.truth = {}, .duration_s = 5.0});
  const Calibration result = calibrate(log, {}, {});
  EXPECT_FALSE(result.answer);
  EXPECT_THAT(result.refusals, ElementsAre(HasSubstr("375 lines")));
}

TEST(Calibration, RefusesLinesWithoutALockedMirror) {
  auto log = record(test::office(), {.truth = {}, .duration_s = 20.0});
  for (MirrorState& state : log.mirror) state.state = MirrorState::State::kFault;
  const Calibration result = calibrate(log, {}, {});
  EXPECT_FALSE(result.answer);
  EXPECT_THAT(result.refusals, ElementsAre(HasSubstr("1500 more have none")));
}

TEST(Calibration, RefusesARobotThatMoved) {
  auto log = record(test::office(), {.truth = {}, .duration_s = 20.0});
  log.odometry = {{0, {0.0, 0.0, 0.0}}, {1'000'000, {0.05, 0.0, 0.0}}};
  EXPECT_THAT(calibrate(log, {}, {}).refusals, ElementsAre(HasSubstr("moved by 0.050 m")));
}

TEST(Calibration, RefusesPhasesWithoutALevelSurface) {
  const auto room = test::box_room({6.0, 5.0, 12.0}, false, false);
  const Calibration result = calibrate(record(room, {.truth = {}}), {}, {});
  EXPECT_THAT(result.refusals, Contains(HasSubstr("neither floor nor ceiling")));
}

TEST(Calibration, NamesWhatALoneWallCannotTell) {
  const Calibration result = calibrate(record(test::lone_wall(), {.truth = {}}), {}, {});
  EXPECT_THAT(result.refusals, Contains(HasSubstr("mirror_phase_0_deg")));
  EXPECT_THAT(result.refusals, Contains(HasSubstr("mirror_height_m")));
  EXPECT_THAT(result.refusals, Contains(HasSubstr("mirror_offset_0_m")));
}

TEST(Calibration, RefusesWhereThereIsNothingFlat) {
  test::TestRoom room{"pole", {}, {}, {}, {}};
  room.boxes.push_back({{0.0, 0.0, 20.0}, {1.0, 1.0, 1.0}, 0.0});  // out of reach
  for (const double x : {-3.0, -2.0, 2.0, 3.0}) room.cylinders.push_back({{x, x}, 0.15, 0.0, 3.0});
  const Calibration result = calibrate(record(room, {.truth = {}}), {}, {});
  EXPECT_THAT(result.refusals, ElementsAre(HasSubstr("no large flat surface")));
}

}  // namespace
}  // namespace voxlist::calibration
