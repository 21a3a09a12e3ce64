// The edits beside a keyframe file.
#include "voxlist/mapping/edits/stored_edits.h"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/temporary_folder.h"
#include "voxlist/io/files/file.h"

namespace voxlist::mapping {
namespace {

using testing::HasSubstr;

MapEdits some_edits(std::int64_t map_id = 42) {
  MapEdits edits{map_id, 7, 12, {}};
  for (const auto kind : {EditKind::kErase, EditKind::kKeepFree, EditKind::kKeepBlocked}) {
    MapEdit edit{static_cast<std::int64_t>(edits.edits.size()) + 3,
                 kind,
                 {Eigen::Vector3d(1.0 / 3.0, -2.0, 1e-17), Eigen::Vector3d(1.0, -1.9, 2.0)},
                 5,
                 1'234'567,
                 {0.1, 1e-20, -3.0}};
    edits.edits.push_back(edit);
  }
  return edits;
}

void replace(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::trunc) << text;
}

TEST(StoredEdits, AreReadAsTheyWereWritten) {
  const MapEdits edits = some_edits();
  const auto read = parse_edits(to_text(edits));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->map_id, 42);
  EXPECT_EQ(read->changes, 7);
  EXPECT_EQ(read->next_id, 12);
  ASSERT_EQ(read->edits.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const MapEdit &in = edits.edits[i], &out = read->edits[i];
    EXPECT_EQ(out.id, in.id);
    EXPECT_EQ(out.kind, in.kind);
    EXPECT_EQ(out.box.min(), in.box.min());
    EXPECT_EQ(out.box.max(), in.box.max());
    EXPECT_EQ(out.keyframe, in.keyframe);
    EXPECT_EQ(out.utime_us, in.utime_us);
    EXPECT_EQ(out.T_map_keyframe, in.T_map_keyframe);
  }
}

TEST(StoredEdits, AreNoneWhereverTheyAreCut) {
  const std::string text = to_text(some_edits());
  ASSERT_TRUE(parse_edits(text));
  for (std::size_t length = 0; length + 1 < text.size(); ++length)
    EXPECT_FALSE(parse_edits(text.substr(0, length))) << length;
}

TEST(StoredEdits, AreNoneWithAnyBitFlipped) {
  const std::string text = to_text(some_edits());
  for (std::size_t at = 0; at + 1 < text.size(); ++at) {
    std::string flipped = text;
    flipped[at] ^= 1;
    EXPECT_FALSE(parse_edits(flipped)) << at;
  }
}

TEST(StoredEdits, AreNoneWithABoxThatNoMapTakes) {
  MapEdits edits = some_edits();
  edits.edits[1].box.max().x() = 1e6;
  EXPECT_FALSE(parse_edits(to_text(edits)));
}

TEST(StoredEdits, AreFoundInTheirMapsFolder) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(find_edits(folder.path(), 42).fault, "");
  write_edits(folder.path(), some_edits());
  const FoundEdits found = find_edits(folder.path(), 42);
  EXPECT_EQ(found.edits.edits.size(), 3U);
  EXPECT_EQ(found.fault, "");
}

TEST(StoredEdits, OfAnotherMapAreToldAndKeptAside) {
  const test::TemporaryFolder folder;
  write_edits(folder.path(), some_edits(1));
  const FoundEdits found = find_edits(folder.path(), 42);
  EXPECT_THAT(found.fault, HasSubstr("is of another map"));
  EXPECT_TRUE(found.edits.edits.empty());
  EXPECT_EQ(found.edits.map_id, 42);
  write_edits(folder.path(), some_edits(42));
  EXPECT_EQ(find_edits(folder.path(), 42).edits.edits.size(), 3U);
  EXPECT_EQ(io::read_file(folder.path() / "edits.txt.damaged"), to_text(some_edits(1)));
}

TEST(StoredEdits, ThatAreTornAreToldAndKeptAside) {
  const test::TemporaryFolder folder;
  replace(folder.path() / kEditsFile, "# voxlist edits 1\nerase");
  EXPECT_THAT(find_edits(folder.path(), 42).fault, HasSubstr("is torn"));
  write_edits(folder.path(), some_edits(42));
  EXPECT_EQ(find_edits(folder.path(), 42).fault, "");
  EXPECT_EQ(io::read_file(folder.path() / "edits.txt.damaged"), "# voxlist edits 1\nerase");
}

TEST(StoredEdits, OfAMapThatIsGivenUpAreKeptAside) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(give_up_edits(folder.path()));
  write_edits(folder.path(), some_edits());
  EXPECT_EQ(give_up_edits(folder.path()), folder.path() / "edits.txt.given-up");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / kEditsFile));
  EXPECT_EQ(io::read_file(folder.path() / "edits.txt.given-up"), to_text(some_edits()));
}

}  // namespace
}  // namespace voxlist::mapping
