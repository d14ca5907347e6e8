#include "proofmass/report/page/page.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <string_view>

#include "proofmass/core/version.hpp"
#include "proofmass/report/page/script.hpp"
#include "proofmass/report/page/style.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using Out = std::back_insert_iterator<std::string>;

constexpr int top_level = 2;            // level of a section's heading
constexpr std::size_t most_rows = 100;  // rows of a table that may be cut

std::string_view word(Severity severity) {
  switch (severity) {
    case Severity::info:
      return "info";
    case Severity::warning:
      return "warning";
    case Severity::bad:
      break;
  }
  return "bad";
}

// Keeps a figure and its standard deviation on one line.
std::string unbroken(const std::string& cell) {
  std::string text = escaped(cell);
  const std::string plain = " ± ", firm = "\u00a0±\u00a0";
  for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain, at)) {
    text.replace(at, plain.size(), firm);
  }
  return text;
}

void write_cells(std::string& text,
                 const std::vector<std::string>& cells,
                 bool head,
                 const std::string& link = {}) {
  text += "<tr>";
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const std::string_view tag = head || k == 0 ? "th" : "td";
    const std::string_view scope = head ? " scope=\"col\"" : k == 0 ? " scope=\"row\"" : "";
    const std::string cell = k > 0 || link.empty() ? unbroken(cells[k])
                                                   : fmt::format("<a href=\"{}\">{}</a>",
                                                                 escaped(link), escaped(cells[k]));
    fmt::format_to(Out(text), "<{0}{1}>{2}</{0}>", tag, scope, cell);
  }
  text += "</tr>\n";
}

void write(std::string& text, const Table& table) {
  fmt::format_to(Out(text), "<div class=\"wide\"><table{}>\n",
                 table.stacks ? " class=\"stacks\"" : "");
  const bool cut = table.long_list && table.rows.size() > most_rows;
  const std::string part = cut ? fmt::format(": the first {} of {}; the JSON document has all",
                                             most_rows, grouped(table.rows.size()))
                               : "";
  if (!table.caption.empty()) {
    fmt::format_to(Out(text), "<caption>{}{}</caption>\n", escaped(table.caption), part);
  }
  if (!table.head.empty()) {
    text += "<thead>";
    write_cells(text, table.head, true);
    text += "</thead>";
  }
  text += "<tbody>\n";
  const std::size_t shown = cut ? most_rows : table.rows.size();
  for (std::size_t k = 0; k < shown; ++k)
    write_cells(text, table.rows[k], false, k < table.links.size() ? table.links[k] : "");
  text += "</tbody></table></div>\n";
}

void write_signatures(std::string& text, const std::vector<std::string>& signatures) {
  if (signatures.empty()) return;
  text += "<div class=\"sign\">\n";
  for (const std::string& one : signatures) {
    fmt::format_to(Out(text), "<div>{}</div>\n", escaped(one));
  }
  text += "</div>\n";
}

std::string_view class_of(const Section& section, int level) {
  if (!section.signatures.empty()) return " class=\"signed\"";
  if (section.new_sheet) return " class=\"sheet\"";
  return level > top_level ? " class=\"part\"" : "";
}

void write(std::string& text, const std::vector<Side>& sides) {
  if (sides.empty()) return;
  text += "<div class=\"sides\">\n";
  for (const Side& side : sides) {
    fmt::format_to(Out(text), "<div><b>{}</b><p>{}</p></div>\n", escaped(side.label),
                   unbroken(side.text));
  }
  text += "</div>\n";
}

void write_points(std::string& text, const std::vector<std::string>& points) {
  if (points.empty()) return;
  text += "<ul>\n";
  for (const std::string& point : points)
    fmt::format_to(Out(text), "<li>{}</li>\n", escaped(point));
  text += "</ul>\n";
}

// Figures are counted over the whole page, whether or not the number is shown.
struct FigureCount {
  bool shown = true;
  int figures = 0;
};

void write(std::string& text, const Figure& figure, FigureCount& count) {
  ++count.figures;
  const std::string number = count.shown ? fmt::format("Figure {}. ", count.figures) : "";
  fmt::format_to(Out(text),
                 "<figure>\n<figcaption><b>{}{}</b><span>{}</span></figcaption>\n{}</figure>\n",
                 number, escaped(figure.title), escaped(figure.description),
                 svg(figure, fmt::format("figure-{}", count.figures)));
}

void write(std::string& text, const Section& section, int level, FigureCount& count) {
  const std::string id = section.id.empty() ? "" : fmt::format(" id=\"{}\"", escaped(section.id));
  fmt::format_to(Out(text), "<section{0}{1}>\n<h{2}>{3}</h{2}>\n", class_of(section, level), id,
                 level, escaped(section.heading));
  write(text, section.sides);
  for (const std::string& paragraph : section.paragraphs) {
    fmt::format_to(Out(text), "<p>{}</p>\n", escaped(paragraph));
  }
  write_points(text, section.points);
  for (const Table& table : section.tables) write(text, table);
  for (const Plot& plot : section.figures) write(text, plot.draw(), count);
  write_signatures(text, section.signatures);
  for (const Section& part : section.parts) write(text, part, level + 1, count);
  text += "</section>\n";
}

void write_contents(std::string& text, const std::vector<Section>& sections) {
  const auto link = [](const Section& section) {
    return fmt::format("<a href=\"#{}\">{}</a>", escaped(section.id), escaped(section.heading));
  };
  text += "<nav class=\"contents\">\n<h2>Contents</h2>\n";
  for (const Section& section : sections) {
    if (section.id.empty()) continue;
    fmt::format_to(Out(text), "<p>{}</p>\n<ul>\n", link(section));
    for (const Section& part : section.parts) {
      if (part.id.empty()) continue;
      fmt::format_to(Out(text), "<li>{} <span>{}</span></li>\n", link(part), escaped(part.gist));
    }
    text += "</ul>\n";
  }
  text += "</nav>\n";
}

void write(std::string& text, const std::vector<KeyFigure>& figures) {
  if (figures.empty()) return;
  text += "<dl class=\"key\">\n";
  for (const KeyFigure& figure : figures) {
    fmt::format_to(Out(text), "<div><dt>{}</dt><dd>{}</dd></div>\n", escaped(figure.label),
                   unbroken(figure.value));
  }
  text += "</dl>\n";
}

std::string items_of(const std::vector<Note>& notes, bool (*wanted)(Severity)) {
  std::string items;
  for (const Note& note : notes) {
    if (!wanted(note.severity)) continue;
    const bool grave = note.severity > Severity::info;
    fmt::format_to(Out(items), "<li class=\"{0}\">{1}{2}</li>\n", word(note.severity),
                   grave ? fmt::format("<b>{}</b> ", word(note.severity)) : "",
                   escaped(with_flags(note)));
  }
  return items;
}

void write_items(std::string& text, const std::string& items) {
  if (!items.empty()) text += "<ul class=\"notes\">\n" + items + "</ul>\n";
}

// Bad notes and warnings come first; a long list of warnings is folded, so that the results remain
// visible.
void write_grave_notes(std::string& text, const std::vector<Note>& notes) {
  constexpr std::ptrdiff_t most_open = 8;
  const auto warnings = std::ranges::count(notes, Severity::warning, &Note::severity);
  write_items(text, items_of(notes, [](Severity s) { return s > Severity::warning; }));
  const std::string items = items_of(notes, [](Severity s) { return s == Severity::warning; });
  if (warnings > most_open)
    fmt::format_to(Out(text), "<details>\n<summary>{} warnings</summary>\n", warnings);
  write_items(text, items);
  if (warnings > most_open) text += "</details>\n";
}

// Informational notes come last.
void write_plain_notes(std::string& text, const std::vector<Note>& notes) {
  const std::string items = items_of(notes, [](Severity s) { return s <= Severity::info; });
  if (items.empty()) return;
  text += "<section>\n<h2>How the input was read</h2>\n";
  write_items(text, items);
  text += "</section>\n";
}

}  // namespace

std::string html(const Page& page) {
  const std::string command = page.action.empty() ? page.verb : page.verb + ' ' + page.action;
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"Proofmass {0}\">\n"
      "<title>{1} – proofmass {2}</title>\n<style>\n{3}{4}{6}</style>\n</head>\n<body>\n<main>\n"
      "<p class=\"from\">Proofmass {0} · {2}</p>\n<h1>{1}</h1>\n<p class=\"conclusion\">{5}</p>\n",
      version(), escaped(page.title), escaped(command), figure_css(), page_css(),
      escaped(page.conclusion), page_script_css());
  write(text, page.key_figures);
  write_grave_notes(text, page.notes);
  if (page.contents) write_contents(text, page.sections);
  FigureCount count{.shown = page.numbered};
  for (const Section& section : page.sections) write(text, section, top_level, count);
  write_plain_notes(text, page.notes);
  text += "<footer>\n";
  for (const std::string& input : page.inputs) {
    fmt::format_to(Out(text), "<p>Input: {}</p>\n", escaped(input));
  }
  fmt::format_to(
      Out(text),
      "<p>Made by Proofmass {}. A figure written a ± b carries its standard deviation b; "
      "bands are 95 % where they do not say otherwise.</p>\n</footer>\n</main>\n",
      version());
  if (count.figures > 0) fmt::format_to(Out(text), "<script>\n{}</script>\n", page_script());
  text += "</body>\n</html>\n";
  return text;
}

}  // namespace proofmass::report
