#include "voxlist/foreign/foxglove/messages.h"

#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <bit>

#include "voxlist/foreign/foxglove/message_parts.h"

namespace voxlist::foreign {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FileDescriptor;
using google::protobuf::FileDescriptorSet;

const Descriptor& descriptor_of(Kind kind) {
  switch (kind) {
    case Kind::kPointCloud:
      return *foxglove::PointCloud::descriptor();
    case Kind::kPoseInFrame:
      return *foxglove::PoseInFrame::descriptor();
    case Kind::kPosesInFrame:
      return *foxglove::PosesInFrame::descriptor();
    case Kind::kFrameTransform:
      return *foxglove::FrameTransform::descriptor();
    case Kind::kGrid:
      return *foxglove::Grid::descriptor();
    case Kind::kLaserScan:
      return *foxglove::LaserScan::descriptor();
    case Kind::kSceneUpdate:
      return *foxglove::SceneUpdate::descriptor();
    case Kind::kLog:
      break;
  }
  return *foxglove::Log::descriptor();
}

// Those that a file imports stand before it.
void add_with_imports(const FileDescriptor& file, FileDescriptorSet& to) {
  for (int i = 0; i < file.dependency_count(); ++i) add_with_imports(*file.dependency(i), to);
  file.CopyTo(to.add_file());
}

std::uint32_t size_of(PackedField::Type type) { return type == PackedField::Type::kUint8 ? 1 : 4; }

template <class M>
void set_fields(const Packed& from, M& to) {
  using foxglove::PackedElementField;
  std::uint32_t offset = 0;
  for (const PackedField& field : from.fields) {
    PackedElementField& added = *to.add_fields();
    added.set_name(field.name);
    added.set_offset(offset);
    added.set_type(field.type == PackedField::Type::kUint8 ? PackedElementField::UINT8
                                                           : PackedElementField::FLOAT32);
    offset += size_of(field.type);
  }
  to.set_data(from.data);
}

foxglove::Log::Level level_of(Level level) {
  switch (level) {
    case Level::kInfo:
      return foxglove::Log::INFO;
    case Level::kWarning:
      return foxglove::Log::WARNING;
    case Level::kError:
      break;
  }
  return foxglove::Log::ERROR;
}

}  // namespace

std::string name_of(Kind kind) { return descriptor_of(kind).full_name(); }

std::string schema_of(Kind kind) {
  FileDescriptorSet set;
  add_with_imports(*descriptor_of(kind).file(), set);
  return set.SerializeAsString();
}

std::uint32_t stride_of(const std::vector<PackedField>& fields) {
  std::uint32_t stride = 0;
  for (const PackedField& field : fields) stride += size_of(field.type);
  return stride;
}

static_assert(std::endian::native == std::endian::little, "numbers are packed as they lie");

void pack(float value, Packed& to) {
  to.data.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void pack(std::uint8_t value, Packed& to) { to.data += static_cast<char>(value); }

std::string ascii(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) > 126; }, '?');
  return text;
}

std::string point_cloud(const Stamp& stamp, const Packed& points) {
  foxglove::PointCloud message;
  set_stamp(stamp, message);
  set(Pose3::Identity(), *message.mutable_pose());
  message.set_point_stride(stride_of(points.fields));
  set_fields(points, message);
  return message.SerializeAsString();
}

std::string pose_in_frame(const Stamp& stamp, const Pose3& pose) {
  foxglove::PoseInFrame message;
  set_stamp(stamp, message);
  set(pose, *message.mutable_pose());
  return message.SerializeAsString();
}

std::string poses_in_frame(const Stamp& stamp, const std::vector<Pose3>& poses) {
  foxglove::PosesInFrame message;
  set_stamp(stamp, message);
  for (const Pose3& pose : poses) set(pose, *message.add_poses());
  return message.SerializeAsString();
}

std::string frame_transform(const Stamp& stamp, const std::string& child, const Pose3& transform) {
  foxglove::FrameTransform message;
  set_time(stamp.utime_us, *message.mutable_timestamp());
  message.set_parent_frame_id(stamp.frame);
  message.set_child_frame_id(child);
  set(transform.translation(), *message.mutable_translation());
  set(turn_of(transform), *message.mutable_rotation());
  return message.SerializeAsString();
}

std::string grid(const Stamp& stamp, const PackedGrid& grid) {
  foxglove::Grid message;
  set_stamp(stamp, message);
  set(grid.T_frame_corner, *message.mutable_pose());
  message.set_column_count(grid.columns);
  message.mutable_cell_size()->set_x(grid.cell_m);
  message.mutable_cell_size()->set_y(grid.cell_m);
  const std::uint32_t stride = stride_of(grid.cells.fields);
  message.set_cell_stride(stride);
  message.set_row_stride(stride * grid.columns);
  set_fields(grid.cells, message);
  return message.SerializeAsString();
}

std::string log_line(std::int64_t utime_us, Level level, const std::string& name,
                     const std::string& message) {
  foxglove::Log line;
  set_time(utime_us, *line.mutable_timestamp());
  line.set_level(level_of(level));
  line.set_name(ascii(name));
  line.set_message(ascii(message));
  return line.SerializeAsString();
}

}  // namespace voxlist::foreign
