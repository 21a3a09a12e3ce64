#pragma once

namespace voxlist::scanner {

/// What is wrong with the mirror, or what its angle waits for.
enum class MirrorTrouble {
  kNone,
  // It stands.
  kStands,
  // The angle is not known though the mirror may turn.
  kNewRate,         ///< the motor's speed has changed, and no arm has confirmed it yet
  kStrangeArmGap,   ///< the arms are not as far apart as the settings say
  kNeverTurned,     ///< no arm seen yet, and the lines do not change
  kNoArmYet,        ///< no arm seen yet
  kNoArmLately,     ///< arms were seen, but not for longer than a gap between them lasts
  kTooFewPassages,  ///< arms are seen, and do not tell the angle yet
  // The angle is known, and something is wrong all the same.
  kReversed,        ///< the mirror turns against its settings
  kWrongRate,       ///< arms and clock tell different rates
  kClockLost,       ///< no edges lately
  kClockNotInStep,  ///< edges come, and passages of the arms do not confirm them yet
  kMissedSteps,     ///< the motor missed steps in the last few seconds
  kArmsSilent,      ///< the clock runs, but no arm comes
  kArmMissing,      ///< one arm of several does not come
};

}  // namespace voxlist::scanner
