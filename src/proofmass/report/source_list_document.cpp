#include "proofmass/report/record_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {

Document describe(const SourceList& list) {
  Document document{
      .page = {.verb = "record",
               .action = "--list",
               .title = "Sources",
               .inputs = {},
               .conclusion = list.found.empty()
                                 ? "No source was found that can be recorded from at once."
                                 : count_words(list.found.size(), "source") + " found."},
      .fields = {field::records("found", list.found,
                                [](const auto& source) {
                                  return Fields{field::text("uri", source.first),
                                                field::text("what", source.second)};
                                },
                                {.meaning = "with --list: sources that were found"}),
                 field::records("kinds", list.kinds,
                                [](const auto& kind) {
                                  return Fields{field::text("grammar", kind.first),
                                                field::text("what", kind.second)};
                                },
                                {.meaning = "with --list: all kinds of source"})},
      .warnings = texts(list.notes, Severity::info)};
  Table found{"Sources found", {}, {}};
  for (const auto& [uri, what] : list.found) found.rows.push_back({uri, what});
  Section kinds{.heading = "Kinds of source", .on_terminal = true};
  for (const auto& [grammar, what] : list.kinds)
    kinds.parts.push_back({.heading = grammar, .digest = what, .paragraphs = {what}});
  document.page.sections = {
      {.heading = "Sources", .tables = {std::move(found)}, .on_terminal = true}, std::move(kinds)};
  if (!document.warnings.empty())
    document.page.sections.push_back(
        {.heading = "Not looked for", .points = document.warnings, .on_terminal = true});
  return document;
}

}  // namespace proofmass::report
