#include "proofmass/report/record_report.hpp"

#include <fmt/format.h>

#include "proofmass/report/json.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {

std::string recover_json(const RecoverReport& report) {
  const Recovery& r = report.recovery;
  return to_json({"recover", {report.input}, texts(r.notes, Severity::warning)},
                 {{"file", r.file},
                  {"was_whole", r.was_whole},
                  {"samples", r.samples},
                  {"first_s", r.first_s},
                  {"last_s", r.last_s},
                  {"missing_samples", r.missing_rows},
                  {"messages", r.messages},
                  {"chunks", r.chunks},
                  {"damaged_chunks", r.damaged_chunks},
                  {"bytes_read", r.bytes_read},
                  {"bytes_lost", r.bytes_lost},
                  {"notes", array_of(texts(r.notes, Severity::info))}});
}

std::string recover_text(const RecoverReport& report) {
  const Recovery& r = report.recovery;
  std::string text;
  if (r.samples > 0)
    text = fmt::format("{}: {}, from {} s to {} s, saved in {}\n", report.input,
                       count_words(r.samples, "sample"), fixed(r.first_s, 2), fixed(r.last_s, 2),
                       r.file);
  else
    text = fmt::format("{}: {} saved in {}\n", report.input, count_words(r.messages, "message"),
                       r.file);
  if (r.was_whole) text += "The file was whole: nothing was missing.\n";
  for (const std::string& note : texts(r.notes, Severity::info)) text += note + "\n";
  return text;
}

}  // namespace proofmass::report
