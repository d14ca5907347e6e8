#include "proofmass/report/tune/wording.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::TunedParameter;
using estimate::TuneModel;
using estimate::TuneRole;
using estimate::TuneVerdict;

// Exponents of m and s in a mechanical unit; nullopt for any other.
struct Powers {
  int metre = 0;
  double second = 0.0;
};

std::optional<Powers> powers_of(const Unit& unit) {
  if (unit.symbol == "m/s^2") return Powers{1, -2.0};
  if (unit.symbol == "m/s") return Powers{1, -1.0};
  if (unit.symbol == "m") return Powers{1, 0.0};
  return std::nullopt;
}

std::string power(const char* base, int exponent) {
  return exponent == 1 ? base : fmt::format("{}^{}", base, exponent);
}

std::string over_seconds(const std::string& top, double second_power) {
  const auto whole = static_cast<int>(-second_power);
  return second_power == 0.0 ? top : top + "/" + power("s", whole);
}

bool is_bare(const std::string& symbol) {
  return symbol.find_first_of("/^*") == std::string::npos;
}

std::string root_unit(const std::string& top, double second_power) {
  if (second_power == 0.5) return top + "/sqrt(Hz)";
  if (second_power == -0.5) return top + "/sqrt(s)";
  return top;
}

std::string printed(std::string unit) {
  constexpr std::array<const char*, 8> digits{"²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  for (std::size_t k = 0; k < digits.size(); ++k) {
    const std::string plain = fmt::format("^{}", k + 2);
    for (std::size_t at = unit.find(plain); at != std::string::npos; at = unit.find(plain)) {
      unit.replace(at, plain.size(), digits[k]);
    }
  }
  return print_unit(unit);
}

std::string time_words(const std::optional<double>& time_s) {
  return time_s ? compact(*time_s, 3) + " s" : "not within the study";
}

}  // namespace

std::string tune_unit(const Unit& unit, int channel_power, double second_power) {
  if (channel_power == 0) return "s";
  const std::string symbol = unit.symbol.empty() ? "1" : unit.symbol;
  if (channel_power == 1) return root_unit(symbol, second_power);
  if (const auto powers = powers_of(unit))
    return over_seconds("m^2", 2.0 * powers->second + second_power);
  if (symbol == "1") return over_seconds("1", second_power);
  return over_seconds((is_bare(symbol) ? symbol : "(" + symbol + ")") + "^2", second_power);
}

std::string parameter_unit(const TuneReport& report, const TunedParameter& parameter) {
  const std::size_t channel = parameter.series.value_or(0);
  const Unit unit = channel < report.channels.size() ? report.channels[channel].unit : Unit{};
  return tune_unit(unit, parameter.channel_power, parameter.second_power);
}

std::string parameter_channel(const TuneReport& report, const TunedParameter& parameter) {
  if (parameter.series) return report.channels[*parameter.series].name;
  return report.channels.size() == 1 ? report.channels.front().name : "all";
}

std::string value_words(const TuneReport& report, const TunedParameter& parameter) {
  const std::string unit = printed(parameter_unit(report, parameter));
  if (parameter.value) return with_std(*parameter.value, unit);
  if (parameter.upper_95)
    return fmt::format("below {} {} (95 %)", significant(*parameter.upper_95, 2), unit);
  if (parameter.lower_95)
    return fmt::format("above {} {} (95 %)", significant(*parameter.lower_95, 2), unit);
  return "not determined";
}

std::string interval_words(const TunedParameter& parameter) {
  if (!parameter.value || !parameter.lower_95 || !parameter.upper_95) return "";
  return significant(*parameter.lower_95, 3) + " … " + significant(*parameter.upper_95, 3);
}

std::string reason_words(const TuneReport& report, const TunedParameter& parameter) {
  std::string text = parameter.reason;
  if (parameter.upper_95 || parameter.lower_95) text += ", " + value_words(report, parameter);
  if (parameter.record_needed_s)
    text += fmt::format("; about {} of record would identify it",
                        duration_words(*parameter.record_needed_s));
  return text;
}

std::string model_words(TuneModel model) {
  switch (model) {
    case TuneModel::rest:
      return "at rest: white noise on a random-walk bias";
    case TuneModel::rest_markov:
      return "at rest: white noise on a random-walk bias and a bias of first-order Markov noise";
    case TuneModel::pva:
      return "position, velocity, acceleration: white noise on an acceleration driven by white "
             "jerk";
    case TuneModel::pva_bias:
      return "white noise on an acceleration driven by white jerk and a bias of first-order Markov "
             "noise";
    case TuneModel::local_level:
      return "white noise on a random-walk level";
    case TuneModel::local_trend:
      return "white noise on a level with a random-walk slope";
    case TuneModel::position:
      return "white noise on a position driven by white jerk";
  }
  return "";
}

NoiseNames noise_names(TuneModel model) {
  const View<estimate::TuneParameter> parameters = estimate::parameters_of(model);
  NoiseNames names;
  names.measurement = parameters[0].name;
  names.process = parameters[1].name;
  if (estimate::is_of_rest(model)) names.slow = parameters[1].name;
  return names;
}

Table parameters_table(const TuneReport& report) {
  Table table{"Parameters, by maximum likelihood",
              {"Parameter", "Channel", "Value", "95 % interval", "Start", "After EM"},
              {}};
  for (const TunedParameter& parameter : report.tuning.parameters) {
    const bool fixed = parameter.verdict == TuneVerdict::fixed;
    table.rows.push_back({parameter.name, parameter_channel(report, parameter),
                          value_words(report, parameter) + (fixed ? " (fixed)" : ""),
                          fixed ? "" : interval_words(parameter),
                          fixed ? "" : significant(parameter.start, 3),
                          fixed ? "" : significant(parameter.after_em, 3)});
  }
  return table;
}

std::string choice_words(const estimate::TuneChoice& choice) {
  using enum estimate::TuneBasis;
  const std::string share = fmt::format("{} % of the recording is at rest",
                                        std::lround(100.0 * choice.rest_share.value_or(0.0)));
  if (choice.basis == no_acceleration)
    return "Chosen because the channels do not measure acceleration.";
  if (choice.basis == in_motion)
    return fmt::format("Chosen because only {}; --model rest would use the rests alone.", share);
  std::string words =
      choice.basis == given ? "Chosen by --model." : fmt::format("Chosen because {}.", share);
  if (!choice.rests.empty())
    words += fmt::format(" Only the {} are used, each with its own level.",
                         count_words(choice.rests.size(), "rest"));
  else if (choice.rest_share && *choice.rest_share < 1.0)
    words += " No rest was found in it: all of it is used.";
  return words;
}

std::vector<Note> outlier_notes(const TuneReport& report) {
  std::vector<Note> notes;
  for (std::size_t k = 0; k < report.channels.size(); ++k) {
    const estimate::TuneOutliers& outliers = report.tuning.series[k].outliers;
    if (outliers.count == 0) continue;
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: {} not used, up to {} {} from the neighbouring measurements: the noise "
                     "of the model does not explain them, a filter has to gate them",
                     report.channels[k].name, count_words(outliers.count, "outlier"),
                     significant(outliers.largest, 2), printed(report.channels[k].unit.symbol))});
  }
  return notes;
}

std::string case_words(const estimate::GainCase& one) {
  if (one.Q_factor > 1.0) return "Q four times";
  return one.R_factor > 1.0 ? "R four times" : "as tuned";
}

Table settling_table(const estimate::TuneStudy& study) {
  Table table{"Gain of the filter",
              {"Case", "Q", "R", "Gain of acceleration", "settles in",
               "Gain of velocity settles in", "Gain of position settles in", "Std of acceleration"},
              {}};
  for (const estimate::GainCase& one : study.cases) {
    const estimate::GainStudy& s = one.study;
    table.rows.push_back({case_words(one), significant(s.options.jerk_psd_m2ps5, 3),
                          significant(s.options.accel_variance_m2ps4, 3),
                          significant(s.limit[2], 3), time_words(s.settling_s[2]),
                          time_words(s.settling_s[1]), time_words(s.settling_s[0]),
                          significant(std::sqrt(s.limit_variance_m2ps4), 3)});
  }
  return table;
}

Table step_table(const estimate::TuneStudy& study) {
  Table table{"Time between measurements, Q and R as tuned",
              {"Step", "Gain", "settles in", "Std after a measurement", "and before it"},
              {}};
  for (const estimate::StepSizeEffect& step : study.steps) {
    table.rows.push_back({compact(step.step_s, 3) + " s", significant(step.gain, 3),
                          time_words(step.settling_s), significant(step.accel_std_mps2, 3),
                          significant(step.predicted_std_mps2, 3)});
  }
  return table;
}

}  // namespace proofmass::report
