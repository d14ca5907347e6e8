#include "proofmass/report/drift/tables.hpp"

#include <fmt/format.h>

#include "proofmass/report/drift/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftFit;
using characterise::Interval95;
using signal::WhitenessTest;

// "106 m (102 m … 109 m)"
std::string position_words(const Interval95& bias_mps2, double t_s) {
  const Interval95 error = characterise::position_error(bias_mps2, t_s);
  const auto end = [](const std::optional<double>& x) { return x ? length_words(*x) : "open"; };
  return fmt::format("{} ({} … {})", end(error.value), end(error.lower_95), end(error.upper_95));
}

}  // namespace

Table parameters_table(const ChannelDrift& channel) {
  const DriftFit& fit = channel.analysis->fit;
  const Unit& unit = channel.unit;
  const std::string symbol = print_unit(level_unit(unit));
  Table table{"Model: " + shape_words(fit.curve.shape),
              {"Parameter", "Value", "95 % interval", "In SI"},
              {}};
  const auto add_bias = [&](const std::string& name, const std::optional<Interval95>& figure) {
    if (!figure) return table.rows.push_back({name, "not identified"});
    table.rows.push_back({name, bias_words(*figure, unit), bias_interval_words(*figure, unit),
                          significant(figure->value, 5) + ' ' + symbol});
  };
  const auto add_time = [&](const char* name, const std::optional<Interval95>& figure) {
    if (!figure) return table.rows.push_back({name, "not identified"});
    table.rows.push_back(
        {name, with_std(Uncertain{figure->value, figure->std}, "s"), time_interval_words(*figure)});
  };
  add_bias(level_words(channel), fit.a2);
  add_bias("Warm-up a1", fit.a1);
  add_time("Time constant T", fit.time_constant_s);
  if (fit.second_a1) add_bias("Second warm-up", fit.second_a1);
  if (fit.second_time_constant_s) add_time("Its time constant", fit.second_time_constant_s);
  if (fit.slope_per_s)
    table.rows.push_back({"Slope a3", slope_words(*fit.slope_per_s, unit), "",
                          significant(fit.slope_per_s->value, 5) + ' ' +
                              print_unit(noise_unit(unit, NoiseScale::slope))});
  const double rms = channel.analysis->residual_rms;
  table.rows.push_back(
      {"Residuals, rms", bias_words(rms, unit), "", significant(rms, 4) + ' ' + symbol});
  for (std::vector<std::string>& row : table.rows) row.resize(table.head.size());
  return table;
}

Table steps_table(const ChannelDrift& channel) {
  Table table{"Steps", {"Step", "Time", "Size"}, {}};
  table.long_list = true;
  for (const characterise::DriftStep& step : channel.analysis->fit.curve.steps)
    table.rows.push_back({std::to_string(table.rows.size() + 1), compact(step.t_s, 6) + " s",
                          bias_words(step.size, channel.unit)});
  return table;
}

std::vector<std::string> whiteness_row(const std::string& name, const WhitenessTest& test) {
  return {name,
          grouped(test.values),
          fmt::format("{} % of {}", fixed(100.0 * test.inside_bounds, 0), grouped(test.lags)),
          p_words(test.ljung_box_p),
          p_words(test.periodogram_p),
          p_words(test.runs_p),
          test.white ? "white" : "not white"};
}

Table whiteness_table(const characterise::DriftAnalysis& analysis) {
  Table table{"Whiteness of the residuals: 95 % of lags inside the bounds if white",
              {"Means over", "Values", "Inside the bounds", "Ljung–Box p", "Periodogram p",
               "Runs p", "Verdict"},
              {}};
  table.page_only = true;
  for (const WhitenessTest& test : analysis.whiteness)
    table.rows.push_back(whiteness_row(duration_words(test.scale_s), test));
  if (analysis.whitened)
    table.rows.push_back(whiteness_row(
        fmt::format("{}, less the noise model", duration_words(analysis.whitened->scale_s)),
        *analysis.whitened));
  return table;
}

Table candidates_table(const DriftFit& fit) {
  Table table{"Shapes tried, best first, with the Schwarz criterion relative to the best",
              {"Shape", "Parameters", "Criterion", "Time constant", "Steps"},
              {}};
  table.page_only = true;
  for (const characterise::DriftCandidate& tried : fit.candidates) {
    const double above = tried.information_criterion - fit.candidates.front().information_criterion;
    table.rows.push_back({shape_words(tried.shape), std::to_string(tried.parameters),
                          fixed(above, 1),
                          tried.time_constant_s ? duration_words(*tried.time_constant_s) : "",
                          tried.steps > 0 ? std::to_string(tried.steps) : ""});
  }
  return table;
}

Table position_table(const characterise::DriftForecast& forecast) {
  const bool gravity = holds_gravity(forecast.bias);
  Table table{fmt::format("Position error ½ b t² from the bias at {}, with its 95 % band{}",
                          duration_words(forecast.t_s),
                          gravity ? "; none uncorrected, as the level contains gravity" : ""),
              {"After", "Zeroed at the end of the recording", "Uncorrected"},
              {}};
  table.page_only = true;
  for (const double t_s : integration_times_s)
    table.rows.push_back({duration_words(t_s), position_words(forecast.change, t_s),
                          gravity ? "" : position_words(forecast.bias, t_s)});
  return table;
}

Table temperature_table(const ChannelDrift& channel) {
  const characterise::TemperatureModel& model = *channel.temperature->model;
  const std::string symbol = level_unit(channel.unit);
  Table table{fmt::format("Σ c_j (T − {} K)^j between {} and {} K", compact(model.reference_k, 6),
                          compact(model.lowest_k, 5), compact(model.highest_k, 5)),
              {"Coefficient", "Value", "In SI"},
              {}};
  table.page_only = true;
  for (std::size_t j = 0; j < model.coefficients.size(); ++j)
    table.rows.push_back(
        {fmt::format("c_{}", j),
         bias_words(model.coefficients[j], channel.unit) + per_kelvin("", j),
         significant(model.coefficients[j].value, 5) + ' ' + print_unit(per_kelvin(symbol, j))});
  if (model.hysteresis)
    table.rows.push_back({"Heating less cooling", bias_words(*model.hysteresis, channel.unit),
                          significant(model.hysteresis->value, 4) + ' ' + print_unit(symbol)});
  return table;
}

Table runs_table(const ChannelRuns& runs) {
  const characterise::RunSet& set = *runs.set;
  Table table{"Each run, over the " + duration_words(set.duration_s) + " common to all",
              {"Run", "Turn-on", "Mean", "Change within"},
              {}};
  table.page_only = true;
  for (const characterise::RunLevel& run : set.runs)
    table.rows.push_back({run.name, bias_words(run.turn_on, runs.unit),
                          bias_words(run.mean, runs.unit), bias_words(run.change, runs.unit)});
  return table;
}

}  // namespace proofmass::report
