#include "voxlist/io/files/scalar.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace voxlist::io {
namespace {

template <typename T>
double load(const char* at, std::endian order) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (order != std::endian::native) {
    std::reverse(bytes.begin(), bytes.end());
  }
  return static_cast<double>(std::bit_cast<T>(bytes));
}

struct TypeInfo {
  Scalar type;
  std::size_t size;
  char pcd_type;
  std::string_view ply_name;
  std::string_view ply_sized_name;
  double (*load)(const char*, std::endian);
};

// Each list is in the order of Scalar.
constexpr std::array<TypeInfo, 10> kTypes{{
    {Scalar::kInt8, 1, 'I', "char", "int8", load<std::int8_t>},
    {Scalar::kUint8, 1, 'U', "uchar", "uint8", load<std::uint8_t>},
    {Scalar::kInt16, 2, 'I', "short", "int16", load<std::int16_t>},
    {Scalar::kUint16, 2, 'U', "ushort", "uint16", load<std::uint16_t>},
    {Scalar::kInt32, 4, 'I', "int", "int32", load<std::int32_t>},
    {Scalar::kUint32, 4, 'U', "uint", "uint32", load<std::uint32_t>},
    {Scalar::kInt64, 8, 'I', "long", "int64", load<std::int64_t>},
    {Scalar::kUint64, 8, 'U', "ulong", "uint64", load<std::uint64_t>},
    {Scalar::kFloat32, 4, 'F', "float", "float32", load<float>},
    {Scalar::kFloat64, 8, 'F', "double", "float64", load<double>},
}};

const TypeInfo& info(Scalar type) { return kTypes[static_cast<std::size_t>(type)]; }

template <typename Predicate>
std::optional<Scalar> find_type(Predicate matches) {
  const auto found = std::find_if(kTypes.begin(), kTypes.end(), matches);
  return found == kTypes.end() ? std::nullopt : std::optional(found->type);
}

}  // namespace

std::size_t size_of(Scalar type) { return info(type).size; }

double decode(Scalar type, const char* at, std::endian order) { return info(type).load(at, order); }

std::optional<Scalar> ply_scalar(std::string_view name) {
  if (name == "bool") return Scalar::kUint8;
  return find_type(
      [&](const TypeInfo& t) { return t.ply_name == name || t.ply_sized_name == name; });
}

std::optional<Scalar> pcd_scalar(std::string_view type, std::size_t size) {
  if (type == "B" && size == 1) return Scalar::kUint8;
  return find_type([&](const TypeInfo& t) {
    return type == std::string_view(&t.pcd_type, 1) && t.size == size;
  });
}

}  // namespace voxlist::io
