#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace voxlist::planning {

/// Columns along a tile's edge: a tile stands over one block of free space (0.64 m).
inline constexpr std::int32_t kTileEdge = 8;

/// Layers of voxels (0.02 m) in a cell of free space (0.08 m), which is as wide as a column.
inline constexpr std::int32_t kLayersInCell = 4;

/// Voxels of a column that stand one upon the other without a gap.
struct Span {
  std::int32_t bottom = 0, top = 0;  ///< layers, top not included
  /// Mean height of its upper 0.1 m, each layer by how many voxels it has (m): a floor's height, to
  /// a few millimetres.
  float surface_m = 0.0F;
  /// How much the surfaces on two opposite sides of it differ, where its own lies between (m): a
  /// kerb that runs through the column looks like two small steps otherwise.
  float kink_m = 0.0F;

  bool operator==(const Span&) const = default;
};

/// Cells of a column that are free without a gap: numbers of cells, top not included.
struct FreeRun {
  std::int32_t bottom = 0, top = 0;

  bool operator==(const FreeRun&) const = default;
};

/// What stands over a cell of the floor plan, lowest first.
struct Column {
  std::span<const Span> spans;
  std::span<const FreeRun> free;
};

/// 8 x 8 columns.
class ColumnTile {
 public:
  /// What stands over a column of the tile.
  Column at(std::int32_t x, std::int32_t y) const {
    const auto i = static_cast<std::size_t>(x + kTileEdge * y);
    return {of(spans_, spans_end_, i), of(free_, free_end_, i)};
  }

  /// Adds the next column, x first.
  void add(const std::vector<Span>& spans, const std::vector<FreeRun>& free);

  /// All spans of a column, to be changed.
  std::span<Span> spans_at(std::int32_t x, std::int32_t y);

  /// A bit for each column, x first, that is not the same in another tile.
  std::uint64_t differs_from(const ColumnTile& other) const;

  std::size_t memory_bytes() const;

 private:
  static constexpr std::size_t kColumns = kTileEdge * kTileEdge;
  using Ends = std::array<std::uint32_t, kColumns>;

  template <class T>
  static std::span<const T> of(const std::vector<T>& all, const Ends& ends, std::size_t i) {
    const std::uint32_t begin = i == 0 ? 0 : ends[i - 1];
    return {all.data() + begin, ends[i] - begin};
  }

  std::vector<Span> spans_;
  std::vector<FreeRun> free_;
  Ends spans_end_{}, free_end_{};
  std::size_t columns_ = 0;
};

}  // namespace voxlist::planning
