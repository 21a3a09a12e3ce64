#include "voxlist/foreign/lcm/lcm_types.h"

#include <gmock/gmock.h>

#include <set>
#include <voxlist/localisation_t.hpp>
#include <voxlist/pose_t.hpp>

namespace voxlist::foreign {
namespace {

using testing::HasSubstr;
using testing::Not;

template <class M>
std::vector<std::uint8_t> encoded() {
  std::vector<std::uint8_t> bytes;
  EXPECT_EQ(bus::encode(M{}, bytes), bus::Fault::kNone);
  return bytes;
}

TEST(LcmTypes, AreToldByAMessagesFirstBytes) {
  const LcmType* type = lcm_type_of(encoded<pose_t>());
  ASSERT_NE(type, nullptr);
  EXPECT_EQ(type->name, "voxlist.pose_t");
  EXPECT_THAT(std::string(type->text), HasSubstr("double orientation[4];"));
}

TEST(LcmTypes, OfOthersAreNotKnown) {
  const std::vector<std::uint8_t> other{1, 2, 3, 4, 5, 6, 7, 8, 9}, short_one{1, 2, 3};
  EXPECT_EQ(lcm_type_of(other), nullptr);
  EXPECT_EQ(lcm_type_of(short_one), nullptr);
}

TEST(LcmTypes, AreDefinedWithAllTypesInThem) {
  const std::string text = definition_of(*lcm_type_of(encoded<localisation_t>()));
  EXPECT_THAT(text, HasSubstr("struct localisation_t"));
  EXPECT_THAT(text, HasSubstr("struct pose_mode_t"));
  EXPECT_THAT(text, Not(HasSubstr("struct pose_t")));
  EXPECT_THAT(definition_of(*lcm_type_of(encoded<pose_t>())), Not(HasSubstr("pose_mode_t")));
}

TEST(LcmTypes, AreEachThereOnce) {
  std::set<std::int64_t> fingerprints;
  for (const LcmType& type : lcm_types()) fingerprints.insert(type.fingerprint);
  EXPECT_EQ(fingerprints.size(), lcm_types().size());
  EXPECT_GT(fingerprints.size(), 15U);
}

}  // namespace
}  // namespace voxlist::foreign
