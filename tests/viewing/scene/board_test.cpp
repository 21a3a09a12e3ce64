#include "voxlist/viewing/scene/board.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace voxlist::viewing {
namespace {

// What somebody is told who has seen so much.
std::vector<std::string> told(const Board& board, std::int64_t seen) {
  std::vector<std::string> topics;
  for (auto entry = board.next_after(seen); entry.topic; entry = board.next_after(entry.number))
    topics.push_back(entry.topic->name + entry.topic->json);
  return topics;
}

TEST(Board, TellsTheNewestOfEachTopicInTheOrderThatTheyWereTold) {
  Board board;
  board.put("a", "1", 0);
  board.put("b", "1", 0);
  board.put("a", "2", 0);
  EXPECT_EQ(told(board, 0), (std::vector<std::string>{"b1", "a2"}));
}

TEST(Board, TellsWhoHasSeenAllNothing) {
  Board board;
  board.put("a", "1", 0);
  const std::int64_t seen = board.next_after(0).number;
  EXPECT_EQ(board.next_after(seen).topic, nullptr);
  board.put("a", "2", 0);
  EXPECT_EQ(told(board, seen), (std::vector<std::string>{"a2"}));
}

TEST(Board, DropsTopicsByTheirBeginning) {
  Board board;
  for (const char* name : {"path", "path/1", "path/2", "pose"}) board.put(name, "", 0);
  board.drop("path/");
  EXPECT_EQ(told(board, 0), (std::vector<std::string>{"path", "pose"}));
}

TEST(Board, HoldsSoManyTopicsAndNoMore) {
  Board board;
  for (std::size_t i = 0; i < 2 * Board::kMostTopics; ++i) board.put(std::to_string(i), "", 0);
  EXPECT_EQ(told(board, 0).size(), Board::kMostTopics);
}

}  // namespace
}  // namespace voxlist::viewing
