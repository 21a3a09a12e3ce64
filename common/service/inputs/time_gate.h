#pragma once

#include <cstdint>
#include <optional>

namespace voxlist::service {

/// Tells the times that go on from those before them from the ones that do not.
///
/// One wrong time must not make all later ones look wrong: three in a row that agree with each
/// other are believed, whatever came before. So a forged time costs the message that has it and two
/// more, and a recording that is played again costs two.
class TimeGate {
 public:
  enum class Verdict {
    kFits,
    kRepeated,   ///< the time of the message before
    kBackwards,  ///< before the newest
    kAhead,      ///< more than kMaxStep_us after the newest
    kNotMicroseconds,
  };

  /// Times farther from the newest than this are not believed at once (us): no scanner pauses for
  /// a minute and goes on, without that two clouds more or less would matter.
  static constexpr std::int64_t kMaxStep_us = 60'000'000;

  /// `disorder_us`: times so much older than the newest fit, too.
  explicit TimeGate(std::int64_t disorder_us = 0) : disorder_us_(disorder_us) {}

  Verdict judge(std::int64_t utime_us);

 private:
  bool follows(std::int64_t before_us, std::int64_t utime_us) const;

  std::int64_t disorder_us_;
  std::optional<std::int64_t> newest_us_;
  // The last time that did not fit, and how many in a row agree with each other.
  std::optional<std::int64_t> other_us_;
  int others_ = 0;
};

}  // namespace voxlist::service
