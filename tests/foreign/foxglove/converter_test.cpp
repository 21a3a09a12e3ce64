#include "voxlist/foreign/foxglove/converter.h"

#include <foxglove.pb.h>
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.pb.h>

#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/pixel_map_t.hpp>

#include "tests/foreign/scene.h"
#include "voxlist/bus/convert.h"

namespace voxlist::foreign {
namespace {

using testing::IsEmpty;
using testing::Not;

// Keeps all that it is told.
class Listener : public Audience {
 public:
  bool wants(const Topic& topic) override { return !unwanted.contains(topic.name); }
  void tell(const Topic& topic, std::int64_t utime_us, std::string bytes) override {
    told[topic.name].push_back(std::move(bytes));
    last_us = utime_us;
  }

  template <class M>
  std::vector<M> messages(const std::string& topic) const {
    std::vector<M> decoded;
    for (const std::string& bytes : told.at(topic))
      EXPECT_TRUE(decoded.emplace_back().ParseFromString(bytes)) << topic;
    return decoded;
  }

  std::size_t bytes(const std::string& topic) const {
    std::size_t sum = 0;
    for (const std::string& each : told.at(topic)) sum += each.size();
    return sum;
  }

  std::set<std::string> unwanted;
  std::map<std::string, std::vector<std::string>> told;
  std::int64_t last_us = 0;
};

int points_in(const foxglove::PointCloud& cloud) {
  return static_cast<int>(cloud.data().size() / cloud.point_stride());
}

float number_at(const std::string& data, std::size_t offset) {
  float value = 0.F;
  std::memcpy(&value, data.data() + offset, sizeof value);
  return value;
}

class AConverter : public testing::Test {
 protected:
  void take_scene() {
    for (const test::SceneMessage& message : test::scene())
      converter_.take(message.channel, message.bytes);
    converter_.tell_rest();
    EXPECT_THAT(converter_.faults(), IsEmpty());
  }

  Listener listener_;
  Converter converter_{listener_, {}};
};

TEST_F(AConverter, TellsEveryTopicThatTheReadmeHas) {
  take_scene();
  std::set<std::string> topics;
  for (const auto& [topic, messages] : listener_.told) topics.insert(topic);
  EXPECT_EQ(topics, (std::set<std::string>{
                        "/map", "/path", "/pose", "/truth", "/odometry", "/tf", "/cloud",
                        "/cloud_slice", "/candidates", "/candidate_points", "/localisation",
                        "/obstacles", "/grid/low", "/traversability/low", "/health", "/free_space",
                        "/moving_obstacles", "/scan/low", "/scan_far/low"}));
}

TEST_F(AConverter, KeepsEveryPointOfACloud) {
  take_scene();
  const auto clouds = listener_.messages<foxglove::PointCloud>("/cloud");
  ASSERT_EQ(clouds.size(), test::kSeconds);
  EXPECT_EQ(points_in(clouds[0]), test::points_of_cloud());
  EXPECT_EQ(clouds[0].frame_id(), "base");
  EXPECT_EQ(clouds[3].timestamp().seconds(), test::kSceneStart_us / 1'000'000 + 3);
  EXPECT_FLOAT_EQ(number_at(clouds[0].data(), 0), -2.F);
  EXPECT_FLOAT_EQ(number_at(clouds[0].data(), 4), 1.5F);
}

TEST_F(AConverter, TellsTheWholeMapInTheEndAndLessWhileItGrows) {
  take_scene();
  const auto maps = listener_.messages<foxglove::PointCloud>("/map");
  ASSERT_GT(maps.size(), 3U);
  for (std::size_t i = 1; i < maps.size(); ++i)
    EXPECT_GT(points_in(maps[i]), points_in(maps[i - 1]));
  // The wall that was seen is 4 m and the robot's way long, 2 m high, in voxels of at most 0.1 m.
  const double length_m = 4.0 + test::x_m(test::kSeconds - 1);
  EXPECT_GT(points_in(maps.back()), 0.9 * length_m * 10 * 20);
  EXPECT_EQ(maps.back().frame_id(), "map");
}

TEST_F(AConverter, TellsThePathOfAllPoses) {
  take_scene();
  const auto path = listener_.messages<foxglove::PointCloud>("/path").back();
  ASSERT_EQ(points_in(path), test::kSeconds);
  for (int i = 0; i < test::kSeconds; ++i)
    EXPECT_FLOAT_EQ(number_at(path.data(), static_cast<std::size_t>(i) * path.point_stride()),
                    static_cast<float>(test::x_m(i)));
}

TEST_F(AConverter, ForgetsThePathOfAnotherMap) {
  take_scene();
  bus::MapChange other;
  other.utime_us = test::kSceneStart_us + 100'000'000;
  other.map_id = 8;
  other.resolution = {0.05, 0.1};
  converter_.take(other);
  for (const test::SceneMessage& message : test::scene())
    if (message.channel == "POSE") converter_.take(message.channel, message.bytes);
  converter_.tell_rest();
  const auto path = listener_.messages<foxglove::PointCloud>("/path").back();
  EXPECT_EQ(points_in(path), test::kSeconds);
}

TEST_F(AConverter, TellsAGrowingMapInAMultipleOfItsLastSize) {
  // Without the share each change would be told, which makes the square of it.
  constexpr int kMost = 21;
  take_scene();
  EXPECT_LT(listener_.bytes("/map"), kMost * listener_.told["/map"].back().size());
}

TEST_F(AConverter, TellsTheMapLaterToWhoDidNotWantItFirst) {
  listener_.unwanted = {"/map", "/cloud", "/path"};
  const auto messages = test::scene();
  for (const test::SceneMessage& message : messages)
    converter_.take(message.channel, message.bytes);
  EXPECT_FALSE(listener_.told.contains("/map"));
  EXPECT_FALSE(listener_.told.contains("/cloud"));
  listener_.unwanted.clear();
  converter_.tick(messages.back().utime_us);
  EXPECT_EQ(listener_.told["/map"].size(), 1U);
  EXPECT_EQ(listener_.told["/path"].size(), 1U);
}

TEST_F(AConverter, TellsPosesAndFrames) {
  take_scene();
  const auto poses = listener_.messages<foxglove::PoseInFrame>("/pose");
  ASSERT_EQ(poses.size(), test::kSeconds);
  EXPECT_DOUBLE_EQ(poses[4].pose().position().x(), test::x_m(4));
  EXPECT_DOUBLE_EQ(poses[4].pose().orientation().w(), 1.0);
  EXPECT_EQ(listener_.messages<foxglove::PoseInFrame>("/odometry")[0].frame_id(), "odom");
  std::map<std::string, double> last_x_m;
  for (const auto& transform : listener_.messages<foxglove::FrameTransform>("/tf")) {
    EXPECT_EQ(transform.parent_frame_id(), "map");
    last_x_m[transform.child_frame_id()] = transform.translation().x();
  }
  EXPECT_EQ(last_x_m, (std::map<std::string, double>{{"base", test::x_m(test::kSeconds - 1)},
                                                     {"odom", 0.1}}));
}

TEST_F(AConverter, TellsCandidatesWithTheirProbabilities) {
  take_scene();
  EXPECT_EQ(listener_.messages<foxglove::PosesInFrame>("/candidates").back().poses_size(),
            test::kPlaces);
  const auto points = listener_.messages<foxglove::PointCloud>("/candidate_points").back();
  ASSERT_EQ(points_in(points), test::kPlaces);
  EXPECT_EQ(points.fields(3).name(), "probability");
  EXPECT_FLOAT_EQ(number_at(points.data(), points.fields(3).offset()), 0.3F);
  const auto states = listener_.messages<foxglove::Log>("/localisation");
  ASSERT_EQ(states.size(), 2U);  // TRACKING, then AMBIGUOUS
  EXPECT_EQ(states[0].message(), "TRACKING");
  EXPECT_EQ(states[1].level(), foxglove::Log::WARNING);
}

TEST_F(AConverter, TellsObstaclesWithTheirTypes) {
  take_scene();
  const auto cloud = listener_.messages<foxglove::PointCloud>("/obstacles")[0];
  ASSERT_EQ(points_in(cloud), 3);
  const auto& type = cloud.fields(cloud.fields_size() - 1);
  EXPECT_EQ(type.name(), "type");
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(static_cast<std::size_t>(cloud.data()[i * cloud.point_stride() + type.offset()]), i);
}

TEST_F(AConverter, TellsWhatMovesAsPostsWithAnArrow) {
  take_scene();
  const auto update = listener_.messages<foxglove::SceneUpdate>("/moving_obstacles")[0];
  ASSERT_EQ(update.entities_size(), 1);
  const auto& entity = update.entities(0);
  EXPECT_EQ(entity.frame_id(), "base");
  EXPECT_EQ(entity.lifetime().seconds(), 1);
  ASSERT_EQ(entity.cylinders_size(), 1);
  EXPECT_DOUBLE_EQ(entity.cylinders(0).pose().position().x(), 2.0);
  EXPECT_NEAR(entity.cylinders(0).size().x(), 0.6, 1e-6);
  ASSERT_EQ(entity.arrows_size(), 1);
  EXPECT_DOUBLE_EQ(entity.arrows(0).shaft_length(), 0.5);
  EXPECT_NEAR(entity.arrows(0).pose().orientation().z(), std::sqrt(0.5), 1e-9) << "to the left";
}

TEST_F(AConverter, TellsScansWithTheirBearings) {
  take_scene();
  for (const char* topic : {"/scan/low", "/scan_far/low"}) {
    const auto scan = listener_.messages<foxglove::LaserScan>(topic)[0];
    EXPECT_EQ(scan.frame_id(), "base");
    EXPECT_DOUBLE_EQ(scan.start_angle(), -1.0);
    EXPECT_DOUBLE_EQ(scan.end_angle(), 1.0);
    ASSERT_EQ(scan.ranges_size(), 5);
    EXPECT_DOUBLE_EQ(scan.ranges(4), 5.0);
  }
}

TEST_F(AConverter, TellsFreeAndOccupiedSpaceInCellsTwiceAsLarge) {
  take_scene();
  const auto space = listener_.messages<foxglove::PointCloud>("/free_space").back();
  ASSERT_EQ(points_in(space), 4 * 2 + 4);
  const auto& occupied = space.fields(space.fields_size() - 1);
  EXPECT_EQ(occupied.name(), "occupied");
  int count = 0;
  for (std::size_t i = 0; i < 12; ++i)
    count += space.data()[i * space.point_stride() + occupied.offset()];
  EXPECT_EQ(count, 4);
  EXPECT_FLOAT_EQ(number_at(space.data(), 0), 0.08F);
}

TEST_F(AConverter, MakesTheMapOfKeyframesWhereNobodyTellsIt) {
  bus::PosedCloud keyframe;
  keyframe.index = 0;
  keyframe.cloud.utime_us = test::kSceneStart_us;
  keyframe.cloud.points = {{1.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}};
  keyframe.T_map_base.translation().y() = 5.03;
  converter_.take("KEYFRAME", bus::to_message(keyframe));
  keyframe.T_map_base.translation().y() = 7.03;  // moved since
  converter_.take("KEYFRAME", bus::to_message(keyframe));
  converter_.tell_rest();
  const auto map = listener_.messages<foxglove::PointCloud>("/map").back();
  ASSERT_EQ(points_in(map), 2);
  EXPECT_NEAR(number_at(map.data(), 4), 7.05, 0.051);
  take_scene();  // has MAP_UPDATE
  EXPECT_GT(points_in(listener_.messages<foxglove::PointCloud>("/map").back()), 100);
}

TEST_F(AConverter, TellsGridsCompressedOrNot) {
  take_scene();
  for (const char* topic : {"/grid/low", "/traversability/low"}) {
    const auto grid = listener_.messages<foxglove::Grid>(topic)[0];
    EXPECT_EQ(grid.column_count(), test::kGridColumns);
    EXPECT_EQ(grid.row_stride(), test::kGridColumns);
    EXPECT_DOUBLE_EQ(grid.cell_size().y(), 0.5);
    ASSERT_EQ(grid.data().size(), test::kGridColumns * test::kGridRows) << topic;
    for (std::size_t i = 0; i < grid.data().size(); ++i)
      EXPECT_EQ(static_cast<std::size_t>(grid.data()[i]), i);
  }
}

TEST_F(AConverter, TellsHealthWhenItChangesAndEveryTenSeconds) {
  take_scene();
  const auto lines = listener_.messages<foxglove::Log>("/health");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].message(), "all is well");
  EXPECT_EQ(lines[0].level(), foxglove::Log::INFO);
  EXPECT_EQ(lines[1].message(), "the disk is nearly full");
  EXPECT_EQ(lines[1].name(), "mapper");
}

TEST_F(AConverter, CountsAGridWhoseCellsAreNotThere) {
  pixel_map_t grid{};
  grid.utime = 1;
  grid.dimensions[0] = grid.dimensions[1] = 30'000;
  grid.mpp = 0.1;
  grid.data_type = pixel_map_t::DATA_TYPE_UINT8;
  converter_.take("GRID_low", grid);
  grid.dimensions[0] = grid.dimensions[1] = 2;
  grid.compressed = 1;
  converter_.take("GRID_low", grid);
  EXPECT_EQ(converter_.faults().at("GRID_low/senseless"), 2);
  EXPECT_THAT(listener_.told, IsEmpty());
}

TEST_F(AConverter, TakesAnyBytes) {
  const auto messages = test::scene();
  std::mt19937 random(4);
  for (int i = 0; i < 4000; ++i) {
    test::SceneMessage message = messages[random() % messages.size()];
    for (auto n = random() % 4; n > 0; --n)
      message.bytes[random() % message.bytes.size()] = static_cast<std::uint8_t>(random());
    if (random() % 4 == 0) message.bytes.resize(random() % message.bytes.size());
    converter_.take(message.channel, message.bytes);
  }
  converter_.tell_rest();
  EXPECT_THAT(converter_.faults(), Not(IsEmpty()));
}

TEST(Schemas, DefineTheirTypeWithAllThatItNeeds) {
  for (const Kind kind : {Kind::kPointCloud, Kind::kPoseInFrame, Kind::kPosesInFrame,
                          Kind::kFrameTransform, Kind::kGrid, Kind::kLog}) {
    google::protobuf::FileDescriptorSet files;
    ASSERT_TRUE(files.ParseFromString(schema_of(kind)));
    google::protobuf::DescriptorPool pool;
    for (const auto& file : files.file()) EXPECT_NE(pool.BuildFile(file), nullptr);
    EXPECT_NE(pool.FindMessageTypeByName(name_of(kind)), nullptr) << name_of(kind);
  }
}

}  // namespace
}  // namespace voxlist::foreign
