#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/statistics.hpp"
#include "proofmass/report/inspect_report.hpp"
#include "proofmass/report/page/thinning.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

constexpr std::array inks{Ink::blue, Ink::orange, Ink::green};

std::vector<double> times_of(const Recording& recording) {
  std::vector<double> time_s(recording.samples());
  for (std::size_t k = 0; k < time_s.size(); ++k) time_s[k] = recording.time.at(k);
  return time_s;
}

std::string description(std::size_t overview_span) {
  if (overview_span == 0) return "As recorded; every spike is kept.";
  return fmt::format("Minimum and maximum of every {} samples.", overview_span);
}

// Channels first … first + count - 1 of the recording, which have the same unit.
Figure channels_figure(const InspectedFile& file, std::size_t first, std::size_t count) {
  const Recording& recording = file.recording;
  const bool timed = recording.time.rate_hz > 0.0 || !recording.time.is_uniform();
  const std::string& unit = recording.channels[first].unit.symbol;
  Figure figure{.title = {},
                .description = description(file.overview_span),
                .x = {.label = timed ? "Time (s)" : "Sample"},
                .y = {.label = unit.empty() ? "unit unknown" : print_unit(unit)},
                .height = 200.0};
  const std::vector<double> time_s = times_of(recording);
  for (std::size_t k = 0; k < count; ++k) {
    const Channel& channel = recording.channels[first + k];
    figure.title += (k == 0 ? "" : ", ") + channel.name;
    // An absurd value would compress the rest; the table counts such values.
    std::vector<double> values = channel.values.copy();
    for (double& value : values)
      if (std::abs(value) > signal::absurd_magnitude) value = std::nan("");
    Polyline line = thinned(time_s, values);
    figure.curves.push_back({channel.name, std::move(line.x), std::move(line.y), inks[k]});
  }
  return figure;
}

// The longest 0.1 % of the steps are pooled in the last bar, unless all others are equal.
Figure steps_figure(const Recording& recording) {
  const std::vector<double>& stamps = recording.time.stamps_s;
  std::vector<double> steps_ms;
  for (std::size_t k = 1; k < stamps.size(); ++k)
    steps_ms.push_back((stamps[k] - stamps[k - 1]) * 1e3);
  const double low = quantile(steps_ms, 0.0).value_or(0.0);
  double high = quantile(steps_ms, 0.999).value_or(0.0);
  if (!(high > low)) high = quantile(steps_ms, 1.0).value_or(0.0);
  constexpr std::size_t bins = 120;
  const double width = (high - low) / static_cast<double>(bins - 1);
  std::vector<double> count(bins, 0.0);
  for (const double step : steps_ms) {
    const double bin = std::floor((step - low) / width + 0.5);
    count[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins - 1)))] += 1.0;
  }
  Band bars{.label = {}, .x = {}, .lower = {}, .upper = {}};
  for (std::size_t b = 0; b < bins; ++b) {
    const double middle = low + width * static_cast<double>(b);
    for (const double edge : {middle - 0.5 * width, middle + 0.5 * width}) {
      bars.x.push_back(edge);
      bars.lower.push_back(0.5);
      bars.upper.push_back(std::max(0.5, count[b]));
    }
  }
  return {.title = "Steps between time stamps",
          .description = "How often each step occurs; the longest 0.1 % are in the last bar.",
          .x = {.label = "Step (ms)"},
          .y = {.label = "Count", .scale = AxisScale::log, .min = 0.5},
          .bands = {std::move(bars)},
          .height = 200.0};
}

bool has_uneven_steps(const std::vector<double>& stamps_s) {
  for (std::size_t k = 2; k < stamps_s.size(); ++k)
    if (stamps_s[k] - stamps_s[k - 1] != stamps_s[1] - stamps_s[0]) return true;
  return false;
}

}  // namespace

std::vector<Plot> inspect_plots(const InspectedFile& file) {
  const std::vector<Channel>& channels = file.recording.channels;
  std::vector<Plot> plots;
  for (std::size_t first = 0, count = 0; first < channels.size(); first += count) {
    count = 1;
    while (count < inks.size() && first + count < channels.size() &&
           channels[first + count].unit == channels[first].unit)
      ++count;
    plots.emplace_back([file, first, count] { return channels_figure(file, first, count); });
  }
  if (file.overview_span == 0 && has_uneven_steps(file.recording.time.stamps_s))
    plots.emplace_back([file] { return steps_figure(file.recording); });
  return plots;
}

}  // namespace proofmass::report
