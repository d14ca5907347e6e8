#include "proofmass/report/document.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

constexpr std::size_t most_printed_rows = 20;  // rows of a long table printed on a terminal

void print(std::string& out, const Table& table) {
  if (table.page_only || table.rows.empty()) return;
  std::vector<std::vector<std::string>> rows;
  if (!table.head.empty()) rows.push_back(table.head);
  const std::size_t shown =
      table.long_list ? std::min(table.rows.size(), most_printed_rows) : table.rows.size();
  rows.insert(rows.end(), table.rows.begin(),
              table.rows.begin() + static_cast<std::ptrdiff_t>(shown));
  out += '\n' + (table.caption.empty() ? "" : table.caption + ":\n") + aligned(rows);
  if (table.rows.size() > shown) out += fmt::format("  and {} more\n", table.rows.size() - shown);
}

void print(std::string& out, const Section& section) {
  if (!section.on_terminal) return;
  if (!section.paragraphs.empty() || !section.points.empty()) out += '\n' + section.heading + ":\n";
  for (const std::string& paragraph : section.paragraphs) out += "  " + paragraph + '\n';
  for (const std::string& point : section.points) out += "  - " + point + '\n';
  for (const Table& table : section.tables) print(out, table);
  if (!section.parts.empty()) out += '\n' + section.heading + '\n';
  for (const Section& part : section.parts) {
    out += fmt::format("  {}{}\n", part.heading, part.gist.empty() ? "" : " (" + part.gist + ")");
    if (!part.digest.empty()) out += "      " + part.digest + '\n';
  }
}

void print(std::string& out, const std::vector<Note>& notes) {
  constexpr std::array words{"note", "warning", "bad data"};
  if (!notes.empty()) out += "\nNotes:\n";
  for (const Note& note : notes)
    out += fmt::format("  - {}: {}\n", words.at(static_cast<std::size_t>(note.severity)),
                       with_flags(note));
}

// The labelled entries, including those in lists.
void collect_labelled(const Fields& fields, std::vector<const Field*>& out) {
  for (const Field& field : fields) {
    if (!field.about.label.empty()) out.push_back(&field);
    if (field.fields && field.shape.kind == Shape::Kind::list) collect_labelled(*field.fields, out);
  }
}

}  // namespace

std::vector<Note> all_notes(std::vector<Note> reading, const std::vector<Note>& computing) {
  reading.insert(reading.end(), computing.begin(), computing.end());
  return reading;
}

Table fields_table(std::string caption, const Fields& fields) {
  Table table{std::move(caption), {}, {}};
  std::vector<const Field*> labelled;
  collect_labelled(fields, labelled);
  for (const Field* field : labelled)
    table.rows.push_back({field->about.label, shown_value(*field)});
  return table;
}

Table records_table(std::string caption, const Field& records) {
  Table table{std::move(caption), {""}, {}};
  for (const Field& record : *records.fields) {
    std::vector<const Field*> labelled;
    collect_labelled(*record.fields, labelled);
    table.rows.resize(labelled.size() - 1);
    table.head.push_back(file_name(shown_value(*labelled.front())));
    for (std::size_t k = 1; k < labelled.size(); ++k) {
      if (table.rows[k - 1].empty()) table.rows[k - 1].push_back(labelled[k]->about.label);
      table.rows[k - 1].push_back(shown_value(*labelled[k]));
    }
  }
  return table;
}

std::vector<KeyFigure> key_figures(const Fields& fields) {
  std::vector<KeyFigure> out;
  for (const Field& field : fields)
    if (!field.about.label.empty()) out.push_back({field.about.label, shown_value(field)});
  return out;
}

std::string to_json(const Document& document) {
  std::vector<std::string> warnings = texts(document.page.notes, Severity::warning);
  warnings.insert(warnings.end(), document.warnings.begin(), document.warnings.end());
  for (std::string& reason : reasons_for_nulls(document.fields))
    warnings.push_back(std::move(reason));
  return to_json({document.page.verb, document.page.inputs, warnings}, json_of(document.fields));
}

std::string to_html(const Document& document) {
  return html(document.page);
}

std::string to_text(const Document& document) {
  std::string out = document.page.conclusion + '\n';
  std::vector<std::vector<std::string>> rows;
  for (const KeyFigure& figure : document.page.key_figures)
    if (!figure.page_only) rows.push_back({figure.label, figure.value});
  if (!rows.empty()) out += '\n' + aligned(rows);
  for (const Section& section : document.page.sections) print(out, section);
  if (document.notes_in_text) print(out, document.page.notes);
  return out;
}

}  // namespace proofmass::report
