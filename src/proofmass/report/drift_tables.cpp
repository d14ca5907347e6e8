#include "proofmass/report/drift_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/drift_wording.hpp"
#include "proofmass/report/noise_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftFit;
using characterise::Interval95;
using signal::WhitenessTest;

std::string time_words(const Interval95& figure) {
  return with_std(Uncertain{figure.value, figure.std}, "s");
}

struct LengthUnit {
  double per_m;
  const char* symbol;
};

LengthUnit length_unit(double size_m) {
  if (size_m >= 1000.0) return {1e-3, "km"};
  if (size_m >= 1.0) return {1.0, "m"};
  return size_m >= 1e-4 ? LengthUnit{1e3, "mm"} : LengthUnit{1e6, "µm"};
}

// "106 (102 … 109) m": all three in one unit, to be compared at a glance.
std::string position_words(const Interval95& bias_mps2, double t_s) {
  const Interval95 error = characterise::position_error(bias_mps2, t_s);
  const auto size = [](const std::optional<double>& x) { return std::abs(x.value_or(0.0)); };
  const auto [per_m, symbol] =
      length_unit(std::max({std::abs(error.value), size(error.lower_95), size(error.upper_95)}));
  const double factor = per_m;
  const auto end = [factor](const std::optional<double>& x) {
    return x ? significant(*x * factor, 3) : "open";
  };
  return fmt::format("{} ({} … {}) {}", end(error.value), end(error.lower_95), end(error.upper_95),
                     symbol);
}

}  // namespace

std::vector<std::string> whiteness_row(const std::string& name, const WhitenessTest& test) {
  return {name,
          grouped(test.values),
          fmt::format("{} % of {}", fixed(100.0 * test.inside_bounds, 0), grouped(test.lags)),
          p_words(test.ljung_box_p),
          p_words(test.periodogram_p),
          p_words(test.runs_p),
          test.white ? "white" : "not white"};
}

Table parameters_table(const ChannelDrift& channel) {
  const DriftFit& fit = channel.analysis->fit;
  const Unit& unit = channel.unit;
  const std::string symbol = print_unit(noise_unit(unit, NoiseScale::level));
  Table table{
      "Taken: " + shape_words(fit.curve.shape), {"Figure", "Value", "95 % interval", "In SI"}, {}};
  const auto add_bias = [&](const char* name, const std::optional<Interval95>& figure) {
    if (!figure) return table.rows.push_back({name, "not identified", "", ""});
    table.rows.push_back({name, bias_words(*figure, unit), bias_interval_words(*figure, unit),
                          significant(figure->value, 5) + ' ' + symbol});
  };
  const auto add_time = [&](const char* name, const std::optional<Interval95>& figure) {
    if (!figure) return table.rows.push_back({name, "not identified", "", ""});
    table.rows.push_back({name, time_words(*figure), time_interval_words(*figure), ""});
  };
  add_bias(level_words(channel).c_str(), fit.a2);
  add_bias("Warm-up a1", fit.a1);
  add_time("Time constant T", fit.time_constant_s);
  if (fit.second_a1) add_bias("Second warm-up", fit.second_a1);
  if (fit.second_time_constant_s) add_time("Its time constant", fit.second_time_constant_s);
  if (fit.slope_per_s) {
    table.rows.push_back({"Slope a3", slope_words(*fit.slope_per_s, unit), "",
                          significant(fit.slope_per_s->value, 5) + ' ' +
                              print_unit(noise_unit(unit, NoiseScale::slope))});
  }
  const double rms = channel.analysis->residual_rms;
  table.rows.push_back(
      {"Residuals, rms", bias_words(rms, unit), "", significant(rms, 4) + ' ' + symbol});
  return table;
}

Table steps_table(const ChannelDrift& channel) {
  constexpr std::size_t most_rows = 40;
  const auto& steps = channel.analysis->fit.curve.steps;
  Table table{"Steps of level", {"Step", "At", "Size"}, {}};
  for (const characterise::DriftStep& step : steps) {
    if (table.rows.size() == most_rows) break;
    table.rows.push_back({std::to_string(table.rows.size() + 1), compact(step.t_s, 6) + " s",
                          bias_words(step.size, channel.unit)});
  }
  if (steps.size() > most_rows) {
    table.caption += fmt::format(": the first {} of {}", most_rows, steps.size());
  }
  return table;
}

Table whiteness_table(const characterise::DriftAnalysis& analysis) {
  Table table{
      "Are the residuals white? 95 % of lags inside the bounds, and p above a few percent, "
      "if they are",
      {"Means over", "Values", "Inside the bounds", "Ljung–Box p", "Periodogram p", "Runs p",
       "Verdict"},
      {}};
  for (const WhitenessTest& test : analysis.whiteness) {
    table.rows.push_back(whiteness_row(duration_words(test.scale_s), test));
  }
  if (analysis.whitened) {
    table.rows.push_back(whiteness_row(
        fmt::format("{}, less the noise model", duration_words(analysis.whitened->scale_s)),
        *analysis.whitened));
  }
  return table;
}

Table candidates_table(const DriftFit& fit) {
  Table table{"Shapes tried, best first, by the Schwarz criterion above that of the best",
              {"Shape", "Parameters", "Criterion", "Time constant", "Steps"},
              {}};
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
  constexpr std::array times_s{1.0, 10.0, 60.0};
  Table table{fmt::format("Position error ½ b t² of the bias at {}, with its 95 % band",
                          duration_words(forecast.t_s)),
              {"After", "If zeroed at the end of the recording", "If left in"},
              {}};
  const bool gravity = holds_gravity(forecast.bias);
  if (gravity) table.caption += ". The level holds gravity, so leaving it in is not shown";
  for (const double t_s : times_s) {
    table.rows.push_back({duration_words(t_s), position_words(forecast.change, t_s),
                          gravity ? "" : position_words(forecast.bias, t_s)});
  }
  return table;
}

Table temperature_table(const ChannelDrift& channel) {
  const characterise::TemperatureModel& model = *channel.temperature->model;
  const std::string symbol = noise_unit(channel.unit, NoiseScale::level);
  Table table{fmt::format("Σ c_j (T − {} K)^j between {} and {} K", compact(model.reference_k, 6),
                          compact(model.lowest_k, 5), compact(model.highest_k, 5)),
              {"Coefficient", "Value", "In SI"},
              {}};
  for (std::size_t j = 0; j < model.coefficients.size(); ++j) {
    const std::string per = j == 0 ? "" : j == 1 ? "/K" : fmt::format("/K^{}", j);
    table.rows.push_back(
        {fmt::format("c_{}", j), bias_words(model.coefficients[j], channel.unit) + per,
         significant(model.coefficients[j].value, 5) + ' ' + print_unit(symbol) + per});
  }
  if (model.hysteresis) {
    table.rows.push_back({"Heating less cooling", bias_words(*model.hysteresis, channel.unit),
                          significant(model.hysteresis->value, 4) + ' ' + print_unit(symbol)});
  }
  return table;
}

Table runs_table(const ChannelRuns& runs) {
  const characterise::RunSet& set = *runs.set;
  Table table{"Each run, over the " + duration_words(set.duration_s) + " that all have",
              {"Run", "Turn-on", "Mean", "Change within"},
              {}};
  for (const characterise::RunLevel& run : set.runs) {
    table.rows.push_back({run.name, bias_words(run.turn_on, runs.unit),
                          bias_words(run.mean, runs.unit), bias_words(run.change, runs.unit)});
  }
  return table;
}

}  // namespace proofmass::report
