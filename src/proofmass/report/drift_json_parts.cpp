#include <array>
#include <string_view>

#include "proofmass/report/drift_json.hpp"
#include "proofmass/report/drift_nulls.hpp"
#include "proofmass/report/drift_wording.hpp"
#include "proofmass/report/noise_wording.hpp"

// Temperature, forecast and sets of runs in the document of `drift`.
namespace proofmass::report {
namespace {

using characterise::Interval95;
using characterise::RunScatter;
using characterise::RunSet;
using characterise::Sweep;
using characterise::TemperatureModel;

std::string_view name_of(Sweep sweep) {
  switch (sweep) {
    case Sweep::heating:
      return "heating";
    case Sweep::cooling:
      return "cooling";
    case Sweep::dwell:
      break;
  }
  return "dwell";
}

// "m/s^2/K^2"
std::string per_kelvin(const std::string& unit, std::size_t power) {
  if (power == 0) return unit;
  return unit + "/K" + (power > 1 ? "^" + std::to_string(power) : "");
}

Array coefficients(const TemperatureModel& model, const std::string& unit) {
  Array items;
  for (std::size_t j = 0; j < model.coefficients.size(); ++j) {
    items.push_back(quantity(model.coefficients[j], per_kelvin(unit, j)));
  }
  return items;
}

Array matrix(const Eigen::MatrixXd& values) {
  Array rows;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    Array row;
    for (Eigen::Index j = 0; j < values.cols(); ++j) row.emplace_back(values(i, j));
    rows.emplace_back(std::move(row));
  }
  return rows;
}

Array scores(const TemperatureModel& model) {
  Array items;
  for (const characterise::DegreeScore& score : model.cross_validation) {
    items.emplace_back(Object{{"degree", score.degree},
                              {"score", score.score},
                              {"excess", score.excess},
                              {"std", score.std}});
  }
  return items;
}

Array points(const TemperatureModel& model) {
  Array items;
  for (const characterise::TemperaturePoint& point : model.points) {
    items.emplace_back(Object{{"sweep", name_of(point.sweep)},
                              {"temperature_k", point.temperature_k},
                              {"mean", point.mean},
                              {"std", point.std},
                              {"blocks", point.blocks}});
  }
  return items;
}

Array position_errors(const Interval95& bias_mps2) {
  constexpr std::array times_s{1.0, 10.0, 60.0};
  Array items;
  for (const double t_s : times_s) {
    const Interval95 error = characterise::position_error(bias_mps2, t_s);
    const auto end = [](const std::optional<double>& x) { return x ? Value(*x) : Value(); };
    items.emplace_back(Object{{"t_s", t_s},
                              {"value", error.value},
                              {"lower", end(error.lower_95)},
                              {"upper", end(error.upper_95)}});
  }
  return items;
}

Object scatter(const RunScatter& found, const std::string& unit) {
  return {{"mean", quantity(Uncertain{found.mean, found.mean_std}, unit)},
          {"observed_std", found.observed_std},
          {"within_std", found.within_std},
          {"between_std", interval_quantity(found.between_std, unit)},
          {"interval_95", interval_value(found.between_std)},
          {"p", found.p}};
}

Array levels(const RunSet& set, const std::string& unit) {
  Array items;
  for (const characterise::RunLevel& run : set.runs) {
    items.emplace_back(Object{{"name", run.name},
                              {"turn_on", quantity(run.turn_on, unit)},
                              {"mean", quantity(run.mean, unit)},
                              {"change", quantity(run.change, unit)}});
  }
  return items;
}

// The warm-up from run to run; null of fewer runs than can show one.
Value level_curve(const ChannelRuns& runs, const std::string& unit) {
  const auto& curve = runs.set->level_curve;
  if (!curve) return nullptr;
  const characterise::DriftFit& fit = *curve;
  return Object{
      {"verdict", fit.identified ? "identified" : "not_identified"},
      {"reason", fit.reason},
      {"reason_code", reason_code(fit.why)},
      {"model", characterise::name_of(fit.curve.shape)},
      {"a1", interval_quantity(fit.a1, unit)},
      {"a2", interval_quantity(fit.a2, unit)},
      {"time_constant_runs", interval_quantity(fit.time_constant_s, "1")},
      {"interval_95", Object{{"a1", interval_value(fit.a1)},
                             {"a2", interval_value(fit.a2)},
                             {"time_constant_runs", interval_value(fit.time_constant_s)}}}};
}

}  // namespace

Value temperature_value(const DriftTemperature& found, const Unit& unit) {
  if (!found.model) return nullptr;
  const TemperatureModel& model = *found.model;
  const std::string level = noise_unit(unit, NoiseScale::level);
  const bool identified = model.verdict == characterise::Verdict::identified;
  return Object{{"channel", found.channel},
                {"verdict", identified ? "identified" : "not_identified"},
                {"reason", model.reason},
                {"degree", model.degree},
                {"reference_k", model.reference_k},
                {"lowest_k", model.lowest_k},
                {"highest_k", model.highest_k},
                {"coefficients", coefficients(model, level)},
                {"covariance", matrix(model.covariance)},
                {"bias_span", model.bias_span},
                {"hysteresis", quantity(model.hysteresis, level)},
                {"hysteresis_significant", model.hysteresis_significant},
                {"slope_upper_95", model.slope_upper_95 ? Value(*model.slope_upper_95) : Value()},
                {"cross_validation", scores(model)},
                {"residual_std", model.residual_std},
                {"white_std", model.white_std},
                {"drift_std", model.drift_std},
                {"block_s", model.block_s},
                {"points", points(model)}};
}

Value forecast_value(const DriftOutlook& outlook, const Unit& unit) {
  if (!outlook.forecast) return nullptr;
  const characterise::DriftForecast& later = *outlook.forecast;
  const std::string level = noise_unit(unit, NoiseScale::level);
  const bool costs = costs_position(unit);
  const bool left_in = costs && !holds_gravity(later.bias);
  return Object{
      {"t_s", later.t_s},
      {"bias", interval_quantity(later.bias, level)},
      {"interval_95", interval_value(later.bias)},
      {"change", interval_quantity(later.change, level)},
      {"change_interval_95", interval_value(later.change)},
      {"position_error_m", costs ? Value(position_errors(later.change)) : Value()},
      {"position_error_uncorrected_m", left_in ? Value(position_errors(later.bias)) : Value()}};
}

Object runs_object(const ChannelRuns& runs) {
  const std::string unit = noise_unit(runs.unit, NoiseScale::level);
  Object item{{"name", runs.name}, {"unit", unit}};
  const auto add = [&](const char* key, Value value) { item.push_back({key, std::move(value)}); };
  if (!runs.set) {
    add("count", 0);
    add("reason", runs.refused);
    for (const char* key : run_set_keys) add(key, nullptr);
    add("levels", Array{});
    return item;
  }
  const RunSet& set = *runs.set;
  ChannelDrift common;
  common.name = runs.name;
  common.unit = runs.unit;
  common.analysis = set.warm_up;
  add("count", set.runs.size());
  add("window_s", set.window_s);
  add("duration_s", set.duration_s);
  add("turn_on", scatter(set.turn_on, unit));
  add("level", scatter(set.level, unit));
  add("trend_per_run", quantity(set.trend_per_run, unit));
  add("trend_p", set.trend_p);
  add("level_curve", level_curve(runs, unit));
  add("levels", levels(set, unit));
  add("warm_up", drift_object(common));
  return item;
}

}  // namespace proofmass::report
