#include <gmock/gmock.h>
#include <octomap/OcTree.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>

#include "services/octomap_export/octomap_export_service.h"
#include "tests/stand_in_mapper.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/service/stop.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

constexpr std::int64_t kSecond_us = 1'000'000;
constexpr float kHeight_m = 0.55F;

// A ray along x at y = index + 0.55 m, which hits at x = 1.05 m; the pose shifts it by index.
keyframe_t keyframe(std::int32_t index, std::int64_t map_id = 7) {
  bus::PosedCloud keyframe;
  keyframe.map_id = map_id;
  keyframe.index = index;
  keyframe.T_map_base.translation() << 0.0, index, 0.0;
  keyframe.cloud = {100 * map_id + index, {{1.05F, 0.55F, kHeight_m}}, {{0.05F, 0.55F, kHeight_m}}};
  return bus::to_message(keyframe);
}

// What OctoMap itself reads from the bytes of a .bt file.
class ReadBack {
 public:
  explicit ReadBack(const std::string& bytes) : tree_(0.5) {
    std::istringstream in(bytes);
    read_ = tree_.readBinary(in);
  }
  bool has(std::int32_t index) const {
    const auto* hit = tree_.search(1.05, index + 0.55, kHeight_m);
    const auto* passed = tree_.search(0.55, index + 0.55, kHeight_m);
    return read_ && hit != nullptr && tree_.isNodeOccupied(hit) && passed != nullptr &&
           !tree_.isNodeOccupied(passed);
  }
  double resolution_m() const { return tree_.getResolution(); }

 private:
  octomap::OcTree tree_;
  bool read_ = false;
};

ReadBack read_back(const map_octree_t& message) {
  return ReadBack({message.data.begin(), message.data.end()});
}

ReadBack read_back(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return ReadBack({std::istreambuf_iterator<char>(in), {}});
}

// While it lives, no file can grow: what a full disk does to a writer.
class FullDisk {
 public:
  FullDisk() {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit none = before_;
    none.rlim_cur = 0;
    setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_;
};

class OctomapExport : public testing::Test {
 protected:
  OctomapExport() {
    bus_.subscribe(bus::kOctomap, [this](const map_octree_t& m) { octomaps_.push_back(m); });
    bus_.subscribe(bus::kMapRequest, [this](const map_request_t& m) {
      if (m.want == map_request_t::WANT_WORD) return say_word(m.utime);
      requests_.push_back(m);
      if (answer_) answer_(m);
    });
  }

  void start() { service_.emplace(bus_, health_, config_); }

  void start_with_files() {
    config_.folder = (folder_ / "map").string();
    start();
  }

  void publish(std::initializer_list<std::int32_t> indices, std::int64_t map_id = 7) {
    for (const std::int32_t index : indices) bus_.publish(bus::kKeyframe, keyframe(index, map_id));
    bus_.handle(std::chrono::milliseconds(0));
  }

  // What a mapper says of its map, where there is one.
  void say_word(std::int64_t answers) {
    if (!word_) return;
    test::StandInMapper mapper(
        {0, word_->map_id, word_->version, bus::kWholeMap, {0.02, 0.08}, {}, word_->moves});
    for (const auto& message : mapper.word(answers)) bus_.publish(bus::kMapUpdate, message);
  }

  // Ticks at the service's pace for some seconds.
  void run(double seconds) {
    const std::int64_t end_us = now_us_ + static_cast<std::int64_t>(seconds * 1e6);
    for (; now_us_ < end_us; now_us_ += 20'000) {
      service_->tick(now_us_);
      bus_.handle(std::chrono::milliseconds(0));
    }
  }

  health_t health() {
    health_us_ += kSecond_us;
    return *health_.due(health_us_);
  }

  std::filesystem::path file(const std::string& name) const {
    return std::filesystem::path(config_.folder) / name;
  }

  TemporaryFolder folder_;
  OctomapExportConfig config_;
  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"octomap_export"};
  std::optional<OctomapExportService> service_;
  std::int64_t now_us_ = kSecond_us, health_us_ = 0;
  std::vector<map_octree_t> octomaps_;
  std::vector<map_request_t> requests_;
  std::optional<service::MapperWord::Word> word_;
  std::function<void(const map_request_t&)> answer_;  // of a mapper, where there is one
};

TEST_F(OctomapExport, PublishesTheKeyframesAsAnOctomapInTheMapFrame) {
  start();
  publish({0, 1, 2});
  run(1.5);
  ASSERT_FALSE(octomaps_.empty());
  const map_octree_t& message = octomaps_.back();
  EXPECT_EQ(message.map_id, 7);
  EXPECT_EQ(message.view_id, 3);
  EXPECT_EQ(message.utime, 702);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_EQ(message.transform[row][column], row == column ? 1.0F : 0.0F);
  const ReadBack tree = read_back(message);
  EXPECT_DOUBLE_EQ(tree.resolution_m(), 0.1);
  for (const std::int32_t index : {0, 1, 2}) EXPECT_TRUE(tree.has(index)) << index;
  EXPECT_FALSE(tree.has(3));
}

TEST_F(OctomapExport, PublishesAtMostOnceASecondAndOnlyChanges) {
  start();
  publish({0});
  run(0.5);
  EXPECT_EQ(octomaps_.size(), 1u);
  publish({1});
  run(0.4);
  EXPECT_EQ(octomaps_.size(), 1u);
  run(0.2);
  EXPECT_EQ(octomaps_.size(), 2u);
  run(5.0);
  EXPECT_EQ(octomaps_.size(), 2u);
}

TEST_F(OctomapExport, PublishesABoxInLargerVoxelsAloneAndOnlyItsChanges) {
  config_.octomap.export_resolution_m = 0.2;
  config_.octomap.export_box_m = {0.0, 0.0, 0.0, 2.0, 2.0, 1.0};
  start();
  publish({0, 1});
  run(2.5);
  ASSERT_FALSE(octomaps_.empty());
  EXPECT_DOUBLE_EQ(read_back(octomaps_.back()).resolution_m(), 0.2);
  EXPECT_TRUE(read_back(octomaps_.back()).has(1));
  const std::size_t before = octomaps_.size();
  publish({2, 3});
  run(2.5);
  EXPECT_EQ(octomaps_.size(), before) << "what lies beside the box is no change";
  EXPECT_FALSE(read_back(octomaps_.back()).has(2));
}

TEST_F(OctomapExport, RefusesABoxWithoutCorners) {
  config_.octomap.export_box_m = {0.0, 1.0};
  EXPECT_THROW(start(), std::invalid_argument);
  config_.octomap.export_box_m.clear();
  config_.octomap.export_resolution_m = 0.05;
  EXPECT_THROW(start(), std::invalid_argument);
}

TEST_F(OctomapExport, AsksForTheWholeMapOnceASecondUntilItComes) {
  start();
  run(2.5);
  ASSERT_EQ(requests_.size(), 3u);
  EXPECT_EQ(requests_[0].want, map_request_t::WANT_KEYFRAMES);
  EXPECT_EQ(requests_[0].first, 0);
  publish({0});
  run(5.0);
  EXPECT_EQ(requests_.size(), 3u);
}

TEST_F(OctomapExport, AsksForWhatItMissed) {
  start();
  publish({0, 1});
  run(2.0);
  ASSERT_TRUE(requests_.empty());
  publish({4});
  run(1.5);
  ASSERT_EQ(requests_.size(), 2u);
  EXPECT_EQ(requests_[0].want, map_request_t::WANT_KEYFRAMES);
  EXPECT_EQ(requests_[0].first, 2);
  EXPECT_THAT(health().message, testing::HasSubstr("waits for keyframe 2"));
  EXPECT_EQ(octomaps_.back().view_id, 2);

  publish({2, 3, 4});
  run(2.0);
  EXPECT_EQ(requests_.size(), 2u);
  EXPECT_EQ(octomaps_.back().view_id, 5);
  for (const std::int32_t index : {0, 1, 2, 3, 4})
    EXPECT_TRUE(read_back(octomaps_.back()).has(index)) << index;
  EXPECT_THAT(health().message, testing::Not(testing::HasSubstr("waits")));
}

TEST_F(OctomapExport, DoesNotAskAgainWhileAnAnswerArrives) {
  start();
  publish({0});
  run(2.0);
  publish({9});
  run(0.1);
  ASSERT_EQ(requests_.size(), 1u);
  for (std::int32_t index = 1; index < 8; ++index) {
    publish({index});
    run(0.5);
  }
  EXPECT_EQ(requests_.size(), 1u);
}

TEST_F(OctomapExport, LetsNothingPileUpAndHealsWhatItDropped) {
  start();
  constexpr std::int32_t kMany = 100;
  for (std::int32_t index = 0; index < kMany; ++index) publish({index});
  run(4.0);
  ASSERT_FALSE(requests_.empty());
  EXPECT_EQ(requests_.back().first, static_cast<std::int32_t>(KeyframeQueue::kCapacity));
  for (std::int32_t index = requests_.back().first; index < kMany; ++index) publish({index});
  run(2.5);
  EXPECT_EQ(octomaps_.back().view_id, kMany);
  EXPECT_TRUE(read_back(octomaps_.back()).has(kMany - 1));
}

// A mapper with many keyframes: each is sent once, for one request in 32 of them.
TEST_F(OctomapExport, CatchesUpWithEachKeyframeSentOnce) {
  constexpr std::int32_t kAll = 900;
  std::int32_t sent = 0;
  word_ = {7, kAll};
  answer_ = [&](const map_request_t& request) {
    const std::int32_t end = std::min(request.first + bus::kKeyframesAtOnce, kAll);
    for (std::int32_t i = request.first; i < end; ++i, ++sent)
      bus_.publish(bus::kKeyframe, keyframe(i));
  };
  start();
  run(25.0);
  EXPECT_EQ(sent, kAll);
  EXPECT_EQ(requests_.size(), 29u);
  EXPECT_EQ(octomaps_.back().view_id, kAll);
  EXPECT_EQ(health().message, "");
}

TEST_F(OctomapExport, AsksOnWhereTheMappersWordWasLost) {
  start();
  run(0.1);
  for (std::int32_t i = 0; i < bus::kKeyframesAtOnce; ++i) publish({i});
  run(1.5);
  EXPECT_EQ(requests_.back().first, bus::kKeyframesAtOnce);
}

TEST_F(OctomapExport, BelievesOnlyTheWordOnItsOwnRequest) {
  start();
  run(0.1);
  publish({0});
  run(1.5);
  ASSERT_EQ(requests_.size(), 1u);
  word_ = {7, 5};
  say_word(0);
  word_.reset();
  run(1.5);
  EXPECT_EQ(requests_.size(), 1u);
  word_ = {7, 5};
  run(0.5);
  ASSERT_EQ(requests_.size(), 2u);
  EXPECT_EQ(requests_[1].first, 1);
}

// A mapper that has keyframes 0 to 2 of map 7, and somebody who makes others up.
class OctomapOfAMapper : public OctomapExport {
 protected:
  OctomapOfAMapper() {
    word_ = {7, 3};
    answer_ = [this](const map_request_t& request) {
      for (std::int32_t i = request.first; i < 3; ++i) bus_.publish(bus::kKeyframe, keyframe(i));
    };
    start();
    run(2.5);
    requests_.clear();
    octomaps_before_ = octomaps_.size();
  }

  std::size_t octomaps_before_ = 0;

  void expect_the_same() {
    run(5.0);
    EXPECT_EQ(octomaps_.back().map_id, 7);
    EXPECT_EQ(octomaps_.back().view_id, 3);
    for (const std::int32_t index : {0, 1, 2})
      EXPECT_TRUE(read_back(octomaps_.back()).has(index)) << index;
    EXPECT_EQ(octomaps_.size(), octomaps_before_) << "nothing was built anew";
    requests_.clear();
    run(5.0);
    EXPECT_TRUE(requests_.empty()) << "it waits for nothing";
  }
};

TEST_F(OctomapOfAMapper, LeavesOutKeyframesOfAnotherMap) {
  publish({0, 1, 3}, 8);
  expect_the_same();
}

TEST_F(OctomapOfAMapper, LeavesOutKeyframesBeyondTheMap) {
  publish({3, 1000, 2'000'000'000});
  expect_the_same();
}

TEST_F(OctomapOfAMapper, LeavesOutAnotherKeyframeInThePlaceOfOneThatItHas) {
  keyframe_t forged = keyframe(1);
  forged.utime += 5;
  for (int i = 0; i < 20; ++i) {
    bus_.publish(bus::kKeyframe, forged);
    run(0.1);
  }
  expect_the_same();
}

TEST_F(OctomapOfAMapper, StartsOverWhenTheMapperHasAnotherKeyframeThere) {
  answer_ = [this](const map_request_t& request) {
    for (std::int32_t i = request.first; i < 3; ++i) {
      keyframe_t other = keyframe(i);
      if (i == 2) other.utime += 5;
      bus_.publish(bus::kKeyframe, other);
    }
  };
  keyframe_t other = keyframe(2);
  other.utime += 5;
  bus_.publish(bus::kKeyframe, other);
  run(6.0);
  EXPECT_EQ(octomaps_.back().utime, 707);
  EXPECT_EQ(octomaps_.back().view_id, 3);
}

TEST_F(OctomapOfAMapper, IsMadeAnewWhereTheMapperHasMovedItsKeyframes) {
  word_ = {7, 4, 1};
  answer_ = [this](const map_request_t& request) {
    for (std::int32_t i = request.first; i < 3; ++i) {
      keyframe_t moved = keyframe(i);
      moved.trans[1] += 10.0;
      bus_.publish(bus::kKeyframe, moved);
    }
  };
  say_word(0);
  run(5.0);
  EXPECT_EQ(octomaps_.back().view_id, 3);
  for (const std::int32_t index : {0, 1, 2}) {
    EXPECT_TRUE(read_back(octomaps_.back()).has(index + 10)) << index;
    EXPECT_FALSE(read_back(octomaps_.back()).has(index)) << index;
  }
}

TEST_F(OctomapOfAMapper, GoesOverToTheMapThatTheMapperHasNow) {
  word_ = {8, 1};
  answer_ = [this](const map_request_t&) { bus_.publish(bus::kKeyframe, keyframe(0, 8)); };
  say_word(0);
  run(3.0);
  EXPECT_EQ(octomaps_.back().map_id, 8);
  EXPECT_EQ(octomaps_.back().view_id, 1);
}

TEST_F(OctomapExport, SaysThatItShortensRays) {
  start();
  bus::PosedCloud far;
  far.map_id = 7;
  for (int i = 0; i < 30'000; ++i) {
    const float a = 0.1F * float(i), b = 0.0001F * float(i - 15'000);
    far.cloud.points.emplace_back(99.F * std::cos(a) * std::cos(b),
                                  99.F * std::sin(a) * std::cos(b), 99.F * std::sin(b) * 0.9F);
  }
  far.cloud.utime_us = 700;
  bus_.publish(bus::kKeyframe, bus::to_message(far));
  run(1.5);
  EXPECT_EQ(health().state, health_t::STATE_WARNING);
  EXPECT_NE(health().message.find("free only"), std::string::npos) << health().message;
}

TEST_F(OctomapExport, GivesUpACloudWhenItIsAskedToStop) {
  start_with_files();
  service::stop_on_signals(false);
  std::raise(SIGTERM);
  publish({0});
  service_->tick(now_us_);
  service::stop_on_signals(false);
  service_->stop();
  EXPECT_TRUE(std::filesystem::exists(file("map.bt")));
  EXPECT_FALSE(read_back(file("map.bt")).has(0));
}

TEST_F(OctomapExport, InsertsOneKeyframeATick) {
  start();
  publish({0, 1, 2});
  service_->tick(now_us_);
  bus_.handle(std::chrono::milliseconds(0));
  ASSERT_EQ(octomaps_.size(), 1u);
  EXPECT_EQ(octomaps_[0].view_id, 1);
}

TEST_F(OctomapExport, StartsANewOctomapForANewMap) {
  start();
  publish({0, 1});
  run(1.5);
  publish({0}, 8);
  run(1.5);
  EXPECT_EQ(octomaps_.back().map_id, 8);
  EXPECT_EQ(octomaps_.back().view_id, 1);
  EXPECT_TRUE(read_back(octomaps_.back()).has(0));
  EXPECT_FALSE(read_back(octomaps_.back()).has(1));
}

TEST_F(OctomapExport, RefusesAKeyframeWithoutAPose) {
  start();
  keyframe_t bad = keyframe(0);
  bad.quat[0] = 0.0;
  bus_.publish(bus::kKeyframe, bad);
  run(1.0);
  EXPECT_TRUE(octomaps_.empty());
  const health_t told = health();
  ASSERT_EQ(told.n_counters, 1);
  EXPECT_EQ(told.counters[0].name, "KEYFRAME/refused");
}

TEST_F(OctomapExport, WritesFilesThatOctomapReads) {
  start_with_files();
  publish({0, 1});
  run(0.1);
  service_->stop();
  EXPECT_TRUE(read_back(file("map.bt")).has(1));
  const std::unique_ptr<octomap::AbstractOcTree> tree(
      octomap::AbstractOcTree::read(file("map.ot").string()));
  ASSERT_NE(tree, nullptr);
  EXPECT_EQ(tree->getTreeType(), "OcTree");
  EXPECT_GT(tree->size(), 20u);
}

TEST_F(OctomapExport, WritesNothingWithoutAFolder) {
  start();
  publish({0});
  run(40.0);
  service_->stop();
  EXPECT_FALSE(std::filesystem::exists("map.bt"));
  EXPECT_NE(health().state, health_t::STATE_ERROR);
}

TEST_F(OctomapExport, WritesFilesPeriodicallyButOnlyChanges) {
  config_.save_period_s = 10.0;
  start_with_files();
  publish({0});
  run(10.5);
  ASSERT_TRUE(read_back(file("map.bt")).has(0));
  publish({1});
  run(9.0);
  EXPECT_FALSE(read_back(file("map.bt")).has(1));
  run(1.0);
  EXPECT_TRUE(read_back(file("map.bt")).has(1));
  std::filesystem::remove(file("map.bt"));
  run(30.0);
  service_->stop();
  EXPECT_FALSE(std::filesystem::exists(file("map.bt")));
}

TEST_F(OctomapExport, WritesFilesOnlyOnStopIfToldSo) {
  config_.save_period_s = 0.0;
  start_with_files();
  publish({0});
  run(60.0);
  EXPECT_FALSE(std::filesystem::exists(file("map.bt")));
  service_->stop();
  EXPECT_TRUE(read_back(file("map.bt")).has(0));
}

TEST_F(OctomapExport, KeepsTheFilesOfBeforeItWasKilledWhileItCatchesUp) {
  config_.save_period_s = 10.0;
  {
    bus::Bus bus({.url = "memq://", .prefix = ""});
    config_.folder = (folder_ / "map").string();
    OctomapExportService before(bus, health_, config_);
    for (const std::int32_t index : {0, 1, 2}) bus.publish(bus::kKeyframe, keyframe(index));
    bus.handle(std::chrono::milliseconds(0));
    for (int i = 0; i < 3; ++i) before.tick(i);
    before.stop();
  }
  start_with_files();
  publish({0});
  run(5.0);
  EXPECT_TRUE(read_back(file("map.bt")).has(2)) << "replaced by the first keyframe alone";
  publish({2});
  run(30.0);
  EXPECT_TRUE(read_back(file("map.bt")).has(2)) << "replaced while keyframe 1 is missing";
  publish({1, 3});
  run(1.0);
  EXPECT_TRUE(read_back(file("map.bt")).has(3));
}

TEST_F(OctomapExport, KeepsRunningWhenTheDiskIsFull) {
  config_.save_period_s = 10.0;
  start_with_files();
  publish({0});
  {
    const FullDisk full;
    run(15.0);
    EXPECT_THROW(service_->stop(), std::runtime_error);
  }
  health_t told = health();
  EXPECT_EQ(told.state, health_t::STATE_ERROR);
  EXPECT_NE(told.message.find("map.bt"), std::string::npos) << told.message;
  EXPECT_FALSE(std::filesystem::exists(file("map.bt")));
  EXPECT_EQ(octomaps_.size(), 1u);

  run(10.0);
  told = health();
  EXPECT_NE(told.state, health_t::STATE_ERROR) << told.message;
  EXPECT_TRUE(read_back(file("map.bt")).has(0));
}

}  // namespace
}  // namespace voxlist::services
