#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/statistics.hpp"
#include "proofmass/report/inspect_report.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/thinning.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using signal::ChannelAudit;
using signal::RecordingAudit;

std::string unit_label(const Unit& unit) {
  return unit.symbol.empty() ? "unit unknown" : print_unit(unit.symbol);
}

Table channels_table(const RecordingAudit& audit) {
  Table table{
      "Each channel, in its own unit; not finite and absurd values are left out of the rest",
      {"Channel", "Unit", "Mean", "Std", "Min", "Max", "LSB", "Not finite", "Absurd", "Clipped"},
      {}};
  for (const ChannelAudit& channel : audit.channels) {
    const Moments& moments = channel.moments;
    const auto cell = [&](double x) { return moments.count > 0 ? significant(x, 5) : "none"; };
    table.rows.push_back({channel.name, unit_label(channel.unit), cell(moments.mean),
                          cell(moments.std()), cell(moments.min), cell(moments.max),
                          channel.lsb ? significant(*channel.lsb, 4) : "none",
                          std::to_string(channel.nonfinite), std::to_string(channel.absurd),
                          std::to_string(channel.clipped)});
  }
  return table;
}

Table timing_table(const RecordingAudit& audit) {
  const signal::TimingAudit& timing = audit.timing;
  Table table{"Timing", {"Figure", "Value"}, {}};
  table.rows = {
      {"Format", audit.format},
      {"Samples", std::to_string(audit.samples)},
      {"Time column", timing.channel.empty() ? "none" : timing.channel},
      {"Rate", timing.rate_hz > 0.0 ? compact(timing.rate_hz, 7) + " Hz" : "unknown"},
      {"Standard deviation of the rate",
       timing.rate_std_hz ? compact(*timing.rate_std_hz, 2) + " Hz" : "unknown"},
      {"Jitter of the steps", jitter_words(timing)},
      {"Gaps", std::to_string(timing.gap_count)},
      {"Stamps that go backwards", std::to_string(timing.backwards)},
      {"Stamps repeated", std::to_string(timing.repeated)},
      {"Stamps mended", std::to_string(timing.mended)},
      {"Rows lost, by the counter", timing.lost ? std::to_string(*timing.lost) : "unknown"}};
  return table;
}

std::vector<Table> file_tables(const InspectedFile& file) {
  std::vector<Table> tables{channels_table(file.audit), timing_table(file.audit)};
  Table labels{"Labels, the words of column " + file.recording.label_channel,
               {"Name", "Runs", "Samples"},
               {}};
  for (const LabelUse& use : label_uses(file.recording))
    labels.rows.push_back({use.name, std::to_string(use.runs), std::to_string(use.samples)});
  if (!labels.rows.empty()) tables.push_back(std::move(labels));
  return tables;
}

std::vector<double> instants(const Recording& recording) {
  std::vector<double> time_s(recording.samples());
  for (std::size_t k = 0; k < time_s.size(); ++k) time_s[k] = recording.time.at(k);
  return time_s;
}

// Channels of one sensor or kind share a figure: same unit, up to three in the order of the file.
std::vector<Figure> channel_figures(const InspectedFile& file) {
  constexpr std::array inks{Ink::blue, Ink::orange, Ink::green};
  const Recording& recording = file.recording;
  const std::vector<double> time_s = instants(recording);
  const bool timed = recording.time.rate_hz > 0.0 || !recording.time.is_uniform();
  std::vector<Figure> figures;
  const Unit* unit = nullptr;
  for (std::size_t k = 0; k < recording.channels.size(); ++k) {
    const Channel& channel = recording.channels[k];
    if (unit == nullptr || *unit != channel.unit || figures.back().curves.size() == inks.size()) {
      unit = &channel.unit;
      figures.push_back({.title = channel.name,
                         .description = file.overview_span == 0
                                            ? "As recorded; every spike is kept."
                                            : fmt::format("The smallest and the largest of every "
                                                          "{} samples.",
                                                          file.overview_span),
                         .x = {.label = timed ? "Time (s)" : "Sample"},
                         .y = {.label = unit_label(channel.unit)},
                         .height = 200.0});
    } else {
      figures.back().title += ", " + channel.name;
    }
    // What is beyond belief would flatten the rest; the table counts it.
    std::vector<double> values = channel.values;
    for (double& value : values) {
      if (std::abs(value) > signal::absurd_magnitude) value = std::nan("");
    }
    Polyline line = thinned(time_s, values);
    figures.back().curves.push_back(
        {channel.name, std::move(line.x), std::move(line.y), inks[figures.back().curves.size()]});
  }
  return figures;
}

// How often each length of step between neighbouring stamps occurs, on a log scale so that the rare
// ones are seen.
std::vector<Figure> step_figures(const Recording& recording) {
  const std::vector<double>& stamps = recording.time.stamps_s;
  std::vector<double> steps_ms;
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    steps_ms.push_back((stamps[k] - stamps[k - 1]) * 1e3);
  }
  const auto low = quantile(steps_ms, 0.0), high = quantile(steps_ms, 0.999);
  if (!low || !high || !(*high > *low)) return {};
  constexpr std::size_t bins = 120;
  const double wide = (*high - *low) / static_cast<double>(bins - 1);
  std::vector<double> count(bins, 0.0);
  for (const double step : steps_ms) {
    const double bin = std::floor((step - *low) / wide + 0.5);
    count[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins - 1)))] += 1.0;
  }
  Band bars{.label = {}, .x = {}, .lower = {}, .upper = {}};
  for (std::size_t b = 0; b < bins; ++b) {
    const double middle = *low + wide * static_cast<double>(b);
    for (const double edge : {middle - 0.5 * wide, middle + 0.5 * wide}) {
      bars.x.push_back(edge);
      bars.lower.push_back(0.5);
      bars.upper.push_back(std::max(0.5, count[b]));
    }
  }
  return {
      Figure{.title = "Steps between stamps",
             .description = "How often each step occurs; the longest 0.1 % are in the last bar.",
             .x = {.label = "Step (ms)"},
             .y = {.label = "Count", .scale = AxisScale::log, .min = 0.5},
             .bands = {std::move(bars)},
             .height = 200.0}};
}

}  // namespace

Page inspect_page(const std::vector<InspectedFile>& files) {
  Page page{.verb = "inspect", .title = {}, .inputs = {}, .conclusion = {}};
  for (const InspectedFile& file : files) {
    page.title += (page.title.empty() ? "" : ", ") + file_name(file.name);
    page.inputs.push_back(file.name);
    page.conclusion +=
        (files.size() > 1 ? file_name(file.name) + ": " : "") + inspect_conclusion(file) + " ";
    page.notes.insert(page.notes.end(), file.audit.notes.begin(), file.audit.notes.end());
    page.sections.push_back({.heading = file_name(file.name),
                             .tables = file_tables(file),
                             .figures = plots(channel_figures(file))});
    if (file.overview_span > 0) continue;
    for (Figure& figure : step_figures(file.recording))
      page.sections.back().figures.push_back(std::move(figure));
  }
  page.sections.push_back(
      {.heading = "How it was judged",
       .paragraphs = {
           "Mean, spread and range are over the plausible values. The LSB is the step that all "
           "differences between neighbouring values are multiples of. A sample is clipped if it is "
           "one "
           "of three or more in a row at the lowest or highest value. A gap is a step longer than "
           "1.5 "
           "nominal ones."}});
  return page;
}

std::string inspect_html(const std::vector<InspectedFile>& files) {
  return html(inspect_page(files));
}

}  // namespace proofmass::report
