#include "proofmass/report/inspect_report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/json.hpp"
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

Value optional(const std::optional<double>& figure) {
  return figure ? Value(*figure) : Value();
}

// A statistic of a channel, null where the channel has no value at all.
Value of_any(const Moments& moments, double figure) {
  return moments.count > 0 ? Value(figure) : Value();
}

Value channel_value(const ChannelAudit& channel) {
  const Moments& moments = channel.moments;
  return Object{{"name", channel.name},
                {"unit", channel.unit.symbol.empty() ? Value() : Value(channel.unit.symbol)},
                {"quantity", name_of(channel.unit.quantity)},
                {"mean", of_any(moments, moments.mean)},
                {"std", of_any(moments, moments.std())},
                {"min", of_any(moments, moments.min)},
                {"max", of_any(moments, moments.max)},
                {"lsb", optional(channel.lsb)},
                {"nonfinite", channel.nonfinite},
                {"clipping", word(channel.clipping)},
                {"clipped", channel.clipped},
                {"limit_low", optional(channel.limit_low)},
                {"limit_high", optional(channel.limit_high)},
                {"absurd", channel.absurd},
                {"denormal", channel.denormal},
                {"longest_stuck", channel.longest_stuck},
                {"longest_stuck_start_s", channel.longest_stuck_start_s}};
}

Value timing_value(const TimingAudit& timing) {
  Array gaps;
  for (const signal::Gap& gap : timing.gaps) {
    gaps.push_back(Object{{"start_s", gap.start_s}, {"duration_s", gap.duration_s}});
  }
  return Object{{"source", time_source_name(timing.source)},
                {"channel", timing.channel.empty() ? Value() : Value(timing.channel)},
                {"rate_long_run_hz", optional(timing.long_run_hz)},
                {"jitter_s", optional(timing.jitter_s)},
                {"gaps", std::move(gaps)},
                {"gap_count", timing.gap_count},
                {"backwards", timing.backwards},
                {"repeated", timing.repeated},
                {"mended", timing.mended},
                {"lost", timing.lost ? Value(std::uint64_t{*timing.lost}) : Value()}};
}

bool has_rate(const RecordingAudit& audit) {
  return audit.timing.rate_hz > 0.0;
}

Array labels_value(const Recording& recording) {
  Array labels;
  for (const LabelUse& use : label_uses(recording))
    labels.push_back(Object{{"channel", recording.label_channel},
                            {"name", use.name},
                            {"runs", use.runs},
                            {"samples", use.samples}});
  return labels;
}

Object file_members(const InspectedFile& file) {
  const RecordingAudit& audit = file.audit;
  Array channels;
  for (const ChannelAudit& channel : audit.channels) channels.push_back(channel_value(channel));
  return {{"format", audit.format},
          {"samples", audit.samples},
          {"duration_s", has_rate(audit) ? Value(audit.duration_s) : Value()},
          {"rate_hz", has_rate(audit) ? Value(audit.timing.rate_hz) : Value()},
          {"rate_std_hz", optional(audit.timing.rate_std_hz)},
          {"channels", std::move(channels)},
          {"labels", labels_value(file.recording)},
          {"timing", timing_value(audit.timing)},
          {"zero_rows", audit.zero_row_count},
          {"bad", audit.is_bad()},
          {"notes", array_of(texts(audit.notes, Severity::info))}};
}

// Why the nulls of a file are null.
std::vector<std::string> reasons(const RecordingAudit& audit) {
  std::vector<std::string> all;
  if (!has_rate(audit)) {
    all.emplace_back("rate_hz, duration_s: null: no time column and no --rate");
  }
  if (!audit.timing.rate_std_hz)
    all.emplace_back(audit.timing.source == TimeSource::stamps
                         ? "rate_std_hz: null: the stamps are even to the last digit, or too few"
                         : "rate_std_hz: null: without stamps there is none");
  if (!audit.timing.long_run_hz) {
    all.emplace_back("timing.rate_long_run_hz: null: without stamps there is none");
  }
  if (!audit.timing.jitter_s) {
    all.emplace_back("timing.jitter_s: null: too few stamps to judge the steps between them");
  }
  if (audit.timing.channel.empty()) all.emplace_back("timing.channel: null: no time column");
  if (!audit.timing.lost) all.emplace_back("timing.lost: null: no packet counter");
  for (const ChannelAudit& channel : audit.channels) {
    if (channel.unit.symbol.empty()) {
      all.push_back(channel.name + ": unit: null: neither the file nor --unit says");
    }
    if (channel.moments.count == 0) {
      all.push_back(channel.name + ": mean, std, min, max: null: no plausible value");
    }
    if (!channel.limit_low || !channel.limit_high)
      all.push_back(channel.name +
                    ": limit_low, limit_high: null: no limit of the range is seen on " +
                    (channel.limit_low    ? "the upper side"
                     : channel.limit_high ? "the lower side"
                                          : "either side"));
    if (!channel.lsb) all.push_back(channel.name + ": lsb: null: no step that the values share");
  }
  return all;
}

// "part: 3 names in 9 runs: x_a, x_p, x_rot"
std::string labels_line(const Recording& recording) {
  const std::vector<LabelUse> uses = label_uses(recording);
  if (uses.empty()) return {};
  constexpr std::size_t most = 12;
  std::string line =
      fmt::format("  labels in {}, {} in {}: ", recording.label_channel,
                  count_words(uses.size(), "name"), count_words(recording.labels.size(), "run"));
  for (std::size_t k = 0; k < std::min(uses.size(), most); ++k)
    line += (k == 0 ? "" : ", ") + uses[k].name;
  return line + (uses.size() > most ? ", …\n" : "\n");
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

std::string inspect_json(const std::vector<InspectedFile>& files) {
  DocumentHead head{"inspect", {}, {}};
  Array all;
  for (const InspectedFile& file : files) {
    head.input.push_back(file.name);
    std::vector<std::string> warnings = texts(file.audit.notes, Severity::warning);
    for (std::string& reason : reasons(file.audit)) warnings.push_back(std::move(reason));
    for (const std::string& text : warnings) {
      head.warnings.push_back(files.size() > 1 ? file.name + ": " + text : text);
    }
    Object members{{"file", file.name}};
    for (Member& member : file_members(file)) members.push_back(std::move(member));
    all.emplace_back(std::move(members));
  }
  Object body = files.empty() ? Object{} : file_members(files.front());
  if (files.size() > 1) body.push_back({"files", std::move(all)});
  return to_json(head, body);
}

/// The nominal rate; and that of the long run where the two differ by more than 0.1 %.
std::string rate_words(const TimingAudit& timing) {
  if (!(timing.rate_hz > 0.0)) return "unknown";
  const std::string nominal = compact(timing.rate_hz, 7) + " Hz";
  const double long_run_hz = timing.long_run_hz.value_or(timing.rate_hz);
  if (std::abs(long_run_hz / timing.rate_hz - 1.0) <= 1e-3) return nominal;
  return fmt::format("{} by the usual step, {} Hz in the long run", nominal,
                     compact(long_run_hz, 7));
}

std::string jitter_words(const TimingAudit& timing) {
  if (!timing.jitter_s) return "unknown";
  constexpr double rounding_s = 1e-9;
  return *timing.jitter_s < rounding_s ? "none" : compact(*timing.jitter_s * 1e3, 3) + " ms";
}

std::string inspect_conclusion(const InspectedFile& file) {
  const RecordingAudit& audit = file.audit;
  const std::string size = has_rate(audit)
                               ? fmt::format("{} Hz for {}", compact(audit.timing.rate_hz, 4),
                                             duration_words(audit.duration_s))
                               : count_words(audit.samples, "sample") + " at an unknown rate";
  const auto bad = texts(audit.notes, Severity::bad).size();
  const auto warnings = texts(audit.notes, Severity::warning).size() - bad;
  std::string verdict = "nothing wrong with it";
  if (warnings > 0) verdict = count_words(warnings, "thing") + " to know";
  if (bad > 0) verdict = count_words(bad, "fault") + " in the data";
  return fmt::format("{}, {}: {}.", size, count_words(audit.channels.size(), "channel"), verdict);
}

std::string inspect_text(const InspectedFile& file) {
  const RecordingAudit& audit = file.audit;
  std::string text = fmt::format("{}: {}\n\n", file.name, inspect_conclusion(file));
  const TimingAudit& timing = audit.timing;
  text += aligned({{"format", audit.format},
                   {"samples", std::to_string(audit.samples)},
                   {"time", fmt::format("{}{}", time_source_name(timing.source),
                                        timing.channel.empty() ? "" : " (" + timing.channel + ")")},
                   {"rate", rate_words(timing)},
                   {"jitter", jitter_words(timing)},
                   {"gaps", std::to_string(timing.gap_count)},
                   {"stamps", fmt::format("{} backwards, {} repeated, {} mended", timing.backwards,
                                          timing.repeated, timing.mended)}});
  std::vector<std::vector<std::string>> rows{
      {"channel", "unit", "mean", "std", "min", "max", "lsb", "nonfinite", "clipped"}};
  for (const ChannelAudit& channel : audit.channels) {
    const Moments& moments = channel.moments;
    const auto cell = [&](double x) { return moments.count > 0 ? significant(x, 5) : "none"; };
    rows.push_back({channel.name, channel.unit.symbol.empty() ? "?" : channel.unit.symbol,
                    cell(moments.mean), cell(moments.std()), cell(moments.min), cell(moments.max),
                    channel.lsb ? significant(*channel.lsb, 4) : "-",
                    std::to_string(channel.nonfinite), std::to_string(channel.clipped)});
  }
  text += '\n' + aligned(rows);
  if (const std::string labels = labels_line(file.recording); !labels.empty())
    text += '\n' + labels;
  if (!audit.notes.empty()) text += '\n';
  for (const Note& note : audit.notes) {
    constexpr const char* marks[] = {"note", "warning", "BAD"};
    text += fmt::format("  {}: {}\n", marks[static_cast<int>(note.severity)], note.text);
  }
  return text;
}

}  // namespace proofmass::report
