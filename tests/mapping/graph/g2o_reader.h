#pragma once

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

// A reader of g2o files that knows nothing of Voxlist: what another program makes of one.

namespace voxlist::test {

struct G2oFile {
  struct Edge {
    int from = 0, to = 0;
    Eigen::Vector3d told;  // x, y, yaw
    Eigen::Matrix3d information;
  };

  std::map<int, Eigen::Vector3d> vertices;
  std::vector<Edge> edges;
  std::vector<int> fixed;
  std::vector<std::string> unknown;

  explicit G2oFile(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) read(line);
  }

  /// As g2o's EDGE_SE2 has it: the miss is the pose of what is seen as what was told would see it.
  double chi2() const {
    double sum = 0.0;
    for (const Edge& edge : edges) {
      const Eigen::Vector3d &from = vertices.at(edge.from), &to = vertices.at(edge.to);
      Eigen::Vector3d miss;
      miss << turned(turned((to - from).head<2>(), -from.z()) - edge.told.head<2>(),
                     -edge.told.z()),
          std::remainder(to.z() - from.z() - edge.told.z(), 2.0 * M_PI);
      sum += miss.dot(edge.information * miss);
    }
    return sum;
  }

 private:
  static Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle) {
    return {std::cos(angle) * v.x() - std::sin(angle) * v.y(),
            std::sin(angle) * v.x() + std::cos(angle) * v.y()};
  }

  void read(const std::string& line) {
    std::istringstream words(line);
    std::string tag;
    words >> tag;
    if (tag.empty() || tag.front() == '#') return;
    if (tag == "VERTEX_SE2") {
      int id = 0;
      Eigen::Vector3d pose;
      words >> id >> pose.x() >> pose.y() >> pose.z();
      vertices[id] = pose;
    } else if (tag == "EDGE_SE2") {
      Edge edge;
      words >> edge.from >> edge.to >> edge.told.x() >> edge.told.y() >> edge.told.z();
      for (int row = 0; row < 3; ++row)
        for (int column = row; column < 3; ++column) {
          words >> edge.information(row, column);
          edge.information(column, row) = edge.information(row, column);
        }
      edges.push_back(edge);
    } else if (tag == "FIX") {
      words >> fixed.emplace_back();
    } else {
      unknown.push_back(line);
    }
    if (!words || words >> tag) unknown.push_back(line);
  }
};

/// The number behind "# chi2 ", which the writer says that the file has.
inline double chi2_told(const std::string& text) {
  return std::stod(text.substr(text.find("# chi2 ") + 7));
}

}  // namespace voxlist::test
