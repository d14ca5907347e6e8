#include <fmt/format.h>

#include "proofmass/report/convert_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

Fields converted_channel_fields(const Channel& channel) {
  return {field::text("name", channel.name),
          field::text_or_null("unit", channel.unit.symbol,
                              {.meaning = "as written; null where unknown",
                               .why_null = "neither the file nor --unit states it"})};
}

Fields convert_fields(const ConvertReport& report) {
  const Recording& recording = report.recording;
  const double rate_hz = recording.time.rate_hz;
  return {field::text("file", report.output, {.meaning = "written; - is standard output"}),
          field::text("format", recording.format, {.meaning = "of the file that was read"}),
          field::count("samples", report.samples),
          field::number(
              "rate_hz", rate_hz > 0.0 ? std::optional(rate_hz) : std::nullopt,
              {.meaning = "nominal sampling rate", .why_null = "no time column and no --rate"}),
          field::records("channels", recording.channels, converted_channel_fields)};
}

}  // namespace

Document describe(const ConvertReport& report) {
  const Recording& recording = report.recording;
  return {.page = {.verb = "convert",
                   .title = file_name(report.input),
                   .inputs = {report.input},
                   .conclusion = fmt::format("{} ({}): {} of {} written to {}", report.input,
                                             recording.format,
                                             count_words(recording.channels.size(), "channel"),
                                             count_words(report.samples, "sample"), report.output),
                   .notes = report.notes},
          .fields = convert_fields(report)};
}

}  // namespace proofmass::report
