#include "proofmass/report/drift/wording.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/noise/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftFit;
using characterise::DriftReason;
using characterise::DriftShape;
using characterise::Interval95;

// Decimals that give an interval's width two significant digits.
int decimals_of(double width) {
  if (!(width > 0.0) || !std::isfinite(width)) return 3;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(width))), 0, 9);
}

std::string interval_words(const Interval95& interval, double factor, const std::string& symbol) {
  const auto& [value, std, lower, upper] = interval;
  const bool both = lower && upper;
  const int decimals = decimals_of(factor * (both ? *upper - *lower : std));
  const auto end = [&](double x) { return fixed(x * factor, decimals); };
  const std::string tail = symbol.empty() ? "" : " " + symbol;
  if (both) return end(*lower) + " … " + end(*upper) + tail;
  if (lower) return "above " + end(*lower) + tail;
  if (upper) return "below " + end(*upper) + tail;
  return "not bounded";
}

double largest_step(const characterise::DriftCurve& curve) {
  double largest = 0.0;
  for (const auto& step : curve.steps) {
    if (std::abs(step.size.value) > std::abs(largest)) largest = step.size.value;
  }
  return largest;
}

std::string steps_words(const characterise::DriftCurve& curve, const Unit& unit) {
  const std::string size = bias_words(std::abs(largest_step(curve)), unit);
  return count_words(curve.steps.size(), "step") +
         (curve.steps.size() == 1 ? " of " : " of up to ") + size;
}

// "longer than 2 h", if the data bound it on one side only.
std::string one_sided_words(const DriftFit& fit) {
  if (fit.time_constant_above_s) {
    return "longer than " + duration_words(*fit.time_constant_above_s) + " (95 %)";
  }
  if (fit.time_constant_below_s) {
    return "shorter than " + duration_words(*fit.time_constant_below_s) + " (95 %)";
  }
  return "not bounded on either side";
}

std::string why_not(const DriftFit& fit, const Unit& unit) {
  switch (fit.why) {
    case DriftReason::hidden_by_noise:
      return "low-frequency noise explains the change as well as an exponential";
    case DriftReason::steps:
      return "steps rather than an exponential: " + steps_words(fit.curve, unit);
    case DriftReason::line:
      return "a straight line fits as well" +
             (fit.slope_per_s ? ", " + slope_words(*fit.slope_per_s, unit) : std::string()) +
             "; the time constant is " + one_sided_words(fit);
    case DriftReason::longer_than_record:
      return "the recording is too short for the time constant, which is " + one_sided_words(fit);
    case DriftReason::shorter_than_resolved:
      return "it ends before it can be resolved: the time constant is " + one_sided_words(fit);
    case DriftReason::begun_later:
      return "the drift began long after power-on, with a time constant of " +
             duration_words(fit.best_time_constant_s);
    case DriftReason::unexplained:
      return "the bias changes in a way that neither noise nor an exponential explains";
    case DriftReason::shape_undetermined:
    case DriftReason::oscillation:
    case DriftReason::no_warm_up:
    case DriftReason::identified:
      break;
  }
  return "noise alone explains the recording";
}

}  // namespace

std::string channel_label(const DriftReport& report, const ChannelDrift& channel) {
  const bool several = std::ranges::any_of(
      report.channels, [&](const ChannelDrift& other) { return other.file != channel.file; });
  return several ? file_name(channel.file) + ": " + channel.name : channel.name;
}

std::string level_unit(const Unit& unit) {
  return noise_unit(unit, NoiseScale::level);
}

std::string per_kelvin(const std::string& unit, std::size_t power) {
  if (power == 0) return unit;
  return unit + "/K" + (power > 1 ? "^" + std::to_string(power) : "");
}

ShownUnit bias_unit(const Unit& unit, double size) {
  const ShownUnit shown = shown_unit(unit, NoiseScale::level, size);
  const bool thousands = shown.symbol.starts_with("µ") && std::abs(size) * shown.per_si >= 1000.0;
  return thousands ? ShownUnit{shown.per_si / 1000.0, "m" + shown.symbol.substr(2)} : shown;
}

std::string bias_interval_words(const Interval95& interval, const Unit& unit) {
  const double size = interval.value != 0.0 ? interval.value : interval.std;
  const ShownUnit shown = bias_unit(unit, size);
  return interval_words(interval, shown.per_si, shown.symbol);
}

std::string time_interval_words(const Interval95& interval) {
  return interval_words(interval, 1.0, "s");
}

std::string runs_interval_words(const Interval95& interval) {
  return interval_words(interval, 1.0, "runs");
}

std::string bias_words(const Uncertain& figure, const Unit& unit) {
  if (!std::isfinite(figure.std)) return "about " + bias_words(figure.value, unit);
  const ShownUnit shown = bias_unit(unit, figure.value != 0.0 ? figure.value : figure.std);
  return with_std({figure.value * shown.per_si, figure.std * shown.per_si}, shown.symbol);
}

std::string bias_words(const Interval95& figure, const Unit& unit) {
  return bias_words(Uncertain{figure.value, figure.std}, unit);
}

std::string bias_words(double value, const Unit& unit) {
  const ShownUnit shown = bias_unit(unit, value);
  return significant(value * shown.per_si, 3) + (shown.symbol.empty() ? "" : " ") + shown.symbol;
}

std::string slope_words(const Interval95& figure, const Unit& unit) {
  // Drift is slow: displayed per hour.
  constexpr double hour_s = 3600.0;
  return bias_words(Uncertain{figure.value * hour_s, figure.std * hour_s}, unit) + "/h";
}

std::string p_words(double p) {
  constexpr double least = 1e-16;
  if (p < least) return "<1e-16";
  return significant(p, 2);
}

std::string shape_words(DriftShape shape) {
  std::string words(characterise::name_of(shape));
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string reason_code(DriftReason reason) {
  switch (reason) {
    case DriftReason::identified:
      return "identified";
    case DriftReason::hidden_by_noise:
      return "hidden_by_noise";
    case DriftReason::steps:
      return "steps";
    case DriftReason::line:
      return "line";
    case DriftReason::longer_than_record:
      return "longer_than_record";
    case DriftReason::shorter_than_resolved:
      return "shorter_than_resolved";
    case DriftReason::begun_later:
      return "begun_later";
    case DriftReason::shape_undetermined:
      return "shape_undetermined";
    case DriftReason::oscillation:
      return "swing";
    case DriftReason::unexplained:
      return "unexplained";
    case DriftReason::no_warm_up:
      break;
  }
  return "no_warm_up";
}

std::string drift_verdict(const ChannelDrift& channel) {
  if (!channel.analysis) return why_not_analysed(channel);
  const DriftFit& fit = channel.analysis->fit;
  if (fit.why == DriftReason::shape_undetermined || fit.why == DriftReason::oscillation)
    return fit.reason;
  if (!fit.identified || !fit.a1 || !fit.time_constant_s) {
    return "no warm-up identified: " + why_not(fit, channel.unit);
  }
  const Interval95& time = *fit.time_constant_s;
  std::string text =
      fmt::format("warm-up of {} with time constant {}", bias_words(*fit.a1, channel.unit),
                  with_std(Uncertain{time.value, time.std}, "s"));
  if (fit.second_a1 && fit.second_time_constant_s) {
    const Interval95& second = *fit.second_time_constant_s;
    text += fmt::format(", and of {} with {}", bias_words(*fit.second_a1, channel.unit),
                        with_std(Uncertain{second.value, second.std}, "s"));
  }
  if (fit.slope_per_s) text += ", then " + slope_words(*fit.slope_per_s, channel.unit);
  return text;
}

std::string scatter_words(const characterise::RunScatter& scatter, const Unit& unit) {
  const Interval95& between = scatter.between_std;
  if (between.value > 0.0) {
    return fmt::format("{} (95 %: {})", bias_words(between, unit),
                       bias_interval_words(between, unit));
  }
  if (!between.upper_95) return "none beyond the noise within the runs";
  return fmt::format("none beyond the noise within the runs, below {} with 95 % confidence",
                     bias_words(*between.upper_95, unit));
}

std::string level_words(const ChannelDrift& channel) {
  const bool level =
      channel.analysis && costs_position(channel.unit) && holds_gravity(channel.analysis->fit.a2);
  return level ? "Level at power-on a2" : "Bias at power-on a2";
}

bool costs_position(const Unit& unit) {
  return unit.quantity == Quantity::acceleration && unit.to_si == 1.0;
}

bool holds_gravity(const Interval95& bias_mps2) {
  constexpr double no_bias_mps2 = 0.5;  // above the bias of any accelerometer
  return std::abs(bias_mps2.value) > no_bias_mps2;
}

}  // namespace proofmass::report
