#include "voxlist/matching/scan/thinning.h"

#include <algorithm>
#include <bit>

#include "voxlist/voxels/fast_cell.h"
#include "voxlist/voxels/numbering.h"

namespace voxlist::matching {
namespace {

std::uint64_t lot_of(const Eigen::Vector3f& p) {
  std::uint64_t lot = 0;
  for (const float value : p)
    lot = (lot ^ std::bit_cast<std::uint32_t>(value)) * 0x9e3779b97f4a7c15u;
  return lot ^ lot >> 32;
}

// Keeps the point with the lowest lot of each cube.
class Draw {
 public:
  explicit Draw(std::size_t most) : numbers_(most) { kept_.reserve(most); }

  void add(const InCube& point) {
    const std::uint32_t number = numbers_.number(point.key);
    if (number == kept_.size())
      kept_.push_back(point);
    else if (point.lot < kept_[number].lot)
      kept_[number] = point;
  }

  std::vector<InCube> kept() { return std::move(kept_); }

 private:
  Numbering<> numbers_;
  std::vector<InCube> kept_;
};

using Layer = std::span<const InCube>;

std::vector<Layer> layers_of(std::span<const InCube> cubes) {
  std::vector<Layer> layers;
  for (std::size_t from = 0; from < cubes.size();) {
    std::size_t to = from;
    while (to < cubes.size() && layer_of(cubes[to].key) == layer_of(cubes[from].key)) ++to;
    layers.push_back(cubes.subspan(from, to - from));
    from = to;
  }
  return layers;
}

std::size_t median_size(const std::vector<Layer>& layers) {
  std::vector<std::size_t> sizes;
  for (const Layer& layer : layers) sizes.push_back(layer.size());
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

std::size_t total(const std::vector<Layer>& layers, std::size_t cap) {
  std::size_t sum = 0;
  for (const Layer& layer : layers) sum += std::min(layer.size(), cap);
  return sum;
}

// The largest cap on a layer's points within the limit.
std::size_t layer_cap(const std::vector<Layer>& layers, const LayerLimit& limit) {
  if (layers.empty()) return 0;
  const double usual = limit.most_of_usual * static_cast<double>(median_size(layers)) + 1.0;
  std::size_t low = 0, high = limit.most_points;
  if (usual < static_cast<double>(high)) high = static_cast<std::size_t>(usual);
  while (low < high) {
    const std::size_t cap = (low + high + 1) / 2;
    if (total(layers, cap) <= limit.most_points)
      low = cap;
    else
      high = cap - 1;
  }
  return low;
}

}  // namespace

std::vector<InCube> thinned(std::span<const Eigen::Vector3f> points,
                            std::span<const std::uint32_t> indices) {
  Draw draw(indices.size());
  for (const std::uint32_t i : indices)
    draw.add({key_of(cell_at(points[i], 1.0 / kFinestCube_m)), lot_of(points[i]), i});
  return draw.kept();
}

std::vector<InCube> halved(std::span<const InCube> cubes) {
  Draw draw(cubes.size());
  for (const InCube& cube : cubes) draw.add({halved_key(cube.key), cube.lot, cube.index});
  return draw.kept();
}

void sort_by_layers(std::vector<InCube>& cubes) {
  std::sort(cubes.begin(), cubes.end(), [](auto& a, auto& b) { return a.key < b.key; });
}

std::vector<std::uint32_t> capped_by_layers(std::vector<InCube> cubes, const LayerLimit& limit) {
  sort_by_layers(cubes);
  const std::vector<Layer> layers = layers_of(cubes);
  const std::size_t cap = layer_cap(layers, limit);
  std::vector<std::uint32_t> indices;
  for (const Layer& layer : layers) {
    const std::size_t kept = std::min(layer.size(), cap);
    for (std::size_t i = 0; i < kept; ++i) indices.push_back(layer[i * layer.size() / kept].index);
  }
  return indices;
}

}  // namespace voxlist::matching
