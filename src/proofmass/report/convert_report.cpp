#include "proofmass/report/convert_report.hpp"

#include <fmt/format.h>

#include "proofmass/report/json.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {

std::string convert_json(const ConvertReport& report) {
  const Recording& recording = report.recording;
  Array channels;
  std::vector<std::string> warnings = texts(report.notes, Severity::warning);
  for (const Channel& channel : recording.channels) {
    const bool known = !channel.unit.symbol.empty();
    channels.push_back(
        Object{{"name", channel.name}, {"unit", known ? Value(channel.unit.symbol) : Value()}});
    if (!known) warnings.push_back(channel.name + ": unit: null: neither the file nor --unit says");
  }
  const bool timed = recording.time.rate_hz > 0.0;
  if (!timed) warnings.emplace_back("rate_hz: null: no time column and no --rate");
  return to_json({"convert", {report.input}, std::move(warnings)},
                 {{"file", report.output},
                  {"format", recording.format},
                  {"samples", report.samples},
                  {"rate_hz", timed ? Value(recording.time.rate_hz) : Value()},
                  {"channels", std::move(channels)}});
}

std::string convert_text(const ConvertReport& report) {
  return fmt::format("{} ({}): {} of {} written to {}\n", report.input, report.recording.format,
                     count_words(report.recording.channels.size(), "channel"),
                     count_words(report.samples, "sample"), report.output);
}

}  // namespace proofmass::report
