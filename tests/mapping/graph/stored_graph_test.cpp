// The graph beside a keyframe file.
#include "voxlist/mapping/graph/stored_graph.h"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/mapping/keyframe_samples.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_reader.h"

namespace voxlist::mapping {
namespace {

using testing::HasSubstr;

const Pose2 kThere{1.0 / 3.0, -7.1e-17, 3.0};

StoredGraph graph_of(int keyframes) {
  StoredGraph graph{42, 3, {}, {}};
  for (int i = 0; i < keyframes; ++i)
    graph.keyframes.push_back({1'000'000 * i, to_pose2(keyframe(i).T_map_base)});
  return graph;
}

std::vector<Keyframe> read_all(KeyframeReader& reader) {
  std::vector<Keyframe> keyframes;
  while (auto keyframe = reader.next()) keyframes.push_back(std::move(*keyframe));
  return keyframes;
}

void replace(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::trunc) << text;
}

TEST(StoredGraph, IsReadAsItWasWritten) {
  StoredGraph graph = graph_of(3);
  graph.keyframes[1] = {5, kThere, Pose2{1e-9, 2e9, -0.1}, true};
  graph.edges.push_back({2, 1, {{1.0, 2.0, -0.5}, Eigen::Vector3d(0.1, 0.2, 0.3).asDiagonal()}});
  const auto read = parse_g2o(to_g2o(graph));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->map_id, 42);
  EXPECT_EQ(read->moves, 3);
  ASSERT_EQ(read->keyframes.size(), 3U);
  EXPECT_EQ(read->keyframes[1].utime_us, 5);
  EXPECT_EQ(read->keyframes[1].T_map_keyframe, kThere);
  EXPECT_EQ(read->keyframes[1].T_odom_keyframe, graph.keyframes[1].T_odom_keyframe);
  EXPECT_TRUE(read->keyframes[1].begins_session);
  EXPECT_FALSE(read->keyframes[2].T_odom_keyframe);
  ASSERT_EQ(read->edges.size(), 1U);
  EXPECT_EQ(read->edges[0].from, 2U);
  EXPECT_EQ(read->edges[0].T_from_to.pose, (Pose2{1.0, 2.0, -0.5}));
  EXPECT_TRUE(read->edges[0].T_from_to.covariance.isApprox(graph.edges[0].T_from_to.covariance));
}

TEST(StoredGraph, IsNoneWhereverItIsCut) {
  const std::string text = to_g2o(graph_of(2));
  ASSERT_TRUE(parse_g2o(text));
  for (std::size_t length = 0; length + 1 < text.size(); ++length)
    EXPECT_FALSE(parse_g2o(text.substr(0, length))) << length;
}

TEST(StoredGraph, IsNoneWithAnyBitFlipped) {
  const std::string text = to_g2o(graph_of(2));
  for (std::size_t at = 0; at + 1 < text.size(); ++at) {
    std::string flipped = text;
    flipped[at] ^= 1;
    EXPECT_FALSE(parse_g2o(flipped)) << at;
  }
}

TEST(KeyframeReader, PutsKeyframesWhereTheGraphHasThem) {
  const test::TemporaryFolder folder;
  const auto map = make_map(folder, 4);
  StoredGraph graph = graph_of(3);
  graph.keyframes[1].T_map_keyframe = kThere;
  MapStore(map, 42, ignore).write_graph(graph);
  KeyframeReader reader(map / kKeyframeFile);
  const auto keyframes = read_all(reader);
  ASSERT_EQ(keyframes.size(), 4U);
  EXPECT_EQ(to_pose2(keyframes[1].T_map_base), kThere);
  for (const std::size_t i : {0, 2, 3})
    EXPECT_EQ(keyframes[i].T_map_base.matrix(), keyframe(int(i)).T_map_base.matrix());
  EXPECT_EQ(reader.moves(), 3);
  EXPECT_EQ(reader.next_number(), 4U);
  EXPECT_EQ(reader.warning(), "");
}

TEST(KeyframeReader, FindsTheOthersInTheGraphWhereAKeyframeIsDamaged) {
  const test::TemporaryFolder folder;
  const auto map = make_map(folder, 3);
  StoredGraph graph = graph_of(3);
  graph.keyframes[2].T_map_keyframe = kThere;
  MapStore(map, 42, ignore).write_graph(graph);
  std::string bytes = io::read_file(map / kKeyframeFile);
  KeyframeReader whole(map / kKeyframeFile);
  whole.next();
  whole.next();
  bytes[whole.place().start + 60] ^= 1;
  replace(map / kKeyframeFile, bytes);
  KeyframeReader reader(map / kKeyframeFile);
  const auto keyframes = read_all(reader);
  ASSERT_EQ(keyframes.size(), 2U);
  EXPECT_EQ(to_pose2(keyframes[1].T_map_base), kThere);
}

// What `spoil` does to the graph is told, and the keyframes stand where they came.
void expect_told(const std::string& words,
                 const std::function<void(std::filesystem::path)>& spoil) {
  const test::TemporaryFolder folder;
  const auto map = make_map(folder, 3);
  StoredGraph graph = graph_of(3);
  graph.keyframes[1].T_map_keyframe = kThere;
  MapStore(map, 42, ignore).write_graph(graph);
  spoil(map / kGraphFile);
  KeyframeReader reader(map / kKeyframeFile);
  EXPECT_EQ(numbers_of(read_all(reader)), first_numbers(3));
  EXPECT_THAT(reader.warning(), HasSubstr(words));
  EXPECT_FALSE(reader.is_damaged());
  const MapStore store(map, 42, ignore);
  EXPECT_THAT(store.notice(), HasSubstr(words));
}

TEST(KeyframeReader, TellsAGraphThatIsMissing) {
  expect_told("graph.g2o is missing", [](const auto& file) { std::filesystem::remove(file); });
}

TEST(KeyframeReader, TellsAGraphThatIsTorn) {
  expect_told("graph.g2o is torn", [](const auto& file) {
    const std::string text = io::read_file(file);
    replace(file, text.substr(0, text.size() / 2));
  });
}

TEST(KeyframeReader, TellsAGraphOfAnotherMap) {
  expect_told("graph.g2o is of another map", [](const auto& file) {
    StoredGraph other = graph_of(3);
    other.map_id = 43;
    replace(file, to_g2o(other));
  });
}

TEST(MapStore, KeepsAGraphAsideThatIsOfNoUse) {
  const test::TemporaryFolder folder;
  const auto map = make_map(folder, 3);
  replace(map / kGraphFile, "mine");
  MapStore(map, 42, ignore).write_graph(graph_of(3));
  EXPECT_EQ(io::read_file(map / "graph.g2o.damaged"), "mine");
  EXPECT_TRUE(find_graph(map, 42).graph);
}

TEST(MapStore, AppendsBehindWhatSaysThatKeyframesWereMoved) {
  const test::TemporaryFolder folder;
  const auto map = make_map(folder, 2);
  {
    MapStore store(map, 42, ignore);
    store.write_graph(graph_of(2));
    store.append(keyframe(2));
  }
  MapStore again(map, 42, ignore);
  EXPECT_EQ(again.moves(), 3);
  again.append(keyframe(3));
  KeyframeReader reader(map / kKeyframeFile);
  EXPECT_EQ(numbers_of(read_all(reader)), first_numbers(4));
  EXPECT_EQ(reader.next_number(), 4U);
}

}  // namespace
}  // namespace voxlist::mapping
