#include "proofmass/report/noise/fields.hpp"

#include <algorithm>
#include <array>

#include "proofmass/report/noise/wording.hpp"
#include "proofmass/sensor/noise_conversions.hpp"

namespace proofmass::report {
namespace {

using characterise::Coefficient;
using characterise::DeviationCurve;
using characterise::DeviationPoint;
using characterise::NoiseAnalysis;
using characterise::NoiseModelFit;
using characterise::NoisePart;

Fields reading_fields(const DeviationPoint& point) {
  const About limit{.why_null = "too few degrees of freedom for a limit at this confidence"};
  return {field::magnitude("tau_s", point.tau_s), field::magnitude("value", point.value),
          field::magnitude("lower", point.lower, limit),
          field::magnitude("upper", point.upper, limit)};
}

Fields point_fields(const DeviationPoint& point, bool knows_lag1) {
  Fields fields = reading_fields(point);
  const auto add = [&](Field one) { fields.push_back(std::move(one)); };
  add(field::magnitude("edf", point.edf,
                       {.meaning = "equivalent degrees of freedom of the variance"}));
  add(field::integer("alpha", point.alpha,
                     {.meaning = "noise type: exponent of f in the spectral density"}));
  if (knows_lag1)
    add(field::integer(
        "alpha_lag1", point.alpha_lag1,
        {.meaning = "noise type by lag-1 autocorrelation", .why_null = "needs 30 averages"}));
  add(field::count("m", point.m, {.meaning = "averaging factor: samples in tau"}));
  add(field::count("terms", point.terms, {.meaning = "squared differences"}));
  add(field::magnitude("uncorrected", point.uncorrected,
                       {.meaning = "before the correction for the bias of the statistic"}));
  return fields;
}

// Minimum inside the curve, not at one of its ends.
Field minimum(const std::vector<CurveReading>& readings) {
  const auto found = std::ranges::find_if(readings, &CurveReading::is_minimum);
  std::optional<Fields> fields;
  if (found != readings.end()) fields = reading_fields(found->point);
  return field::object_or_null("minimum", std::move(fields),
                               {.meaning = "within the curve",
                                .why_null = "the deviation is lowest at an end of the curve"});
}

std::optional<Fields> deviation_fields(const ChannelNoise& channel) {
  if (!channel.analysis) return std::nullopt;
  const DeviationCurve& curve = channel.analysis->deviation;
  const bool knows_lag1 =
      std::ranges::any_of(curve.points, [](const auto& p) { return p.alpha_lag1.has_value(); });
  std::vector<CurveReading> at = curve_readings(curve);
  Field lowest = minimum(at);
  std::erase_if(at, [](const CurveReading& reading) { return reading.is_minimum; });
  return Fields{
      field::choice("statistic", characterise::name_of(curve.statistic),
                    {"adev", "oadev", "mdev", "tdev", "hdev", "ohdev", "totdev", "mtotdev",
                     "ttotdev", "htotdev", "theo1", "pdev"}),
      field::text("unit", noise_unit(channel.unit, curve_scale(curve.statistic))),
      field::probability("confidence", curve.confidence, {.meaning = "of lower and upper"}),
      field::text("bias_correction", curve.bias_correction,
                  {.meaning = "in words; empty: none was needed"}),
      std::move(lowest),
      field::records("at", at,
                     [](const CurveReading& reading) { return reading_fields(reading.point); },
                     {.meaning = "at 1, 10 and 100 s, where the curve has a point within 3 %"}),
      field::records("points", curve.points,
                     [&](const DeviationPoint& point) { return point_fields(point, knows_lag1); })};
}

Fields coefficient_fields(const Coefficient& found, const std::string& unit) {
  return {
      field::magnitude("value", found.value, {.meaning = "0 where not observable"}),
      field::magnitude("std", found.std,
                       {.meaning = "half of interval_95 over 1.96, for flicker, random_walk and "
                                   "markov its longer side; where not observable upper_95/1.645"}),
      field::text("unit", unit),
      field::numbers("interval_95", std::array{found.lower_95, found.upper_two_sided_95},
                     {.meaning = "central, by likelihood ratio"}),
      field::magnitude("upper_95", found.upper_95, {.meaning = "one-sided 95 % upper limit"}),
      field::choice("verdict", is_identified(found) ? "identified" : "not_observable",
                    {"identified", "not_observable"}),
      field::magnitude(
          "record_needed_s", found.record_needed_s,
          {.meaning = "length of recording that identifies it with 95 % probability, at its "
                      "value, or at upper_95 where it is not observable",
           .why_null = "not even a recording ten thousand times as long would identify it"})};
}

Fields parameter_fields(const NoiseModelFit& model, const Unit& unit) {
  Fields all;
  for (const NamedCoefficient& term : named_coefficients) {
    Fields fields = coefficient_fields(model.*term.figure, noise_unit(unit, term.scale));
    if (term.scale == NoiseScale::density)
      fields.push_back(field::magnitude("one_sided_density",
                                        sensor::one_sided_density(model.white.value),
                                        {.meaning = "as in data sheets: sqrt(2) times the value"}));
    if (term.scale == NoiseScale::slope)
      fields.push_back(
          field::number("slope_per_s", model.slope_per_s,
                        {.meaning = "as fitted, with its sign, also where not observable"}));
    all.push_back(field::object(term.key, std::move(fields)));
  }
  if (!model.markov) return all;
  Fields fields = coefficient_fields(model.markov->strength, noise_unit(unit, NoiseScale::walk));
  fields.push_back(field::measured("time_constant_s", model.markov->time_constant_s, "s"));
  fields.push_back(field::magnitude("std_of_process", model.markov->std_of_process()));
  all.push_back(field::object("markov", std::move(fields),
                              {.meaning = "first-order Markov noise, where the data need it"}));
  return all;
}

Field parameters(const NoiseModelFit& model, const Unit& unit) {
  return field::object(
      "parameters", parameter_fields(model, unit),
      {.meaning = "coefficients of the Allan variance 3 Q^2/tau^2 + N^2/tau + (2 ln2/pi) B^2 + "
                  "K^2 tau/3 + R^2 tau^2/2 (IEEE Std 952-1997, annex C); two-sided"});
}

Field slow_change(const NoiseModelFit& model, const Unit& unit) {
  std::optional<Fields> fields;
  if (model.slow_change)
    fields = Fields{
        field::magnitude("period_s", model.slow_change->period_s),
        field::magnitude("peak_to_peak", model.slow_change->peak_to_peak),
        field::text("unit", noise_unit(unit, NoiseScale::level)),
        field::flag("taken_out", model.slow_change->taken_out,
                    {.meaning = "false: it explains the recording as well as the slow terms whose "
                                "interval reaches 0"})};
  return field::object_or_null(
      "slow_change", std::move(fields),
      {.meaning = "slow deterministic change, like a sine of a few periods or a part of one",
       .why_null = "noise alone explains the recording"});
}

Field misfit(const NoiseModelFit& model) {
  return field::object(
      "misfit",
      {field::magnitude("share_of_density", model.misfit,
                        {.meaning = "rms difference of spectrum and model beyond the scatter of "
                                    "the spectrum"}),
       field::probability("p", model.misfit_p, {.meaning = "probability of as much by chance"}),
       field::count("groups", model.ordinates, {.meaning = "of spectral values in the fit"})});
}

// The square of a coefficient, times a factor.
Field squared(const char* key,
              const Coefficient& found,
              double factor,
              const std::string& unit,
              About about) {
  std::optional<Uncertain> square;
  if (is_identified(found))
    square = Uncertain{factor * found.value * found.value, factor * 2.0 * found.value * found.std};
  return field::measured(key, square, unit, std::move(about));
}

Field markov_for_flicker(const NoiseAnalysis& analysis, const Unit& unit) {
  constexpr double maximum_at = 1.89;  // of a Markov process's Allan variance, in units of its
                                       // time constant
  std::optional<Fields> fields;
  if (const auto flat_s = flicker_tau_s(analysis)) {
    const sensor::FirstOrderMarkov process =
        sensor::markov_of_flicker({analysis.model.flicker.value, *flat_s / maximum_at});
    fields = Fields{field::magnitude("time_constant_s", process.time_constant_s),
                    field::magnitude("psd", process.psd_m2ps5),
                    field::text("psd_unit", squared_unit(unit, NoiseScale::walk)),
                    field::magnitude("variance", process.variance_m2ps4()),
                    field::text("variance_unit", squared_unit(unit, NoiseScale::level))};
  }
  return field::object_or_null(
      "flicker_as_markov", std::move(fields),
      {.meaning = "first-order Markov process with the same flat part (Farrell et al., IEEE "
                  "Control Systems Magazine 42(6), 2022)",
       .why_null = "no flicker noise is identified"});
}

Field filter(const NoiseAnalysis& analysis, const Unit& unit) {
  const NoiseModelFit& model = analysis.model;
  std::optional<double> bandwidth_hz;
  if (model.bandwidth_hz) bandwidth_hz = model.bandwidth_hz->value;
  const double of_density = sensor::sample_variance_m2ps4({1.0, analysis.rate_hz, bandwidth_hz});
  const char* no_white = "white noise is not identified";
  return field::object(
      "filter",
      {squared("sample_variance", model.white, of_density, squared_unit(unit, NoiseScale::level),
               {.meaning = "variance of the white noise of a sample: R of a filter",
                .why_null = no_white}),
       squared("white_psd", model.white, 1.0, squared_unit(unit, NoiseScale::density),
               {.meaning = "N^2, two-sided", .why_null = no_white}),
       squared("bias_psd", model.random_walk, 1.0, squared_unit(unit, NoiseScale::walk),
               {.meaning = "K^2: density of the white noise that drives the bias random walk",
                .why_null = "no random walk is identified; parameters.random_walk.upper_95 is its "
                            "limit"}),
       markov_for_flicker(analysis, unit)},
      {.meaning = "for estimators"});
}

// Entries that need coefficients, which a short recording does not give.
Fields model_fields(const ChannelNoise& channel) {
  if (has_coefficients(channel)) {
    const NoiseModelFit& model = channel.analysis->model;
    return {parameters(model, channel.unit), slow_change(model, channel.unit),
            field::measured("bandwidth_hz", model.bandwidth_hz, "Hz",
                            {.meaning = "-3 dB of a one-pole filter on the white noise",
                             .why_null = "the spectrum does not roll off below half the rate"}),
            misfit(model), filter(*channel.analysis, channel.unit)};
  }
  const About about{.why_null = channel.analysis ? "the recording is too short for coefficients"
                                                 : why_not_analysed(channel)};
  Fields fields;
  for (const char* key : {"parameters", "slow_change"})
    fields.push_back(field::object_or_null(key, std::nullopt, about));
  fields.push_back(field::measured("bandwidth_hz", std::nullopt, "Hz", about));
  for (const char* key : {"misfit", "filter"})
    fields.push_back(field::object_or_null(key, std::nullopt, about));
  return fields;
}

Field stationarity(const ChannelNoise& channel) {
  std::optional<Fields> fields;
  if (channel.analysis && channel.analysis->stationarity.tested) {
    const characterise::Stationarity& test = channel.analysis->stationarity;
    const auto part_fields = [&](const NoisePart& part) -> Fields {
      return {field::number("start_s", part.start_s), field::number("end_s", part.end_s),
              parameters(part.model, channel.unit)};
    };
    fields = Fields{
        field::choice("verdict", test.stationary ? "stationary" : "not_stationary",
                      {"stationary", "not_stationary"}),
        field::probability("p", test.p, {.meaning = "of all tests together"}),
        field::magnitude("averaging_s",
                         test.line_hz ? std::nullopt : std::optional(test.averaging_s),
                         {.meaning = "averaging time at which the level varies most",
                          .why_null = "the line at line_hz varies most"}),
        field::magnitude("line_hz", test.line_hz,
                         {.meaning = "line whose level varies most",
                          .why_null = "the level at averaging_s varies more than any line"}),
        field::numbers("relative_level", test.relative_level,
                       {.meaning = "level there in equal parts of the recording, over its mean"}),
        field::records("parts", channel.analysis->parts, part_fields,
                       {.meaning = "where not stationary: each eighth (or quarter) by itself; "
                                   "empty for a recording larger than --memory"})};
  }
  return field::object_or_null(
      "stationarity", std::move(fields),
      {.meaning = "whether the noise is constant; lines are not tested in a recording larger than "
                  "--memory",
       .why_null = channel.analysis ? "the recording is too short for the test"
                                    : why_not_analysed(channel)});
}

Fields record_fields(const ChannelNoise& channel) {
  const NoiseAnalysis none;
  const NoiseAnalysis& analysis = channel.analysis ? *channel.analysis : none;
  Fields fields{field::count("samples", analysis.samples, {.meaning = "missing ones included"}),
                field::count("missing", analysis.missing),
                field::magnitude("rate_hz", analysis.rate_hz),
                field::magnitude("duration_s", analysis.duration_s),
                field::number("mean", analysis.mean),
                field::magnitude("lsb", analysis.lsb,
                                 {.meaning = "converter step",
                                  .why_null = "the values show no step of a converter"})};
  if (!channel.analysis)
    for (Field& one : fields) one = field::without_value(std::move(one), why_not_analysed(channel));
  return fields;
}

Field temperature(const ChannelNoise& channel) {
  const TemperatureEffect& effect = *channel.temperature;
  return field::object(
      "temperature",
      {field::text("channel", effect.channel),
       field::measured("coefficient", effect.coefficient,
                       noise_unit(channel.unit, NoiseScale::level) + "/" + effect.per)},
      {.meaning = "removed linear dependence, with --temperature"});
}

}  // namespace

Fields noise_fields(const ChannelNoise& channel) {
  Fields fields{field::text("name", channel.name),
                field::text("unit", noise_unit(channel.unit, NoiseScale::level),
                            {.meaning = "of the series analysed: SI, counts, or 1 where unknown"}),
                rest_field(channel.rest), stationarity(channel),
                field::object_or_null("deviation", deviation_fields(channel),
                                      {.why_null = why_not_analysed(channel)})};
  append(fields, model_fields(channel));
  append(fields, noise_spectrum_fields(channel));
  append(fields, record_fields(channel));
  if (channel.temperature) fields.push_back(temperature(channel));
  return fields;
}

}  // namespace proofmass::report
