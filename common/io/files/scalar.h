#pragma once

#include <bit>
#include <cstddef>
#include <optional>
#include <string_view>

namespace voxlist::io {

/// The number types that scan files are made of.
enum class Scalar {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

/// Bytes of one number.
std::size_t size_of(Scalar type);

/// The number whose size_of(type) bytes start at `at`.
double decode(Scalar type, const char* at, std::endian order);

/// The type that a PLY header calls `name` (int, int32, float, float32, bool, ...), if there is
/// one.
std::optional<Scalar> ply_scalar(std::string_view name);

/// The type of a PCD header's TYPE (I, U, F, B) and SIZE (bytes), if there is one.
std::optional<Scalar> pcd_scalar(std::string_view type, std::size_t size);

}  // namespace voxlist::io
