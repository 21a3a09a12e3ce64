#include "voxlist/mapping/loops/stored_looks.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/cursor.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/built/checked_stream.h"
#include "voxlist/system/version.h"

namespace voxlist::mapping {
namespace {

constexpr std::uint64_t kMagic = 0x3130304b4c584f56;  // "VOXLK001"

class Writing {
 public:
  explicit Writing(CheckedWriter& out) : out_(out) {}

  void put(double value) { out_.put(value); }
  void put(std::size_t value) { out_.put(std::uint64_t{value}); }
  void put(const Pose2& pose) { out_.put(pose); }
  void put(const Tilt& tilt) { out_.put(tilt); }
  void put(const Pose3& pose) { put(pose.matrix()); }

  template <class Scalar, int kRows, int kColumns>
  void put(const Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) put(matrix.data()[i]);
  }

  void put(const UncertainPose& pose) { put_all(pose.pose, pose.covariance); }
  void put(const UncertainPose3& pose) { put_all(pose.pose, pose.covariance); }

  void put(const NeighbourLook& look) {
    put_all(look.expected, look.expected_back, look.there, look.back);
  }
  void put(const Loop& loop) {
    put_all(loop.edge.from, loop.edge.to, loop.edge.T_from_to, loop.look, loop.probability);
  }
  void put(const TakenLook& taken) {
    const LoopLook& look = taken.look;
    put_all(look.keyframe, look.reach_m, look.from, look.predicted, look.round, taken.places);
  }
  void put(const SpatialLook::Other& other) {
    put_all(other.keyframe, other.T_from_other, other.tilt);
  }
  void put(const TakenSpatialLook& taken) {
    const SpatialLook& look = taken.look;
    put_all(look.keyframe, look.tilt, look.expected, look.off_m, look.others, taken.found);
  }

  template <class First, class Second>
  void put(const std::pair<First, Second>& both) {
    put_all(both.first, both.second);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(std::size_t{value.has_value()});
    if (value) put(*value);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(values.size());
    for (const T& value : values) put(value);
  }
  template <class Key, class T>
  void put(const std::map<Key, T>& values) {
    put(values.size());
    for (const auto& value : values) {
      put(value);
      out_.end_item();
    }
  }

 private:
  template <class... T>
  void put_all(const T&... values) {
    (put(values), ...);
  }

  CheckedWriter& out_;
};

// Takes what Writing puts, in the same order.
class Reading {
 public:
  explicit Reading(CheckedReader& in) : in_(in) {}

  void take(double& value) { value = in_.take<double>(); }
  void take(std::size_t& value) { value = in_.take<std::uint64_t>(); }
  void take(Pose2& pose) { pose = in_.take<Pose2>(); }
  void take(Tilt& tilt) { tilt = in_.take<Tilt>(); }
  void take(Pose3& pose) { take(pose.matrix()); }

  template <class Scalar, int kRows, int kColumns>
  void take(Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) take(matrix.data()[i]);
  }

  void take(UncertainPose& pose) { take_all(pose.pose, pose.covariance); }
  void take(UncertainPose3& pose) { take_all(pose.pose, pose.covariance); }

  void take(NeighbourLook& look) {
    take_all(look.expected, look.expected_back, look.there, look.back);
  }
  void take(Loop& loop) {
    take_all(loop.edge.from, loop.edge.to, loop.edge.T_from_to, loop.look, loop.probability);
  }
  void take(TakenLook& taken) {
    LoopLook& look = taken.look;
    take_all(look.keyframe, look.reach_m, look.from, look.predicted, look.round, taken.places);
  }
  void take(SpatialLook::Other& other) { take_all(other.keyframe, other.T_from_other, other.tilt); }
  void take(TakenSpatialLook& taken) {
    SpatialLook& look = taken.look;
    take_all(look.keyframe, look.tilt, look.expected, look.off_m, look.others, taken.found);
  }

  template <class First, class Second>
  void take(std::pair<First, Second>& both) {
    take_all(both.first, both.second);
  }
  template <class T>
  void take(std::optional<T>& value) {
    if (count() > 0) take(value.emplace());
  }
  template <class T>
  void take(std::vector<T>& values) {
    for (std::size_t left = count(); left > 0; --left) take(values.emplace_back());
  }
  template <class Key, class T>
  void take(std::map<Key, T>& values) {
    for (std::size_t left = count(); left > 0; --left) {
      std::pair<Key, T> value;
      take(value);
      values.insert(std::move(value));
    }
  }

 private:
  // No more than the file has bytes.
  std::size_t count() {
    std::size_t count = 0;
    take(count);
    if (count > in_.size()) throw io::FormatError("has more than it can hold");
    return count;
  }

  template <class... T>
  void take_all(T&... values) {
    (take(values), ...);
  }

  CheckedReader& in_;
};

// What tells keyframes apart, and the order in which they came.
std::size_t name_of(const StoredGraph::Keyframe& keyframe) {
  return 2 * static_cast<std::size_t>(keyframe.utime_us) + std::size_t{keyframe.begins_session};
}

std::size_t version_hash() { return std::hash<std::string>()(version()); }

bool is_of(Reading& in, std::int64_t map_id, const std::vector<StoredGraph::Keyframe>& keyframes) {
  std::size_t by = 0, of = 0;
  in.take(by);
  in.take(of);
  std::vector<std::size_t> names;
  in.take(names);
  return by == version_hash() && of == static_cast<std::size_t>(map_id) &&
         names.size() <= keyframes.size() &&
         std::equal(
             names.begin(), names.end(), keyframes.begin(),
             [](std::size_t name, const auto& keyframe) { return name == name_of(keyframe); });
}

}  // namespace

void write_looks(const std::filesystem::path& folder, std::int64_t map_id,
                 const std::vector<StoredGraph::Keyframe>& keyframes, const LookMemory& memory) {
  io::AtomicFile file(folder / kLooksFile);
  CheckedWriter checked(file);
  Writing out(checked);
  std::vector<std::size_t> names;
  for (const auto& keyframe : keyframes) names.push_back(name_of(keyframe));
  checked.put(kMagic);
  out.put(version_hash());
  out.put(static_cast<std::size_t>(map_id));
  out.put(names);
  const LookMemory::Looks looks = memory.all();
  out.put(looks.neighbours);
  out.put(looks.loops);
  out.put(looks.in_space);
  checked.finish();
  file.commit();
}

std::string read_looks(const std::filesystem::path& folder, std::int64_t map_id,
                       const std::vector<StoredGraph::Keyframe>& keyframes, LookMemory& memory) {
  const std::filesystem::path file = folder / kLooksFile;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return {};
  try {
    io::FileWindow window(file);
    CheckedReader checked(window);
    if (checked.take<std::uint64_t>() != kMagic) throw io::FormatError("has no looks");
    Reading in(checked);
    if (!is_of(in, map_id, keyframes)) return {};
    LookMemory::Looks looks;
    in.take(looks.neighbours);
    in.take(looks.loops);
    in.take(looks.in_space);
    checked.end();
    memory.take(std::move(looks));
  } catch (const std::exception& failure) {
    return file.string() + ": " + failure.what();
  }
  return {};
}

}  // namespace voxlist::mapping
