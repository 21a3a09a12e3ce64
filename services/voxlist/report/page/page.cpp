#include "services/voxlist/report/page/page.h"

#include <fmt/core.h>

#include "services/voxlist/report/charts/svg.h"
#include "services/voxlist/report/page/page_style.h"

namespace voxlist::desk {
namespace {

std::string element(const std::string& name, const std::string& words,
                    const std::string& css = "") {
  if (words.empty()) return "";
  const std::string open = css.empty() ? name : fmt::format("{} class=\"{}\"", name, css);
  return fmt::format("<{}>{}</{}>\n", open, escaped(words), name);
}

std::string cell(const CellText& cell, const std::string& css = "") {
  const std::string inner = cell.timed
                                ? fmt::format("<span class=\"timed\">{}</span>", escaped(cell.text))
                                : escaped(cell.text);
  return fmt::format("<td{}>{}</td>", css.empty() ? "" : " class=\"" + css + '"', inner);
}

std::string comparisons(const std::vector<Comparison>& all) {
  if (all.empty()) return "";
  std::string html =
      "<div class=\"wide\"><table "
      "class=\"beside\"><thead><tr><th></th><th>paper</th><th>Voxlist</th>"
      "<th class=\"words\"></th></tr></thead><tbody>\n";
  for (const Comparison& c : all)
    html += "<tr>" + cell(c.what) + cell(c.paper, "paper") + cell(c.ours, "ours") +
            cell(c.means, "words dim") + "</tr>\n";
  return html + "</tbody></table></div>\n";
}

std::string panels(const std::vector<Panel>& all) {
  if (all.empty()) return "";
  std::string html = "<div class=\"panels\">\n";
  for (const Panel& panel : all)
    html += "<figure>" + panel.svg + element("figcaption", panel.caption) + "</figure>\n";
  return html + "</div>\n";
}

std::string table(const Table& table) {
  std::string html =
      "<div class=\"wide\"><table>" + element("caption", table.caption) + "<thead><tr>";
  for (const std::string& head : table.heads) html += "<th>" + escaped(head) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const CellText& text : row) html += cell(text);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string footer(const Entry& entry) {
  if (entry.command.empty() && entry.seeds.empty()) return "";
  std::string html = "<footer><dl>";
  if (!entry.seeds.empty()) html += "<dt>seeds</dt>" + element("dd", entry.seeds);
  if (!entry.command.empty())
    html += "<dt>repeat</dt><dd><code>" + escaped(entry.command) + "</code></dd>";
  return html + "</dl></footer>\n";
}

std::string section(const Entry& entry) {
  std::string html = fmt::format("<section id=\"{}\">\n", escaped(entry.id));
  html += element("h2", entry.title);
  if (!entry.paper.empty())
    html += "<blockquote>" + element("p", "Paper: " + entry.paper) + "</blockquote>\n";
  html += element("p", entry.setup, "setup");
  html += comparisons(entry.comparisons) + panels(entry.panels);
  for (const Table& t : entry.tables) html += table(t);
  html += element("p", entry.differs, "differs");
  return html + footer(entry) + "</section>\n";
}

std::string head(const Report& report) {
  return "<head><meta charset=\"utf-8\"/><meta name=\"viewport\" "
         "content=\"width=device-width, initial-scale=1\"/><title>" +
         escaped(report.title) + "</title><style>" + kPageStyle + "</style></head>\n";
}

std::string facts(const Report& report) {
  std::string html = "<dl class=\"facts\">";
  for (const auto& [name, fact] : report.facts)
    html += element("dt", name) + element("dd", fact.text, fact.timed ? "timed" : "");
  return html + "</dl>\n";
}

std::string contents(const Report& report) {
  std::string html = "<nav><ol>\n";
  for (const Entry& entry : report.entries)
    html +=
        fmt::format("<li><a href=\"#{}\">{}</a></li>\n", escaped(entry.id), escaped(entry.title));
  return html + "</ol></nav>\n";
}

}  // namespace

CellText timed(std::string text) {
  CellText cell(std::move(text));
  cell.timed = true;
  return cell;
}

std::string html_of(const Report& report) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n" + head(report) + "<body>\n";
  html += element("h1", report.title) + element("p", report.lead) + facts(report);
  html += contents(report);
  for (const Entry& entry : report.entries) html += section(entry);
  return html + "</body>\n</html>\n";
}

}  // namespace voxlist::desk
