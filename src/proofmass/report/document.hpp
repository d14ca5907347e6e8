#pragma once

#include <string>
#include <vector>

#include "proofmass/report/fields.hpp"
#include "proofmass/report/page/page.hpp"

namespace proofmass::report {

/// The result of a verb, described once by its `describe()`; text, JSON, page and schema are
/// generated from it.
struct Document {
  Page page;      ///< verb, inputs, conclusion, notes, key figures, sections
  Fields fields;  ///< entries of the JSON document, after its head
  std::vector<std::string> warnings = {};  ///< of the JSON document, besides notes and nulls
  bool bad = false;                        ///< true: --strict fails even if no note is bad
  bool notes_in_text = false;              ///< to_text() includes the notes; finish() omits them
  std::string failure = {};  ///< reason if there is no result at all; the run then fails
};

/// Notes of reading, followed by those of the computation.
[[nodiscard]] std::vector<Note> all_notes(std::vector<Note> reading,
                                          const std::vector<Note>& computing);

/// The labelled entries of `fields` as key figures, in order.
[[nodiscard]] std::vector<KeyFigure> key_figures(const Fields& fields);

/// The labelled entries of an object, one per row.
[[nodiscard]] Table fields_table(std::string caption, const Fields& fields);

/// The labelled entries of a list of objects with equal keys: one row per entry, one column per
/// object. The first entry heads the column.
[[nodiscard]] Table records_table(std::string caption, const Field& records);

/// The document: "proofmass", "verb", "input", "warnings" (notes of warning level,
/// Document::warnings, and the reason of each null), then the fields.
[[nodiscard]] std::string to_json(const Document& document);

/// The result as one self-contained page.
[[nodiscard]] std::string to_html(const Document& document);

/// Plain text for a terminal: conclusion, key figures, sections with `on_terminal`, and the notes
/// if `notes_in_text`.
[[nodiscard]] std::string to_text(const Document& document);

}  // namespace proofmass::report
