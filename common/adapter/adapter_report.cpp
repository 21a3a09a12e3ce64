#include "voxlist/adapter/adapter_report.h"

namespace voxlist::adapter {
namespace {

// Each list in the order of its enum.
constexpr std::array<const char*, kMessageFates> kMessageNames{
    "used",      "left_for_newer", "out_of_order", "bad_point_times",
    "no_points", "no_odometry",    "overflow"};
constexpr std::array<const char*, kPointFates> kPointNames{"points",   "no_return", "no_time",
                                                           "too_near", "too_far",   "robot"};

}  // namespace

const char* counter_name(MessageFate fate) { return kMessageNames[static_cast<std::size_t>(fate)]; }

const char* counter_name(PointFate fate) { return kPointNames[static_cast<std::size_t>(fate)]; }

}  // namespace voxlist::adapter
