#pragma once

#include <string>
#include <vector>

namespace voxlist::desk {

/// One cell of a table: a text, and whether it is a time, which no two runs have alike.
struct CellText {
  std::string text;
  bool timed = false;

  CellText(const char* words) : text(words) {}
  CellText(std::string words) : text(std::move(words)) {}
};

/// A cell that is measured by a clock.
CellText timed(std::string text);

/// A value of the paper beside what Voxlist measures.
struct Comparison {
  std::string what;
  std::string paper;
  CellText ours;
  std::string means{};  ///< how the one is to the other, in few words
};

/// A table with a heading for each column.
struct Table {
  std::string caption;
  std::vector<std::string> heads;
  std::vector<std::vector<CellText>> rows;
};

/// A chart, and what there is to see in it.
struct Panel {
  std::string svg;
  std::string caption{};
};

/// A section of the report: one figure or claim of the paper, or one view of a run.
struct Entry {
  std::string id;  ///< its address in the page
  std::string title;
  std::string paper{};  ///< what the paper says; empty in the report of a run
  std::string setup{};  ///< what was measured, and on what
  std::vector<Comparison> comparisons{};
  std::vector<Panel> panels{};
  std::vector<Table> tables{};
  std::string differs{};  ///< what differs, and why
  std::string seeds{};
  std::string command{};  ///< repeats it
};

}  // namespace voxlist::desk
