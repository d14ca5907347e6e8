#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/wheel/figures.hpp"
#include "proofmass/report/wheel/report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::WheelMethod;
using estimate::WheelSensorFit;
using estimate::WheelSolution;

constexpr double rpm_per_radps = 1.0 / radps_per_rpm;
constexpr Display degrees{"°", deg_per_rad}, millimetres{"mm", 1e3}, milliseconds{"ms", 1e3};

// An angle of less than a revolution is given in degrees.
std::string how_far(const Uncertain& turns) {
  const Uncertain size{std::abs(turns.value), turns.std};
  const std::string way = turns.value < 0.0 ? "backwards" : "forwards";
  if (size.value >= 1.0) return fmt::format("turned {} times {}", with_std(size), way);
  return fmt::format("turned by {} {}", with_std(*scaled(size, 360.0), "degrees"), way);
}

// "turned 19.53 (probability 0.6) or 20.53 (0.4) times"
std::string candidate_words(const std::vector<estimate::TurnsCandidate>& candidates) {
  std::string words = "turned ";
  for (std::size_t i = 0; i < candidates.size(); ++i)
    words += fmt::format("{}{} ({}{})", i == 0 ? "" : " or ", fixed(candidates[i].turns.value, 2),
                         i == 0 ? "probability " : "", significant(candidates[i].probability, 2));
  return words + " times";
}

std::string conclusion(const WheelSolution& solution) {
  const std::vector<double>& time_s = solution.series.time_s;
  const std::string when =
      time_s.empty() ? "" : " in " + duration_words(time_s.back() - time_s.front());
  std::string words;
  if (solution.turns_candidates.size() > 1)
    words = fmt::format("The wheel {}{}", candidate_words(solution.turns_candidates), when);
  else if (solution.turns)
    words = fmt::format("The wheel {}{}", how_far(*solution.turns), when);
  else
    words = fmt::format("This recording does not determine how far the wheel turned{}", when);
  if (!solution.peak_speed_radps) return words + ".";
  const double rpm = std::abs(solution.peak_speed_radps->value) * rpm_per_radps;
  return fmt::format("{}; top speed {} rpm.", words, significant(rpm, 3));
}

std::string delay_words(const WheelReport& report) {
  const std::string delay = with_std(*scaled(report.solution.delay_s, 1e3), "ms");
  if (report.options.bandwidth_hz)
    return fmt::format("The delay of the sensor's filter ({} Hz), {}, is corrected.",
                       significant(*report.options.bandwidth_hz, 3), delay);
  if (report.solution.encoder)
    return fmt::format(
        "The bandwidth of the sensor's filter is unknown: its delay was estimated by the encoder, "
        "as far as the speed changes, as {}.",
        delay);
  return fmt::format(
      "The bandwidth of the sensor's filter is unknown: its delay was assumed to be {}. The "
      "bandwidth, from the datasheet or the filter's capacitor, determines it.",
      delay);
}

Fields method_fields(const WheelMethod& method) {
  const bool has_std = method.turns && method.turns->std > 0.0;
  return {field::number("turns", method.turns ? std::optional(method.turns->value) : std::nullopt,
                        {.why_null = method.note}),
          field::number(
              "turns_std", has_std ? std::optional(method.turns->std) : std::nullopt,
              {.why_null = method.turns ? "the method has no standard deviation" : method.note}),
          field::text("note", method.note)};
}

Field pair(const char* key,
           const std::array<std::optional<Uncertain>, 2>& figures,
           const char* unit,
           const std::string& label) {
  Fields items;
  for (std::size_t i = 0; i < 2; ++i)
    items.push_back(
        field::measured({}, figures[i], unit, {.label = fmt::format("{}, axis {}", label, i + 1)}));
  return field::fixed_list(key, std::move(items), {.meaning = "of in-plane axis 1 and 2"});
}

Field spin_axis(const WheelSensorFit& fit) {
  return field::numbers("spin_axis", fit.spin_axis,
                        {.meaning = "unit vector in the sensor's axes", .label = "Spin axis"});
}

// Relative to the first sensor: exactly zero for the first sensor itself, as is the offset of a
// shared clock.
std::optional<Uncertain> relative(const std::optional<Uncertain>& figure, bool zero) {
  return !figure && zero ? Uncertain{0.0, 0.0} : figure;
}

Fields sensor_fields(const WheelSensorFit& fit, bool first, bool clocks_shared) {
  return {
      field::text("file", fit.name, {.label = "Sensor"}),
      field::measured("radius_m", fit.radius_m, "m",
                      {.meaning = "distance of the sensor from the axle",
                       .label = "Distance from the axle",
                       .display = millimetres}),
      pair("bias", fit.bias_mps2, "m/s^2", "Bias"),
      pair("scale", fit.scale, "1", "Scale"),
      spin_axis(fit),
      field::flag("spin_axis_given", fit.spin_axis_given,
                  {.meaning = "by the user, rather than found"}),
      field::measured("mounting_rad", fit.mounting_rad, "rad",
                      {.meaning = "in-plane axis 1 against the spoke through the sensor",
                       .label = "Mounting, axis 1 against the spoke",
                       .display = degrees}),
      field::measured("skew_rad", fit.skew_rad, "rad",
                      {.meaning = "in-plane axes against orthogonal",
                       .label = "Non-orthogonality",
                       .display = degrees}),
      field::measured("phase_rad", relative(fit.phase_rad, first), "rad",
                      {.meaning = "azimuth about the axle against the first sensor",
                       .label = "Azimuth against the first sensor",
                       .display = degrees}),
      field::measured("clock_offset_s", relative(fit.clock_offset_s, first || clocks_shared), "s",
                      {.meaning = "against the first sensor",
                       .label = "Clock against the first sensor",
                       .display = milliseconds}),
      field::magnitude("noise_mps2", fit.noise_mps2,
                       {.meaning = "standard deviation of one sample",
                        .label = "Noise of a sample",
                        .display = Display{"m/s²"}}),
      field::count("samples", fit.samples, {.meaning = "recorded", .label = "Samples"}),
      field::count("unusable", fit.unusable,
                   {.meaning = "without a value on every channel", .label = "Unusable"}),
      field::count("gated", fit.gated, {.meaning = "rejected by the gate", .label = "Rejected"})};
}

Field gyroscope(const WheelSolution& solution) {
  std::optional<Fields> fields;
  const auto fit = std::ranges::find_if(solution.sensors, &WheelSensorFit::has_gyro);
  if (fit != solution.sensors.end())
    fields = Fields{field::measured("bias", fit->gyro_bias_radps, "rad/s", {.label = "Bias"}),
                    field::measured("scale", fit->gyro_scale, "1", {.label = "Scale"})};
  return field::object_or_null("gyroscope", std::move(fields),
                               {.meaning = "about the axle, of the first sensor that has one",
                                .why_null = "no gyroscope was used"});
}

Fields slip_fields(const signal::CountSlip& slip) {
  return {
      field::number("time_s", slip.time_s),
      field::interval("interval_95_s", std::array{slip.start_s, slip.end_s}),
      field::integer("counts", slip.counts,
                     {.meaning = "change of the count; negative if counts were missed forwards"})};
}

Field encoder(const WheelSolution& solution) {
  std::optional<Fields> fields;
  if (solution.encoder) {
    const estimate::WheelEncoderFit& fit = *solution.encoder;
    const auto error = [&](const char* key, std::size_t at, const char* label) {
      return field::measured(key, fit.errors_rad[at], "rad", {.label = label, .display = degrees});
    };
    fields = Fields{
        field::text("channel", fit.name, {.label = "Channel"}),
        field::flag("reversed", fit.direction < 0.0,
                    {.meaning = "its angle falls where the wheel's rises", .label = "Reversed"}),
        field::measured("offset_rad", fit.offset_rad, "rad",
                        {.meaning = "its angle, in the wheel's direction, less the wheel's",
                         .label = "Offset",
                         .display = degrees}),
        error("once_cos_rad", 0, "Error once a turn, cosine"),
        error("once_sin_rad", 1, "Error once a turn, sine"),
        error("twice_cos_rad", 2, "Error twice a turn, cosine"),
        error("twice_sin_rad", 3, "Error twice a turn, sine"),
        field::records("missed_counts", fit.missed, slip_fields),
        field::magnitude("noise_rad", fit.noise_rad,
                         {.meaning = "standard deviation of one angle at a sample",
                          .label = "Noise of an angle",
                          .display = degrees})};
  }
  return field::object_or_null("encoder", std::move(fields),
                               {.meaning = "shown angle less true angle, over the shown angle",
                                .why_null = "no encoder was used"});
}

Fields candidate_fields(const estimate::TurnsCandidate& candidate) {
  return {field::number("value", candidate.turns.value), field::number("std", candidate.turns.std),
          field::probability("probability", candidate.probability)};
}

Fields stretch_fields(const estimate::Stretch& stretch) {
  return {field::number("start_s", stretch.start_s), field::number("end_s", stretch.end_s),
          field::count("rows", stretch.rows), field::text("reason", stretch.reason)};
}

Field sensors(const WheelReport& report) {
  const std::vector<WheelSensorFit>& fits = report.solution.sensors;
  return field::records("sensors", fits, [&](const WheelSensorFit& fit) {
    return sensor_fields(fit, &fit == &fits.front(), report.options.clocks_shared);
  });
}

Field methods(const WheelSolution& solution) {
  return field::object(
      "methods", {field::object("double_integration", method_fields(solution.double_integration)),
                  field::object("atan2", method_fields(solution.atan2)),
                  field::object("ekf", method_fields(solution.ekf)),
                  field::object("smoother", method_fields(solution.smoother))});
}

std::string distance_label(const WheelSolution& solution) {
  if (solution.distance_of.empty()) return "Distance";
  return "Distance, path of " + file_name(solution.distance_of);
}

Fields wheel_fields(const WheelReport& report) {
  const WheelSolution& solution = report.solution;
  const std::vector<double>& time_s = solution.series.time_s;
  const std::string& why = solution.smoother.note;
  return {
      field::measured("turns", solution.turns, "turn",
                      {.meaning = "signed about the spin axis; null where the count is ambiguous",
                       .label = "Turns",
                       .why_null = why,
                       .display = Display{}}),
      field::records("turns_candidates", solution.turns_candidates, candidate_fields,
                     {.meaning = "where the count is ambiguous, each with its probability"}),
      field::measured("distance_m", solution.distance_m, "m",
                      {.meaning = "length of the path of the sensor, or of the rim",
                       .label = distance_label(solution),
                       .why_null = "no radius is known or determined"}),
      field::text("distance_of", solution.distance_of, {.meaning = "whose path it is"}),
      field::measured("angle_final_rad", solution.angle_final_rad, "rad",
                      {.meaning = "unwrapped, at the last sample",
                       .label = "Final angle",
                       .why_null = why,
                       .display = degrees}),
      field::measured("peak_speed_rpm", scaled(solution.peak_speed_radps, rpm_per_radps), "rpm",
                      {.label = "Top speed", .why_null = why}),
      field::number("duration_s", time_s.empty() ? 0.0 : time_s.back() - time_s.front()),
      field::number("gravity_mps2", report.options.gravity_mps2, {.meaning = "as assumed"}),
      field::flag("clocks_shared", report.options.clocks_shared,
                  {.meaning = "the sensors were sampled by one clock"}),
      field::measured(
          "delay_s", solution.delay_s, "s",
          {.meaning = "of the sensors' filters, given, assumed or shown by an encoder"}),
      field::measured(
          "rolling_radius_m", solution.rolling_radius_m, "m",
          {.meaning = "of a vehicle's wheel, where its acceleration shows it",
           .label = solution.rolling_radius_m ? "Rolling radius" : "",
           .why_null = report.options.rolling_radius_m
                           ? "given"
                           : "needs a gyroscope or an encoder and changes of a vehicle's speed",
           .display = millimetres}),
      sensors(report),
      gyroscope(solution),
      encoder(solution),
      field::count("rejected_samples", solution.rejected_samples, {.label = "Rows rejected"}),
      field::records("rejected", solution.rejected, stretch_fields),
      methods(solution),
      consistency_field(solution.consistency),
      field::texts("not_observable", solution.not_observable,
                   {.meaning = "what the recording does not determine, and what would"}),
      field::notes(all_notes(report.notes, report.solution.notes))};
}

Table methods_table(const WheelSolution& solution) {
  Table table{"Turns by method", {"Method", "Turns", "Difference", "Remark"}, {}};
  const auto add = [&](const char* name, const WheelMethod& method) {
    const bool both = method.turns && solution.smoother.turns && &method != &solution.smoother;
    table.rows.push_back(
        {name, with_std(method.turns, "", "none"),
         both ? significant(method.turns->value - solution.smoother.turns->value, 2) : "",
         print_unit(method.note)});
  };
  add("Smoother", solution.smoother);
  add("Filter (EKF)", solution.ekf);
  add("atan2", solution.atan2);
  add("Double integration", solution.double_integration);
  return table;
}

Section sensors_section(const WheelReport& report, const Fields& fields) {
  const auto entry = [&](std::string_view key) -> const Field& {
    return *std::ranges::find(fields, key, &Field::key);
  };
  Section section{
      .heading = "The sensors",
      .paragraphs = {delay_words(report)},
      .tables = {records_table("In-plane axes 1 and 2: output = scale · specific force + bias",
                               entry("sensors"))},
      .on_terminal = true};
  if (const auto& gyro = entry("gyroscope").fields)
    section.tables.push_back(fields_table("Gyroscope about the axle", *gyro));
  if (const auto& encoder = entry("encoder").fields)
    section.tables.push_back(fields_table("Encoder on the axle", *encoder));
  return section;
}

Section consistency_and_rejected(const WheelSolution& solution) {
  Section section = consistency_section(solution.consistency);
  section.figures = {[&] { return innovations_figure(solution); }};
  if (solution.rejected.empty()) return section;
  Table table{"Rejected measurements", {"From", "To", "Rows", "Reason"}, {}};
  table.page_only = table.long_list = true;
  for (const estimate::Stretch& stretch : solution.rejected)
    table.rows.push_back({fixed(stretch.start_s, 3) + " s", fixed(stretch.end_s, 3) + " s",
                          std::to_string(stretch.rows), stretch.reason});
  section.tables.insert(section.tables.begin(), std::move(table));
  return section;
}

Section method_section(const WheelReport& report) {
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "Each accelerometer on the wheel measures gravity, which rotates in its frame, the "
          "centripetal acceleration ω²r and the tangential acceleration αr. An extended Kalman "
          "filter estimates angle, speed and angular acceleration jointly with the sensors' "
          "biases, "
          "scales, positions and mounting angles; measurements far from their prediction are "
          "rejected. A fixed-interval smoother then uses all measurements at every sample. The "
          "standard deviations are those of the smoother.",
          "For comparison: atan2 takes the direction of the measured force for that of gravity; "
          "double integration integrates the tangential acceleration twice.",
          fmt::format("Gravity was taken as {} m/s².", fixed(report.options.gravity_mps2, 5))}};
}

}  // namespace

Document describe(const WheelReport& report) {
  const WheelSolution& solution = report.solution;
  Document document{.page = {.verb = "wheel",
                             .title = file_names(report.inputs),
                             .inputs = report.inputs,
                             .conclusion = conclusion(solution),
                             .notes = all_notes(report.notes, report.solution.notes)},
                    .fields = wheel_fields(report),
                    .warnings = solution.not_observable,
                    .bad = std::ranges::any_of(solution.sensors, [](const WheelSensorFit& fit) {
                      return fit.unusable > 0;
                    })};
  Page& page = document.page;
  page.key_figures = key_figures(document.fields);
  page.key_figures.push_back({"Mean NIS (1 expected)", fixed(solution.consistency.nis, 3)});
  page.sections.push_back({.heading = "Angle",
                           .tables = {methods_table(solution)},
                           .figures = {[&] { return turns_figure(solution); },
                                       [&] { return plain_methods_figure(solution); },
                                       [&] { return filter_figure(solution); },
                                       [&] { return angle_std_figure(solution); }},
                           .on_terminal = true});
  page.sections.push_back(
      {.heading = "Speed", .figures = {[&] { return speed_figure(solution); }}});
  page.sections.push_back(sensors_section(report, document.fields));
  if (!solution.not_observable.empty())
    page.sections.push_back({.heading = "Not identifiable from this recording",
                             .points = solution.not_observable,
                             .on_terminal = true});
  page.sections.push_back(consistency_and_rejected(solution));
  page.sections.push_back(method_section(report));
  return document;
}

}  // namespace proofmass::report
