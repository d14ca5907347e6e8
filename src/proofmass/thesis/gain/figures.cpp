#include "proofmass/thesis/gain/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "proofmass/report/wording.hpp"

namespace proofmass::thesis {
namespace {

using estimate::GainStudy;
using estimate::GainStudyOptions;
using report::AxisScale;
using report::Curve;
using report::Figure;
using report::Ink;
using report::Mark;

constexpr std::array<const char*, 3> states{"position", "velocity", "acceleration"};
constexpr std::array state_inks{Ink::orange, Ink::green, Ink::blue};

std::string setting_words(const GainStudyOptions& options) {
  return fmt::format("Q = {}, R = {}", report::compact(options.jerk_psd_m2ps5, 3),
                     report::compact(options.accel_variance_m2ps4, 3));
}

Curve variance_curve(const GainStudyOptions& options, Ink ink) {
  constexpr std::size_t shown = 40;
  const GainStudy study = gain_study(options);
  Curve curve{.label = setting_words(options), .x = {}, .y = {}, .ink = ink};
  for (std::size_t k = 0; k < shown; ++k) {
    curve.x.push_back(static_cast<double>(k + 1));
    curve.y.push_back(study.epochs[k].variance[2]);
  }
  return curve;
}

Curve settling_curve(const GainStudyOptions& options, std::size_t state, Ink ink, Mark mark) {
  const GainStudy study = gain_study(options);
  Curve curve{.label = fmt::format("{}, gain of {}", setting_words(options), states[state]),
              .x = {},
              .y = {},
              .ink = ink,
              .mark = mark};
  for (int k = 0; k <= 60; ++k) {
    const double within = std::pow(10.0, -1.0 - 0.05 * k);
    const auto time_s = settling_s(study, state, within);
    if (!time_s) continue;
    curve.x.push_back(100.0 * within);
    curve.y.push_back(*time_s);
  }
  return curve;
}

}  // namespace

Figure covariance_figure(double slowest_r_m2ps4) {
  GainStudyOptions slowest = slow_filter;
  slowest.accel_variance_m2ps4 = slowest_r_m2ps4;
  return {.title = "Variance of the acceleration after each reading",
          .description = fmt::format(
              "From 100 before the first reading, in steps of 0.2 s. With the thesis's own R one "
              "reading brings it below 10; with R = {} it takes 20.",
              report::compact(slowest_r_m2ps4, 3)),
          .x = {.label = "Readings", .min = 0.0, .max = 40.0},
          .y = {.label = "Variance (m²/s⁴)", .scale = AxisScale::log},
          .curves = {variance_curve(quick_filter, Ink::blue),
                     variance_curve(slow_filter, Ink::orange), variance_curve(slowest, Ink::green)},
          .levels = {{.label = "10", .y = 10.0}}};
}

Figure step_figure() {
  std::vector<double> steps_s;
  for (int k = 0; k <= 40; ++k) steps_s.push_back(std::pow(10.0, -2.0 + 0.05 * k));
  Figure figure{.title = "What a longer step does",
                .description =
                    "Variance of the acceleration once the gain has settled, just after a "
                    "reading (lines) and just before the next (dashed). It grows with the step.",
                .x = {.label = "Step (s)", .scale = AxisScale::log},
                .y = {.label = "Variance (m²/s⁴)", .scale = AxisScale::log}};
  for (const auto& [options, ink] :
       {std::pair{quick_filter, Ink::blue}, std::pair{slow_filter, Ink::orange}}) {
    Curve after{.label = setting_words(options), .x = steps_s, .y = {}, .ink = ink};
    Curve before{.label = "", .x = steps_s, .y = {}, .ink = ink, .mark = Mark::dashes};
    for (const auto& effect : step_size_study(options, steps_s)) {
      after.y.push_back(effect.accel_std_mps2 * effect.accel_std_mps2);
      before.y.push_back(effect.predicted_std_mps2 * effect.predicted_std_mps2);
    }
    figure.curves.push_back(std::move(after));
    figure.curves.push_back(std::move(before));
  }
  return figure;
}

Figure growth_figure(const GainStudy& study) {
  Figure figure{
      .title = "What is read settles, what is not grows: " + setting_words(study.options),
      .description =
          "Variances after each reading, in m²/s⁴, m²/s² and m². The acceleration is read and "
          "settles; velocity and position never are, and grow without bound.",
      .x = {.label = "Time (s)", .scale = AxisScale::log},
      .y = {.label = "Variance (SI units)", .scale = AxisScale::log}};
  for (std::size_t i = 3; i-- > 0;) {
    Curve curve{.label = states[i], .x = {}, .y = {}, .ink = state_inks[i]};
    for (const auto& epoch : study.epochs) {
      if (!(epoch.t_s > 0.0)) continue;
      curve.x.push_back(epoch.t_s);
      curve.y.push_back(epoch.variance[i]);
    }
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

Figure readings_figure(const SimulatedReadings& readings, SimulatedAxis axis) {
  constexpr double shown_s = 30.0;
  const auto end = std::ranges::upper_bound(readings.time_s, shown_s + 1e-9);
  const auto count = end - readings.time_s.begin();
  const auto first = [count](const std::vector<double>& values) {
    return std::vector<double>(values.begin(), values.begin() + count);
  };
  const std::vector<double> t = first(readings.time_s);
  const std::string what = axis == SimulatedAxis::x ? "x: sin t" : "y: cos t";
  return {.title = "Simulated acceleration, " + what,
          .description =
              "The first 30 s of 100 s: the truth, readings with noise of variance R, the Kalman "
              "filter and the smoother that also knows what comes.",
          .x = {.label = "Time (s)", .min = 0.0, .max = shown_s},
          .y = {.label = "Acceleration (m/s²)"},
          .curves = {
              {.label = "Readings",
               .x = t,
               .y = first(readings.reading_mps2),
               .ink = Ink::grey,
               .mark = Mark::points},
              {.label = "Truth",
               .x = t,
               .y = first(readings.truth_mps2),
               .ink = Ink::green,
               .mark = Mark::dashes},
              {.label = "Kalman filter",
               .x = t,
               .y = first(readings.filtered_mps2),
               .ink = Ink::orange},
              {.label = "Smoother", .x = t, .y = first(readings.smoothed_mps2), .ink = Ink::blue}}};
}

Figure gain_figure(const GainStudy& study) {
  constexpr double shown_s = 10.0;
  Figure figure{.title = "Kalman gain, " + setting_words(study.options),
                .description =
                    "The first 10 s. A dot marks from when on a gain stays within 2 % of its "
                    "limit.",
                .x = {.label = "Time (s)", .min = 0.0, .max = shown_s},
                .y = {.label = "Gain", .min = 0.0, .max = 1.0}};
  for (std::size_t i = 3; i-- > 0;) {
    Curve curve{
        .label = fmt::format("of the {}", states[i]), .x = {}, .y = {}, .ink = state_inks[i]};
    for (const auto& epoch : study.epochs) {
      if (epoch.t_s > shown_s + 1e-9) break;
      curve.x.push_back(epoch.t_s);
      curve.y.push_back(epoch.gain[i]);
      if (study.settling_s[i] && epoch.t_s == *study.settling_s[i])
        figure.callouts.push_back({.text = report::fixed(epoch.t_s, 1) + " s",
                                   .x = epoch.t_s,
                                   .y = epoch.gain[i],
                                   .ink = state_inks[i],
                                   .below = i < 2});
    }
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

Figure tolerance_figure() {
  return {.title = "When a gain has settled depends on what is called settled",
          .description =
              "Time from which on a gain stays within so many per cent of its limit. The "
              "thesis's two and eight seconds are read off a plot.",
          .x = {.label = "Within (% of the limit)", .scale = AxisScale::log},
          .y = {.label = "Settled after (s)", .min = 0.0, .max = 10.0},
          .curves = {settling_curve(slow_filter, 0, Ink::orange, Mark::line),
                     settling_curve(slow_filter, 2, Ink::orange, Mark::dashes),
                     settling_curve(quick_filter, 0, Ink::blue, Mark::line),
                     settling_curve(quick_filter, 2, Ink::blue, Mark::dashes)},
          .levels = {{.label = "thesis, Q < R: 8 s", .y = 8.0},
                     {.label = "thesis, Q > R: 2 s", .y = 2.0}}};
}

}  // namespace proofmass::thesis
