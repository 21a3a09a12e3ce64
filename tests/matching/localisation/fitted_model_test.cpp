// The model of how sure a pose is stands in C++, and in the Python that fits it: both say the same.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <random>

#include "tests/temporary_folder.h"
#include "voxlist/matching/localisation/hypotheses.h"

namespace voxlist::matching {
namespace {

constexpr int kScans = 10;

// One to four modes of a scan, the best by near rays first, as the localiser would list them.
struct Listed {
  std::vector<PoseMode> modes;
  double unseen = 1.0;
};

std::vector<Listed> listed_modes() {
  std::mt19937 random(161);
  const auto share = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 1000) / 1000.0;
  };
  std::vector<Listed> scans(kScans);
  for (int scan = 0; scan < kScans; ++scan) {
    Listed& listed = scans[static_cast<std::size_t>(scan)];
    listed.unseen = scan % 3 == 0 ? 1.0 : share(0.7, 0.9);
    const double best = share(0.8, 0.99);
    for (int m = 0; m <= scan % 4; ++m) {
      PoseMode mode;
      mode.T_map_base.x_m = 5.0 * m;
      mode.support = {best - 0.03 * m, share(0.7, 0.98)};
      listed.modes.push_back(mode);
    }
  }
  return scans;
}

void write_csv(const std::string& path, const std::vector<Listed>& scans) {
  std::ofstream file(path);
  file.precision(17);
  file << "kind,seed,query,mode,right,support,even_support,unseen\n";
  for (std::size_t scan = 0; scan < scans.size(); ++scan)
    for (std::size_t m = 0; m < scans[scan].modes.size(); ++m)
      file << "kind,1," << scan << ',' << m << ",0," << scans[scan].modes[m].support.near << ','
           << scans[scan].modes[m].support.even << ',' << scans[scan].unseen << '\n';
}

// What Python prints, number by number.
std::vector<double> python_says(const std::string& csv) {
  const std::string command =
      "python3 -B " VOXLIST_SOURCE_DIR "/tests/bench/fits/fit_confidence.py --as-built " + csv;
  const std::unique_ptr<FILE, int (*)(FILE*)> out(popen(command.c_str(), "r"), pclose);
  std::vector<double> numbers;
  for (double number = 0.0; std::fscanf(out.get(), "%lf", &number) == 1;) numbers.push_back(number);
  return numbers;
}

TEST(FittedModel, SaysTheSameInCppAsInThePythonThatFitsIt) {
  if (std::system("command -v python3 >/dev/null") != 0) GTEST_SKIP() << "no python3 here";
  const test::TemporaryFolder folder;
  const std::vector<Listed> scans = listed_modes();
  write_csv((folder / "scans.csv").string(), scans);
  std::vector<double> expected;
  for (const auto& [modes, unseen] : scans) {
    Hypotheses hypotheses;
    hypotheses.update(modes, unseen);
    for (const PoseMode& mode : hypotheses.modes()) expected.push_back(mode.probability);
  }
  const std::vector<double> said = python_says((folder / "scans.csv").string());
  ASSERT_EQ(said.size(), expected.size());
  ASSERT_GE(said.size(), 20U);
  for (std::size_t i = 0; i < said.size(); ++i)
    EXPECT_NEAR(said[i], expected[i], 1e-9 + 1e-6 * expected[i]) << i;
}

}  // namespace
}  // namespace voxlist::matching
