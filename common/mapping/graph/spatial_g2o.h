#pragma once

#include <optional>
#include <string_view>

#include "voxlist/mapping/graph/stored_graph.h"
#include "voxlist/mapping/text/words.h"

namespace voxlist::mapping {

/// The first line of a graph in space.
inline constexpr std::string_view kSpatialTitle = "# voxlist graph 3";

/// Whether a graph is to be told in space: some of its keyframes lean or stand higher than others.
bool is_in_space(const StoredGraph& graph);

/// Appends the keyframes and edges of a graph in space to a text (to_g2o).
void write_in_space(const StoredGraph& graph, std::string& text);

/// Reads the same; what is wrong makes the words no good.
void read_in_space(Words& words, StoredGraph& graph);

/// The sum over all edges, where the keyframes stand.
double chi2_in_space(const StoredGraph& graph);

}  // namespace voxlist::mapping
