#pragma once

#include "voxlist/geometry/cloud.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {

/// What goes wrong with a scan.
enum class Bad {
  kNot,
  kEmpty,
  kOnePoint,
  kLid,     ///< all returns come from a lid 0.1 m before the laser
  kPerson,  ///< somebody 0.3 m away covers nine tenths
  kTilted,  ///< by 10 deg, on a bump
  kLifted,  ///< by 0.5 m
  kHalfNoise,
  kNoise,
  kShort,  ///< each return comes from somewhere on its ray
  kOtherPlace,
};
inline constexpr Bad kAllBad[] = {Bad::kEmpty,  Bad::kOnePoint,  Bad::kLid,       Bad::kPerson,
                                  Bad::kTilted, Bad::kLifted,    Bad::kHalfNoise, Bad::kNoise,
                                  Bad::kShort,  Bad::kOtherPlace};

const char* name(Bad bad);

/// What becomes of a scan; of another place, `other` is the scan.
Cloud spoiled(const Cloud& scan, Bad bad, const Cloud& other, simulation::Random& random);

/// The scan with this share of its returns shortened at random, as at edges, rain and dust.
Cloud with_short_returns(Cloud scan, double share, simulation::Random& random);

}  // namespace voxlist::bench
