#include "voxlist/foreign/websocket/foxglove_server.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <random>

#include "voxlist/foreign/websocket/base64.h"

namespace voxlist::foreign {
namespace {

using nlohmann::json;

const Topic kPose{"/pose", Kind::kPoseInFrame}, kMap{"/map", Kind::kPointCloud};

std::uint64_t number_at(const std::string& bytes, std::size_t offset, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;)
    value = value << 8 | static_cast<std::uint8_t>(bytes.at(offset + i));
  return value;
}

class AFoxgloveServer : public testing::Test {
 protected:
  json next_text(int client) {
    const auto frame = server_.next(client);
    EXPECT_TRUE(frame && frame->is_text);
    return frame ? json::parse(frame->bytes) : json();
  }

  // A client that has been told the channels, and the ids of /pose and /map.
  int client_that_knows() {
    server_.wants(kPose);
    server_.wants(kMap);
    const int client = server_.open();
    next_text(client);
    next_text(client);
    return client;
  }

  void subscribe(int client, int id, int channel) {
    server_.on_text(
        client, json{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}}
                    .dump());
  }

  std::vector<std::string> rest(int client) {
    std::vector<std::string> frames;
    while (auto frame = server_.next(client)) frames.push_back(frame->bytes);
    return frames;
  }

  FoxgloveServer server_{"robot", "session 1"};
};

TEST_F(AFoxgloveServer, SaysFirstWhoItIs) {
  const json info = next_text(server_.open());
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["name"], "robot");
  EXPECT_EQ(info["sessionId"], "session 1");
  EXPECT_EQ(info["capabilities"], json{"time"});
}

TEST_F(AFoxgloveServer, AdvertisesChannelsWhenItHearsOfThem) {
  server_.wants(kPose);
  const int client = server_.open();
  next_text(client);
  const json first = next_text(client);
  EXPECT_EQ(first["op"], "advertise");
  ASSERT_EQ(first["channels"].size(), 1U);
  EXPECT_EQ(first["channels"][0]["topic"], "/pose");
  EXPECT_EQ(first["channels"][0]["encoding"], "protobuf");
  EXPECT_EQ(first["channels"][0]["schemaName"], "foxglove.PoseInFrame");
  EXPECT_EQ(first["channels"][0]["schema"], base64(schema_of(Kind::kPoseInFrame)));
  EXPECT_FALSE(server_.next(client));
  server_.tell(kMap, 1, "a map");
  const json second = next_text(client);
  ASSERT_EQ(second["channels"].size(), 1U);
  EXPECT_EQ(second["channels"][0]["topic"], "/map");
}

TEST_F(AFoxgloveServer, SendsWhatIsSubscribedToAndNothingElse) {
  const int client = client_that_knows();
  subscribe(client, 42, 1);
  server_.tell(kMap, 1, "a map");
  server_.tell(kPose, 1'700'000'000'000'001, "a pose");
  const auto frames = rest(client);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(number_at(frames[0], 0, 1), 1U);   // message data
  EXPECT_EQ(number_at(frames[0], 1, 4), 42U);  // of this subscription
  EXPECT_EQ(number_at(frames[0], 5, 8), 1'700'000'000'000'001'000U);
  EXPECT_EQ(frames[0].substr(13), "a pose");
}

TEST_F(AFoxgloveServer, WantsWhatSomebodyHasSubscribedTo) {
  const int client = client_that_knows();
  EXPECT_FALSE(server_.wants(kPose));
  subscribe(client, 1, 1);
  EXPECT_TRUE(server_.wants(kPose));
  EXPECT_FALSE(server_.wants(kMap));
  server_.on_text(client, R"({"op":"unsubscribe","subscriptionIds":[1]})");
  EXPECT_FALSE(server_.wants(kPose));
  subscribe(client, 1, 1);
  server_.close(client);
  EXPECT_FALSE(server_.wants(kPose));
}

TEST_F(AFoxgloveServer, SendsTheNewestMessageToWhoComesLater) {
  const int client = client_that_knows();
  server_.tell(kMap, 1, "an old map");
  server_.tell(kMap, 2, "the map");
  subscribe(client, 5, 2);
  const auto frames = rest(client);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].substr(13), "the map");
}

TEST_F(AFoxgloveServer, KeepsOnlyTheNewestLargeMessageForASlowClient) {
  const int client = client_that_knows();
  subscribe(client, 1, 2);
  for (char name = 'a'; name <= 'e'; ++name) server_.tell(kMap, 1, std::string(100'000, name));
  const auto frames = rest(client);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].back(), 'e');
}

TEST_F(AFoxgloveServer, KeepsSmallMessagesInTheirOrder) {
  const int client = client_that_knows();
  subscribe(client, 1, 1);
  for (char name = 'a'; name <= 'e'; ++name) server_.tell(kPose, 1, std::string(100, name));
  const auto frames = rest(client);
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames.front().back(), 'a');
  EXPECT_EQ(frames.back().back(), 'e');
}

TEST_F(AFoxgloveServer, GivesEachSubscriptionItsTurn) {
  const int client = client_that_knows();
  subscribe(client, 1, 1);
  subscribe(client, 2, 2);
  for (int i = 0; i < 3; ++i) server_.tell(kPose, 1, "a pose");
  server_.tell(kMap, 1, "a map");
  const auto frames = rest(client);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[1].substr(13), "a map");
}

TEST_F(AFoxgloveServer, TellsTheNewestTime) {
  const int client = client_that_knows();
  server_.tell_time(1);
  server_.tell_time(2);
  const auto frames = rest(client);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(number_at(frames[0], 0, 1), 2U);
  EXPECT_EQ(number_at(frames[0], 1, 8), 2000U);
}

TEST_F(AFoxgloveServer, WarnsWhoAsksForWhatIsNotThere) {
  const int client = client_that_knows();
  for (const char* text :
       {"", "[]", "7", "no JSON", R"({"op":"setParameters"})", R"({"op":1})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":99}]})",
        R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":[3]})"}) {
    server_.on_text(client, text);
    const json answer = next_text(client);
    EXPECT_EQ(answer["op"], "status") << text;
    EXPECT_EQ(answer["level"], 1) << text;
  }
  server_.on_binary(client, "bytes");
  EXPECT_EQ(next_text(client)["op"], "status");
  EXPECT_FALSE(server_.wants(kPose));
}

TEST_F(AFoxgloveServer, KeepsABoundedNumberOfAnswersAndTopics) {
  const int client = client_that_knows();
  for (int i = 0; i < 1000; ++i) server_.on_text(client, "nonsense");
  EXPECT_EQ(rest(client).size(), FoxgloveServer::kMostAnswers);
  for (int i = 0; i < 1000; ++i) server_.tell({"/grid/" + std::to_string(i), Kind::kGrid}, 1, "");
  EXPECT_EQ(next_text(client)["channels"].size(), FoxgloveServer::kMostTopics - 2);
}

TEST_F(AFoxgloveServer, TakesAnyText) {
  const std::string said = R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1}]})";
  std::mt19937 random(6);
  for (int i = 0; i < 20'000; ++i) {
    const int client = server_.open();
    std::string text = said;
    for (auto n = random() % 5; n > 0; --n)
      text[random() % text.size()] = static_cast<char>(random());
    server_.on_text(client, text.substr(random() % 8));
    rest(client);
    server_.close(client);
  }
  EXPECT_FALSE(server_.wants(kPose));
}

TEST(Base64, IsAsTheStandardHasIt) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("\xFF\xFE\xFD"), "//79");
}

}  // namespace
}  // namespace voxlist::foreign
