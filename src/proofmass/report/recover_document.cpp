#include <fmt/format.h>

#include "proofmass/report/recover_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

Fields recover_fields(const Recovery& r) {
  return {field::text("file", r.file, {.meaning = "the file that was written"}),
          field::flag("was_whole", r.was_whole, {.meaning = "nothing was missing"}),
          field::count("samples", r.samples, {.meaning = "saved; 0 for files of other programs"}),
          field::number("first_s", r.first_s, {.meaning = "time of the first sample"}),
          field::number("last_s", r.last_s, {.meaning = "time of the last sample"}),
          field::count("missing_samples", r.missing_rows,
                       {.meaning = "known to be missing between them", .label = "Samples missing"}),
          field::count("messages", r.messages, {.meaning = "saved"}),
          field::count("chunks", r.chunks, {.meaning = "read", .label = "Chunks read"}),
          field::count("damaged_chunks", r.damaged_chunks,
                       {.meaning = "skipped", .label = "Damaged chunks skipped"}),
          field::count("bytes_read", r.bytes_read, {.meaning = "of the damaged file"}),
          field::count(
              "bytes_lost", r.bytes_lost,
              {.meaning = "of the damaged file that could not be used", .label = "Bytes lost"}),
          field::notes(r.notes)};
}

std::string recover_conclusion(const RecoverReport& report) {
  const Recovery& r = report.recovery;
  const std::string saved =
      r.samples > 0 ? fmt::format("{}, from {} s to {} s,", count_words(r.samples, "sample"),
                                  fixed(r.first_s, 2), fixed(r.last_s, 2))
                    : count_words(r.messages, "message");
  return fmt::format("{}: {} saved in {}{}", report.input, saved, r.file,
                     r.was_whole ? ". The file was whole: nothing was missing." : ".");
}

}  // namespace

Document describe(const RecoverReport& report) {
  Document document{.page = {.verb = "recover",
                             .title = file_name(report.input),
                             .inputs = {report.input},
                             .conclusion = recover_conclusion(report),
                             .notes = report.recovery.notes},
                    .fields = recover_fields(report.recovery),
                    .bad = !report.recovery.was_whole,
                    .notes_in_text = true};
  document.page.key_figures = key_figures(document.fields);
  return document;
}

}  // namespace proofmass::report
