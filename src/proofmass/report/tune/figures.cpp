#include "proofmass/report/tune/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/tune/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

constexpr double two_sided_95 = 1.959964;  // of the normal distribution
constexpr std::array inks{Ink::blue, Ink::orange, Ink::green, Ink::purple, Ink::red, Ink::grey};

}  // namespace

Figure innovations_figure(const TuneReport& report, std::size_t channel) {
  const estimate::TunedSeries& series = report.tuning.series[channel];
  Figure figure{.title = report.channels[channel].name + ": innovations",
                .description =
                    "Each measurement minus its prediction, in predicted standard "
                    "deviations: 95 in 100 are between the lines if the noise parameters "
                    "are correct.",
                .x = {.label = "Time (s)"},
                .y = {.label = "Innovation (standard deviations)"}};
  Curve curve{"innovation", series.time_s, series.innovation, Ink::blue, Mark::thin};
  for (std::size_t k = 0; k < curve.y.size(); ++k) curve.y[k] /= std::sqrt(series.variance[k]);
  figure.curves.push_back(std::move(curve));
  figure.levels = {{"+1.96", two_sided_95}, {"−1.96", -two_sided_95}};
  return figure;
}

bool has_whiteness(const TuneReport& report, std::size_t channel) {
  return channel < report.consistency.whiteness.size() &&
         !report.consistency.whiteness[channel].empty();
}

Figure autocorrelation_figure(const TuneReport& report, std::size_t channel) {
  const signal::WhitenessTest& test = report.consistency.whiteness[channel].front();
  Figure figure{.title = report.channels[channel].name + ": autocorrelation of the innovations",
                .description = fmt::format(
                    "Autocorrelation; for white innovations 95 in 100 values are between the "
                    "lines: here {} in 100.",
                    std::lround(100.0 * test.inside_bounds)),
                .x = {.label = "Lag (s)"},
                .y = {.label = "Autocorrelation"},
                .height = 220.0};
  Curve curve{"autocorrelation", {}, test.autocorrelation, Ink::blue, Mark::thin};
  for (std::size_t k = 0; k < test.autocorrelation.size(); ++k) {
    curve.x.push_back(static_cast<double>(k + 1) * test.scale_s);
  }
  figure.curves.push_back(std::move(curve));
  figure.levels = {{"", test.bound}, {"", -test.bound}};
  return figure;
}

Figure gain_figure(const estimate::TuneStudy& study) {
  Figure figure{.title = study.channel + ": gain against time",
                .description =
                    "Fraction of an innovation that the filter attributes to the "
                    "acceleration: it falls from one to a limit that depends on Q/R alone, "
                    "the sooner the larger Q is. A dot marks where it stays within 2 %.",
                .x = {.label = "Time (s)", .scale = AxisScale::log},
                .y = {.label = "Gain of acceleration", .min = 0.0, .max = 1.05}};
  for (std::size_t k = 0; k < study.cases.size(); ++k) {
    const estimate::GainCase& one = study.cases[k];
    Curve curve{case_words(one), {}, {}, inks[k % inks.size()]};
    for (const estimate::GainEpoch& epoch : one.study.epochs) {
      if (epoch.t_s <= 0.0) continue;
      curve.x.push_back(epoch.t_s);
      curve.y.push_back(epoch.gain[2]);
    }
    figure.curves.push_back(std::move(curve));
    if (const auto settled = one.study.settling_s[2]; settled && *settled > 0.0) {
      figure.callouts.push_back(
          {compact(*settled, 3) + " s", *settled, one.study.limit[2], inks[k % inks.size()]});
    }
  }
  return figure;
}

Figure covariance_figure(const estimate::TuneStudy& study) {
  constexpr std::array names{"position (m)", "velocity (m/s)", "acceleration (m/s²)"};
  Figure figure{.title = study.channel + ": standard deviations against time, as tuned",
                .description =
                    "With measurements of acceleration only, that of the acceleration "
                    "settles, and those of velocity and position grow without bound.",
                .x = {.label = "Time (s)", .scale = AxisScale::log},
                .y = {.label = "Standard deviation", .scale = AxisScale::log}};
  if (study.cases.empty()) return figure;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Curve curve{names[i], {}, {}, inks[i]};
    for (const estimate::GainEpoch& epoch : study.cases.front().study.epochs) {
      if (epoch.t_s <= 0.0) continue;
      curve.x.push_back(epoch.t_s);
      curve.y.push_back(std::sqrt(epoch.variance[i]));
    }
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

Figure step_figure(const estimate::TuneStudy& study) {
  Figure figure{.title = study.channel + ": standard deviation against the step",
                .description =
                    "Acceleration, once the gain has settled: less frequent measurements "
                    "of equal noise determine it less precisely.",
                .x = {.label = "Step (s)", .scale = AxisScale::log},
                .y = {.label = "Standard deviation of acceleration", .scale = AxisScale::log},
                .height = 240.0};
  Curve after{"after a measurement", {}, {}, Ink::blue}, before{"before it", {}, {}, Ink::orange};
  for (const estimate::StepSizeEffect& step : study.steps) {
    after.x.push_back(step.step_s);
    after.y.push_back(step.accel_std_mps2);
    before.x.push_back(step.step_s);
    before.y.push_back(step.predicted_std_mps2);
  }
  figure.curves = {std::move(after), std::move(before)};
  return figure;
}

}  // namespace proofmass::report
