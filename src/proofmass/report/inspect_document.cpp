#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "proofmass/report/inspect_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using signal::ChannelAudit;
using signal::RecordingAudit;
using signal::TimingAudit;

const char* word(signal::Clipping clipping) {
  switch (clipping) {
    case signal::Clipping::rail:
      return "rail";
    case signal::Clipping::before_noise:
      return "before_noise";
    case signal::Clipping::soft:
      return "soft";
    case signal::Clipping::undetermined:
      return "undetermined";
    case signal::Clipping::none:
      break;
  }
  return "none";
}

bool has_rate(const RecordingAudit& audit) {
  return audit.timing.rate_hz > 0.0;
}

bool has_values(const ChannelAudit& channel) {
  return channel.moments.count > 0;
}

// A statistic of the plausible values.
Field statistic(const char* key, const ChannelAudit& channel, double figure) {
  return field::number(key, has_values(channel) ? std::optional(figure) : std::nullopt,
                       {.why_null = "no plausible value"});
}

Fields channel_fields(const ChannelAudit& channel) {
  const Moments& moments = channel.moments;
  const auto limit = [](const char* key, const std::optional<double>& value) {
    return field::number(key, value,
                         {.meaning = "end of the range, or where the crests begin to be bent",
                          .why_null = "the data do not show the end of the range on that side"});
  };
  return {field::text("name", channel.name),
          field::text_or_null("unit", channel.unit.symbol,
                              {.meaning = "as written; null where unknown",
                               .why_null = "neither the file nor --unit states it"}),
          field::text("quantity", name_of(channel.unit.quantity)),
          statistic("mean", channel, moments.mean),
          statistic("std", channel, moments.std()),
          statistic("min", channel, moments.min),
          statistic("max", channel, moments.max),
          field::number("lsb", channel.lsb,
                        {.meaning = "step of the converter",
                         .why_null = "the values are not multiples of a common step"}),
          field::count("nonfinite", channel.nonfinite, {.meaning = "NaN and infinities"}),
          field::choice(
              "clipping", word(channel.clipping),
              {"none", "rail", "before_noise", "soft", "undetermined"},
              {.meaning = "how the range limits the channel: at its exact extreme, at a level "
                          "with noise added after it, or softly; undetermined: flat crests "
                          "that the motion itself may have"}),
          field::count("clipped", channel.clipped,
                       {.meaning = "samples at the limits, or on bent crests; 0 where clipping is "
                                   "undetermined"}),
          limit("limit_low", channel.limit_low),
          limit("limit_high", channel.limit_high),
          field::count("absurd", channel.absurd, {.meaning = "values beyond 1e15 in magnitude"}),
          field::count("denormal", channel.denormal,
                       {.meaning = "values other than 0 below 1.2e-38 in magnitude"}),
          field::count("longest_stuck", channel.longest_stuck,
                       {.meaning = "samples of the longest run of equal values"}),
          field::number("longest_stuck_start_s", channel.longest_stuck_start_s)};
}

Fields gap_fields(const signal::Gap& gap) {
  return {field::number("start_s", gap.start_s), field::magnitude("duration_s", gap.duration_s)};
}

Field lost(const TimingAudit& timing) {
  Field field = field::count("lost", timing.lost.value_or(0),
                             {.meaning = "rows missing by the packet counter of the file"});
  return timing.lost ? field : field::without_value(field, "no packet counter");
}

Field timing(const TimingAudit& timing) {
  return field::object(
      "timing",
      {field::choice("source", time_source_name(timing.source),
                     {"stamps", "counter", "given_rate", "none"}),
       field::text_or_null("channel", timing.channel, {.why_null = "no time column"}),
       field::number("rate_long_run_hz", timing.long_run_hz,
                     {.meaning = "samples, missing ones included, over the duration; rate_hz is "
                                 "that of the usual step or, where stamps are rounded, jitter or "
                                 "come in bursts, of a line through them",
                      .why_null = "no time stamps"}),
       field::magnitude("jitter_s", timing.jitter_s,
                        {.meaning = "standard deviation of the steps, without gaps",
                         .why_null = "too few time stamps"}),
       field::long_records("gaps", timing.gaps, gap_fields),
       field::count("gap_count", timing.gap_count,
                    {.meaning = "all gaps; of more than a million the first are listed"}),
       field::count("stalls", timing.stalls,
                    {.meaning = "intervals of more than three steps in which no sample is missing: "
                                "those that follow were stamped late"}),
       field::count("backwards", timing.backwards, {.meaning = "stamps earlier than the last"}),
       field::count("repeated", timing.repeated, {.meaning = "stamps equal to the last"}),
       field::count("mended", timing.mended, {.meaning = "stamps that the reader replaced"}),
       lost(timing)});
}

// Use of one name among the labels of a recording.
struct LabelUse {
  std::string name;
  std::size_t runs = 0;
  std::size_t samples = 0;
};

// In order of first appearance.
std::vector<LabelUse> label_uses(const Recording& recording) {
  std::vector<LabelUse> uses;
  for (const Label& label : recording.labels) {
    auto use = std::ranges::find(uses, label.text, &LabelUse::name);
    if (use == uses.end()) use = uses.insert(uses.end(), {label.text, 0, 0});
    ++use->runs;
    use->samples += label.last - label.first + 1;
  }
  return uses;
}

Field labels(const Recording& recording) {
  return field::records(
      "labels", label_uses(recording),
      [&](const LabelUse& use) {
        return Fields{field::text("channel", recording.label_channel, {.meaning = "the column"}),
                      field::text("name", use.name), field::count("runs", use.runs),
                      field::count("samples", use.samples)};
      },
      {.meaning = "names in a column of words, in the order of their first appearance"});
}

Fields file_fields(const InspectedFile& file) {
  const RecordingAudit& audit = file.audit;
  const auto if_timed = [&](double value) {
    return has_rate(audit) ? std::optional(value) : std::nullopt;
  };
  const About about_rate{.meaning = "nominal sampling rate",
                         .why_null = "no time column and no --rate"};
  return {
      field::text("format", audit.format),
      field::count("samples", audit.samples),
      field::number("duration_s", if_timed(audit.duration_s), {.why_null = about_rate.why_null}),
      field::magnitude("rate_hz", if_timed(audit.timing.rate_hz), about_rate),
      field::magnitude(
          "rate_std_hz", audit.timing.rate_std_hz,
          {.meaning = "standard deviation of rate_hz, in seconds of the clock of the stamps",
           .why_null = audit.timing.source == TimeSource::stamps
                           ? "the stamps are even to the last digit, or too few"
                           : "no time stamps"}),
      field::records("channels", audit.channels, channel_fields,
                     {.meaning = "figures are in the channel's own unit"}),
      labels(file.recording),
      timing(audit.timing),
      field::count("zero_rows", audit.zero_row_count,
                   {.meaning = "samples at which every inertial channel is exactly 0"}),
      field::flag("bad", audit.is_bad(), {.meaning = "what --strict reports"}),
      field::notes(audit.notes)};
}

Fields inspect_fields(const std::vector<InspectedFile>& files) {
  Fields fields = file_fields(files.front());
  if (files.size() == 1) return fields;
  fields.push_back(field::records("files", files, [](const InspectedFile& file) {
    Fields own{field::text("file", file.name)};
    append(own, file_fields(file));
    return own;
  }));
  return fields;
}

// The nominal rate, and the long-run rate where the two differ by more than 0.1 %.
std::string rate_words(const TimingAudit& timing) {
  if (!(timing.rate_hz > 0.0)) return "unknown";
  const std::string nominal = compact(timing.rate_hz, 7) + " Hz";
  const double long_run_hz = timing.long_run_hz.value_or(timing.rate_hz);
  if (std::abs(long_run_hz / timing.rate_hz - 1.0) <= 1e-3) return nominal;
  return fmt::format("{} by the usual step, {} Hz over the duration", nominal,
                     compact(long_run_hz, 7));
}

// Values below a nanosecond are rounding of the stamps.
std::string jitter_words(const TimingAudit& timing) {
  constexpr double rounding_s = 1e-9;
  if (!timing.jitter_s) return "unknown";
  return *timing.jitter_s < rounding_s ? "none" : compact(*timing.jitter_s * 1e3, 3) + " ms";
}

// "120 Hz for 91.6 s, 3 channels: no faults found."
std::string verdict(const RecordingAudit& audit) {
  const std::string size = has_rate(audit)
                               ? fmt::format("{} Hz for {}", compact(audit.timing.rate_hz, 4),
                                             duration_words(audit.duration_s))
                               : count_words(audit.samples, "sample") + " at an unknown rate";
  const auto bad = texts(audit.notes, Severity::bad).size();
  const auto warnings = texts(audit.notes, Severity::warning).size() - bad;
  std::string found = "no faults found";
  if (warnings > 0) found = count_words(warnings, "warning");
  if (bad > 0) found = count_words(bad, "fault") + " in the data";
  return fmt::format("{}, {}: {}.", size, count_words(audit.channels.size(), "channel"), found);
}

std::string format_words(const RecordingAudit& audit) {
  const std::string& column = audit.timing.channel;
  return fmt::format("{}, {}, {}.", audit.format, count_words(audit.samples, "sample"),
                     column.empty() ? "no time column" : "time from column " + column);
}

Table channels_table(const RecordingAudit& audit) {
  Table table{
      "Channels, each in its own unit; statistics are of the plausible values",
      {"Channel", "Unit", "Mean", "Std", "Min", "Max", "LSB", "Not finite", "Absurd", "Clipped"},
      {}};
  for (const ChannelAudit& channel : audit.channels) {
    const Moments& moments = channel.moments;
    const auto cell = [&](double x) { return has_values(channel) ? significant(x, 5) : "none"; };
    table.rows.push_back(
        {channel.name, channel.unit.symbol.empty() ? "unknown" : print_unit(channel.unit.symbol),
         cell(moments.mean), cell(moments.std()), cell(moments.min), cell(moments.max),
         channel.lsb ? significant(*channel.lsb, 4) : "none", std::to_string(channel.nonfinite),
         std::to_string(channel.absurd), std::to_string(channel.clipped)});
  }
  return table;
}

Table timing_table(const TimingAudit& timing) {
  Table table{"Timing", {}, {}};
  table.rows = {{"Rate", rate_words(timing)},
                {"Jitter", jitter_words(timing)},
                {"Gaps", std::to_string(timing.gap_count)},
                {"Time stamps", fmt::format("{} backwards, {} repeated, {} replaced",
                                            timing.backwards, timing.repeated, timing.mended)}};
  if (timing.rate_std_hz)
    table.rows.push_back(
        {"Standard deviation of the rate", compact(*timing.rate_std_hz, 2) + " Hz"});
  if (timing.lost)
    table.rows.push_back({"Rows lost, by the packet counter", std::to_string(*timing.lost)});
  return table;
}

std::vector<Table> labels_tables(const Recording& recording) {
  Table table{"Labels in column " + recording.label_channel, {"Name", "Runs", "Samples"}, {}};
  table.long_list = true;
  for (const LabelUse& use : label_uses(recording))
    table.rows.push_back({use.name, std::to_string(use.runs), std::to_string(use.samples)});
  if (table.rows.empty()) return {};
  return {std::move(table)};
}

Section file_section(const InspectedFile& file) {
  Section section{.heading = file_name(file.name),
                  .paragraphs = {format_words(file.audit)},
                  .tables = {channels_table(file.audit), timing_table(file.audit.timing)},
                  .figures = inspect_plots(file),
                  .on_terminal = true};
  for (Table& table : labels_tables(file.recording)) section.tables.push_back(std::move(table));
  return section;
}

Section method_section() {
  return {.heading = "How it was determined",
          .paragraphs = {
              "Mean, standard deviation and range are over the plausible values. The LSB is the "
              "step of which all differences between consecutive values are multiples. A sample is "
              "clipped if it is one of three or more consecutive ones at the lowest or highest "
              "value. A gap is a step longer than 1.5 nominal ones."}};
}

}  // namespace

const char* time_source_name(TimeSource source) {
  switch (source) {
    case TimeSource::stamps:
      return "stamps";
    case TimeSource::counter:
      return "counter";
    case TimeSource::given_rate:
      return "given_rate";
    case TimeSource::none:
      break;
  }
  return "none";
}

Document describe(const std::vector<InspectedFile>& files) {
  Document document{.page = {.verb = "inspect", .title = {}, .inputs = {}, .conclusion = {}},
                    .fields = inspect_fields(files),
                    .notes_in_text = true};
  Page& page = document.page;
  std::vector<std::string> verdicts;
  for (const InspectedFile& file : files) {
    const std::string name = file_name(file.name);
    page.inputs.push_back(file.name);
    verdicts.push_back(name + ": " + verdict(file.audit));
    for (const Note& note : file.audit.notes)
      page.notes.push_back(note.at(files.size() > 1 ? name : ""));
    page.sections.push_back(file_section(file));
  }
  page.title = file_names(page.inputs);
  page.conclusion = fmt::to_string(fmt::join(verdicts, "\n"));
  page.sections.push_back(method_section());
  return document;
}

}  // namespace proofmass::report
