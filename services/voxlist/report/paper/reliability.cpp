#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <array>
#include <numbers>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/paper/figures.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::desk {
namespace {

enum Kind : int { kMapped, kChanged, kForeign, kKinds };
constexpr const char* kNames[] = {"as mapped", "furniture moved, three people", "another building"};
constexpr double kRight_m = 0.15, kRight_rad = 1.5 * std::numbers::pi / 180.0;
// Buildings of this figure: none of them is one of the others'.
constexpr int kFirstBuilding = 101;

struct Answer {
  Kind kind;
  matching::LocalisationState state;
  double said;
  bool right;
};

// What the localiser says of scans in one building. Its map has 60 of them.
std::vector<Answer> ask(int seed, int scans) {
  constexpr Floor kFloor = Floor::kLarger;
  const Scene scene(seed, {}, kFloor);
  const simulation::Building now[] = {building_of(seed, kFloor), building_of(seed, kFloor, true),
                                      building_of(seed + 500, kFloor)};
  OccupancyMap map = scene.map();
  for (const PlacedScan& scan : scene.queries(40))  // a denser map, as a robot's
    add_scan(scan.cloud, to_pose3(scan.truth), 100.0, map);
  matching::LocaliserConfig config;
  config.threads = 1;
  matching::Localiser localiser(map, config);
  std::vector<Answer> answers;
  for (int kind = 0; kind < kKinds; ++kind)
    for (int i = 0; i < scans; ++i) {
      const auto number = static_cast<std::uint64_t>(1000 + i);
      const Pose2 truth =
          free_pose(now[kind], kFloor, static_cast<std::uint64_t>(seed + kind), number);
      const Cloud scan = standing_scan(now[kind], truth, kind == kChanged ? 3 : 0, number);
      const matching::Localisation found = localiser.locate(scan);
      const bool right = kind != kForeign && !found.modes.empty() &&
                         distance_m(found.modes.front().T_map_base, truth) < kRight_m &&
                         turn_rad(found.modes.front().T_map_base, truth) < kRight_rad;
      answers.push_back({static_cast<Kind>(kind), found.state, found.confidence, right});
    }
  return answers;
}

struct Bin {
  double low, high;
  int count = 0, right = 0;
  double said = 0.0;
};

std::vector<Bin> bins_of(const std::vector<Answer>& answers) {
  std::vector<Bin> bins{{0.0, 0.1},  {0.1, 0.3},   {0.3, 0.5},    {0.5, 0.7},  {0.7, 0.9},
                        {0.9, 0.97}, {0.97, 0.99}, {0.99, 0.999}, {0.999, 1.1}};
  for (const Answer& answer : answers)
    for (Bin& bin : bins)
      if (answer.said >= bin.low && answer.said < bin.high) {
        ++bin.count;
        bin.right += answer.right;
        bin.said += answer.said;
      }
  return bins;
}

Table claims(const std::vector<Answer>& answers) {
  Table table{"Claims of single scans, without a guess",
              {"scans", "TRACKING, right", "TRACKING, wrong", "AMBIGUOUS", "LOST"},
              {}};
  for (int kind = 0; kind < kKinds; ++kind) {
    std::array<int, 4> counts{};
    for (const Answer& a : answers) {
      if (a.kind != kind) continue;
      if (a.state == matching::LocalisationState::kTracking) ++counts[a.right ? 0 : 1];
      if (a.state == matching::LocalisationState::kAmbiguous) ++counts[2];
      if (a.state == matching::LocalisationState::kLost) ++counts[3];
    }
    table.rows.push_back({kNames[kind], fmt::format("{}", counts[0]), fmt::format("{}", counts[1]),
                          fmt::format("{}", counts[2]), fmt::format("{}", counts[3])});
  }
  return table;
}

int count_of(const std::vector<Answer>& answers, Kind kind, bool right) {
  int count = 0;
  for (const Answer& a : answers)
    count +=
        a.kind == kind && a.right == right && a.state == matching::LocalisationState::kTracking;
  return count;
}

}  // namespace

Entry reliability(const Scene& scene) {
  const int buildings = scene.scale().buildings, scans = scene.scale().reliability_scans;
  const int first = kFirstBuilding + 10 * (scene.seed() - 1);
  std::vector<std::vector<Answer>> by_building(static_cast<std::size_t>(buildings));
  tbb::parallel_for(0, buildings, [&](int b) {
    by_building[static_cast<std::size_t>(b)] = ask(first + b, scans);
  });
  std::vector<Answer> answers;
  for (const auto& some : by_building) answers.insert(answers.end(), some.begin(), some.end());
  Table table{"Said and true: first modes of all scans",
              {"probability said", "scans", "said, mean", "right"},
              {}};
  std::vector<Eigen::Vector2d> diagram;
  for (const Bin& bin : bins_of(answers)) {
    if (bin.count == 0) continue;
    const double said = bin.said / bin.count, right = double(bin.right) / bin.count;
    diagram.emplace_back(said, right);
    table.rows.push_back({fmt::format("{} to {}", bin.low, std::min(1.0, bin.high)),
                          fmt::format("{}", bin.count), fmt::format("{:.3f}", said),
                          fmt::format("{:.3f}", right)});
  }
  int wrong = 0;
  for (int kind = 0; kind < kKinds; ++kind)
    wrong += count_of(answers, static_cast<Kind>(kind), false);
  Entry entry;
  entry.paper =
      "\"Determination of the confidence in the alignment pose is required for reliable map "
      "building; only those scans with high confidence value should be added to the map.\" Dynamic "
      "environments are future work (section VI).";
  entry.setup = fmt::format(
      "{} buildings of 16 x 12 m with maps of 60 scans, {} scans each as mapped, with moved "
      "furniture and people, and of another "
      "building. Right: within 0.15 m and 1.5 deg.",
      buildings, scans);
  entry.comparisons = {
      {"claimed poses that are wrong", "not said", fmt::format("{} of {}", wrong, answers.size())},
      {"as mapped: claimed and right", "not said",
       fmt::format("{} of {}", count_of(answers, kMapped, true), buildings * scans)},
      {"changed, with people: claimed and right", "future work",
       fmt::format("{} of {}", count_of(answers, kChanged, true), buildings * scans)}};
  entry.panels = {
      {Chart({"reliability diagram",
              {"probability said", Range{-0.02, 1.02}},
              {"share that is right", Range{-0.02, 1.02}},
              400.0,
              380.0})
           .dashes("as it should be", Ink::kFaint, {{0.0, 0.0}, {1.0, 1.0}})
           .line("Voxlist", Ink::kOurs, diagram)
           .dots("", Ink::kOurs, diagram, 7.0)
           .svg(),
       "On the line: what is said to be right so often is right so often. Points of few scans lie "
       "off it by chance; the table has their numbers."}};
  entry.tables = {table, claims(answers)};
  entry.differs =
      "The paper has no number for its confidence. These buildings chose no coefficient; larger "
      "runs "
      "are in tests/bench/README.md (bench_confidence).";
  entry.seeds = fmt::format("buildings {} to {}", first, first + buildings - 1);
  return entry;
}

}  // namespace voxlist::desk
