#include "proofmass/report/record_report.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "proofmass/report/json.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

constexpr double ms_per_s = 1e3, ppm = 1e6;
constexpr std::int64_t ns_per_s = 1'000'000'000;

std::string_view name_of(RecordEnd end) {
  switch (end) {
    case RecordEnd::duration:
      return "duration";
    case RecordEnd::stopped:
      return "stopped";
    case RecordEnd::source_end:
      return "source_end";
    case RecordEnd::source_gone:
      return "source_gone";
    case RecordEnd::disk_failed:
      break;
  }
  return "disk_failed";
}

// "2026-11-22T12:30:05.250Z"
std::string utc(std::int64_t realtime_ns) {
  const std::int64_t seconds = realtime_ns / ns_per_s;
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(static_cast<std::time_t>(seconds)),
                     realtime_ns % ns_per_s / 1'000'000);
}

Array events_json(const std::vector<RecordEvent>& events) {
  Array out;
  for (const RecordEvent& event : events)
    out.push_back(Object{{"kind", proofmass::name_of(event.kind)},
                         {"start_s", event.time_s},
                         {"duration_s", event.duration_s},
                         {"rows", event.rows},
                         {"text", event.text}});
  return out;
}

Value clock_json(const ClockMap& clock, std::vector<std::string>& warnings) {
  const bool told = clock.rate_error && clock.rate_hz;
  if (!told)
    warnings.emplace_back(
        "clock: rate_error_ppm and rate_hz: null: too short, or too few samples, to hold the "
        "recording's clock against this computer's");
  return Object{{"start", utc(clock.start_realtime_ns)},
                {"rate_error_ppm", quantity(scaled(clock.rate_error, ppm), "ppm")},
                {"rate_hz", quantity(clock.rate_hz, "Hz")}};
}

Value latency_json(const std::optional<Latency>& latency) {
  if (!latency) return {};
  return Object{{"blocks", std::uint64_t{latency->blocks}},
                {"median_ms", latency->median_s * ms_per_s},
                {"p99_ms", latency->p99_s * ms_per_s},
                {"worst_ms", latency->worst_s * ms_per_s}};
}

Array channels_json(const RecordSummary& summary, std::vector<std::string>& warnings) {
  Array out;
  if (!summary.head) return out;
  for (const Channel& channel : summary.head->channels) {
    const bool known = !channel.unit.symbol.empty();
    if (!known)
      warnings.push_back(channel.name +
                         ": unit: null: the source does not say; give unit= or "
                         "--unit where it is read");
    out.push_back(
        Object{{"name", channel.name}, {"unit", known ? Value(channel.unit.symbol) : Value()}});
  }
  return out;
}

std::vector<std::string> warnings_of(const RecordReport& report) {
  std::vector<std::string> out = texts(report.notes, Severity::warning);
  const RecordSummary& summary = report.summary;
  for (const auto* events : {&summary.gaps, &summary.events})
    for (const RecordEvent& event : *events)
      if (event.severity != Severity::info) out.push_back(event_words(event));
  const std::vector<std::string> audit = texts(summary.audit, Severity::warning);
  out.insert(out.end(), audit.begin(), audit.end());
  if (!summary.end_reason.empty()) out.push_back(summary.end_reason);
  return out;
}

std::string missing_words(const RecordSummary& summary) {
  // What the disk failed to take has a line of its own.
  const std::uint64_t lost = summary.lost - std::min(summary.lost, summary.not_written);
  if (summary.gap_count == 0 && summary.lost == 0) return "Nothing was lost, and there is no gap.";
  if (summary.gap_count == 0 && lost == 0) return {};
  const std::string gaps = count_words(summary.gap_count, "gap");
  if (lost == 0) return gaps + "; how many samples are missing cannot be determined.";
  std::string out = fmt::format("{} lost in {}", count_words(lost, "sample"), gaps);
  if (summary.overrun > 0)
    out += fmt::format(", {} of them because the disk could not keep up", grouped(summary.overrun));
  return out + ".";
}

std::string end_words(const RecordSummary& summary) {
  switch (summary.end) {
    case RecordEnd::source_gone:
    case RecordEnd::disk_failed:
      return summary.end_reason;
    case RecordEnd::source_end:
      return "The source came to its end.";
    case RecordEnd::duration:
    case RecordEnd::stopped:
      break;
  }
  return {};
}

std::string clock_words(const RecordSummary& summary) {
  const ClockMap& clock = summary.clock;
  if (!clock.rate_hz || !clock.rate_error) return {};
  return fmt::format("By this computer's clock it came at {}; the recording's clock is off by {}.",
                     with_std(*clock.rate_hz, "Hz"),
                     with_std(*scaled(clock.rate_error, ppm), "ppm"));
}

std::string latency_words(const RecordSummary& summary) {
  if (!summary.latency || summary.latency->blocks == 0) return {};
  const Latency& latency = *summary.latency;
  return fmt::format("Estimates came {} ms after their samples ({} ms at most for 99 % of them).",
                     compact(latency.median_s * ms_per_s, 2), compact(latency.p99_s * ms_per_s, 2));
}

void add_line(std::string& text, const std::string& line) {
  if (!line.empty()) text += line + "\n";
}

// The first few events of a list, and how many more.
void add_events(std::string& text, const std::vector<RecordEvent>& events, std::size_t count) {
  constexpr std::size_t most = 8;
  for (std::size_t i = 0; i < std::min(most, events.size()); ++i)
    text += fmt::format("  {}\n", event_words(events[i]));
  if (count > most) text += fmt::format("  … and {} more\n", grouped(count - most));
}

std::vector<RecordEvent> worth_telling(const std::vector<RecordEvent>& events) {
  std::vector<RecordEvent> out;
  std::ranges::copy_if(events, std::back_inserter(out),
                       [](const RecordEvent& event) { return event.severity != Severity::info; });
  return out;
}

}  // namespace

std::string event_words(const RecordEvent& event) {
  return fmt::format("{} s: {}", fixed(event.time_s, 2), event.text);
}

bool is_bad(const RecordReport& report) {
  const RecordSummary& summary = report.summary;
  const auto bad = [](const auto& item) { return item.severity == Severity::bad; };
  return summary.lost > 0 || summary.gap_count > 0 || summary.not_written > 0 ||
         std::ranges::any_of(summary.events, bad) || std::ranges::any_of(summary.audit, bad);
}

std::string record_json(const RecordReport& report) {
  const RecordSummary& summary = report.summary;
  std::vector<std::string> warnings = warnings_of(report);
  Array channels = channels_json(summary, warnings);
  Value clock = clock_json(summary.clock, warnings);
  if (!summary.latency)
    warnings.emplace_back(
        "latency: null: no --estimate was asked for, or the source waits until it is read");
  if (summary.files.empty()) warnings.emplace_back("file: null: no sample came, so none was kept");
  Object settings;
  for (const auto& [key, value] : report.settings) settings.push_back({key, value});
  return to_json({"record", {report.source}, std::move(warnings)},
                 {{"file", summary.files.empty() ? Value() : Value(summary.files.front())},
                  {"files", array_of(summary.files)},
                  {"samples", summary.samples},
                  {"duration_s", summary.duration_s},
                  {"lost", summary.lost},
                  {"overrun", summary.overrun},
                  {"not_kept", summary.not_kept},
                  {"not_written", summary.not_written},
                  {"gaps", std::uint64_t{summary.gap_count}},
                  {"gap_list", events_json(summary.gaps)},
                  {"events", events_json(summary.events)},
                  {"end", name_of(summary.end)},
                  {"channels", std::move(channels)},
                  {"clock", std::move(clock)},
                  {"latency", latency_json(summary.latency)},
                  {"settings", std::move(settings)},
                  {"audit", array_of(texts(summary.audit, Severity::info))}});
}

std::string record_text(const RecordReport& report) {
  const RecordSummary& summary = report.summary;
  const std::size_t channels = summary.head ? summary.head->channels.size() : 0;
  std::string text = fmt::format(
      "{} of {} over {} from {}{}\n", count_words(summary.samples, "sample"),
      count_words(channels, "channel"), duration_words(summary.duration_s), report.source,
      summary.files.empty() ? ": no file" : fmt::format(" to {}", fmt::join(summary.files, ", ")));
  add_line(text, missing_words(summary));
  add_events(text, summary.gaps, summary.gap_count);
  if (summary.not_kept > 0)
    add_line(text, fmt::format("{} in between were not asked for by the trigger.",
                               count_words(summary.not_kept, "sample")));
  if (summary.not_written > 0)
    add_line(text, fmt::format("{} are in no file, since the disk failed.",
                               count_words(summary.not_written, "sample")));
  const std::vector<RecordEvent> told = worth_telling(summary.events);
  add_events(text, told, told.size());
  add_line(text, end_words(summary));
  add_line(text, clock_words(summary));
  add_line(text, latency_words(summary));
  for (const std::string& note : texts(summary.audit, Severity::warning)) add_line(text, note);
  return text;
}

std::string source_list_text(const SourceList& list) {
  std::string text =
      list.found.empty() ? "Nothing is there that can be recorded from at once.\n" : "There now:\n";
  std::vector<std::vector<std::string>> rows;
  for (const auto& [uri, what] : list.found) rows.push_back({uri, what});
  text += aligned(rows) + "\nKinds of source:\n";
  for (const auto& [grammar, what] : list.kinds)
    text += fmt::format("  {}\n      {}\n", grammar, what);
  if (!list.notes.empty()) text += "\nNot looked for:\n";
  for (const Note& note : list.notes) text += fmt::format("  {}\n", note.text);
  return text;
}

std::string source_list_json(const SourceList& list) {
  Array found, kinds;
  for (const auto& [uri, what] : list.found) found.push_back(Object{{"uri", uri}, {"what", what}});
  for (const auto& [grammar, what] : list.kinds)
    kinds.push_back(Object{{"grammar", grammar}, {"what", what}});
  return to_json({"record", {}, texts(list.notes, Severity::info)},
                 {{"found", std::move(found)}, {"kinds", std::move(kinds)}});
}

}  // namespace proofmass::report
