#pragma once

#include <string>
#include <utility>
#include <vector>

#include "services/voxlist/report/page/entry.h"

namespace voxlist::desk {

/// A report: its entries, and what is told before them.
struct Report {
  std::string title;
  std::string lead;                                     ///< one paragraph
  std::vector<std::pair<std::string, CellText>> facts;  ///< version, machine, seeds, command
  std::vector<Entry> entries;
};

/// The report as one page of HTML that is well-formed XML, too: style and drawings are in it, and
/// nothing is loaded from anywhere. Times are marked by the class "timed".
std::string html_of(const Report& report);

}  // namespace voxlist::desk
