#include "proofmass/report/page.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <string_view>

#include "proofmass/core/version.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using Out = std::back_insert_iterator<std::string>;

constexpr std::string_view page_css = R"(*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,sans-serif}
main{max-width:60rem;margin:0 auto;padding:2.5rem 1.5rem 4rem}
.from{margin:0;color:var(--soft);font-size:.85rem;letter-spacing:.04em}
h1{font-size:1.05rem;font-weight:600;margin:.2rem 0 1.6rem;overflow-wrap:anywhere}
.conclusion{font-size:1.55rem;line-height:1.35;font-weight:500;margin:0 0 1.6rem;max-width:46rem}
dl.key{display:flex;flex-wrap:wrap;gap:1px;margin:0 0 2rem;
background:var(--rule);border:1px solid var(--rule);border-radius:6px;overflow:hidden}
dl.key div{flex:1 1 15rem;background:var(--panel);padding:.7rem .9rem}dl.key dt{color:var(--soft);font-size:.82rem}
dl.key dd{margin:0;font-size:1.08rem;font-variant-numeric:tabular-nums}
h2{font-size:1.15rem;margin:2.6rem 0 .6rem;padding-bottom:.3rem;border-bottom:1px solid var(--rule)}
p{margin:.5rem 0;max-width:46rem}ul{margin:.5rem 0;padding-left:1.2rem;max-width:46rem}li{margin:.2rem 0}
.notes{list-style:none;padding:0}.notes li{padding:.35rem .8rem;border-left:3px solid var(--rule);
margin:.4rem 0;overflow-wrap:anywhere}.notes .warning{border-color:var(--orange)}
.notes .bad{border-color:var(--red)}.notes b{font-weight:600}
summary{cursor:pointer;margin:.4rem 0}.warning b{color:var(--orange)}.bad b{color:var(--red)}.info b{color:var(--soft)}
figure{margin:1.4rem 0 2.2rem;break-inside:avoid}
figcaption{margin:0 0 .7rem}figcaption b{display:block;font-weight:600}
figcaption span{color:var(--soft);font-size:.9rem}
.wide{overflow-x:auto;margin:1rem 0 1.6rem;break-inside:avoid}
table{border-collapse:collapse;width:100%;font-size:.92rem;font-variant-numeric:tabular-nums}
caption{text-align:left;color:var(--soft);font-size:.9rem;padding-bottom:.4rem}
th,td{padding:.35rem .9rem .35rem 0;text-align:left;vertical-align:top;border-bottom:1px solid var(--rule)}
th{font-weight:600}thead th{color:var(--soft);font-weight:500}tbody th{font-weight:500}
.conclusion:empty{display:none}
.sign{display:flex;gap:2.5rem;margin:4.5rem 0 0;break-inside:avoid}
.sign div{flex:1;border-top:1px solid var(--ink);padding-top:.3rem;color:var(--soft);font-size:.85rem}
footer{margin-top:3rem;color:var(--soft);font-size:.85rem}
@page{size:A4;margin:15mm 17mm}
@media print{body{font-size:10pt;line-height:1.4}main{max-width:none;padding:0}.conclusion{font-size:15pt}
h2{font-size:12.5pt;margin:1.2rem 0 .4rem;break-after:avoid}p,ul{max-width:none}.sheet{break-before:page}
.wide{overflow:visible;margin:.7rem 0 1.1rem}table{font-size:9pt}th,td{padding:.22rem .7rem .22rem 0}
tr,li,.signed{break-inside:avoid}.sign{margin-top:2.9rem}footer{margin-top:1.6rem;break-inside:avoid}}
)";

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

// A figure and its standard deviation stay on one line.
std::string unbroken(const std::string& cell) {
  std::string text = escaped(cell);
  const std::string plain = " ± ", firm = "\u00a0±\u00a0";
  for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain, at)) {
    text.replace(at, plain.size(), firm);
  }
  return text;
}

void write_cells(std::string& text, const std::vector<std::string>& cells, bool head) {
  text += "<tr>";
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const std::string_view tag = head || k == 0 ? "th" : "td";
    const std::string_view scope = head ? " scope=\"col\"" : k == 0 ? " scope=\"row\"" : "";
    fmt::format_to(Out(text), "<{0}{1}>{2}</{0}>", tag, scope, unbroken(cells[k]));
  }
  text += "</tr>\n";
}

void write(std::string& text, const Table& table) {
  text += "<div class=\"wide\"><table>\n";
  if (!table.caption.empty()) {
    fmt::format_to(Out(text), "<caption>{}</caption>\n", escaped(table.caption));
  }
  if (!table.head.empty()) {
    text += "<thead>";
    write_cells(text, table.head, true);
    text += "</thead>";
  }
  text += "<tbody>\n";
  for (const std::vector<std::string>& cells : table.rows) write_cells(text, cells, false);
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

std::string_view class_of(const Section& section) {
  if (!section.signatures.empty()) return " class=\"signed\"";
  return section.new_sheet ? " class=\"sheet\"" : "";
}

void write(std::string& text, const Section& section, int& figures) {
  fmt::format_to(Out(text), "<section{}>\n<h2>{}</h2>\n", class_of(section),
                 escaped(section.heading));
  for (const std::string& paragraph : section.paragraphs) {
    fmt::format_to(Out(text), "<p>{}</p>\n", escaped(paragraph));
  }
  if (!section.points.empty()) text += "<ul>\n";
  for (const std::string& point : section.points) {
    fmt::format_to(Out(text), "<li>{}</li>\n", escaped(point));
  }
  if (!section.points.empty()) text += "</ul>\n";
  for (const Table& table : section.tables) write(text, table);
  for (const Figure& figure : section.figures) {
    ++figures;
    fmt::format_to(Out(text),
                   "<figure>\n<figcaption><b>Figure {0}. {1}</b><span>{2}</span></figcaption>\n"
                   "{3}</figure>\n",
                   figures, escaped(figure.title), escaped(figure.description),
                   svg(figure, fmt::format("figure-{}", figures)));
  }
  write_signatures(text, section.signatures);
  text += "</section>\n";
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
                   grave ? fmt::format("<b>{}</b> ", word(note.severity)) : "", escaped(note.text));
  }
  return items;
}

void write_items(std::string& text, const std::string& items) {
  if (!items.empty()) text += "<ul class=\"notes\">\n" + items + "</ul>\n";
}

// What is wrong stands at the top; a long list of warnings is folded, so that the results come
// first.
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

// What is merely so stands at the end.
void write_plain_notes(std::string& text, const std::vector<Note>& notes) {
  const std::string items = items_of(notes, [](Severity s) { return s <= Severity::info; });
  if (items.empty()) return;
  text += "<section>\n<h2>How the input was read</h2>\n";
  write_items(text, items);
  text += "</section>\n";
}

}  // namespace

std::string html(const Page& page) {
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"Proofmass {0}\">\n"
      "<title>{1} – proofmass {2}</title>\n<style>\n{3}{4}</style>\n</head>\n<body>\n<main>\n"
      "<p class=\"from\">Proofmass {0} · {2}</p>\n<h1>{1}</h1>\n<p class=\"conclusion\">{5}</p>\n",
      version(), escaped(page.title), escaped(page.verb), figure_css(), page_css,
      escaped(page.conclusion));
  write(text, page.key_figures);
  write_grave_notes(text, page.notes);
  int figures = 0;
  for (const Section& section : page.sections) write(text, section, figures);
  write_plain_notes(text, page.notes);
  text += "<footer>\n";
  for (const std::string& input : page.inputs) {
    fmt::format_to(Out(text), "<p>Input: {}</p>\n", escaped(input));
  }
  fmt::format_to(
      Out(text),
      "<p>Made by Proofmass {}. A figure written a ± b carries its standard deviation b; "
      "bands are 95 % where they do not say otherwise.</p>\n</footer>\n</main>\n</body>\n</html>\n",
      version());
  return text;
}

}  // namespace proofmass::report
