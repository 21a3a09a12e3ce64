#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "tests/mapping/keyframe_samples.h"
#include "voxlist/mapping/keyframe_format.h"
#include "voxlist/system/file_descriptor.h"

namespace voxlist::mapping {
namespace {

constexpr std::int64_t kSize = std::int64_t{3} << 30;

// A keyframe of 16 MiB, all of whose points are 0.
Keyframe large_keyframe() {
  Keyframe keyframe;
  keyframe.cloud.points.assign((std::size_t{16} << 20) / 12, Eigen::Vector3f::Zero());
  return keyframe;
}

// Writes a file of such records, 3 GiB long: on the disk their points are holes. False: no room.
bool write_large_file(const std::filesystem::path& path, std::int64_t& keyframes) {
  constexpr std::size_t kHead = 200;  // bytes of a record before it is all 0
  const Keyframe keyframe = large_keyframe();
  const FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  bool ok = ::pwrite(file.get(), file_header(42).data(), kFileHeaderBytes, 0) > 0;
  auto at = static_cast<std::int64_t>(kFileHeaderBytes);
  // Two records by turns, for one that is repeated is taken for one.
  const std::string records[] = {encode_record(keyframe, 42, 0), encode_record(keyframe, 42, 1)};
  for (keyframes = 0; ok && at < kSize; ++keyframes) {
    const std::string& record = records[keyframes % 2];
    ok = ::pwrite(file.get(), record.data(), kHead, at) > 0;
    at += static_cast<std::int64_t>(record.size());
  }
  return ok && ::ftruncate(file.get(), at) == 0;
}

#ifdef __SANITIZE_ADDRESS__
constexpr long kKept_kB = 256 * 1024;  // of what is freed, AddressSanitizer keeps so much
#else
constexpr long kKept_kB = 0;
#endif

long peak_kB() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(LargeKeyframeFile, Of3GiBIsReadInTheMemoryOfAFewRecords) {
  const test::TemporaryFolder folder;
  std::int64_t written = 0, read = 0;
  if (!write_large_file(folder / kKeyframeFile, written)) GTEST_SKIP() << "no room for 3 GiB";
  const long before_kB = peak_kB();
  KeyframeReader reader(folder / kKeyframeFile);
  while (const auto keyframe = reader.next()) read += keyframe->cloud.utime_us == 0;
  EXPECT_EQ(read, written);
  EXPECT_GT(read, 190);
  EXPECT_EQ(reader.warning(), "");
  EXPECT_LT(peak_kB() - before_kB, 128 * 1024 + kKept_kB);
}

TEST(LargeKeyframeFile, IsReadOnBehindAHoleInTheSameMemory) {
  const test::TemporaryFolder folder;
  std::string bytes = file_header(42) + encode_record(keyframe(0), 42, 0);
  const auto path = folder.write(kKeyframeFile, bytes);
  std::filesystem::resize_file(path, std::uintmax_t{256} << 20);
  std::ofstream(path, std::ios::binary | std::ios::app) << encode_record(keyframe(1), 42, 1);
  const long before_kB = peak_kB();
  const test::StoredMap stored = test::load_map(folder.path());
  EXPECT_EQ(numbers_of(stored.keyframes), first_numbers(2));
  EXPECT_LT(peak_kB() - before_kB, 32 * 1024 + kKept_kB);
}

}  // namespace
}  // namespace voxlist::mapping
