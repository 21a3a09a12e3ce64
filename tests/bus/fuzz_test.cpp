#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_edit_t.hpp>
#include <voxlist/map_edits_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pixel_map_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_hint_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>
#include <voxlist/traversability_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

#include "tests/bus/forge.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/maps/edit_convert.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::bus {
namespace {

using std::chrono::milliseconds;

constexpr std::uint32_t kSeed = 20'240'229;

// As the highest byte of a length: negative, and from the absurd to nothing.
constexpr std::array<std::uint8_t, 7> kAbsurdBytes = {0xFF, 0x80, 0x7F, 0x20, 0x15, 0x05, 0x00};

// Subscribes to every channel and does with a message what services do first.
class Victim {
 public:
  explicit Victim(Bus& bus) : bus_(bus) {
    listen(kLaser, Delivery::kEvery, [](const planar_lidar_t& m) { from_message(m); });
    listen(kMirror, Delivery::kEvery, [](const mirror_state_t& m) { from_message(m); });
    listen(kCloud, Delivery::kEvery, [](const pointcloud_t& m) { from_message(m); });
    listen(kCloudSlice, Delivery::kLatest, [](const pointcloud_t& m) { from_message(m); });
    listen(kOdometry, Delivery::kEvery, [](const pose_t& m) { from_message(m); });
    listen(kPose, Delivery::kLatest, [](const pose_t& m) { from_message(m); });
    listen(kPoseCovariance, Delivery::kEvery, [](const uncertain_pose_t&) {});
    listen(kMapOdom, Delivery::kEvery, [](const rigid_transform_t&) {});
    listen(kTruth, Delivery::kEvery, [](const pose_t& m) { from_message(m); });
    listen(kKeyframe, Delivery::kEvery, [](const keyframe_t& m) { from_message(m); });
    listen(kMapUpdate, Delivery::kEvery, [this](const map_update_t& m) { take_map(m); });
    listen(kFreeSpace, Delivery::kEvery, [this](const map_update_t& m) { take_map(m); });
    listen(kLocalisation, Delivery::kEvery, [](const localisation_t&) {});
    listen(kMapRequest, Delivery::kEvery, [](const map_request_t&) {});
    listen(kPoseHint, Delivery::kEvery, [](const pose_hint_t& m) { from_message(m); });
    listen(kMapEdit, Delivery::kEvery, [](const map_edit_t& m) { from_message(m); });
    listen(kMapEdits, Delivery::kEvery, [](const map_edits_t& m) { from_message(m); });
    listen(kOctomap, Delivery::kEvery, [](const map_octree_t&) {});
    listen(kObstacles, Delivery::kLatest, [](const obstacles_t&) {});
    listen(Channel<pixel_map_t>{"GRID_low"}, Delivery::kEvery, [](const pixel_map_t&) {});
    listen(Channel<traversability_t>{"TRAVERSABILITY_low"}, Delivery::kEvery,
           [](const traversability_t&) {});
    // A handler that fails counts too.
    listen(kHealth, Delivery::kEvery, [](const health_t& m) {
      if (m.n_counters == 3) throw std::runtime_error("three");
    });
  }

  // Everything received was handed over or counted under one reason, and handed over as often as
  // counted.
  void expect_sums(const std::map<std::string, std::int64_t>& sent) const {
    for (const auto& [channel, n] : sent) {
      std::int64_t accounted = 0;
      for (const auto& [name, count] : bus_.counters()) {
        const bool outcome = name.starts_with(channel + '/') && !name.ends_with("/received") &&
                             !name.ends_with("/sent");
        if (outcome) accounted += count;
      }
      EXPECT_EQ(counter(channel + "/received"), n) << channel;
      EXPECT_EQ(accounted, n) << channel;
      EXPECT_EQ(counter(channel + "/handled") + counter(channel + "/handler_failed"),
                calls_.at(channel))
          << channel;
      EXPECT_GT(counter(channel + "/handled"), n / 20) << channel;
      EXPECT_GT(counter(channel + "/truncated"), n / 50) << channel;
      EXPECT_GT(counter(channel + "/wrong_type"), n / 50) << channel;
      EXPECT_GT(counter(channel + "/trailing_bytes"), n / 50) << channel;
      EXPECT_EQ(counter(channel + "/codec_failed"), 0) << channel;
    }
    EXPECT_GT(counter("HEALTH/handler_failed"), 0);
    EXPECT_GT(counter("CLOUD_SLICE/superseded"), 0);
  }

 private:
  template <class M>
  void listen(Channel<M> channel, Delivery delivery,
              std::function<void(const std::type_identity_t<M>&)> handler) {
    calls_[channel.name] = 0;
    const auto counted = [this, channel, handler](const M& message) {
      ++calls_[channel.name];
      handler(message);
    };
    bus_.subscribe(channel, counted, delivery);
  }

  void take_map(const map_update_t& message) {
    for (const MapChange& change : assembler_.add(message)) apply(change, map_);
  }

  std::int64_t counter(const std::string& name) const {
    const auto found = bus_.counters().find(name);
    return found == bus_.counters().end() ? 0 : found->second;
  }

  Bus& bus_;
  MapAssembler assembler_;
  OccupancyMap map_;
  std::map<std::string, std::int64_t> calls_;
};

TEST(Fuzz, AHundredThousandForgedMessagesAreEachHandledOrCounted) {
  RecordProperty("seed", kSeed);
  SCOPED_TRACE(kSeed);
  Bus bus({.url = "memq://", .prefix = ""});
  Victim victim(bus);
  Forge forge(kSeed);
  std::map<std::string, std::int64_t> sent;
  for (int i = 0; i < 100'000; ++i) {
    const Forgery forgery = forge.next();
    ++sent[forgery.channel];
    bus.publish_encoded(forgery.channel, forgery.bytes);
    const bool open = i % 100 != 99 || bus.handle(milliseconds(0));
    ASSERT_TRUE(open);
  }
  EXPECT_EQ(sent.size(), Forge::channels().size());
  victim.expect_sums(sent);
}

// Every place of a message in turn holds every absurd length: finds each count wherever it stands.
TEST(Fuzz, AbsurdLengthsAtEveryPlaceOfEveryTypeStopNothing) {
  SCOPED_TRACE(kSeed);
  Bus bus({.url = "memq://", .prefix = ""});
  Victim victim(bus);
  Forge forge(kSeed);
  std::int64_t sent = 0;
  for (std::size_t channel = 0; channel < Forge::channels().size(); ++channel) {
    const std::vector<std::uint8_t> whole = forge.whole(channel);
    for (std::size_t at = 8; at + 4 <= whole.size(); ++at) {
      for (const std::uint8_t high : kAbsurdBytes) {
        std::vector<std::uint8_t> bytes = whole;
        bytes[at] = high;
        bus.publish_encoded(Forge::channels()[channel], bytes);
        ASSERT_TRUE(bus.handle(milliseconds(0)));
        ++sent;
      }
    }
  }
  std::int64_t received = 0;
  for (const auto& [name, count] : bus.counters())
    received += name.ends_with("/received") ? count : 0;
  EXPECT_EQ(received, sent);
}

std::size_t number_of(const std::string& channel) {
  const auto& all = Forge::channels();
  return static_cast<std::size_t>(std::ranges::find(all, channel) - all.begin());
}

TEST(Forge, EncodesEveryChannelsTypeWithoutFault) {
  Forge forge(kSeed);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(check_wire<pointcloud_t>(forge.whole(number_of(kCloud.name))), Fault::kNone);
    EXPECT_EQ(check_wire<health_t>(forge.whole(number_of(kHealth.name))), Fault::kNone);
  }
}

}  // namespace
}  // namespace voxlist::bus
