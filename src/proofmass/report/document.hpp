#pragma once

#include <string>
#include <vector>

#include "proofmass/report/fields.hpp"
#include "proofmass/report/page/page.hpp"

namespace proofmass::report {

/// The result of a verb, described once. `describe()` of each result makes one; text, JSON, page
/// and schema are made from it.
struct Document {
  Page page;      ///< verb, inputs, conclusion, notes, key figures, sections
  Fields fields;  ///< of the JSON document, after its head
  std::vector<std::string> warnings = {};  ///< of the JSON document, beside notes and nulls
  bool bad = false;                        ///< --strict fails even if no note says so
  bool notes_in_text = false;  ///< to_text() has the notes, so that finish() need not show them
  std::string failure = {};    ///< why there is no result at all: with it the run fails
};

/// Notes of reading, then those of computing.
[[nodiscard]] std::vector<Note> all_notes(std::vector<Note> reading,
                                          const std::vector<Note>& computing);

/// The labelled entries among `fields`, as key figures in the same order.
[[nodiscard]] std::vector<KeyFigure> key_figures(const Fields& fields);

/// The labelled entries of an object, one a row.
[[nodiscard]] Table fields_table(std::string caption, const Fields& fields);

/// The labelled entries of a list of objects that have the same ones, one a row, with a column for
/// each object; the first names the column.
[[nodiscard]] Table records_table(std::string caption, const Field& records);

/// The document: "proofmass", "verb", "input", "warnings" (warnings among the notes, the document's
/// own, and the reason of every null), then the fields.
[[nodiscard]] std::string to_json(const Document& document);

/// One self-contained page.
[[nodiscard]] std::string to_html(const Document& document);

/// For a terminal, without colour: conclusion, key figures, the sections that are marked so,
/// and the notes if they are to be there.
[[nodiscard]] std::string to_text(const Document& document);

}  // namespace proofmass::report
