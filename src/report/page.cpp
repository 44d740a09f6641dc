#include "page.hpp"

#include "svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace eigengrain::report {
namespace {

constexpr std::string_view style = R"(
@page { margin: 16mm }
body { font: 15px/1.45 Georgia, "Times New Roman", serif; color: #222; max-width: 58em; margin: 2em auto; padding: 0 1em }
h1 { font-size: 1.9em; line-height: 1.15; margin: 0 0 .2em }
h2 { font-size: 1.35em; margin: 2em 0 .4em; border-top: 1px solid #222; padding-top: .5em }
h3 { font-size: 1.08em; margin: 1.6em 0 .3em }
p.subtitle { color: #555; margin-top: 0 }
figure { margin: 1em 0; break-inside: avoid }
figure svg { max-width: 100%; height: auto; display: block }
svg text { paint-order: stroke; stroke: #fff; stroke-width: 2.5px; stroke-linejoin: round }
figcaption { font-size: .9em; color: #444; margin-top: .3em }
table { border-collapse: collapse; font: 12px/1.3 sans-serif; margin: .3em 0 1.2em }
p.caption { font-size: .9em; color: #444; margin: 1.2em 0 .2em; break-after: avoid }
th, td { padding: .15em .6em; text-align: left; vertical-align: baseline; border-bottom: 1px solid #ddd }
thead th { border-bottom: 1px solid #222; font-weight: 600; vertical-align: bottom }
th.n, td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
th.u { padding: .3em .1em } th.u span { writing-mode: vertical-rl; transform: rotate(180deg); white-space: nowrap }
td.u { padding: .2em .25em; font-size: 11px } td:first-child { white-space: nowrap }
tbody tr { break-inside: avoid } thead { display: table-header-group }
.f { color: #767676 } .g { color: #0072B2 } .b { color: #a84300; font-weight: 700 }
.wide { overflow-x: auto }
@media print { body { font-size: 10pt; max-width: none; margin: 0; padding: 0 } table { font-size: 7.5pt }
  h2 { break-after: avoid } h3 { break-before: page; break-after: avoid }
  .wide { overflow: visible } }
)";

std::string classes_of(const Table::Column& column, Emphasis emphasis) {
  std::string classes;
  const auto add = [&](std::string_view name) {
    classes += (classes.empty() ? "" : " ") + std::string(name);
  };
  if (column.number) add("n");
  if (column.upright) add("u");
  if (emphasis == Emphasis::faint) add("f");
  if (emphasis == Emphasis::good) add("g");
  if (emphasis == Emphasis::bad) add("b");
  return classes.empty() ? std::string() : fmt::format(" class=\"{}\"", classes);
}

}  // namespace

Page::Page(std::string_view title, std::string_view subtitle)
    : body_(fmt::format(
          "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta "
          "charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width\"/>\n<title>{0}"
          "</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n",
          escaped(title), style)) {
  if (!subtitle.empty()) body_ += fmt::format("<p class=\"subtitle\">{}</p>\n", escaped(subtitle));
}

void Page::section(std::string_view heading) {
  body_ += fmt::format("<h2>{}</h2>\n", escaped(heading));
}

void Page::subsection(std::string_view heading) {
  body_ += fmt::format("<h3>{}</h3>\n", escaped(heading));
}

void Page::paragraph(std::string_view text) {
  body_ += fmt::format("<p>{}</p>\n", escaped(text));
}

void Page::list(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += fmt::format("<li>{}</li>\n", escaped(item));
  body_ += "</ul>\n";
}

void Page::picture(const std::string& svg, std::string_view caption) {
  body_ += "<figure>\n" + svg;
  if (!caption.empty())
    body_ += fmt::format("<figcaption>Figure {}. {}</figcaption>\n", ++figures_, escaped(caption));
  body_ += "</figure>\n";
}

void Page::table(const Table& table, std::string_view caption) {
  if (!caption.empty()) body_ += fmt::format("<p class=\"caption\">{}</p>\n", escaped(caption));
  body_ += "<div class=\"wide\"><table>\n";
  body_ += "<thead><tr>";
  for (const Table::Column& column : table.columns) {
    const std::string name = escaped(column.name);
    body_ += fmt::format("<th{}>{}</th>", classes_of(column, Emphasis::none),
                         column.upright ? fmt::format("<span>{}</span>", name) : name);
  }
  body_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    body_ += "<tr>";
    for (std::size_t k = 0; k < std::min(row.size(), table.columns.size()); ++k)
      body_ +=
          fmt::format("<td{}>{}</td>", classes_of(table.columns[k], row[k].emphasis), escaped(row[k].text));
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

std::string Page::finish() const {
  return body_ + "</body>\n</html>\n";
}

}  // namespace eigengrain::report
