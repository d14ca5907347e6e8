#include <algorithm>
#include <array>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "proofmass/report/record_report.hpp"
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

std::vector<std::string> event_kinds() {
  using enum EventKind;
  constexpr std::array all{lost,        overrun,    gap,        stalled,   disconnected,
                           reconnected, clock_jump, clock_dead, host_jump, disk_full,
                           triggered,   rotated,    note};
  std::vector<std::string> names;
  for (const EventKind kind : all) names.emplace_back(proofmass::name_of(kind));
  return names;
}

// "2026-11-22T12:30:05.250Z"
std::string utc(std::int64_t realtime_ns) {
  const std::int64_t seconds = realtime_ns / ns_per_s;
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(static_cast<std::time_t>(seconds)),
                     realtime_ns % ns_per_s / 1'000'000);
}

Fields event_fields(const RecordEvent& event) {
  return {field::choice("kind", proofmass::name_of(event.kind), event_kinds()),
          field::number("start_s", event.time_s, {.meaning = "on the recording's clock"}),
          field::number("duration_s", event.duration_s, {.meaning = "of a gap"}),
          field::count("rows", event.rows, {.meaning = "samples lost, as far as it is known"}),
          field::text("text", with_flags(event))};
}

Fields clock_fields(const ClockMap& clock) {
  const std::string why =
      "too short, or too few samples, to compare the recording's clock with this computer's";
  return {field::text("start", utc(clock.start_realtime_ns),
                      {.meaning = "time of day of the first sample, UTC"}),
          field::measured("rate_error_ppm", scaled(clock.rate_error, ppm), "ppm",
                          {.label = "Error of the recording's clock", .why_null = why}),
          field::measured("rate_hz", clock.rate_hz, "Hz",
                          {.label = "Sample rate by this computer's clock", .why_null = why})};
}

Field latency_field(const std::optional<Latency>& latency) {
  const Display milliseconds{"ms", 1.0};
  std::optional<Fields> fields;
  if (latency)
    fields = Fields{field::count("blocks", latency->blocks, {.meaning = "of samples"}),
                    field::number("median_ms", latency->median_s * ms_per_s,
                                  {.label = "Median", .display = milliseconds}),
                    field::number("p99_ms", latency->p99_s * ms_per_s,
                                  {.label = "99 % of estimates within", .display = milliseconds}),
                    field::number("worst_ms", latency->worst_s * ms_per_s,
                                  {.label = "Largest", .display = milliseconds})};
  return field::object_or_null(
      "latency", std::move(fields),
      {.meaning = "from a block's arrival to its estimate",
       .why_null = "no --estimate was asked for, or the source waits until it is read"});
}

Field channels(const RecordSummary& summary) {
  return field::records(
      "channels", summary.head ? summary.head->channels : std::vector<Channel>{},
      [](const Channel& channel) {
        return Fields{field::text("name", channel.name),
                      field::text_or_null("unit", channel.unit.symbol,
                                          {.why_null = "the source does not state it; give unit= "
                                                       "in SOURCE, or --unit when it is read"})};
      });
}

Field settings(const RecordReport& report) {
  Fields entries;
  for (const auto& [key, value] : report.settings) entries.push_back(field::text(key, value));
  return field::map("settings", std::move(entries),
                    {.meaning = "asked of the source, and granted by it"});
}

Fields count_fields(const RecordSummary& summary) {
  return {
      field::count("samples", summary.samples, {.meaning = "in the files"}),
      field::number("duration_s", summary.duration_s, {.meaning = "by the recording's clock"}),
      field::count("lost", summary.lost,
                   {.meaning = "samples known to be missing: by the device or its protocol, by the "
                               "clocks, or because the queue to the disk was full"}),
      field::count("overrun", summary.overrun,
                   {.meaning = "of these, because the queue to the disk was full"}),
      field::count("not_kept", summary.not_kept,
                   {.meaning = "samples outside the intervals that the trigger selects"}),
      field::count("not_written", summary.not_written,
                   {.meaning = "samples that no file has, since the disk failed"}),
      field::count("gaps", summary.gap_count, {.meaning = "intervals with missing samples"}),
      field::records("gap_list", summary.gaps, event_fields,
                     {.meaning = "the first 10 000 of them"}),
      field::records("events", summary.events, event_fields,
                     {.meaning = "all others, the first 10 000"})};
}

Fields record_fields(const RecordReport& report) {
  const RecordSummary& summary = report.summary;
  Fields fields{
      field::text_or_null("file", summary.files.empty() ? "" : summary.files.front(),
                          {.why_null = "no sample came, so none was kept; or --no-file"}),
      field::texts("files", summary.files, {.meaning = "all of them: several with --rotate"})};
  append(fields, count_fields(summary));
  append(fields, {field::choice("end", name_of(summary.end),
                                {"duration", "stopped", "source_end", "source_gone", "disk_failed"},
                                {.meaning = "why it ended"}),
                  channels(summary),
                  field::object("clock", clock_fields(summary.clock),
                                {.meaning = "the recording's clock against this computer's"}),
                  latency_field(summary.latency), settings(report),
                  field::texts("audit", texts(summary.audit, Severity::info),
                               {.meaning = "on the samples: jitter, clipping, stuck channels"})});
  return fields;
}

std::vector<RecordEvent> grave(const std::vector<RecordEvent>& events) {
  std::vector<RecordEvent> out;
  std::ranges::copy_if(events, std::back_inserter(out),
                       [](const RecordEvent& event) { return event.severity != Severity::info; });
  return out;
}

std::vector<std::string> warnings_of(const RecordSummary& summary) {
  std::vector<std::string> out;
  for (const auto* events : {&summary.gaps, &summary.events})
    for (const RecordEvent& event : grave(*events)) out.push_back(event_words(event));
  const std::vector<std::string> audit = texts(summary.audit, Severity::warning);
  out.insert(out.end(), audit.begin(), audit.end());
  if (!summary.end_reason.empty()) out.push_back(summary.end_reason);
  return out;
}

bool is_bad(const RecordSummary& summary) {
  const auto bad = [](const auto& item) { return item.severity == Severity::bad; };
  return summary.lost > 0 || summary.gap_count > 0 || summary.not_written > 0 ||
         std::ranges::any_of(summary.events, bad) || std::ranges::any_of(summary.audit, bad);
}

std::string missing_words(const RecordSummary& summary) {
  // Samples that could not be written to disk have a sentence of their own.
  const std::uint64_t lost = summary.lost - std::min(summary.lost, summary.not_written);
  if (summary.gap_count == 0 && summary.lost == 0) return " Nothing was lost, and there is no gap.";
  if (summary.gap_count == 0 && lost == 0) return {};
  const std::string gaps = count_words(summary.gap_count, "gap");
  if (lost == 0) return " " + gaps + "; how many samples are missing cannot be determined.";
  std::string out = fmt::format(" {} lost in {}", count_words(lost, "sample"), gaps);
  if (summary.overrun > 0)
    out += fmt::format(", {} of them because the disk could not keep up", grouped(summary.overrun));
  return out + ".";
}

std::string conclusion(const RecordReport& report) {
  const RecordSummary& summary = report.summary;
  const std::size_t channels = summary.head ? summary.head->channels.size() : 0;
  return fmt::format(
      "{} of {} over {} from {}{}.{}", count_words(summary.samples, "sample"),
      count_words(channels, "channel"), duration_words(summary.duration_s), report.source,
      summary.files.empty() ? ": no file" : fmt::format(" to {}", fmt::join(summary.files, ", ")),
      missing_words(summary));
}

std::vector<std::string> course(const RecordSummary& summary) {
  std::vector<std::string> out;
  if (summary.not_kept > 0)
    out.push_back(fmt::format("{} outside the trigger's intervals were not kept.",
                              count_words(summary.not_kept, "sample")));
  if (summary.not_written > 0)
    out.push_back(fmt::format("{} are in no file, since the disk failed.",
                              count_words(summary.not_written, "sample")));
  if (summary.end == RecordEnd::source_end) out.emplace_back("The source came to its end.");
  if (!summary.end_reason.empty()) out.push_back(summary.end_reason);
  const std::vector<std::string> audit = texts(summary.audit, Severity::warning);
  out.insert(out.end(), audit.begin(), audit.end());
  return out;
}

// Events of one kind; `count` is their total number.
Table events_table(const std::string& name,
                   const std::vector<RecordEvent>& events,
                   std::size_t count) {
  Table table{name, {}, {}};
  if (count > events.size())
    table.caption += fmt::format(", the first {} of {}", grouped(events.size()), grouped(count));
  table.long_list = true;
  for (const RecordEvent& event : events)
    table.rows.push_back({fixed(event.time_s, 2) + " s", with_flags(event)});
  return table;
}

std::vector<Table> record_tables(const RecordSummary& summary, const Fields& fields) {
  const std::vector<RecordEvent> events = grave(summary.events);
  std::vector<Table> tables{events_table("Gaps", summary.gaps, summary.gap_count),
                            events_table("Events", events, events.size())};
  for (const Field& field : fields) {
    if (field.key == "clock" && summary.clock.rate_error && summary.clock.rate_hz)
      tables.push_back(fields_table("Clock", *field.fields));
    if (field.key == "latency" && summary.latency && summary.latency->blocks > 0)
      tables.push_back(fields_table("Latency of the estimates", *field.fields));
  }
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace

std::string event_words(const RecordEvent& event) {
  return fmt::format("{} s: {}", fixed(event.time_s, 2), with_flags(event));
}

Document describe(const RecordReport& report) {
  const RecordSummary& summary = report.summary;
  Document document{.page = {.verb = "record",
                             .title = report.source,
                             .inputs = {report.source},
                             .conclusion = conclusion(report),
                             .notes = report.notes},
                    .fields = record_fields(report),
                    .warnings = warnings_of(summary),
                    .bad = is_bad(summary)};
  document.page.sections = {{.heading = "Course of the recording",
                             .points = course(summary),
                             .tables = record_tables(summary, document.fields),
                             .on_terminal = true}};
  return document;
}

}  // namespace proofmass::report
