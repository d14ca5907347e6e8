#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/calibrate/encoder_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::EncoderCalibration;
using calibrate::EncoderHarmonic;
using signal::CountSlip;

constexpr const char* not_seen =
    "not distinguishable from zero: amplitude_95_rad has an upper bound";

Fields harmonic_fields(const EncoderHarmonic& one) {
  return {field::count("per_turn", static_cast<std::size_t>(one.per_turn),
                       {.meaning = "cycles a turn; 1 is eccentricity"}),
          field::measured("amplitude", one.amplitude_rad, "rad",
                          {.meaning = "A in A cos(n theta + phase), shown less true angle",
                           .why_null = not_seen}),
          field::interval("amplitude_95_rad", one.amplitude_95_rad),
          field::measured("phase", one.phase_rad, "rad",
                          {.meaning = "at the encoder's zero: its index pulse, or count 0",
                           .why_null = not_seen}),
          field::interval("phase_95_rad", one.phase_95_rad, {.why_null = not_seen}),
          field::measured("cos", one.cos_rad, "rad"),
          field::measured("sin", one.sin_rad, "rad"),
          field::magnitude("half_width_95_rad", one.half_width_95_rad,
                           {.meaning = "of the 95 % intervals of cos and sin"}),
          field::probability("chance_p", one.chance_p,
                             {.meaning = "probability of such values without this error"})};
}

struct NamedSlip {
  CountSlip slip;
  const char* by = "gravity";
};

std::vector<NamedSlip> slips_in(const EncoderReport& report) {
  std::vector<NamedSlip> all;
  for (const CountSlip& slip : report.fit.missed) all.push_back({slip, "gravity"});
  for (const CountSlip& slip : report.index_slips) all.push_back({slip, "index"});
  std::ranges::stable_sort(all, {}, [](const NamedSlip& one) { return one.slip.time_s; });
  return all;
}

Fields slip_fields(const NamedSlip& one) {
  return {
      field::number("time_s", one.slip.time_s),
      field::interval("interval_95_s", std::array{one.slip.start_s, one.slip.end_s}),
      field::integer("counts", one.slip.counts,
                     {.meaning = "change of the count; negative if counts were missed forwards"}),
      field::choice("by", one.by, {"gravity", "index"},
                    {.meaning = "what shows it: the accelerometers, whose slips are removed "
                                "before the fit, or two index pulses"})};
}

Fields share_fields(const calibrate::EncoderShare& one) {
  return {field::text("source", one.source),
          field::choice("type", one.type_a ? "A" : "B", {"A", "B"}),
          field::magnitude("once_std_rad", one.std_rad[0]),
          field::magnitude("twice_std_rad", one.std_rad[1])};
}

Fields axis_fields_of(const EncoderCalibration& fit, std::size_t at) {
  return {field::text("name", fit.axis_names[at]),
          field::magnitude("residual_rms_mps2", fit.residual_rms_mps2[at])};
}

Fields encoder_fields(const EncoderReport& report) {
  const EncoderCalibration& fit = report.fit;
  Fields axes, rows;
  for (std::size_t at = 0; at < fit.axis_names.size(); ++at)
    axes.push_back(field::object({}, axis_fields_of(fit, at)));
  for (Eigen::Index i = 0; i < 4; ++i)
    rows.push_back(field::numbers({}, Eigen::Vector4d(fit.covariance.row(i))));
  const std::optional<double> step =
      fit.step_rad > 0.0 ? std::optional(fit.step_rad) : std::nullopt;
  return {
      field::choice("mode", "encoder", {"encoder"}),
      field::text("channel", report.channel, {.meaning = "of the encoder"}),
      field::magnitude("resolution_rad", step,
                       {.meaning = "one count",
                        .why_null = "the angle has no visible steps: give --counts-per-turn"}),
      field::records(
          "harmonics", fit.harmonics, harmonic_fields,
          {.meaning = "errors of the encoder; the orders 3 and 4 are fitted because they "
                      "resemble the first two"}),
      field::fixed_list("covariance", std::move(rows),
                        {.meaning = "of cos and sin once a turn, cos and sin twice a turn, rad^2"}),
      field::records("missed_counts", slips_in(report), slip_fields),
      field::integer("detectable_counts", fit.detectable_counts,
                     {.meaning = "the fewest counts missed at once that are found",
                      .why_null = "the angle has no visible steps, or the recording is too short"}),
      field::records("budget", fit.shares, share_fields,
                     {.meaning = "contributions to the standard deviations of cos and sin, rms"}),
      field::measured("delay_s", fit.delay_s, "s",
                      {.meaning = "of the accelerometers after the encoder; with its prior if one "
                                  "speed does not show it"}),
      field::list("axes", std::move(axes), {.meaning = "accelerometer channels used"}),
      field::magnitude("nonlinearity", fit.nonlinearity,
                       {.meaning = "standard deviation assumed of the accelerometers at 1 g"}),
      field::magnitude("turns", fit.turns, {.meaning = "sum over both directions"}),
      field::magnitude("speed_min_radps", fit.speed_min_radps),
      field::magnitude("speed_max_radps", fit.speed_max_radps),
      field::count("samples", fit.samples),
      field::count("blocks", fit.blocks),
      field::magnitude("dof", fit.dof, {.meaning = "of type A"}),
      field::flag("converged", fit.converged),
      field::notes(report.notes)};
}

std::string order_words(int per_turn) {
  if (per_turn == 1) return "once a turn";
  return per_turn == 2 ? "twice a turn" : fmt::format("{} times a turn", per_turn);
}

std::string amplitude_words(const EncoderHarmonic& one) {
  if (one.amplitude_rad) return with_std(*scaled(one.amplitude_rad, 1e3), "mrad");
  return fmt::format("below {} mrad", significant(1e3 * one.amplitude_95_rad[1], 2));
}

std::string conclusion(const EncoderReport& report) {
  const EncoderCalibration& fit = report.fit;
  const EncoderHarmonic& once = fit.harmonics[0];
  std::string text = fmt::format(
      "{} turns: eccentricity {}", fixed(fit.turns, 1),
      once.amplitude_rad
          ? with_std(*scaled(once.amplitude_rad, 100.0), "%") + ", " + amplitude_words(once)
          : amplitude_words(once));
  text += fmt::format("; twice a turn {}.", amplitude_words(fit.harmonics[1]));
  const std::size_t slips = fit.missed.size();
  if (fit.step_rad > 0.0)
    text += slips == 0 ? std::string(" No missed counts.")
                       : fmt::format(" Counts were missed {}.", count_words(slips, "time"));
  return text;
}

Table harmonics_table(const EncoderReport& report) {
  Table table{"Error of the encoder, amplitude · cos(n θ + phase); ± one standard deviation",
              {"Order", "Amplitude", "95 %", "Phase", "95 %"},
              {}};
  for (const EncoderHarmonic& one : report.fit.harmonics) {
    std::vector<std::string> row{
        order_words(one.per_turn), amplitude_words(one),
        fmt::format("{} to {} mrad", significant(1e3 * one.amplitude_95_rad[0], 3),
                    significant(1e3 * one.amplitude_95_rad[1], 3)),
        degree_words(one.phase_rad),
        one.phase_95_rad ? fmt::format("{} to {}°", fixed((*one.phase_95_rad)[0] * deg_per_rad, 1),
                                       fixed((*one.phase_95_rad)[1] * deg_per_rad, 1))
                         : std::string()};
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table slips_table(const EncoderReport& report) {
  Table table{"Missed counts", {"Time", "95 %", "Counts", "By"}, {}};
  table.long_list = true;
  for (const NamedSlip& one : slips_in(report))
    table.rows.push_back(
        {fixed(one.slip.time_s, 3) + " s",
         fmt::format("{} to {} s", fixed(one.slip.start_s, 3), fixed(one.slip.end_s, 3)),
         fmt::format("{:+d}", one.slip.counts), one.by});
  return table;
}

Table budget_table(const EncoderReport& report) {
  Table table{"Standard deviation of the cosine and sine components, by cause",
              {"Source", "Type", "Once a turn", "Twice a turn"},
              {}};
  for (const calibrate::EncoderShare& one : report.fit.shares)
    table.rows.push_back({one.source, one.type_a ? "A" : "B",
                          significant(1e3 * one.std_rad[0], 2) + " mrad",
                          significant(1e3 * one.std_rad[1], 2) + " mrad"});
  return table;
}

std::vector<std::string> facts(const EncoderReport& report) {
  const EncoderCalibration& fit = report.fit;
  std::vector<std::string> out;
  if (fit.step_rad > 0.0)
    out.push_back(fmt::format("One count is {} mrad ({} counts a turn).",
                              significant(1e3 * fit.step_rad, 3),
                              fixed(rad_per_turn / fit.step_rad, 0)));
  if (fit.detectable_counts)
    out.push_back(
        fmt::format("{} missed at once would be found with a probability of one half or more.",
                    count_words(static_cast<std::size_t>(*fit.detectable_counts), "count")));
  out.push_back(fmt::format("Speed {} to {} rpm.",
                            significant(fit.speed_min_radps / radps_per_rpm, 3),
                            significant(fit.speed_max_radps / radps_per_rpm, 3)));
  return out;
}

Figure error_figure(const EncoderReport& report) {
  const EncoderCalibration& fit = report.fit;
  Figure figure{.title = "Error of the encoder against the wheel's angle",
                .description =
                    "Encoder less gravity's direction in sixteenths of a turn, and the "
                    "fitted error.",
                .x = {.label = "Angle (°)", .min = 0.0, .max = 360.0},
                .y = {.label = "Encoder − gravity (mrad)"}};
  Curve points{"encoder − gravity", {}, {}, Ink::grey, Mark::points};
  for (std::size_t k = 0; k < fit.offset_rad.size(); ++k) {
    const double turns = fit.offset_angle_rad[k] / rad_per_turn;
    points.x.push_back(360.0 * (turns - std::floor(turns)));
    points.y.push_back(1e3 * fit.offset_rad[k]);
  }
  Curve line{"fitted", {}, {}, Ink::blue};
  for (int degree = 0; degree <= 360; degree += 3) {
    double error = 0.0;
    for (const EncoderHarmonic& one : fit.harmonics)
      error += one.cos_rad.value * std::cos(one.per_turn * degree * rad_per_deg) +
               one.sin_rad.value * std::sin(one.per_turn * degree * rad_per_deg);
    line.x.push_back(degree);
    line.y.push_back(1e3 * error);
  }
  figure.curves = {std::move(points), std::move(line)};
  return figure;
}

Figure residual_figure(const EncoderReport& report) {
  const EncoderCalibration& fit = report.fit;
  Curve points{"encoder − gravity − fitted error", {}, {}, Ink::blue, Mark::points};
  for (std::size_t k = 0; k < fit.offset_rad.size(); ++k) {
    points.x.push_back(fit.offset_time_s[k]);
    points.y.push_back(1e3 * (fit.offset_rad[k] - fit.fitted_rad[k]));
  }
  return {.title = "Residual against time",
          .description =
              "After removal of the missed counts; a step would be one that was not "
              "found.",
          .x = {.label = "Time (s)"},
          .y = {.label = "Residual (mrad)"},
          .curves = {std::move(points)},
          .levels = {{"", 0.0}}};
}

Section method_section_of() {
  return {.heading = "How it was computed",
          .paragraphs = {
              "The reference is gravity as the accelerometers on the wheel show it. Their bias "
              "displaces the circle on which gravity moves, an eccentricity does not: it appears "
              "twice a turn in each axis, the second order three times. Bias, scale, skew, "
              "mounting, lever arm and drift of every axis are fitted together with the encoder's "
              "errors. The accelerometers' nonlinearity, the run-out of the axle and the speed's "
              "own ripple through the lever arm resemble an eccentricity; what the recording does "
              "not separate is in the intervals, with the standard deviations assumed of them.",
              "A constant offset of the encoder is its mounting angle, which gravity does not "
              "show."}};
}

}  // namespace

Document describe(const EncoderReport& report) {
  Document document{.page = {.verb = "calibrate",
                             .title = "Calibration of an encoder against gravity",
                             .inputs = report.inputs,
                             .conclusion = conclusion(report),
                             .notes = report.notes},
                    .fields = encoder_fields(report)};
  document.bad = !report.fit.converged;
  Section errors{
      .heading = "Errors of the encoder",
      .points = facts(report),
      .tables = {harmonics_table(report)},
      .figures = {[&] { return error_figure(report); }, [&] { return residual_figure(report); }},
      .on_terminal = true};
  Table slips = slips_table(report);
  if (!slips.rows.empty()) errors.tables.push_back(std::move(slips));
  document.page.sections = {
      std::move(errors),
      {.heading = "Uncertainty", .tables = {budget_table(report)}, .on_terminal = true},
      method_section_of()};
  return document;
}

Recording encoder_series(const EncoderReport& report) {
  const EncoderCalibration& fit = report.fit;
  Recording out;
  out.source = "proofmass calibrate";
  out.format = "series";
  out.time.source = TimeSource::stamps;
  out.time.stamps_s = fit.offset_time_s;
  const Unit radian = *parse_unit("rad");
  out.channels = {{"angle", radian, fit.offset_angle_rad},
                  {"encoder_minus_gravity", radian, fit.offset_rad},
                  {"fitted_error", radian, fit.fitted_rad}};
  return out;
}

}  // namespace proofmass::report
