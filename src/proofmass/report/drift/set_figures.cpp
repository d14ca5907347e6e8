#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/drift/figures.hpp"
#include "proofmass/report/drift/wording.hpp"
#include "proofmass/report/noise/wording.hpp"
#include "proofmass/report/wording.hpp"

// Figures of bias against temperature and of several runs.
namespace proofmass::report {
namespace {

using characterise::Sweep;
using characterise::TemperatureModel;

constexpr double zero_celsius_k = 273.15;

// Values with error bars: points, and the bars as one curve with gaps.
struct Bars {
  Curve dots, bars;
};

Bars bars_of(const std::string& label, Ink ink) {
  return {{.label = label, .x = {}, .y = {}, .ink = ink, .mark = Mark::points},
          {.label = "", .x = {}, .y = {}, .ink = ink, .mark = Mark::thin}};
}

void add(Bars& bars, double x, double y, double reach) {
  bars.dots.x.push_back(x);
  bars.dots.y.push_back(y);
  bars.bars.x.insert(bars.bars.x.end(), 3, x);
  bars.bars.y.insert(bars.bars.y.end(), {y - reach, y + reach, gap});
}

void add(Bars bars, Figure& figure) {
  if (bars.dots.x.empty()) return;
  figure.curves.push_back(std::move(bars.bars));
  figure.curves.push_back(std::move(bars.dots));
}

void add_points(const TemperatureModel& model, double per_si, Figure& figure) {
  const auto of = [&](Sweep sweep, const char* label, Ink ink) {
    Bars bars = bars_of(label, ink);
    for (const characterise::TemperaturePoint& point : model.points) {
      if (point.sweep != sweep) continue;
      add(bars, point.temperature_k - zero_celsius_k, point.mean * per_si, point.std * per_si);
    }
    add(std::move(bars), figure);
  };
  of(Sweep::dwell, "dwelling", Ink::grey);
  of(Sweep::heating, "heating", Ink::red);
  of(Sweep::cooling, "cooling", Ink::blue);
}

void add_curve(const TemperatureModel& model, double per_si, Figure& figure) {
  constexpr int count = 120;
  const bool identified = model.verdict == characterise::Verdict::identified;
  Curve curve{.label = identified ? fmt::format("polynomial of degree {}", model.degree)
                                  : "level; no dependence is identified",
              .x = {},
              .y = {},
              .ink = Ink::orange,
              .mark = identified ? Mark::line : Mark::dashes};
  Band band{
      .label = "95 % band of the curve", .x = {}, .lower = {}, .upper = {}, .ink = Ink::orange};
  for (int k = 0; k <= count; ++k) {
    const double at_k =
        std::min(model.lowest_k + (model.highest_k - model.lowest_k) * k / count, model.highest_k);
    const auto bias = model.at(at_k);
    if (!bias) continue;
    curve.x.push_back(at_k - zero_celsius_k);
    curve.y.push_back(bias->value * per_si);
    band.lower.push_back((bias->value - normal_95 * bias->std) * per_si);
    band.upper.push_back((bias->value + normal_95 * bias->std) * per_si);
  }
  band.x = curve.x;
  figure.bands.push_back(std::move(band));
  figure.curves.push_back(std::move(curve));
}

}  // namespace

Figure temperature_figure(const ChannelDrift& channel, const std::string& label) {
  const TemperatureModel& model = *channel.temperature->model;
  double size = 0.0;
  for (const auto& point : model.points) size = std::max(size, std::abs(point.mean));
  const ShownUnit shown = bias_unit(channel.unit, size);
  Figure figure{.title = fmt::format("{} against {}", label, channel.temperature->channel),
                .description =
                    "Means about a temperature, with their scatter; the curve is valid between the "
                    "temperatures recorded.",
                .x = {.label = "Temperature (°C)"},
                .y = {.label = shown.symbol.empty() ? "Bias" : "Bias (" + shown.symbol + ")"},
                .height = 300.0};
  const double room_k = 0.02 * (model.highest_k - model.lowest_k);
  figure.x.min = model.lowest_k - zero_celsius_k - room_k;
  figure.x.max = model.highest_k - zero_celsius_k + room_k;
  add_points(model, shown.per_si, figure);
  add_curve(model, shown.per_si, figure);
  return figure;
}

Figure levels_figure(const ChannelRuns& runs) {
  const characterise::RunSet& set = *runs.set;
  double size = 0.0;
  for (const auto& run : set.runs) size = std::max(size, std::abs(run.mean.value));
  const ShownUnit shown = bias_unit(runs.unit, size);
  Bars turn_on = bars_of("turn-on: first " + duration_words(set.window_s), Ink::orange);
  Bars mean = bars_of("mean of the run", Ink::blue);
  constexpr double aside = 0.12;  // horizontal offset, so that the two do not overlap
  for (std::size_t k = 0; k < set.runs.size(); ++k) {
    const characterise::RunLevel& run = set.runs[k];
    const double number = static_cast<double>(k) + 1.0;
    const auto reach = [&](const Uncertain& figure) {
      return normal_95 * figure.std * shown.per_si;
    };
    add(turn_on, number - aside, run.turn_on.value * shown.per_si, reach(run.turn_on));
    add(mean, number + aside, run.mean.value * shown.per_si, reach(run.mean));
  }
  Figure figure{
      .title = runs.name + ": from run to run",
      .description = "Each with the 95 % interval from the noise within its run.",
      .x = {.label = "Run", .min = 0.5, .max = static_cast<double>(set.runs.size()) + 0.5},
      .y = {.label = shown.symbol.empty() ? "Level" : "Level (" + shown.symbol + ")"},
      .levels = {{"mean of the runs", set.level.mean * shown.per_si}},
      .height = 260.0};
  add(std::move(turn_on), figure);
  add(std::move(mean), figure);
  return figure;
}

}  // namespace proofmass::report
