#include "proofmass/report/drift/figures.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/drift/wording.hpp"
#include "proofmass/report/noise/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftAnalysis;
using characterise::DriftCurve;
using characterise::DriftFit;
using characterise::DriftShape;
using signal::WhitenessTest;

std::string axis_label(const std::string& what, const ShownUnit& shown) {
  return shown.symbol.empty() ? what : what + " (" + shown.symbol + ")";
}

// Alternates minimum and maximum, like a plot of all samples.
Curve zigzag(const characterise::Envelope& envelope, double per_si) {
  Curve curve{.label = "", .x = {}, .y = {}, .ink = Ink::grey, .mark = Mark::thin};
  for (std::size_t k = 0; k < envelope.t_s.size(); ++k) {
    curve.x.insert(curve.x.end(), 2, envelope.t_s[k]);
    curve.y.push_back(envelope.lower[k] * per_si);
    curve.y.push_back(envelope.upper[k] * per_si);
  }
  return curve;
}

double largest(const characterise::Envelope& envelope) {
  double size = 0.0;
  for (std::size_t k = 0; k < envelope.t_s.size(); ++k) {
    for (const double value : {envelope.lower[k], envelope.upper[k]}) {
      if (std::isfinite(value)) size = std::max(size, std::abs(value));
    }
  }
  return size;
}

// Limits of an axis symmetric about zero that leave room for three ticks.
void about_zero(double reach, Figure& figure) {
  if (!(reach > 0.0) || !std::isfinite(reach)) return;
  const double decade = std::pow(10.0, std::floor(std::log10(reach)));
  const bool between_ticks = reach > 3.9 * decade && reach < 5.05 * decade;
  figure.y.max = between_ticks ? 5.05 * decade : 1.02 * reach;
  figure.y.min = -*figure.y.max;
}

// Evenly spaced times, and both sides of each step.
std::vector<double> curve_times(const DriftCurve& curve, double from_s, double to_s) {
  constexpr std::size_t count = 400;
  std::vector<double> times_s;
  for (std::size_t k = 0; k <= count; ++k) {
    times_s.push_back(from_s + (to_s - from_s) * static_cast<double>(k) / count);
  }
  for (const characterise::DriftStep& step : curve.steps) {
    times_s.push_back(std::nextafter(step.t_s, from_s));
    times_s.push_back(step.t_s);
  }
  std::ranges::sort(times_s);
  return times_s;
}

std::string curve_words(const DriftFit& fit) {
  if (fit.identified) return "fit, " + shape_words(fit.curve.shape);
  switch (fit.curve.shape) {
    case DriftShape::steps:
      return "steps; no exponential is identified";
    case DriftShape::line:
      return "straight line; no exponential is identified";
    case DriftShape::square_root:
    case DriftShape::logarithm:
    case DriftShape::hyperbola:
    case DriftShape::stretched_exponential:
    case DriftShape::sine:
    case DriftShape::exponential:
    case DriftShape::exponential_and_line:
    case DriftShape::two_exponentials:
      return shape_words(fit.curve.shape) + ", one of the shapes that fit";
    default:
      return "level; no exponential is identified";
  }
}

void add_fit(const DriftAnalysis& analysis, double per_si, Figure& figure) {
  const DriftFit& fit = analysis.fit;
  Curve curve{.label = curve_words(fit),
              .x = curve_times(fit.curve, analysis.start_s, analysis.start_s + analysis.duration_s),
              .y = {},
              .ink = Ink::orange,
              .mark = fit.identified ? Mark::line : Mark::dashes};
  Band band{.label = "95 % band of the curve, without slow noise",
            .x = curve.x,
            .lower = {},
            .upper = {},
            .ink = Ink::orange};
  for (const double t_s : curve.x) {
    const double value = fit.curve.value(t_s), reach = normal_95 * fit.curve.std(t_s);
    curve.y.push_back(value * per_si);
    band.lower.push_back((value - reach) * per_si);
    band.upper.push_back((value + reach) * per_si);
  }
  figure.bands.push_back(std::move(band));
  figure.curves.push_back(std::move(curve));
}

// From the end of the recording to the time of the forecast, including the slow noise in between.
void add_forecast(const ChannelDrift& channel, double per_si, Figure& figure) {
  if (!channel.outlook || !channel.outlook->forecast) return;
  constexpr int count = 60;
  const DriftFit& fit = channel.analysis->fit;
  const double until_s = channel.outlook->forecast->t_s;
  Curve curve{.label = "forecast", .x = {}, .y = {}, .ink = Ink::purple, .mark = Mark::dashes};
  Band band{.label = "its 95 % band", .x = {}, .lower = {}, .upper = {}, .ink = Ink::purple};
  for (int k = 0; k <= count; ++k) {
    const double t_s = fit.end.t_s + (until_s - fit.end.t_s) * k / count;
    const auto later = characterise::forecast(fit, t_s);
    if (!later) break;
    curve.x.push_back(t_s);
    curve.y.push_back(later->bias.value * per_si);
    band.lower.push_back(later->bias.lower_95.value_or(gap) * per_si);
    band.upper.push_back(later->bias.upper_95.value_or(gap) * per_si);
  }
  band.x = curve.x;
  figure.bands.push_back(std::move(band));
  figure.curves.push_back(std::move(curve));
}

Curve profile_curve(const DriftFit& fit) {
  std::vector<characterise::ProfilePoint> points = fit.profile;
  points.push_back({fit.best_time_constant_s, 0.0});
  std::ranges::sort(points, {}, &characterise::ProfilePoint::time_constant_s);
  Curve curve{.label = "2 ln (best likelihood / likelihood)", .x = {}, .y = {}};
  for (const characterise::ProfilePoint& point : points) {
    if (!(point.time_constant_s > 0.0) || !std::isfinite(point.deviance)) continue;
    curve.x.push_back(point.time_constant_s);
    curve.y.push_back(point.deviance);
  }
  return curve;
}

// Limits the x axis to the part of the curve below `top`, with a margin.
void show_within(const Curve& curve, double top, Figure& figure) {
  constexpr double room = 1.5;
  const auto low = [&](double y) { return y <= top; };
  const auto first = std::ranges::find_if(curve.y, low);
  if (first == curve.y.end()) return;
  const auto last = std::find_if(curve.y.rbegin(), curve.y.rend(), low);
  const double from_s = curve.x[static_cast<std::size_t>(first - curve.y.begin())];
  const double to_s = curve.x[static_cast<std::size_t>(curve.y.rend() - last) - 1];
  figure.x.min = std::max(curve.x.front(), from_s / room);
  figure.x.max = std::min(curve.x.back(), to_s * room);
}

std::string lags_words(const WhitenessTest& test) {
  return fmt::format(
      "{} lags of {}, {} % of them inside the bounds (95 % if white). Ljung–Box p {}, cumulative "
      "periodogram p {}, runs p {}: {}.",
      grouped(test.lags), duration_words(test.scale_s), fixed(100.0 * test.inside_bounds, 0),
      p_words(test.ljung_box_p), p_words(test.periodogram_p), p_words(test.runs_p),
      test.white ? "white" : "not white");
}

}  // namespace

Figure drift_figure(const ChannelDrift& channel, const std::string& label) {
  const DriftAnalysis& analysis = *channel.analysis;
  const ShownUnit shown = bias_unit(channel.unit, largest(analysis.data));
  const std::string means = "means over " + duration_words(analysis.block_s);
  Figure figure{
      .title = label + ": bias since power-on",
      .description = analysis.fit.identified
                         ? "The curve is fitted to " + means + ", jointly with the noise model."
                         : "No time constant is identified: the dashed curve is the best of the "
                           "shapes without one.",
      .x = {.label = "Time since power-on (s)"},
      .y = {.label = axis_label("Bias", shown)},
      .height = 340.0};
  Curve bias{.label = means, .x = {}, .y = {}, .ink = Ink::grey, .mark = Mark::thin};
  for (std::size_t k = 0; k < analysis.block_mean.size(); ++k) {
    bias.x.push_back(analysis.block_time_s(k));
    bias.y.push_back(analysis.block_mean[k] * shown.per_si);
  }
  Curve slow_noise{
      .label = "with slow noise, white noise removed", .x = bias.x, .y = {}, .ink = Ink::blue};
  for (const double value : analysis.block_bias) slow_noise.y.push_back(value * shown.per_si);
  figure.curves.push_back(std::move(bias));
  figure.curves.push_back(std::move(slow_noise));
  add_fit(analysis, shown.per_si, figure);
  add_forecast(channel, shown.per_si, figure);
  return figure;
}

Figure samples_figure(const ChannelDrift& channel, const std::string& label) {
  const DriftAnalysis& analysis = *channel.analysis;
  const ShownUnit shown = bias_unit(channel.unit, largest(analysis.data));
  Figure figure{.title = label + ": samples",
                .description = "Least and greatest in each interval, and the same curve.",
                .x = {.label = "Time since power-on (s)"},
                .y = {.label = axis_label("Output", shown)}};
  figure.curves.push_back(zigzag(analysis.data, shown.per_si));
  figure.curves.back().label = "samples";
  add_fit(analysis, shown.per_si, figure);
  return figure;
}

Figure residual_figure(const ChannelDrift& channel, std::size_t scale, const std::string& label) {
  const characterise::Envelope& envelope = channel.analysis->residuals[scale];
  const ShownUnit shown = bias_unit(channel.unit, largest(envelope));
  const bool samples = envelope.scale_s < 1.5 / channel.analysis->rate_hz;
  Curve curve = zigzag(envelope, shown.per_si);
  curve.ink = Ink::blue;
  Figure figure{.title = samples ? label + ": residuals, each sample"
                                 : fmt::format("{}: residuals, means over {}", label,
                                               duration_words(envelope.scale_s)),
                .description = "Samples less the curve: the residuals should show no structure.",
                .x = {.label = "Time since power-on (s)"},
                .y = {.label = axis_label("Residual", shown)},
                .curves = {std::move(curve)},
                .levels = {{"", 0.0}},
                .height = 195.0};
  about_zero(largest(envelope) * shown.per_si, figure);
  return figure;
}

Figure autocorrelation_figure(const WhitenessTest& test, const std::string& label) {
  constexpr std::size_t most_stems = 300;
  const bool stems = test.autocorrelation.size() <= most_stems;
  Curve curve{.label = "autocorrelation", .x = {}, .y = {}, .ink = Ink::blue, .mark = Mark::line};
  for (std::size_t k = 0; k < test.autocorrelation.size(); ++k) {
    const double lag_s = static_cast<double>(k + 1) * test.scale_s;
    curve.x.push_back(lag_s);
    curve.y.push_back(test.autocorrelation[k]);
    if (!stems) continue;
    curve.x.insert(curve.x.end(), 2, lag_s);
    curve.y.insert(curve.y.end(), {0.0, gap});
  }
  const double last_s = static_cast<double>(test.lags) * test.scale_s;
  Figure figure{.title = fmt::format("{}: autocorrelation of the residuals at {}", label,
                                     duration_words(test.scale_s)),
                .description = lags_words(test),
                .x = {.label = "Lag (s)", .min = 0.0, .max = last_s + test.scale_s},
                .y = {.label = "Autocorrelation"},
                .bands = {{.label = "±1.96/√n: 95 % of lags if white",
                           .x = {0.0, last_s + test.scale_s},
                           .lower = {-test.bound, -test.bound},
                           .upper = {test.bound, test.bound},
                           .ink = Ink::green}},
                .curves = {std::move(curve)},
                .levels = {{"", 0.0}},
                .height = 195.0};
  double reach = test.bound;
  for (const double r : test.autocorrelation) reach = std::max(reach, std::abs(r));
  about_zero(reach, figure);
  return figure;
}

Figure profile_figure(const ChannelDrift& channel, const std::string& label) {
  constexpr double bound = 3.84, least_height = 6.0, most_height = 16.0;
  const DriftFit& fit = channel.analysis->fit;
  Curve curve = profile_curve(fit);
  const double highest = curve.y.empty() ? 0.0 : *std::ranges::max_element(curve.y);
  const double top = std::clamp(1.1 * highest, least_height, most_height);
  Figure figure{
      .title = label + ": profile likelihood of the time constant",
      .description = fit.identified
                         ? "All else is refitted for each time constant. Values below the dotted "
                           "line are inside the 95 % interval."
                         : "All else is refitted for each time constant. None is identified: " +
                               drift_verdict(channel) + ".",
      .x = {.label = "Time constant T (s)", .scale = AxisScale::log},
      .y = {.label = "Deviance", .min = 0.0, .max = top},
      .levels = {{"3.84: 95 % interval", bound}},
      .height = 220.0};
  if (fit.time_constant_s && !curve.x.empty()) {
    const double lower_s = fit.time_constant_s->lower_95.value_or(curve.x.front());
    const double upper_s = fit.time_constant_s->upper_95.value_or(curve.x.back());
    figure.bands.push_back({.label = "95 % interval " + time_interval_words(*fit.time_constant_s),
                            .x = {lower_s, upper_s},
                            .lower = {0.0, 0.0},
                            .upper = {top, top},
                            .ink = Ink::orange});
  }
  show_within(curve, top, figure);
  figure.curves.push_back(std::move(curve));
  figure.callouts.push_back(
      {.text = fmt::format("{}T = {} s", fit.identified ? "" : "not identified; best ",
                           compact(fit.best_time_constant_s, 4)),
       .x = fit.best_time_constant_s,
       .y = 0.0,
       .ink = Ink::orange});
  return figure;
}

}  // namespace proofmass::report
