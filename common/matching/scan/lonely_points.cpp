#include "voxlist/matching/scan/lonely_points.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "voxlist/voxels/fast_cell.h"
#include "voxlist/voxels/numbering.h"

namespace voxlist::matching {
namespace {

// Points are looked at in shells, each to twice the range (m) of the one before, in cubes whose
// edge is this share of the range at the shell's inner face: company is within 4 deg, or 8 deg with
// the cubes beside it. On a changed floor with 5 % short returns, three people and the mirror's
// lines 7 deg apart, 0.05, 0.07 and 0.1 find 90, 82 and 66 % of the short ones, and 1.4, 0.4 and
// 0.1 % of the others.
constexpr double kFirstShell_m = 0.25, kWidest = 0.07;
constexpr std::size_t kShells = 9;

// Cubes are halved until the median point has less company than this. Of 64,000 rays, 17 companions
// find 97 % of the short ones, and 73 find 92 %; the others are 0.4 and 0.1 %.
constexpr int kMostCompany = 20;

// A point is alone with less company than one in so many of the median's, and with none. With one
// in five, twice as many are left out that are not short.
constexpr int kOneIn = 10;

// Where a larger share of the points is alone, it is the laser's way of looking. A judgement.
constexpr double kMostAlone = 0.25;

// The median is that of about so many points: it takes ten times as long as the rest.
constexpr std::size_t kSample = 1000;

std::size_t shell_of(const Eigen::Vector3f& way) {
  double outer_m = 2.0 * kFirstShell_m;
  std::size_t shell = 0;
  const double range2 = way.cast<double>().squaredNorm();
  for (; shell + 1 < kShells && range2 >= outer_m * outer_m; ++shell) outer_m *= 2.0;
  return shell;
}

// The cubes of one shell, and how many points are in each.
class Shell {
 public:
  void add(const Voxel& cube) {
    const std::uint32_t number = cubes_.number(cube);
    if (number == points_.size()) points_.push_back(0);
    ++points_[number];
  }

  // How many points are in the cube and in those beside it; or at least `enough`.
  int about(const Voxel& cube, int enough) const {
    int sum = points_[cubes_.find(cube)];
    for (int i = 0; i < 27 && sum < enough; ++i) {
      const Voxel other{cube.x + i % 3 - 1, cube.y + i / 3 % 3 - 1, cube.z + i / 9 - 1};
      const std::uint32_t number = other == cube ? Numbering<Voxel>::kNone : cubes_.find(other);
      if (number != Numbering<Voxel>::kNone) sum += points_[number];
    }
    return sum;
  }

 private:
  Numbering<Voxel> cubes_;
  std::vector<int> points_;
};

// Which other points each point has about it, in cubes of one width.
class Company {
 public:
  Company(const Cloud& cloud, const std::vector<std::uint32_t>& indices, double edge) {
    places_.reserve(indices.size());
    for (const std::uint32_t i : indices) {
      const Eigen::Vector3f way = cloud.points[i] - cloud.origin(i);
      const std::size_t shell = shell_of(way);
      const double edge_m = edge * kFirstShell_m * static_cast<double>(1 << shell);
      places_.emplace_back(shell, cell_at(way, 1.0 / edge_m));
      shells_[shell].add(places_.back().second);
    }
  }

  bool has(std::size_t k, int companions) const { return of(k, companions + 1) >= companions; }

  // Of the points of some cubes, which are the same however the points are ordered.
  int median() const {
    std::vector<int> some;
    const std::uint64_t every = 1 + places_.size() / kSample;
    for (std::size_t k = 0; k < places_.size(); ++k)
      if (hash_of(places_[k].second) % every == 0)
        some.push_back(of(k, std::numeric_limits<int>::max()));
    if (some.empty()) return 0;
    const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
    std::nth_element(some.begin(), middle, some.end());
    return *middle;
  }

 private:
  int of(std::size_t k, int enough) const {
    return shells_[places_[k].first].about(places_[k].second, enough) - 1;
  }

  std::array<Shell, kShells> shells_;
  std::vector<std::pair<std::size_t, Voxel>> places_;  // shell and cube of each point
};

}  // namespace

std::vector<std::uint32_t> without_lonely(const Cloud& cloud,
                                          const std::vector<std::uint32_t>& indices) {
  double edge = kWidest;
  Company company(cloud, indices, edge);
  int median = company.median();
  // Ends, however many points are at one spot.
  for (int i = 0; i < 4 && median > kMostCompany; ++i) {
    company = Company(cloud, indices, edge /= 2.0);
    median = company.median();
  }
  const int least = std::max(1, (median + kOneIn - 1) / kOneIn);
  std::vector<std::uint32_t> kept;
  for (std::size_t k = 0; k < indices.size(); ++k)
    if (company.has(k, least)) kept.push_back(indices[k]);
  const auto alone = static_cast<double>(indices.size() - kept.size());
  return alone > kMostAlone * static_cast<double>(indices.size()) ? indices : kept;
}

}  // namespace voxlist::matching
