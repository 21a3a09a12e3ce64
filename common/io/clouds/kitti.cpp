#include "voxlist/io/clouds/kitti.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "voxlist/io/clouds/point_rows.h"
#include "voxlist/io/files/cursor.h"

namespace voxlist::io {
namespace {

constexpr std::size_t kRow = 16;

// Farther than any laser measures (m): random bytes are mostly far greater numbers, or far smaller.
constexpr double kFar_m = 1e4;

bool is_near(double value_m) { return !std::isfinite(value_m) || std::abs(value_m) < kFar_m; }

}  // namespace

Cloud parse_kitti(std::string_view bytes, FurtherColumns* further) {
  if (bytes.empty() || bytes.size() % kRow != 0)
    throw FormatError("is no scan of the KITTI data sets, which has 16 bytes a point");
  PointRows rows({"x", "y", "z", "intensity"}, further);
  BinaryCursor cursor(bytes, std::endian::little);
  rows.reserve(bytes.size() / kRow);
  for (std::size_t row = 0; row < bytes.size() / kRow; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const double value = cursor.next(Scalar::kFloat32);
      if (!is_near(value))
        throw FormatError("is no scan of the KITTI data sets: its numbers are no metres");
      if (rows.wants(column)) rows.set(column, value);
    }
    rows.finish_row();
  }
  return rows.take();
}

}  // namespace voxlist::io
